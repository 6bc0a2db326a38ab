/* Tracing one ray: the query, the judgement of candidates, the dispatch of programs.
 *
 * `Programs` is what the pipeline emits for each payload class: which programs a trace with that payload can run, as constants that
 * decide what is compiled at all, and static functions that run them. `Flags` is KnownFlags<value> where the ray flags are a constant,
 * else uint32_t. Decision order: OptiX guide, "Ray flags", "Instance flags", "Any hit".
 */
#ifndef OXRT_DEVICE_TRACE_H
#define OXRT_DEVICE_TRACE_H

#include <oxrt/device_ray.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* What the emitted Programs of a payload class override. */
struct NoPrograms {
    using Payload = NoPayload;
    static constexpr bool hasClosestHit = false;
    static constexpr bool hasAnyHit = false;
    static constexpr bool hasIntersection = false;
    static constexpr bool hasMiss = false;
    static constexpr bool mayThrow = false;
    static constexpr bool countsDepth = false;  /* traces may nest deeper than maxTraceDepth */
    static constexpr bool depthThrows = false;  /* ... which is an exception rather than a fault */
    static constexpr uint32_t maxTraceDepth = 0;
    static constexpr bool usesTime = false;
    static constexpr bool isValidated = false;
};

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

/* The neighbours of a float. Embree's intervals are closed, OptiX's open for built-in primitives. */
OXRT_INLINE constexpr float nextUp(float x) {
    if (!(x < __builtin_inff()))
        return x;
    const uint32_t bits = __builtin_bit_cast(uint32_t, x);
    return __builtin_bit_cast(float, x == 0.0f ? 1u : x > 0.0f ? bits + 1 : bits - 1);
}
OXRT_INLINE constexpr float nextDown(float x) { return -nextUp(-x); }

/* ---- the scene ------------------------------------------------------------------------------------------------------------------- */

/* What the handle names, null if it is zero or stale. */
OXRT_INLINE const OxrtTraversableView* findTraversable(const OxrtLaunch& launch, uint64_t handle) {
    const uint32_t slot = uint32_t(handle);
    if (__builtin_expect(slot >= launch.traversableCount, 0))
        return nullptr;
    /* Another thread may destroy the accel meanwhile: the view stays readable until the launch has ended. */
    const OxrtTraversableSlot& found = launch.traversables[slot];
    const bool isCurrent = __atomic_load_n(&found.generation, __ATOMIC_ACQUIRE) == uint32_t(handle >> 32);
    return __builtin_expect(isCurrent, 1) ? __atomic_load_n(&found.view, __ATOMIC_ACQUIRE) : nullptr;
}

/* Enter which primitive the hit is on. */
OXRT_INLINE void locate(Ray& ray, uint32_t instance, uint32_t geometry, uint32_t primitive) {
    ray.instance = instance == RTC_INVALID_GEOMETRY_ID ? nullptr : ray.root->instances + instance;
    ray.geometry = (ray.instance ? ray.instance->child : ray.root)->geometries + geometry;
    ray.primitive = primitive;
}
OXRT_INLINE void enterHit(Ray& ray, const RTCHit& hit, float t) {
    locate(ray, hit.instID[0], hit.geomID, hit.primID);
    ray.t = t;
    ray.u = hit.u;
    ray.v = hit.v;
    ray.normal = {hit.Ng_x, hit.Ng_y, hit.Ng_z};
}

/* The hit's SBT record, null if there is none that this pipeline may run. */
OXRT_INLINE const OxrtRecordHeader* findHitRecord(Ray& ray) {
    const OxrtLaunch& launch = *ray.thread->launch;
    const uint32_t instanceOffset = ray.instance ? ray.instance->sbtOffset : 0;
    ray.recordIndex = instanceOffset + getSbtGASIndex(ray) * ray.sbtStride + ray.sbtOffset;
    ray.record = findRecord(launch, launch.hitgroupRecords, launch.hitgroupStride, launch.hitgroupCount, ray.recordIndex);
    return ray.record;
}

/* ---- candidates ------------------------------------------------------------------------------------------------------------------- */

/* Whether any-hit programs run: the ray's flag beats the instance's, which beats the geometry's; ENFORCE beats DISABLE. */
OXRT_INLINE bool anyHitEnabled(const Ray& ray, uint32_t instanceFlags, uint32_t geometryFlags) {
    if (ray.flags & (RAY_DISABLE_ANYHIT | RAY_ENFORCE_ANYHIT))
        return ray.flags & RAY_ENFORCE_ANYHIT;
    if (instanceFlags & (INSTANCE_DISABLE_ANYHIT | INSTANCE_ENFORCE_ANYHIT))
        return instanceFlags & INSTANCE_ENFORCE_ANYHIT;
    return !(geometryFlags & GEOMETRY_DISABLE_ANYHIT);
}

/* Whether the ray's culling flags drop the candidate. */
OXRT_INLINE bool isCulled(const Ray& ray, uint32_t instanceFlags, uint32_t geometryFlags, bool runsAnyHit) {
    if (ray.flags & (runsAnyHit ? RAY_CULL_ENFORCED_ANYHIT : RAY_CULL_DISABLED_ANYHIT))
        return true;
    if (!(ray.flags & (RAY_CULL_BACK_FACING | RAY_CULL_FRONT_FACING)) || !isTriangleGeometry(ray))
        return false;
    if ((instanceFlags & INSTANCE_DISABLE_FACE_CULLING) || (geometryFlags & GEOMETRY_DISABLE_FACE_CULLING))
        return false;
    return ray.flags & (isFrontFacing(ray) ? RAY_CULL_FRONT_FACING : RAY_CULL_BACK_FACING);
}

/* Decides about the candidate that was entered into the ray; runs the any-hit program if it is to run. */
template <class Programs, bool MAY_CULL> OXRT_INLINE Verdict judge(Ray& ray) {
    const uint32_t instanceFlags = ray.instance ? ray.instance->flags : 0;
    const uint32_t geometryFlags = ray.geometry->recordFlags[localRecord(ray)];
    const bool runsAnyHit = anyHitEnabled(ray, instanceFlags, geometryFlags);
    if constexpr (MAY_CULL)
        if (isCulled(ray, instanceFlags, geometryFlags, runsAnyHit))
            return Verdict::Ignore;
    ray.verdict = Verdict::Accept;
    if constexpr (Programs::hasAnyHit)
        if (runsAnyHit)
            if (const OxrtRecordHeader* record = findHitRecord(ray)) {
                Programs::anyHit(ray, *static_cast<typename Programs::Payload*>(ray.payload), *record);
                if constexpr (Programs::mayThrow)
                    if (ray.thread->exceptionPending)
                        return Verdict::Terminate;
            }
    if (ray.verdict == Verdict::Accept && (ray.flags & RAY_TERMINATE_ON_FIRST_HIT))
        return Verdict::Terminate;
    return ray.verdict;
}

/* Stops the traversal; what was accepted stays. */
OXRT_INLINE void stopTraversal(Ray& ray, RTCRay& embreeRay, float t) {
    ray.isTerminated = true;
    ray.closest = t;
    embreeRay.tfar = -__builtin_inff();
}

/* Embree's filter callback: called for every candidate on a built-in primitive. */
template <class Programs, bool MAY_CULL> void filterCandidate(const RTCFilterFunctionNArguments* arguments) {
    Ray& ray = *reinterpret_cast<Ray*>(arguments->context);
    RTCRay& embreeRay = *static_cast<RTCRay*>(arguments->ray);
    if (arguments->valid[0] != -1)
        return;
    enterHit(ray, *static_cast<const RTCHit*>(arguments->hit), embreeRay.tfar);
    ray.objectRay = &embreeRay;
    switch (judge<Programs, MAY_CULL>(ray)) {
    case Verdict::Accept: break;
    case Verdict::Ignore: arguments->valid[0] = 0; break;
    case Verdict::Terminate: stopTraversal(ray, embreeRay, ray.t); break;
    }
}

/* ---- custom primitives ------------------------------------------------------------------------------------------------------------- */

/* Whether the ray meets a box inside its interval, faces included; in doubt it does. Embree calls back without this test where a scene
   holds one primitive. */
OXRT_INLINE bool meetsBox(const RTCRay& ray, const float* box, float tmin, float tmax) {
    const float origin[3] = {ray.org_x, ray.org_y, ray.org_z};
    const float direction[3] = {ray.dir_x, ray.dir_y, ray.dir_z};
    float enter = tmin;
    float leave = tmax;
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0.0f) {
            if (origin[axis] < box[axis] || origin[axis] > box[axis + 3])
                return false;
            continue;
        }
        const float a = (box[axis] - origin[axis]) / direction[axis];
        const float b = (box[axis + 3] - origin[axis]) / direction[axis];
        const float near = a < b ? a : b;
        const float far = a < b ? b : a;
        enter = near > enter ? near : enter;
        leave = far < leave ? far : leave;
    }
    constexpr float rounding = 1e-6f;
    return !(enter > leave + rounding * __builtin_fabsf(leave));
}

template <class Programs> void runIntersection(Ray& ray, RTCRay& embreeRay, RTCHit* hit, uint32_t geometry, uint32_t primitive) {
    if (ray.isTerminated)
        return;
    locate(ray, ray.context.instID[0], geometry, primitive);
    ray.embreeRay = &embreeRay;
    ray.embreeHit = hit;
    ray.objectRay = &embreeRay;
    if (embreeRay.tfar != ray.closestInEmbree)
        ray.closest = ray.closestInEmbree = embreeRay.tfar;
    if (ray.geometry->primitiveCount == 1 && ray.geometry->keyCount == 1 &&
        !meetsBox(embreeRay, ray.geometry->vertices + 6 * uint64_t(primitive), ray.tmin, ray.closest))
        return;
    const uint32_t instanceFlags = ray.instance ? ray.instance->flags : 0;
    const uint32_t geometryFlags = ray.geometry->recordFlags[localRecord(ray)];
    if ((ray.flags & RAY_CULL_ANY) && isCulled(ray, instanceFlags, geometryFlags, anyHitEnabled(ray, instanceFlags, geometryFlags)))
        return; /* before the program runs, as in OptiX */
    ray.t = ray.closest;
    ray.verdict = Verdict::Accept;
    if (const OxrtRecordHeader* record = findHitRecord(ray)) {
        Programs::intersection(ray, *static_cast<typename Programs::Payload*>(ray.payload), *record);
        if constexpr (Programs::mayThrow)
            if (ray.thread->exceptionPending)
                stopTraversal(ray, embreeRay, ray.closest);
    }
}
template <class Programs> void intersectCustom(const RTCIntersectFunctionNArguments* arguments) {
    auto& rayhit = *static_cast<RTCRayHit*>(arguments->rayhit);
    if (arguments->valid[0] == -1)
        runIntersection<Programs>(*reinterpret_cast<Ray*>(arguments->context), rayhit.ray, &rayhit.hit, arguments->geomID, arguments->primID);
}
template <class Programs> void occludeCustom(const RTCOccludedFunctionNArguments* arguments) {
    auto& embreeRay = *static_cast<RTCRay*>(arguments->ray);
    if (arguments->valid[0] == -1)
        runIntersection<Programs>(*reinterpret_cast<Ray*>(arguments->context), embreeRay, nullptr, arguments->geomID, arguments->primID);
}

/* Makes the candidate the closest hit. */
OXRT_INLINE void commitCandidate(Ray& ray) {
    ray.closest = ray.t;
    ray.committedKind = ray.kind;
    __builtin_memcpy(ray.committedAttributes, ray.attributes, sizeof(ray.attributes));
    if (ray.embreeHit) {
        *ray.embreeHit = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, ray.primitive, uint32_t(ray.geometry - (ray.instance ? ray.instance->child : ray.root)->geometries),
                          {ray.context.instID[0]}, {ray.context.instPrimID[0]}};
        ray.closestInEmbree = nextDown(ray.t);
        ray.embreeRay->tfar = ray.closestInEmbree;
    } else
        stopTraversal(ray, *ray.embreeRay, ray.t);
}

template <class Programs> OXRT_INLINE bool reportCandidate(Ray& ray, float t, uint32_t kind) {
    if (!(ray.tmin <= t && t <= ray.closest))
        return false;
    ray.kind = kind & 0xFF;
    ray.t = t;
    const Verdict verdict = judge<Programs, true>(ray);
    if (verdict != Verdict::Ignore)
        commitCandidate(ray);
    if (verdict == Verdict::Terminate)
        stopTraversal(ray, *ray.embreeRay, t);
    ray.t = ray.closest;
    ray.verdict = verdict == Verdict::Terminate ? Verdict::Terminate : Verdict::Accept;
    return verdict != Verdict::Ignore;
}

/* Offers a hit of the intersection program. Where it ends the ray, `hasEnded` is true afterwards and the program returns at once. */
template <class Programs, class Attributes> OXRT_INLINE bool reportIntersection(Ray& ray, float t, uint32_t kind, const Attributes& attributes) {
    static_assert(sizeof(Attributes) <= sizeof(ray.attributes));
    __builtin_memcpy(ray.attributes, &attributes, sizeof(Attributes));
    return reportCandidate<Programs>(ray, t, kind);
}
template <class Programs> OXRT_INLINE bool reportIntersection(Ray& ray, float t, uint32_t kind) { return reportCandidate<Programs>(ray, t, kind); }

/* Whether the running program or a helper has called something that does not return. */
OXRT_INLINE bool hasEnded(const Ray& ray) { return ray.verdict != Verdict::Accept; }

/* Attribute words given one by one. */
template <class... T> struct AttributeWords {
    uint32_t words[sizeof...(T)];
};
template <class... T> OXRT_INLINE AttributeWords<T...> attributeWords(T... values) { return {{bitCast<uint32_t>(values)...}}; }

/* ---- queries ----------------------------------------------------------------------------------------------------------------------- */

OXRT_INLINE void setEmbreeRay(RTCRay& target, const Ray& ray) {
    target.org_x = ray.origin.x;
    target.org_y = ray.origin.y;
    target.org_z = ray.origin.z;
    target.tnear = nextUp(ray.tmin);
    target.dir_x = ray.direction.x;
    target.dir_y = ray.direction.y;
    target.dir_z = ray.direction.z;
    target.time = ray.time;
    target.tfar = nextDown(ray.tmax);
    target.mask = ray.mask;
    target.id = 0;
    target.flags = 0;
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
        const bool runsAnyHit = Programs::hasAnyHit && ((ray.flags & RAY_ENFORCE_ANYHIT) || !(ray.flags & RAY_DISABLE_ANYHIT));
        const uint32_t overridingFlags = RAY_CULL_ANY | (Programs::hasAnyHit ? RAY_ENFORCE_ANYHIT : 0u);
        if (runsAnyHit || (ray.flags & RAY_CULL_ANY))
            arguments.filter = filterCandidate<Programs, Known::mayCull>;
        /* Without this flag Embree calls the filter on those geometries only that do not disable any-hit programs. */
        if ((ray.flags & overridingFlags) || (ray.root->needs & OXRT_SCENE_HAS_INSTANCE_FLAGS))
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
            __builtin_memcpy(ray.attributes, ray.committedAttributes, sizeof(ray.attributes));
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
