/* Custom primitives in packets: Embree's callbacks run one primitive's intersection program for all lanes that may meet it.
 *
 * Primitive, instance and record are the same in all lanes. The order of decisions is that of device_custom.h.
 */
#ifndef OXRT_LANES_CUSTOM_H
#define OXRT_LANES_CUSTOM_H

#include <oxrt/lanes_candidate.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* The scalar ray of an intersection program over lanes: primitive, instance and geometry are set. */
template <int W> OXRT_INLINE const Ray& commonHit(const RayLanes<W>& ray) { return candidatesOf(ray).common; }

/* ---- boxes -------------------------------------------------------------------------------------------------------------------- */

/* 1 / x; for 0 a large number, so that a box is met from inside only. */
template <int W> OXRT_INLINE Lanes<float, W> inverseOf(Lanes<float, W> x) { return 1.0f / select(x == 0.0f, 1e-37f, x); }
template <int W> OXRT_INLINE Vector<Lanes<float, W>, 3> inverseOf(const Vector<Lanes<float, W>, 3>& v) {
    return {inverseOf(v.x), inverseOf(v.y), inverseOf(v.z)};
}

/* The lanes whose ray meets a box inside its interval; in doubt they do. */
template <int W>
OXRT_INLINE Lanes<bool, W> meetingBox(const Wide<float3, W>& origin, const Wide<float3, W>& inverse, const float* box, Lanes<float, W> tmin,
                                      Lanes<float, W> tmax) {
    Lanes<float, W> enter = tmin;
    Lanes<float, W> leave = tmax;
    for (int axis = 0; axis < 3; ++axis) {
        const Lanes<float, W> a = (box[axis] - origin[axis]) * inverse[axis];
        const Lanes<float, W> b = (box[axis + 3] - origin[axis]) * inverse[axis];
        enter = maximum(minimum(a, b), enter);
        leave = minimum(maximum(a, b), leave);
    }
    constexpr float rounding = 1e-6f;
    return !(enter > leave * select(leave < 0.0f, 1.0f - rounding, 1.0f + rounding));
}

/* Enters what the getters over lanes read of the primitive. Its instance and geometry come as values: read again from the scalar ray, where they
   were stored a moment ago, they would be fetched as one pair, which waits for both stores. */
template <int W>
OXRT_INLINE void enterCommonHit(CandidateLanes<W>& ray, const OxrtInstanceView* instance, uint32_t instanceId, const OxrtGeometry& geometry) {
    ray.commonInstance = instance;
    ray.commonGeometry = &geometry;
    storeLanes<uint32_t, W>(ray.packet.hit.primID, ray.common.primitive);
    storeLanes<uint32_t, W>(ray.packet.hit.geomID, ray.embreeGeometry);
    storeLanes<uint32_t, W>(ray.packet.hit.instID[0], instanceId);
}

/* ---- callbacks ---------------------------------------------------------------------------------------------------------------- */

/* Runs the program of one record. */
template <class Programs, int W>
__attribute__((noinline)) void runIntersection(CandidateLanes<W>& ray, Lanes<bool, W> mask, uint32_t recordIndex) {
    const OxrtLaunch& launch = *ray.thread->thread->launch;
    const OxrtRecordHeader* record =
        findRecord(launch, launch.hitgroupRecords, launch.hitgroupStride, launch.hitgroupCount, recordIndex);
    if (!record)
        return;
    ray.records.common = record;
    ray.active = mask;
    ray.ended = false;
    Programs::intersection(ray, mask, *static_cast<typename Programs::Payload*>(ray.payload), *record);
    if constexpr (Programs::Scalar::mayThrow)
        stopTraversals(ray, mask & ray.thread->thrown);
}

/* One custom primitive, for the lanes to which Embree offers it. */
template <class Programs, int W, class Arguments> OXRT_INLINE void runIntersections(CandidateLanes<W>& ray, const Arguments& offer) {
    using Scalar = typename Programs::Scalar;
    Lanes<bool, W> mask = without(loadValid<W>(offer.valid), ray.isTerminated);
    if (none(mask))
        return;
    const uint32_t instance = offer.context->instID[0], primitive = offer.primID;
    const OxrtInstanceView* const ownInstance = instance == RTC_INVALID_GEOMETRY_ID ? nullptr : ray.root->instances + instance;
    const auto& geometry = *static_cast<const OxrtGeometry*>(offer.geometryUserPtr);
    Ray& common = ray.common;
    common.instance = ownInstance;
    common.geometry = &geometry;
    common.primitive = primitive;
    ray.embreeGeometry = offer.geomID;
    if constexpr (Programs::callbacksReadHit)
        enterCommonHit(ray, ownInstance, instance, geometry);
    // what Embree itself found since
    const Lanes<float, W> tfar = packetLanes<W>(ray.objectRay->tfar);
    if (const Lanes<bool, W> nearer = mask & (tfar != ray.closestInEmbree); any(nearer)) {
        ray.closest = select(nearer, tfar, ray.closest);
        ray.closestInEmbree = select(nearer, tfar, ray.closestInEmbree);
    }
    if (geometry.hasUntestedBoxes) {
        const Wide<float3, W> inverse = inverseOf(getObjectRayDirection(ray));
        mask = mask & meetingBox<W>(getObjectRayOrigin(ray), inverse, geometry.vertices + 6 * uint64_t(primitive), ray.tmin, ray.closest);
        if (none(mask))
            return;
    }
    const uint32_t record = geometry.recordOffsets ? geometry.recordOffsets[primitive] : 0;
    const uint32_t instanceFlags = ownInstance ? ownInstance->flags : 0;
    if (Scalar::hasAnyHit || (ray.flags & RAY_CULL_ANY)) {
        const uint32_t flags = geometry.recordFlags[record];
        common.flags = ray.flags;
        ray.runsAnyHit = anyHitEnabled(common.flags, instanceFlags, flags);
        if ((ray.flags & RAY_CULL_ANY) && isCulled(common, instanceFlags, flags, ray.runsAnyHit))
            return;
    }
    const uint32_t base = ownInstance ? ownInstance->sbtOffset : 0;
    const uint32_t local = geometry.recordBase + record;
    if (ray.hasCommonRecord)
        return runIntersection<Programs>(ray, mask, base + local * ray.commonStride + ray.commonOffset);
    eachValue(mask, base + local * ray.sbtStride + ray.sbtOffset,
              [&](uint32_t index, Lanes<bool, W> equal) { runIntersection<Programs>(ray, equal, index); });
}

template <class Programs, int W> void intersectCustoms(const RTCIntersectFunctionNArguments* a) {
    if (const OxrtOwnShape* own = ownShape(*a))
        return own->intersect(a, nullptr); /* curves with filters are traced lane by lane */
    CandidateLanes<W>& ray = *reinterpret_cast<QueryLanes<W>*>(a->context)->candidates;
    auto& rayhit = *static_cast<typename Packet<W>::RayHit*>(a->rayhit);
    ray.objectRay = &rayhit.ray;
    ray.embreeHit = &rayhit.hit;
    runIntersections<Programs>(ray, *a);
}
template <class Programs, int W> void occludeCustoms(const RTCOccludedFunctionNArguments* a) {
    if (const OxrtOwnShape* own = ownShape(*a))
        return own->occluded(a, nullptr);
    CandidateLanes<W>& ray = *reinterpret_cast<QueryLanes<W>*>(a->context)->candidates;
    ray.objectRay = static_cast<typename CandidateLanes<W>::PacketRay*>(a->ray);
    ray.embreeHit = nullptr;
    runIntersections<Programs>(ray, *a);
}

/* ---- attributes --------------------------------------------------------------------------------------------------------------- */

template <int W> struct AttributeLanes {
    Lanes<uint32_t, W> words[8];
    int count = 0;
};
template <int W, class... T> OXRT_INLINE AttributeLanes<W> attributeLanes(T... values) {
    AttributeLanes<W> result;
    ((result.words[result.count++] = bitCast<uint32_t>(values)), ...);
    return result;
}
template <class Attributes, int W> OXRT_INLINE AttributeLanes<W> attributesToLanes(const Wide<Attributes, W>& attributes) {
    AttributeLanes<W> result;
    result.count = int(sizeof(Attributes) / 4);
    if constexpr (Wide<Attributes, W>::hasWrappedFields)
        for (int lane = 0; lane < W; ++lane) {
            Attributes own;
            extractLane(own, attributes, lane);
            uint32_t words[8];
            __builtin_memcpy(words, &own, sizeof(own));
            for (int i = 0; i < result.count; ++i)
                result.words[i].set(lane, words[i]);
        }
    else {
        int next = 0;
        Wide<Attributes, W> copy = attributes;
        eachPart([&](auto& part) { result.words[next++] = bitCast<uint32_t>(part); }, copy);
    }
    return result;
}

/* ---- reports ------------------------------------------------------------------------------------------------------------------ */

/* Makes the reported hits the closest ones of their lanes. */
template <class Programs, int W>
OXRT_INLINE void commitReports(CandidateLanes<W>& ray, Lanes<bool, W> mask, Lanes<float, W> t, Lanes<uint32_t, W> kind,
                               const AttributeLanes<W>& attributes) {
    ray.closest = select(mask, t, ray.closest);
    if (!ray.embreeHit) { /* of an occlusion query nothing is asked but whether there is a hit */
        stopTraversals(ray, mask);
        return;
    }
    for (int i = 0; Programs::attributeWords > 0 && i < attributes.count; ++i)
        ray.committedAttributes[i] = select(mask, attributes.words[i], ray.committedAttributes[i]);
    ray.committedKind = select(mask, kind, ray.committedKind);
    auto& hit = *ray.embreeHit;
    storeLanes<uint32_t, W>(hit.primID, select(mask, ray.common.primitive, packetLanes<W>(hit.primID)));
    storeLanes<uint32_t, W>(hit.geomID, select(mask, ray.embreeGeometry, packetLanes<W>(hit.geomID)));
    if (ray.common.instance) { /* where structures have no instances the packet says so from the beginning */
        const uint32_t instance = uint32_t(ray.common.instance - ray.root->instances);
        storeLanes<uint32_t, W>(hit.instID[0], select(mask, instance, packetLanes<W>(hit.instID[0])));
    }
    ray.closestInEmbree = select(mask, nextDown(t), ray.closestInEmbree);
    auto& tfar = ray.objectRay->tfar;
    storeLanes<float, W>(tfar, select(mask, ray.closestInEmbree, packetLanes<W>(tfar)));
}

/* Offers hits of the intersection program; the lanes where they are accepted. Lanes whose ray ends leave the program at once. */
template <class Programs, int W>
OXRT_INLINE Lanes<bool, W> reportIntersection(RayLanes<W>& base, Lanes<bool, W> mask, Wide<float, W> t, Wide<uint32_t, W> kind,
                                              const AttributeLanes<W>& attributes = {}) {
    CandidateLanes<W>& ray = candidatesOf(base);
    Lanes<bool, W> accepted = mask & (ray.tmin <= t) & (t <= ray.closest);
    if (none(accepted))
        return accepted;
    const Lanes<uint32_t, W> hitKind = kind & 0xFFu;
    Lanes<bool, W> stopped = false;
    if constexpr (Programs::Scalar::hasAnyHit)
        if (ray.runsAnyHit) {
            for (int i = 0; Programs::attributeWords > 0 && i < attributes.count; ++i)
                ray.attributes[i] = attributes.words[i];
            ray.kind = hitKind;
            ray.t = t;
            const Lanes<bool, W> outer = ray.active;
            ray.active = accepted;
            accepted = runAnyHits<Programs>(ray);
            ray.active = outer;
            stopped = ray.stopped;
        }
    if (ray.flags & RAY_TERMINATE_ON_FIRST_HIT)
        stopped |= accepted;
    if (any(accepted))
        commitReports<Programs>(ray, accepted, t, hitKind, attributes);
    if (any(stopped)) {
        stopTraversals(ray, stopped);
        ray.ended |= stopped;
    }
    return accepted;
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
