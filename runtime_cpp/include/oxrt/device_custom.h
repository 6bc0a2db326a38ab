/* Custom primitives: Embree's callbacks run intersection programs, which report hits. */
#ifndef OXRT_DEVICE_CUSTOM_H
#define OXRT_DEVICE_CUSTOM_H

#include <oxrt/device_candidate.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* Runs the intersection program of a custom primitive that Embree offers. `hit` is null in occlusion queries. */
template <class Programs> OXRT_INLINE void runIntersection(Ray& ray, RTCRay& embreeRay, RTCHit* hit, const void* geometry, uint32_t geometryId, uint32_t primitive) {
    if (ray.isTerminated)
        return;
    if (embreeRay.tfar != ray.closestInEmbree)
        ray.closest = ray.closestInEmbree = embreeRay.tfar;
    const OxrtGeometry& own = *static_cast<const OxrtGeometry*>(geometry);
    if (own.hasUntestedBoxes && !meetsBox(quadAt(&embreeRay.org_x), quadAt(&embreeRay.dir_x), own.vertices + 6 * uint64_t(primitive), ray.tmin,
                                          ray.closest))
        return;
    locate(ray, ray.context.instID[0], &own, primitive);
    ray.embreeRay = &embreeRay;
    ray.embreeHit = hit;
    ray.embreeGeometry = geometryId;
    ray.objectRay = &embreeRay;
    if (Programs::hasAnyHit || (ray.flags & RAY_CULL_ANY)) {
        const uint32_t instanceFlags = ray.instance ? ray.instance->flags : 0;
        const uint32_t geometryFlags = ray.geometry->recordFlags[localRecord(ray)];
        ray.runsAnyHit = anyHitEnabled(ray.flags, instanceFlags, geometryFlags);
        if ((ray.flags & RAY_CULL_ANY) && isCulled(ray, instanceFlags, geometryFlags, ray.runsAnyHit))
            return; /* before the program runs, as in OptiX */
    }
    ray.t = ray.closest;
    ray.verdict = Verdict::Accept;
    if (const OxrtRecordHeader* record = findHitRecord(ray)) {
        Programs::intersection(ray, *static_cast<typename Programs::Payload*>(ray.payload), *record);
        if constexpr (Programs::mayThrow)
            if (ray.thread->exceptionPending)
                stopTraversal(ray, embreeRay, ray.closest);
    }
}
/* What the runtime intersects by itself: curves and ribbons that Embree does not have. */
template <class Arguments> OXRT_INLINE const OxrtOwnShape* ownShape(const Arguments& arguments) {
    return static_cast<const OxrtGeometry*>(arguments.geometryUserPtr)->ownShape;
}
using OwnFilter = void (*)(const void*);
OXRT_INLINE OwnFilter ownFilter(const RTCRayQueryContext* context) {
    return reinterpret_cast<OwnFilter>(reinterpret_cast<const Ray*>(context)->filter);
}
/* For pipelines without intersection programs. */
static inline void intersectOwn(const RTCIntersectFunctionNArguments* arguments) {
    if (const OxrtOwnShape* own = ownShape(*arguments))
        own->intersect(arguments, ownFilter(arguments->context));
}
static inline void occludeOwn(const RTCOccludedFunctionNArguments* arguments) {
    if (const OxrtOwnShape* own = ownShape(*arguments))
        own->occluded(arguments, ownFilter(arguments->context));
}
template <class Programs> void intersectCustom(const RTCIntersectFunctionNArguments* arguments) {
    if (const OxrtOwnShape* own = ownShape(*arguments))
        return own->intersect(arguments, ownFilter(arguments->context));
    auto& rayhit = *static_cast<RTCRayHit*>(arguments->rayhit);
    if (arguments->valid[0] == -1)
        runIntersection<Programs>(*reinterpret_cast<Ray*>(arguments->context), rayhit.ray, &rayhit.hit, arguments->geometryUserPtr,
                                  arguments->geomID, arguments->primID);
}
template <class Programs> void occludeCustom(const RTCOccludedFunctionNArguments* arguments) {
    if (const OxrtOwnShape* own = ownShape(*arguments))
        return own->occluded(arguments, ownFilter(arguments->context));
    auto& embreeRay = *static_cast<RTCRay*>(arguments->ray);
    if (arguments->valid[0] == -1)
        runIntersection<Programs>(*reinterpret_cast<Ray*>(arguments->context), embreeRay, nullptr, arguments->geometryUserPtr,
                                  arguments->geomID, arguments->primID);
}

/* Makes the reported hit the closest one. */
OXRT_INLINE void commitReport(Ray& ray, float t, uint32_t kind) {
    ray.committedKind = kind;
    ray.closest = t;
    if (RTCHit* hit = ray.embreeHit) {
        hit->primID = ray.primitive;
        hit->geomID = ray.embreeGeometry;
        hit->instID[0] = ray.context.instID[0];
        ray.closestInEmbree = nextDown(t);
        ray.embreeRay->tfar = ray.closestInEmbree;
    } else
        stopTraversal(ray, *ray.embreeRay, t);
}

/* Offers a hit of the intersection program. Where it ends the ray, `hasEnded` is true afterwards and the program returns at once. */
template <class Programs, class Attributes> OXRT_INLINE bool reportIntersection(Ray& ray, float t, uint32_t kind, const Attributes& attributes) {
    static_assert(sizeof(Attributes) <= sizeof(ray.committedAttributes));
    if (!(ray.tmin <= t && t <= ray.closest))
        return false;
    Verdict verdict = ray.flags & RAY_TERMINATE_ON_FIRST_HIT ? Verdict::Terminate : Verdict::Accept;
    if constexpr (Programs::hasAnyHit)
        if (ray.runsAnyHit) {
            __builtin_memcpy(ray.candidateAttributes, &attributes, sizeof(Attributes));
            ray.attributes = ray.candidateAttributes;
            ray.kind = kind & 0xFF;
            ray.t = t;
            runAnyHit<Programs>(ray, *ray.record);
            verdict = ray.verdict;
            ray.t = ray.closest;
            ray.verdict = Verdict::Accept;
            if (verdict == Verdict::Ignore)
                return false;
        }
    __builtin_memcpy(ray.committedAttributes, &attributes, sizeof(Attributes));
    commitReport(ray, t, kind & 0xFF);
    if (verdict == Verdict::Terminate)
        stopTraversal(ray, *ray.embreeRay, t);
    ray.t = t;
    ray.verdict = verdict;
    return true;
}
template <class Programs> OXRT_INLINE bool reportIntersection(Ray& ray, float t, uint32_t kind) {
    return reportIntersection<Programs>(ray, t, kind, NoPayload{});
}

/* Whether the running program or a helper has called something that does not return. */
OXRT_INLINE bool hasEnded(const Ray& ray) { return ray.verdict != Verdict::Accept; }

/* Attribute words given one by one. */
template <class... T> struct AttributeWords {
    uint32_t words[sizeof...(T)];
};
template <class... T> OXRT_INLINE AttributeWords<T...> attributeWords(T... values) { return {{bitCast<uint32_t>(values)...}}; }

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
