/* Embree's queries for one ray: the ray, the callbacks, and what is known of the ray flags when the trace is compiled.
 *
 * `Flags` is KnownFlags<value> where the ray flags are a constant, else uint32_t.
 */
#ifndef OXRT_DEVICE_QUERY_H
#define OXRT_DEVICE_QUERY_H

#include <oxrt/device_custom.h>

namespace oxrt {
inline namespace OXRT_ISA {

template <uint32_t VALUE> struct KnownFlags {
    OXRT_INLINE constexpr operator uint32_t() const { return VALUE; }
};

/* What is known of ray flags when the trace is compiled. */
template <class Flags> struct FlagTraits {
    static constexpr bool mayCull = true;
    static constexpr bool mayRunAnyHit = true;
    static constexpr bool mayRunClosestHit = true;
    static constexpr bool alwaysTerminates = false;
};
template <uint32_t VALUE> struct FlagTraits<KnownFlags<VALUE>> {
    static constexpr bool mayCull = (VALUE & RAY_CULL_ANY) != 0;
    static constexpr bool mayRunAnyHit = (VALUE & RAY_ENFORCE_ANYHIT) != 0 || (VALUE & RAY_DISABLE_ANYHIT) == 0;
    static constexpr bool mayRunClosestHit = (VALUE & RAY_DISABLE_CLOSESTHIT) == 0;
    static constexpr bool alwaysTerminates = (VALUE & RAY_TERMINATE_ON_FIRST_HIT) != 0;
};

/* ---- queries ----------------------------------------------------------------------------------------------------------------------- */

/* Embree reads origin and tnear in one piece right after the call, direction and time in another. Stored one by one they could not be
   forwarded from the store buffer: Embree would wait for the cache, a tenth of a short ray's time. */
using EmbreeRow = float __attribute__((vector_size(16), may_alias));
static_assert(offsetof(RTCRay, org_x) == 0 && offsetof(RTCRay, tnear) == 12 && offsetof(RTCRay, dir_x) == 16 && offsetof(RTCRay, time) == 28);

/* Four numbers in a register. Older clang loads them in one piece where they were just stored one by one, and waits for that itself. */
OXRT_INLINE EmbreeRow embreeRow(float3 xyz, float w) {
#if defined(__clang__) && defined(__x86_64__)
    __asm__("" : "+x"(xyz.x), "+x"(xyz.y), "+x"(xyz.z));
#endif
    return EmbreeRow{xyz.x, xyz.y, xyz.z, w};
}

OXRT_INLINE void setEmbreeRay(RTCRay& target, const float3& origin, float tnear, const float3& direction, float time, float tfar, uint32_t mask) {
    EmbreeRow* rows = reinterpret_cast<EmbreeRow*>(&target);
    rows[0] = embreeRow(origin, tnear);
    rows[1] = embreeRow(direction, time);
    target.tfar = tfar;
    target.mask = mask;
    target.id = 0;
    target.flags = 0;
}
OXRT_INLINE void setEmbreeRay(RTCRay& target, const Ray& ray) {
    setEmbreeRay(target, ray.origin, nextUp(ray.tmin), ray.direction, ray.time, nextDown(ray.tmax), ray.mask);
}

/* Whether built-in primitives may need a decision under these ray flags. */
template <class Programs> OXRT_INLINE bool mayFilter(uint32_t flags, const OxrtTraversableView& root) {
    const bool runsAnyHit = Programs::hasAnyHit && ((flags & RAY_ENFORCE_ANYHIT) || !(flags & RAY_DISABLE_ANYHIT));
    return runsAnyHit || (flags & RAY_CULL_ANY) || (Programs::usesMicromaps && (root.needs & OXRT_SCENE_HAS_MICROMAPS));
}
/* Whether that can be at all under flags of which this much is known. */
template <class Programs, class Flags> inline constexpr bool mayHaveCandidates =
    FlagTraits<Flags>::mayCull || Programs::usesMicromaps || (Programs::hasAnyHit && FlagTraits<Flags>::mayRunAnyHit);
/* Whether that is so even on geometries that disable any-hit programs, where Embree does not call the filter unasked. */
template <class Programs> OXRT_INLINE bool filtersEverything(uint32_t flags, const OxrtTraversableView& root) {
    const uint32_t overridingFlags = RAY_CULL_ANY | (Programs::hasAnyHit ? RAY_ENFORCE_ANYHIT : 0u);
    return (flags & overridingFlags) || (root.needs & OXRT_SCENE_HAS_INSTANCE_FLAGS);
}

/* Embree's query arguments for traces that need callbacks; the ray's address goes with them. */
template <class Programs, class Flags, class Arguments> OXRT_INLINE void setCallbacks(Arguments& arguments, Ray& ray) {
    using Known = FlagTraits<Flags>;
    ray.context.instID[0] = RTC_INVALID_GEOMETRY_ID;
    ray.context.instPrimID[0] = RTC_INVALID_GEOMETRY_ID;
    ray.isTerminated = false;
    ray.closest = ray.tmax;
    arguments.flags = RTC_RAY_QUERY_FLAG_NONE;
    arguments.feature_mask = RTC_FEATURE_FLAG_ALL;
    arguments.context = &ray.context;
    arguments.filter = nullptr;
    arguments.minWidth = 0.0f;
    if constexpr (mayHaveCandidates<Programs, Flags>) {
        if (mayFilter<Programs>(ray.flags, *ray.root))
            arguments.filter = filterCandidate<Programs, Known::mayCull>;
        if constexpr (mayHaveSoleRecord<Programs, Known::mayCull>) {
            ray.recordIndex = ray.sbtOffset;
            ray.soleRecord = ray.path ? nullptr : findSoleRecord(*ray.thread->launch, *ray.root, ray.flags, ray.sbtOffset);
        }
        if (filtersEverything<Programs>(ray.flags, *ray.root))
            arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
    }
    ray.filter = arguments.filter;
    ray.curveRoots.geometry = nullptr;
    ray.curveRoots.closest = __builtin_inff();
}

/* The callbacks for user geometry: intersection programs, and curves of the runtime's own whose hits are to be judged. Null: Embree calls
   what the geometry brings. */
template <class Programs> OXRT_INLINE RTCIntersectFunctionN intersectCallback(const Ray& ray) {
    if constexpr (Programs::hasIntersection)
        return intersectCustom<Programs>;
    else
        return ray.filter && (ray.root->needs & OXRT_SCENE_HAS_CURVES) ? intersectOwn : nullptr;
}
template <class Programs> OXRT_INLINE RTCOccludedFunctionN occludeCallback(const Ray& ray) {
    if constexpr (Programs::hasIntersection)
        return occludeCustom<Programs>;
    else
        return ray.filter && (ray.root->needs & OXRT_SCENE_HAS_CURVES) ? occludeOwn : nullptr;
}

template <class Programs, class Flags> inline constexpr bool hasCallbacks = Programs::hasIntersection || mayHaveCandidates<Programs, Flags>;

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
