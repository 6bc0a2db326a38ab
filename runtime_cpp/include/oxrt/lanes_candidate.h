/* Embree's callbacks for packets: candidates of all lanes judged at once, intersection programs over lanes.
 *
 * The order of decisions is that of device_candidate.h and device_custom.h, lane by lane the same.
 */
#ifndef OXRT_LANES_CANDIDATE_H
#define OXRT_LANES_CANDIDATE_H

#include <oxrt/lanes_loops.h>
#include <oxrt/lanes_records.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* The candidates of one trace while its callbacks run. `packet` holds the world's rays; Embree's own packet may be in object space. */
template <int W> struct CandidateLanes : RayLanes<W> {
    using PacketRay = decltype(Packet<W>::RayHit::ray);
    using PacketHit = decltype(Packet<W>::RayHit::hit);
    PacketRay* objectRay;
    PacketHit* embreeHit; /* null in occlusion queries */
    Lanes<bool, W> ignored, stopped; /* what any-hit programs decided */
    Lanes<bool, W> ended;            /* lanes whose program called something that does not return */
    Lanes<bool, W> isTerminated;
    Lanes<bool, W> runsAnyHit;
    Lanes<float, W> closest;         /* t of the closest accepted hits, or the callers' tmax */
    Lanes<float, W> closestInEmbree; /* what stands for `closest` in Embree's packet */
    Lanes<uint32_t, W> committedKind;
    Lanes<uint32_t, W> committedAttributes[8];

    OXRT_INLINE explicit CandidateLanes(typename Packet<W>::RayHit& rays) : RayLanes<W>(rays) {}
};

/* What Embree hands to the callbacks. */
template <int W> struct QueryLanes {
    RTCRayQueryContext context;
    CandidateLanes<W>* candidates;
};

template <int W> OXRT_INLINE CandidateLanes<W>& candidatesOf(RayLanes<W>& ray) { return static_cast<CandidateLanes<W>&>(ray); }
template <int W> OXRT_INLINE const CandidateLanes<W>& candidatesOf(const RayLanes<W>& ray) {
    return static_cast<const CandidateLanes<W>&>(ray);
}

template <int W> OXRT_INLINE Wide<float3, W> getObjectRayOrigin(const RayLanes<W>& ray) {
    const auto& r = *candidatesOf(ray).objectRay;
    return {packetLanes<W>(r.org_x), packetLanes<W>(r.org_y), packetLanes<W>(r.org_z)};
}
template <int W> OXRT_INLINE Wide<float3, W> getObjectRayDirection(const RayLanes<W>& ray) {
    const auto& r = *candidatesOf(ray).objectRay;
    return {packetLanes<W>(r.dir_x), packetLanes<W>(r.dir_y), packetLanes<W>(r.dir_z)};
}

/* ---- ends of any-hit programs: the lanes leave the program right after -------------------------------------------------------- */

template <int W> OXRT_INLINE void ignoreIntersection(RayLanes<W>& ray, Lanes<bool, W> mask) {
    candidatesOf(ray).ignored |= mask;
    candidatesOf(ray).ended |= mask;
}
template <int W> OXRT_INLINE void terminateRay(RayLanes<W>& ray, Lanes<bool, W> mask) {
    candidatesOf(ray).stopped |= mask;
    candidatesOf(ray).ended |= mask;
}
/* The lanes whose program or a helper has called something that does not return. */
template <int W> OXRT_INLINE Lanes<bool, W> endedLanes(const RayLanes<W>& ray) { return candidatesOf(ray).ended; }

/* ---- judgement ---------------------------------------------------------------------------------------------------------------- */

/* The flag word of each candidate's record. */
template <int W> OXRT_INLINE Lanes<uint32_t, W> geometryFlags(const RayLanes<W>& ray) {
    const Lanes<uint32_t, W> record = localRecord(ray);
    if (ray.commonGeometry && !ray.commonGeometry->recordOffsets)
        return ray.commonGeometry->recordFlags[0];
    if (ray.commonGeometry)
        return gather<uint32_t, W>(placesIn<uint32_t, W>(ray.commonGeometry->recordFlags, record), 0, ray.active);
    const Lanes<uint64_t, W> flags = OXRT_GEOMETRY_FIELD(uint64_t, ray, recordFlags);
    return gather<uint32_t, W>(AddressPlaces<W>{flags + convert<uint64_t>(record) * uint64_t(4)}, 0, ray.active);
}

template <int W>
OXRT_INLINE Lanes<bool, W> anyHitEnabled(const RayLanes<W>& ray, Lanes<uint32_t, W> instanceFlags, Lanes<uint32_t, W> flags) {
    if (ray.flags & (RAY_DISABLE_ANYHIT | RAY_ENFORCE_ANYHIT))
        return bool(ray.flags & RAY_ENFORCE_ANYHIT);
    const Lanes<bool, W> byInstance = (instanceFlags & (INSTANCE_DISABLE_ANYHIT | INSTANCE_ENFORCE_ANYHIT)) != 0u;
    return select(byInstance, (instanceFlags & INSTANCE_ENFORCE_ANYHIT) != 0u, (flags & GEOMETRY_DISABLE_ANYHIT) == 0u);
}

/* The candidates that the ray's culling flags drop. */
template <int W>
OXRT_INLINE Lanes<bool, W> culledLanes(const RayLanes<W>& ray, Lanes<uint32_t, W> instanceFlags, Lanes<uint32_t, W> flags,
                                       Lanes<bool, W> runsAnyHit) {
    Lanes<bool, W> culled = false;
    if (ray.flags & RAY_CULL_ENFORCED_ANYHIT)
        culled |= runsAnyHit;
    if (ray.flags & RAY_CULL_DISABLED_ANYHIT)
        culled |= !runsAnyHit;
    if (ray.flags & (RAY_CULL_BACK_FACING | RAY_CULL_FRONT_FACING)) {
        const Lanes<bool, W> exempt = ((instanceFlags & INSTANCE_DISABLE_FACE_CULLING) | (flags & GEOMETRY_DISABLE_FACE_CULLING)) != 0u;
        const Lanes<bool, W> isTriangle = geometryType(ray) == uint32_t(OXRT_PRIMITIVE_TRIANGLE);
        const auto& hit = ray.packet.hit;
        const Wide<float3, W> normal = {packetLanes<W>(hit.Ng_x), packetLanes<W>(hit.Ng_y), packetLanes<W>(hit.Ng_z)};
        const Wide<float3, W> direction = transformVectorFromWorldToObjectSpace(ray, getWorldRayDirection(ray));
        const Lanes<float, W> cosine = normal.x * direction.x + normal.y * direction.y + normal.z * direction.z;
        const Lanes<bool, W> isFront = (cosine < 0.0f) ^ ((instanceFlags & INSTANCE_FLIP_FACING) != 0u);
        const Lanes<bool, W> front = bool(ray.flags & RAY_CULL_FRONT_FACING);
        const Lanes<bool, W> back = bool(ray.flags & RAY_CULL_BACK_FACING);
        culled |= without(isTriangle, exempt) & ((isFront & front) | without(back, isFront));
    }
    return culled;
}

/* Runs the any-hit programs of the active lanes; which of these are accepted. */
template <class Programs, int W> OXRT_INLINE Lanes<bool, W> runAnyHits(CandidateLanes<W>& ray) {
    const Lanes<bool, W> before = ray.ended;
    ray.ignored = ray.stopped = ray.ended = false;
    Programs::anyHit(ray, ray.active, *static_cast<typename Programs::Payload*>(ray.payload));
    ray.ended = before;
    if constexpr (Programs::Scalar::mayThrow)
        ray.stopped |= ray.active & ray.thread->thrown;
    return without(ray.active, ray.ignored);
}

template <int W> OXRT_INLINE void stopTraversals(CandidateLanes<W>& ray, Lanes<bool, W> mask) {
    ray.isTerminated |= mask;
    auto& tfar = ray.objectRay->tfar;
    storeLanes<float, W>(tfar, select(mask, -__builtin_inff(), packetLanes<W>(tfar)));
}

template <int W> OXRT_INLINE Lanes<bool, W> loadValid(const int* valid) {
    int32_t values[W];
    __builtin_memcpy(values, valid, sizeof(values));
    return loadLanes<int32_t, W>(values) == int32_t(-1);
}

/* Embree's filter callback: candidates on built-in primitives. */
template <class Programs, bool MAY_CULL, int W> void filterCandidates(const RTCFilterFunctionNArguments* arguments) {
    CandidateLanes<W>& ray = *reinterpret_cast<QueryLanes<W>*>(arguments->context)->candidates;
    const Lanes<bool, W> offered = loadValid<W>(arguments->valid);
    if (none(offered))
        return;
    __builtin_memcpy(&ray.packet.hit, arguments->hit, sizeof(ray.packet.hit));
    ray.objectRay = static_cast<typename CandidateLanes<W>::PacketRay*>(arguments->ray);
    ray.t = packetLanes<W>(ray.objectRay->tfar);
    enterHits(ray, offered);
    // the geometry's, the instance's and the ray's word on culling and any-hit programs
    const Lanes<uint32_t, W> flags = geometryFlags(ray);
    const Lanes<uint32_t, W> instanceFlags = instanceField<uint32_t>(ray, OXRT_FIELD_OFFSET(OxrtInstanceView, flags), 0u);
    const Lanes<bool, W> runs = anyHitEnabled(ray, instanceFlags, flags);
    Lanes<bool, W> accepted = offered;
    if constexpr (MAY_CULL)
        accepted = without(accepted, culledLanes(ray, instanceFlags, flags, runs));
    Lanes<bool, W> stopped = false;
    if constexpr (Programs::Scalar::hasAnyHit) {
        ray.active = accepted & runs;
        if (any(ray.active))
            ray.active = findHitRecords(ray);
        if (const Lanes<bool, W> asked = ray.active; any(asked)) {
            accepted = without(accepted, asked) | runAnyHits<Programs>(ray);
            stopped = ray.stopped;
        }
    }
    if (ray.flags & RAY_TERMINATE_ON_FIRST_HIT)
        stopped |= accepted;
    storeLanes<int32_t, W>(*reinterpret_cast<int32_t(*)[W]>(arguments->valid), select(accepted, int32_t(-1), int32_t(0)));
    if (any(stopped)) {
        ray.closest = select(stopped, ray.t, ray.closest);
        stopTraversals(ray, stopped);
    }
}

/* ---- custom primitives -------------------------------------------------------------------------------------------------------- */

/* The lanes whose ray meets the box of a scene's only primitive. */
template <int W> Lanes<bool, W> meetingBox(const CandidateLanes<W>& ray) {
    uint32_t bits = 0;
    eachLane(ray.active, [&](int lane) {
        RTCRay one{};
        one.org_x = ray.objectRay->org_x[lane];
        one.org_y = ray.objectRay->org_y[lane];
        one.org_z = ray.objectRay->org_z[lane];
        one.dir_x = ray.objectRay->dir_x[lane];
        one.dir_y = ray.objectRay->dir_y[lane];
        one.dir_z = ray.objectRay->dir_z[lane];
        bits |= uint32_t(meetsBox(one, ray.commonGeometry->vertices, ray.tmin[lane], ray.closest[lane])) << lane;
    });
    return Lanes<bool, W>::ofBits(bits);
}

/* Runs the intersection programs of one custom primitive for the lanes to which Embree offers it. */
template <class Programs, int W>
void runIntersections(const int* valid, RTCRayQueryContext* context, void* packetRay, typename CandidateLanes<W>::PacketHit* hit,
                      uint32_t geometry,
                      uint32_t primitive) {
    using Scalar = typename Programs::Scalar;
    CandidateLanes<W>& ray = *reinterpret_cast<QueryLanes<W>*>(context)->candidates;
    ray.active = without(loadValid<W>(valid), ray.isTerminated);
    if (none(ray.active))
        return;
    const uint32_t instance = context->instID[0];
    ray.commonInstance = instance == RTC_INVALID_GEOMETRY_ID ? nullptr : ray.root->instances + instance;
    const OxrtTraversableView& structure = ray.commonInstance ? *ray.commonInstance->child : *ray.root;
    ray.commonGeometry = structure.geometries + geometry;
    storeLanes<uint32_t, W>(ray.packet.hit.primID, primitive);
    storeLanes<uint32_t, W>(ray.packet.hit.geomID, geometry);
    storeLanes<uint32_t, W>(ray.packet.hit.instID[0], instance);
    ray.objectRay = static_cast<typename CandidateLanes<W>::PacketRay*>(packetRay);
    ray.embreeHit = hit;
    // what Embree itself found since
    const Lanes<float, W> tfar = packetLanes<W>(ray.objectRay->tfar);
    const Lanes<bool, W> nearer = ray.active & (tfar != ray.closestInEmbree);
    ray.closest = select(nearer, tfar, ray.closest);
    ray.closestInEmbree = select(nearer, tfar, ray.closestInEmbree);
    if (structure.geometryCount == 1 && ray.commonGeometry->primitiveCount == 1 && ray.commonGeometry->keyCount == 1)
        ray.active = meetingBox(ray);
    if (any(ray.active) && (Scalar::hasAnyHit || (ray.flags & RAY_CULL_ANY))) {
        const Lanes<uint32_t, W> flags = geometryFlags(ray);
        const Lanes<uint32_t, W> instanceFlags = ray.commonInstance ? ray.commonInstance->flags : 0u;
        ray.runsAnyHit = anyHitEnabled(ray, instanceFlags, flags);
        if (ray.flags & RAY_CULL_ANY)
            ray.active = without(ray.active, culledLanes(ray, instanceFlags, flags, ray.runsAnyHit));
    }
    if (none(ray.active))
        return;
    ray.t = ray.closest;
    ray.ended = false;
    ray.active = findHitRecords(ray);
    if (none(ray.active))
        return;
    const Lanes<bool, W> ran = ray.active;
    Programs::intersection(ray, ran, *static_cast<typename Programs::Payload*>(ray.payload));
    if constexpr (Scalar::mayThrow)
        stopTraversals(ray, ran & ray.thread->thrown);
}
template <class Programs, int W> void intersectCustoms(const RTCIntersectFunctionNArguments* a) {
    if (const OxrtOwnShape* own = ownShape(*a))
        return own->intersect(a, nullptr); /* curves with filters are traced lane by lane */
    auto& rayhit = *static_cast<typename Packet<W>::RayHit*>(a->rayhit);
    runIntersections<Programs, W>(a->valid, a->context, &rayhit.ray, &rayhit.hit, a->geomID, a->primID);
}
template <class Programs, int W> void occludeCustoms(const RTCOccludedFunctionNArguments* a) {
    if (const OxrtOwnShape* own = ownShape(*a))
        return own->occluded(a, nullptr);
    runIntersections<Programs, W>(a->valid, a->context, a->ray, nullptr, a->geomID, a->primID);
}

/* Attribute words of lanes. */
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

/* Makes the reported hits the closest ones of their lanes. */
template <int W>
OXRT_INLINE void commitReports(CandidateLanes<W>& ray, Lanes<bool, W> mask, Lanes<float, W> t, Lanes<uint32_t, W> kind,
                               const AttributeLanes<W>& attributes) {
    for (int i = 0; i < attributes.count; ++i)
        ray.committedAttributes[i] = select(mask, attributes.words[i], ray.committedAttributes[i]);
    ray.committedKind = select(mask, kind, ray.committedKind);
    ray.closest = select(mask, t, ray.closest);
    if (!ray.embreeHit) {
        stopTraversals(ray, mask);
        return;
    }
    auto& hit = *ray.embreeHit;
    const auto& own = ray.packet.hit;
    storeLanes<uint32_t, W>(hit.primID, select(mask, packetLanes<W>(own.primID), packetLanes<W>(hit.primID)));
    storeLanes<uint32_t, W>(hit.geomID, select(mask, packetLanes<W>(own.geomID), packetLanes<W>(hit.geomID)));
    storeLanes<uint32_t, W>(hit.instID[0], select(mask, packetLanes<W>(own.instID[0]), packetLanes<W>(hit.instID[0])));
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
        if (const Lanes<bool, W> asked = accepted & ray.runsAnyHit; any(asked)) {
            for (int i = 0; i < attributes.count; ++i)
                ray.attributes[i] = attributes.words[i];
            ray.kind = hitKind;
            ray.t = t;
            const Lanes<bool, W> outer = ray.active;
            ray.active = asked;
            accepted = without(accepted, asked) | runAnyHits<Programs>(ray);
            ray.active = outer;
            ray.t = ray.closest;
            stopped = ray.stopped;
        }
    if (ray.flags & RAY_TERMINATE_ON_FIRST_HIT)
        stopped |= accepted;
    if (any(accepted))
        commitReports(ray, accepted, t, hitKind, attributes);
    if (any(stopped))
        stopTraversals(ray, stopped);
    ray.t = select(accepted, t, ray.t);
    ray.ended |= stopped;
    return accepted;
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
