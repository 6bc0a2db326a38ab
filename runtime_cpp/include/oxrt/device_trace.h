/* Tracing one ray: the query, and the closest-hit or miss program after it.
 *
 * `Programs`: see device_candidate.h; `Flags`: see device_query.h.
 */
#ifndef OXRT_DEVICE_TRACE_H
#define OXRT_DEVICE_TRACE_H

#include <oxrt/device_graph.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* ---- traversal --------------------------------------------------------------------------------------------------------------------- */

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
        arguments.occluded = occludeCallback<Programs>(ray);
        if constexpr (Programs::hasIntersection)
            ray.closestInEmbree = query.tfar;
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
        arguments.intersect = intersectCallback<Programs>(ray);
        if constexpr (Programs::hasIntersection) {
            ray.closestInEmbree = query.ray.tfar;
            ray.committedKind = NO_REPORT;
        }
        services.intersect1(ray.root->scene, &query, &arguments);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
            return false;
        bool isClosestOwn = ray.isTerminated;
        if constexpr (Programs::hasIntersection)
            isClosestOwn = isClosestOwn || (ray.committedKind != NO_REPORT && query.ray.tfar == ray.closestInEmbree);
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

/* Whether the pipeline was made for graphs as deep as this one. */
template <class Programs> OXRT_INLINE bool isGraphAllowed(const OxrtTraversableView& root) {
    const bool isGas = root.type == OXRT_TRAVERSABLE_GAS;
    const bool isSingleLevel = root.type == OXRT_TRAVERSABLE_IAS && !(root.needs & OXRT_SCENE_MULTI_LEVEL);
    return Programs::graphFlags == 0 || (isGas && (Programs::graphFlags & 1)) || (isSingleLevel && (Programs::graphFlags & 2));
}

/* What validation has to say about a ray and what it is to be traced through. */
/* Whether more traversables lie one below the other than the stack was configured for. */
OXRT_INLINE bool isTooDeep(const OxrtThread& thread, const OxrtTraversableView* root) {
    return root && root->graphDepth > thread.launch->maxGraphDepth;
}

template <class Programs> __attribute__((noinline)) void checkRay(const Ray& ray, uint64_t handle, Place place) {
    OxrtThread& thread = *ray.thread;
    if (!isValidRay(ray))
        faultWithValues(thread, OXRT_FAULT_INVALID_RAY, "invalid ray (origin, direction, tmin, tmax)", place, ray.origin.x, ray.origin.y,
                        ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z, ray.tmin, ray.tmax);
    else if (!ray.root && handle != 0)
        fault(thread, OXRT_FAULT_INVALID_TRAVERSABLE, "the handle names no traversable of this context, or one that was destroyed", place);
    else if (ray.root && !isGraphAllowed<Programs>(*ray.root))
        fault(thread, ray.root->type == OXRT_TRAVERSABLE_GAS ? OXRT_FAULT_SINGLE_LEVEL_GAS : OXRT_FAULT_INVALID_TRAVERSABLE,
              "the traversable is of a kind that the pipeline's traversable_graph_flags leave out", place);
    else if (!Programs::graphDepthThrows && isTooDeep(thread, ray.root))
        fault(thread, OXRT_FAULT_TRAVERSAL_DEPTH, "the graph is deeper than max_traversable_graph_depth of set_stack_size()", place);
    else if (ray.root && (ray.root->needs & Programs::excludedNeeds))
        fault(thread, OXRT_FAULT_PRIMITIVE_TYPE, "the scene holds primitives that the pipeline's uses_primitive_type_flags leave out", place);
    else if (!Programs::usesMicromaps && ray.root && (ray.root->needs & OXRT_SCENE_HAS_MICROMAPS))
        fault(thread, OXRT_FAULT_INVALID_TRAVERSABLE,
              "the scene has opacity micromaps, but the pipeline was made without allow_opacity_micromaps", place);
}

template <class Programs> OXRT_INLINE void runMiss(Ray& ray, typename Programs::Payload& payload, Place place) {
    const OxrtLaunch& launch = *ray.thread->launch;
    ray.t = ray.tmax;
    if constexpr (Programs::isValidated)
        placeOfTrace() = place;
    ray.record = findRecord(launch, launch.missRecords, launch.missStride, launch.missCount, ray.missIndex);
    if (ray.record)
        Programs::miss(ray, payload, *ray.record);
    else if (Programs::isValidated && ray.missIndex >= launch.missCount)
        fault(*ray.thread, OXRT_FAULT_MISS_SBT, "miss_sbt_index is not below the number of miss records", place);
}

template <class Programs> OXRT_INLINE void runClosestHit(Ray& ray, typename Programs::Payload& payload, Place place) {
    if constexpr (Programs::isValidated)
        placeOfTrace() = place;
    if (const OxrtRecordHeader* record = findHitRecord(ray))
        Programs::closestHit(ray, payload, *record);
    else if (Programs::isValidated && ray.recordIndex >= ray.thread->launch->hitgroupCount)
        fault(*ray.thread, OXRT_FAULT_HIT_SBT, "the hit needs a record behind the end of the hit group records", place);
}

/* Whether a traversal can find anything. */
OXRT_INLINE bool canHit(const Ray& ray) { return ray.root && ray.root->scene && ray.tmin <= ray.tmax; }

/* True if something was hit; the closest hit is entered into the ray, and the way to it into `path` where the ray then refers to it. */
template <class Programs, class Flags> OXRT_INLINE bool findClosest(Ray& ray, GraphPath& path) {
    if (__builtin_expect(isGraph(*ray.root), 0))
        return traverseGraphClosest<Programs, Flags>(ray, path);
    return traverseClosest<Programs, Flags>(ray);
}

/* Traversal and then the closest-hit or miss program. */
template <class Programs, class Flags> OXRT_INLINE void traceNow(Ray& ray, typename Programs::Payload& payload, Place place) {
    using Known = FlagTraits<Flags>;
    constexpr bool runsClosestHit = Programs::hasClosestHit && Known::mayRunClosestHit;
    GraphPath path;
    bool isHit = false;
    if (canHit(ray)) {
        if constexpr (Known::alwaysTerminates && !runsClosestHit)
            isHit = __builtin_expect(isGraph(*ray.root), 0) ? traverseGraphAny<Programs, Flags>(ray, path) : traverseAny<Programs, Flags>(ray);
        else
            isHit = findClosest<Programs, Flags>(ray, path);
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

/* Counts the nesting of traces; false at the limit, of which `told` gets to know. */
template <class Programs, class Told> OXRT_INLINE bool enterTrace(OxrtThread& thread, Told told, Place place) {
    if constexpr (Programs::countsDepth) {
        if (__builtin_expect(thread.traceDepth >= Programs::maxTraceDepth, 0)) {
            if constexpr (Programs::depthThrows)
                throwException(told(), nullptr, OXRT_FAULT_TRACE_DEPTH);
            else
                fault(told(), OXRT_FAULT_TRACE_DEPTH, "traces nest deeper than max_trace_depth", place);
            return false;
        }
        if constexpr (Programs::checksStack)
            if (__builtin_expect(thread.traceDepth >= thread.launch->maxTraceDepth || isStackFull(thread), 0)) {
                overflowStack<Programs::overflowThrows>(told(), place);
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

/* Enters what the caller of a trace gave; false if that was an exception. */
template <class Programs>
OXRT_INLINE bool setRay(Ray& ray, OxrtThread& thread, uint64_t handle, const float3& origin, const float3& direction, float tmin, float tmax,
                        float time, uint32_t mask, uint32_t flags, uint32_t sbtOffset, uint32_t sbtStride, uint32_t missIndex,
                        typename Programs::Payload& payload, Place place) {
    ray.thread = &thread;
    ray.payload = &payload;
    ray.root = findTraversable(*thread.launch, handle);
    ray.path = nullptr;
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
        placeOfTrace() = place;
        checkRay<Programs>(ray, handle, place);
    }
    if constexpr (Programs::graphDepthThrows)
        if (__builtin_expect(isTooDeep(thread, ray.root), 0)) {
            ray.root = nullptr;
            throwException(thread, nullptr, OXRT_FAULT_TRACE_DEPTH);
            return false;
        }
    return true;
}

template <class Programs, class Flags>
OXRT_INLINE void trace(OxrtThread& thread, uint64_t handle, const float3& origin, const float3& direction, float tmin, float tmax, float time,
                       uint32_t mask, Flags flags, uint32_t sbtOffset, uint32_t sbtStride, uint32_t missIndex,
                       typename Programs::Payload& payload, Place place = Place::current()) {
    if (!enterTrace<Programs>(thread, SameThread{thread}, place))
        return;
    Ray ray;
    if (setRay<Programs>(ray, thread, handle, origin, direction, tmin, tmax, time, mask, flags, sbtOffset, sbtStride, missIndex, payload, place))
        traceNow<Programs, Flags>(ray, payload, place);
    leaveTrace<Programs>(thread);
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
