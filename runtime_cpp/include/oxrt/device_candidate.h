/* Candidates of a traversal: where they are, their SBT record, and whether they count.
 *
 * `Programs` is what the pipeline emits for each payload class: which programs a trace with that payload can run, as constants that
 * decide what is compiled at all, and static functions that run them. Decision order: OptiX guide, "Ray flags", "Instance flags",
 * "Any hit".
 */
#ifndef OXRT_DEVICE_CANDIDATE_H
#define OXRT_DEVICE_CANDIDATE_H

#include <oxrt/device_opacity.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* What the emitted Programs of a payload class override. */
struct NoPrograms {
    using Payload = NoPayload;
    static constexpr bool hasClosestHit = false;
    static constexpr bool hasAnyHit = false;
    static constexpr bool inlinesAnyHit = false; /* ... into the callback, wholly */
    static constexpr bool hasIntersection = false;
    static constexpr bool hasMiss = false;
    static constexpr bool mayThrow = false;
    static constexpr bool countsDepth = false;  /* traces may nest deeper than maxTraceDepth */
    static constexpr bool depthThrows = false;  /* ... which is an exception rather than a fault */
    static constexpr uint32_t maxTraceDepth = 0;
    static constexpr bool graphDepthThrows = false; /* a graph that is too deep is an exception */
    static constexpr bool checksStack = false;    /* nested traces may use up the stack */
    static constexpr bool overflowThrows = false; /* ... which is an exception rather than a fault */
    static constexpr bool usesTime = false;
    static constexpr bool usesMicromaps = false;
    static constexpr bool isValidated = false;
    static constexpr uint32_t excludedNeeds = 0; /* OXRT_SCENE_...: kinds of primitives that uses_primitive_type_flags leaves out */
    static constexpr uint32_t graphFlags = 0; /* the pipeline's traversable_graph_flags: 1 a lone GAS, 2 one level of instances, 0 any */
};

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

/* Whether kernels walk through the scene themselves. */
OXRT_INLINE bool isGraph(const OxrtTraversableView& view) { return view.needs & (OXRT_SCENE_MULTI_LEVEL | OXRT_SCENE_HAS_MOTION); }

inline __attribute__((noinline)) const OxrtInstanceView* findInstanceOnPath(GraphPath& path, uint32_t instance) {
    path.native = instance == RTC_INVALID_GEOMETRY_ID ? nullptr : path.structure->instances + instance;
    return path.native ? path.native : path.instance;
}

/* Enter which primitive the hit is on. */
OXRT_INLINE void locate(Ray& ray, uint32_t instance, const OxrtGeometry* geometry, uint32_t primitive) {
    if (__builtin_expect(ray.path != nullptr, 0))
        ray.instance = findInstanceOnPath(*ray.path, instance);
    else
        ray.instance = instance == RTC_INVALID_GEOMETRY_ID ? nullptr : ray.root->instances + instance;
    ray.geometry = geometry;
    ray.primitive = primitive;
}
/* Of a candidate: `geometry` is what Embree's callbacks get as the geometry's user pointer. */
OXRT_INLINE void enterHit(Ray& ray, const RTCHit& hit, const OxrtGeometry* geometry, float t) {
    locate(ray, hit.instID[0], geometry, hit.primID);
    ray.t = t;
    ray.u = hit.u;
    ray.v = hit.v;
    ray.normal = {hit.Ng_x, hit.Ng_y, hit.Ng_z};
}

/* The geometry is looked up. */
OXRT_INLINE void enterHit(Ray& ray, const RTCHit& hit, float t) {
    enterHit(ray, hit, nullptr, t);
    ray.geometry = holderOf(ray).geometries + hit.geomID;
}

/* The hit's SBT record, null if there is none that this pipeline may run. */
OXRT_INLINE const OxrtRecordHeader* findHitRecord(Ray& ray) {
    const OxrtLaunch& launch = *ray.thread->launch;
    ray.recordIndex = instanceSbtOffset(ray) + getSbtGASIndex(ray) * ray.sbtStride + ray.sbtOffset;
    ray.record = findRecord(launch, launch.hitgroupRecords, launch.hitgroupStride, launch.hitgroupCount, ray.recordIndex);
    return ray.record;
}

/* ---- candidates ------------------------------------------------------------------------------------------------------------------- */

/* Whether any-hit programs run: the ray's flag beats the instance's, which beats the geometry's; ENFORCE beats DISABLE. */
OXRT_INLINE bool anyHitEnabled(uint32_t rayFlags, uint32_t instanceFlags, uint32_t geometryFlags) {
    if (rayFlags & (RAY_DISABLE_ANYHIT | RAY_ENFORCE_ANYHIT))
        return rayFlags & RAY_ENFORCE_ANYHIT;
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

/* Runs the any-hit program of a candidate's record; what it decided stands in ray.verdict. */
template <class Programs> OXRT_INLINE void runAnyHit(Ray& ray, const OxrtRecordHeader& record) {
    ray.verdict = Verdict::Accept;
    Programs::anyHit(ray, *static_cast<typename Programs::Payload*>(ray.payload), record);
    if constexpr (Programs::mayThrow)
        if (ray.thread->exceptionPending)
            ray.verdict = Verdict::Terminate;
    if (ray.verdict == Verdict::Accept && (ray.flags & RAY_TERMINATE_ON_FIRST_HIT))
        ray.verdict = Verdict::Terminate;
}

/* Whether all candidates of a trace with the same program run it without a further question. */
template <class Programs, bool MAY_CULL> inline constexpr bool mayHaveSoleRecord =
    Programs::hasAnyHit && !MAY_CULL && !Programs::usesMicromaps;

/* The one record of all candidates of a trace, if they have one and its any-hit program runs. It is looked for beforehand: in the callbacks
   that is a chain of loads, one after the other, in front of those of the program. Not for paths through a graph. */
OXRT_INLINE const OxrtRecordHeader* findSoleRecord(const OxrtLaunch& launch, const OxrtTraversableView& root, uint32_t rayFlags,
                                                   uint32_t sbtOffset) {
    if (root.geometryCount != 1 || (root.needs & OXRT_SCENE_HAS_CURVES) || root.geometries->recordOffsets)
        return nullptr;
    if (!anyHitEnabled(rayFlags, 0, root.geometries->recordFlags[0]))
        return nullptr;
    return findRecord(launch, launch.hitgroupRecords, launch.hitgroupStride, launch.hitgroupCount, sbtOffset);
}

/* What becomes of a candidate for which no any-hit program runs. */
OXRT_INLINE Verdict plainVerdict(const Ray& ray) { return ray.flags & RAY_TERMINATE_ON_FIRST_HIT ? Verdict::Terminate : Verdict::Accept; }

/* Decides about the candidate that was entered into the ray; runs the any-hit program if it is to run. */
template <class Programs, bool MAY_CULL> OXRT_INLINE Verdict judge(Ray& ray) {
    const OxrtRecordHeader* record = nullptr;
    if constexpr (mayHaveSoleRecord<Programs, MAY_CULL>)
        record = ray.record = ray.soleRecord;
    if (!record) {
        const uint32_t instanceFlags = ray.instance ? ray.instance->flags : 0;
        uint32_t geometryFlags = ray.geometry->recordFlags[localRecord(ray)];
        if constexpr (Programs::usesMicromaps)
            if (!passesMicromap(ray, instanceFlags, geometryFlags))
                return Verdict::Ignore;
        const bool runsAnyHit = anyHitEnabled(ray.flags, instanceFlags, geometryFlags);
        if constexpr (MAY_CULL)
            if (isCulled(ray, instanceFlags, geometryFlags, runsAnyHit))
                return Verdict::Ignore;
        if (!Programs::hasAnyHit || !runsAnyHit)
            return plainVerdict(ray);
        record = findHitRecord(ray);
        if (!record)
            return plainVerdict(ray);
    }
    if constexpr (Programs::hasAnyHit)
        runAnyHit<Programs>(ray, *record);
    return ray.verdict;
}

/* Stops the traversal; what was accepted stays. */
OXRT_INLINE void stopTraversal(Ray& ray, RTCRay& embreeRay, float t) {
    ray.isTerminated = true;
    ray.closest = t;
    embreeRay.tfar = -__builtin_inff();
}

/* Whether the candidate is a crossing of a curve that was offered before; it is noted if not. */
OXRT_INLINE bool isRepeatedCurveHit(const Ray& ray, CurveRoots& roots) {
    if (ray.t >= roots.closest)
        return true; /* of hits at one distance, as at joints of segments, the first counts */
    if (roots.geometry != ray.geometry || roots.primitive != ray.primitive || roots.instance != ray.instance)
        roots = {ray.geometry, ray.instance, ray.primitive, 0, {}, roots.closest};
    /* Embree's roots of one crossing differ by its tolerance, two crossings by about the thickness of the curve. */
    constexpr float sameRoot = 1e-4f;
    for (uint32_t i = 0; i < roots.count; ++i)
        if (__builtin_fabsf(roots.t[i] - ray.t) <= sameRoot * __builtin_fabsf(ray.t))
            return true;
    roots.t[roots.count & 3] = ray.t;
    roots.count += roots.count < 4;
    return false;
}

/* Enters the candidate into `ray` and judges it; what outlasts it goes into `trace`. */
template <class Programs, bool MAY_CULL>
OXRT_INLINE void judgeCandidate(Ray& ray, Ray& trace, const RTCFilterFunctionNArguments* arguments) {
    RTCRay& embreeRay = *static_cast<RTCRay*>(arguments->ray);
    const RTCHit& hit = *static_cast<const RTCHit*>(arguments->hit);
    enterHit(ray, hit, static_cast<const OxrtGeometry*>(arguments->geometryUserPtr), embreeRay.tfar);
    ray.objectRay = &embreeRay;
    if ((ray.root->needs & OXRT_SCENE_HAS_CURVES) && isRepeatedCurveHit(ray, trace.curveRoots)) {
        arguments->valid[0] = 0;
        return;
    }
    switch (judge<Programs, MAY_CULL>(ray)) {
    case Verdict::Accept: trace.curveRoots.closest = ray.t; break;
    case Verdict::Ignore: arguments->valid[0] = 0; break;
    case Verdict::Terminate: stopTraversal(trace, embreeRay, ray.t); break;
    }
}

/* Embree's filter callback: called for every candidate on a built-in primitive. */
template <class Programs, bool MAY_CULL> void filterCandidate(const RTCFilterFunctionNArguments* arguments) {
    Ray& trace = *reinterpret_cast<Ray*>(arguments->context);
    if (arguments->valid[0] != -1)
        return;
    if constexpr (Programs::inlinesAnyHit) {
        /* nobody sees this one's address: what the programs do not read of it is never stored */
        Ray candidate = trace;
        judgeCandidate<Programs, MAY_CULL>(candidate, trace, arguments);
    } else
        judgeCandidate<Programs, MAY_CULL>(trace, trace, arguments);
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
