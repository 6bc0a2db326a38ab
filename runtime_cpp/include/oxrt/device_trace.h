/* Tracing one ray: the query, and the closest-hit or miss program after it.
 *
 * `Programs`: see device_candidate.h. `Flags` is KnownFlags<value> where the ray flags are a constant, else uint32_t.
 */
#ifndef OXRT_DEVICE_TRACE_H
#define OXRT_DEVICE_TRACE_H

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

OXRT_INLINE void setEmbreeRay(RTCRay& target, const Ray& ray) {
    EmbreeRow* rows = reinterpret_cast<EmbreeRow*>(&target);
    rows[0] = EmbreeRow{ray.origin.x, ray.origin.y, ray.origin.z, nextUp(ray.tmin)};
    rows[1] = EmbreeRow{ray.direction.x, ray.direction.y, ray.direction.z, ray.time};
    target.tfar = nextDown(ray.tmax);
    target.mask = ray.mask;
    target.id = 0;
    target.flags = 0;
}

/* Whether built-in primitives may need a decision under these ray flags. */
template <class Programs> OXRT_INLINE bool mayFilter(uint32_t flags) {
    const bool runsAnyHit = Programs::hasAnyHit && ((flags & RAY_ENFORCE_ANYHIT) || !(flags & RAY_DISABLE_ANYHIT));
    return runsAnyHit || (flags & RAY_CULL_ANY);
}
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
    if constexpr (Known::mayCull || (Programs::hasAnyHit && Known::mayRunAnyHit)) {
        if (mayFilter<Programs>(ray.flags))
            arguments.filter = filterCandidate<Programs, Known::mayCull>;
        if (filtersEverything<Programs>(ray.flags, *ray.root))
            arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
    }
}

template <class Programs, class Flags> inline constexpr bool hasCallbacks =
    Programs::hasIntersection || FlagTraits<Flags>::mayCull || (Programs::hasAnyHit && FlagTraits<Flags>::mayRunAnyHit);

/* True if something was hit; the hit is not known. */
template <class Programs, class Flags> OXRT_INLINE bool traverseAny(Ray& ray) {
    RTCRay query;
    setEmbreeRay(query, ray);
    const OxrtServices& services = *ray.thread->launch->services;
    if constexpr (!hasCallbacks<Programs, Flags>) {
        services.occluded1(ray.root->scene, &query, nullptr);
        return query.tfar < 0.0f;
    } else {
        RTCOccludedArguments arguments;
        setCallbacks<Programs, Flags>(arguments, ray);
        arguments.occluded = nullptr;
        if constexpr (Programs::hasIntersection) {
            ray.closestInEmbree = query.tfar;
            arguments.occluded = occludeCustom<Programs>;
        }
        services.occluded1(ray.root->scene, &query, &arguments);
        return ray.isTerminated || query.tfar < 0.0f;
    }
}

/* True if something was hit; the closest hit is entered into the ray. */
template <class Programs, class Flags> OXRT_INLINE bool traverseClosest(Ray& ray) {
    RTCRayHit query;
    setEmbreeRay(query.ray, ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    const OxrtServices& services = *ray.thread->launch->services;
    if constexpr (!hasCallbacks<Programs, Flags>) {
        services.intersect1(ray.root->scene, &query, nullptr);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
            return false;
        enterHit(ray, query.hit, query.ray.tfar);
    } else {
        RTCIntersectArguments arguments;
        setCallbacks<Programs, Flags>(arguments, ray);
        arguments.intersect = nullptr;
        if constexpr (Programs::hasIntersection) {
            ray.closestInEmbree = query.ray.tfar;
            arguments.intersect = intersectCustom<Programs>;
        }
        services.intersect1(ray.root->scene, &query, &arguments);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
            return false;
        bool isClosestOwn = ray.isTerminated;
        if constexpr (Programs::hasIntersection)
            isClosestOwn = isClosestOwn || query.ray.tfar == ray.closestInEmbree;
        enterHit(ray, query.hit, isClosestOwn ? ray.closest : query.ray.tfar);
        if constexpr (Programs::hasIntersection) {
            ray.kind = ray.committedKind;
            ray.attributes = ray.committedAttributes;
        }
    }
    return true;
}

/* ---- trace --------------------------------------------------------------------------------------------------------------------------- */

OXRT_INLINE bool isFiniteVector(const float3& v) {
    const float limit = __builtin_inff();
    return __builtin_fabsf(v.x) < limit && __builtin_fabsf(v.y) < limit && __builtin_fabsf(v.z) < limit;
}

/* Whether a launch in validation mode may trace this ray: no NaN or infinity, tmin not negative. Zero directions pass, as in OptiX. */
OXRT_INLINE bool isValidRay(const Ray& ray) {
    const bool isDirectionNumber = ray.direction.x == ray.direction.x && ray.direction.y == ray.direction.y && ray.direction.z == ray.direction.z;
    return isFiniteVector(ray.origin) && isDirectionNumber && ray.tmin >= 0.0f && ray.tmin < __builtin_inff() && ray.tmax == ray.tmax;
}

template <class Programs> OXRT_INLINE void runMiss(Ray& ray, typename Programs::Payload& payload, Place place) {
    const OxrtLaunch& launch = *ray.thread->launch;
    ray.t = ray.tmax;
    ray.record = findRecord(launch, launch.missRecords, launch.missStride, launch.missCount, ray.missIndex);
    if (ray.record)
        Programs::miss(ray, payload, *ray.record);
    else if (Programs::isValidated && ray.missIndex >= launch.missCount)
        fault(*ray.thread, OXRT_FAULT_MISS_SBT, "miss_sbt_index is not below the number of miss records", place);
}

template <class Programs> OXRT_INLINE void runClosestHit(Ray& ray, typename Programs::Payload& payload, Place place) {
    if (const OxrtRecordHeader* record = findHitRecord(ray))
        Programs::closestHit(ray, payload, *record);
    else if (Programs::isValidated && ray.recordIndex >= ray.thread->launch->hitgroupCount)
        fault(*ray.thread, OXRT_FAULT_HIT_SBT, "the hit needs a record behind the end of the hit group records", place);
}

/* Whether a traversal can find anything. */
OXRT_INLINE bool canHit(const Ray& ray) { return ray.root && ray.root->scene && ray.tmin <= ray.tmax; }

/* Traversal and then the closest-hit or miss program. */
template <class Programs, class Flags> OXRT_INLINE void traceNow(Ray& ray, typename Programs::Payload& payload, Place place) {
    using Known = FlagTraits<Flags>;
    constexpr bool runsClosestHit = Programs::hasClosestHit && Known::mayRunClosestHit;
    bool isHit = false;
    if (canHit(ray)) {
        if constexpr (Known::alwaysTerminates && !runsClosestHit)
            isHit = traverseAny<Programs, Flags>(ray);
        else
            isHit = traverseClosest<Programs, Flags>(ray);
        if constexpr (Programs::mayThrow)
            if (ray.thread->exceptionPending)
                return;
    }
    if (!isHit) {
        if constexpr (Programs::hasMiss)
            runMiss<Programs>(ray, payload, place);
    } else if constexpr (runsClosestHit)
        if (!(ray.flags & RAY_DISABLE_CLOSESTHIT))
            runClosestHit<Programs>(ray, payload, place);
}

/* Counts the nesting of traces; false at the limit. */
template <class Programs> OXRT_INLINE bool enterTrace(OxrtThread& thread, Place place) {
    if constexpr (Programs::countsDepth) {
        if (__builtin_expect(thread.traceDepth >= Programs::maxTraceDepth, 0)) {
            if constexpr (Programs::depthThrows)
                throwException(thread, nullptr, OXRT_FAULT_TRACE_DEPTH);
            else
                fault(thread, OXRT_FAULT_TRACE_DEPTH, "traces nest deeper than max_trace_depth", place);
            return false;
        }
        ++thread.traceDepth;
    }
    return true;
}
template <class Programs> OXRT_INLINE void leaveTrace(OxrtThread& thread) {
    if constexpr (Programs::countsDepth)
        --thread.traceDepth;
}

/* Enters what the caller of a trace gave. */
template <class Programs>
OXRT_INLINE void setRay(Ray& ray, OxrtThread& thread, uint64_t handle, const float3& origin, const float3& direction, float tmin, float tmax,
                        float time, uint32_t mask, uint32_t flags, uint32_t sbtOffset, uint32_t sbtStride, uint32_t missIndex,
                        typename Programs::Payload& payload, Place place) {
    ray.thread = &thread;
    ray.payload = &payload;
    ray.root = findTraversable(*thread.launch, handle);
    ray.origin = origin;
    ray.direction = direction;
    ray.tmin = tmin;
    ray.tmax = tmax;
    ray.time = Programs::usesTime ? time : 0.0f;
    ray.mask = mask & 0xFF;
    ray.flags = flags & 0xFFFF;
    ray.sbtOffset = (sbtOffset | sbtStride >> 4) & 15; /* as in OptiX: the stride's bits 4 to 7 spill into the offset */
    ray.sbtStride = sbtStride & 15;
    ray.missIndex = missIndex;
    if constexpr (Programs::isValidated) {
        if (!isValidRay(ray))
            faultWithValues(thread, OXRT_FAULT_INVALID_RAY, "invalid ray (origin, direction, tmin, tmax)", place, origin.x, origin.y, origin.z,
                            direction.x, direction.y, direction.z, tmin, tmax);
        else if (!ray.root && handle != 0)
            fault(thread, OXRT_FAULT_INVALID_TRAVERSABLE, "the handle names no traversable of this context, or one that was destroyed", place);
    }
}

template <class Programs, class Flags>
OXRT_INLINE void trace(OxrtThread& thread, uint64_t handle, const float3& origin, const float3& direction, float tmin, float tmax, float time,
                       uint32_t mask, Flags flags, uint32_t sbtOffset, uint32_t sbtStride, uint32_t missIndex,
                       typename Programs::Payload& payload, Place place = Place::current()) {
    if (!enterTrace<Programs>(thread, place))
        return;
    Ray ray;
    setRay<Programs>(ray, thread, handle, origin, direction, tmin, tmax, time, mask, flags, sbtOffset, sbtStride, missIndex, payload, place);
    traceNow<Programs, Flags>(ray, payload, place);
    leaveTrace<Programs>(thread);
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
