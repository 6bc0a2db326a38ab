/* Hit objects: a trace cut in two. Traversal fills the outgoing hit object, invoke runs closest-hit or miss on it.
 *
 * A program has one outgoing hit object, shared by the helpers that it calls; it starts as a nop and is one again after invoke and
 * after any trace. Queries of a nop give zero (OptiX guide, "Shader execution reordering").
 */
#ifndef OXRT_DEVICE_HIT_OBJECT_H
#define OXRT_DEVICE_HIT_OBJECT_H

#include <oxrt/device_curves.h>
#include <oxrt/device_trace.h>
#include <oxrt/hit_getters.h>

namespace oxrt {
inline namespace OXRT_ISA {

struct HitObject {
    enum class Kind : uint32_t { Nop, Hit, Miss } kind = Kind::Nop;
    uint32_t recordIndex = 0;
    OxrtThread* thread;
    Ray ray;
    GraphPath path;

    OXRT_INLINE explicit HitObject(OxrtThread& owner) : thread(&owner) {}
};

OXRT_INLINE bool hitObjectIsHit(const HitObject& object) { return object.kind == HitObject::Kind::Hit; }
OXRT_INLINE bool hitObjectIsMiss(const HitObject& object) { return object.kind == HitObject::Kind::Miss; }
OXRT_INLINE bool hitObjectIsNop(const HitObject& object) { return object.kind == HitObject::Kind::Nop; }
OXRT_INLINE void makeNopHitObject(HitObject& object) { object.kind = HitObject::Kind::Nop; }
OXRT_INLINE void hitObjectSetSbtRecordIndex(HitObject& object, uint32_t index) { object.recordIndex = index; }
OXRT_INLINE void reorder(HitObject&, uint32_t, uint32_t) {}

/* ---- traverse, invoke, make ------------------------------------------------------------------------------------------------------ */

template <class Programs, class Flags>
OXRT_INLINE void traverse(OxrtThread& thread, HitObject& object, uint64_t handle, const float3& origin, const float3& direction, float tmin,
                          float tmax, float time, uint32_t mask, Flags flags, uint32_t sbtOffset, uint32_t sbtStride, uint32_t missIndex,
                          typename Programs::Payload& payload, Place place = Place::current()) {
    Ray& ray = object.ray;
    if (!setRay<Programs>(ray, thread, handle, origin, direction, tmin, tmax, time, mask, flags, sbtOffset, sbtStride, missIndex, payload, place))
        return;
    object.kind = HitObject::Kind::Miss;
    object.recordIndex = missIndex;
    if (canHit(ray) && findClosest<Programs, Flags>(ray, object.path)) {
        findHitRecord(ray);
        object.kind = HitObject::Kind::Hit;
        object.recordIndex = ray.recordIndex;
    } else
        ray.t = ray.tmax;
}

template <class Programs> OXRT_INLINE void invoke(OxrtThread& thread, HitObject& object, typename Programs::Payload& payload, Place place = Place::current()) {
    const HitObject::Kind kind = object.kind;
    object.kind = HitObject::Kind::Nop;
    if (kind == HitObject::Kind::Nop || !enterTrace<Programs>(thread, SameThread{thread}, place))
        return;
    Ray ray = object.ray;
    ray.payload = &payload;
    GraphPath path; /* the program may fill the hit object anew */
    if (ray.path) {
        copyPath(path, *ray.path);
        ray.path = &path;
    }
    const OxrtLaunch& launch = *thread.launch;
    if (kind == HitObject::Kind::Miss) {
        ray.missIndex = object.recordIndex;
        if constexpr (Programs::hasMiss)
            runMiss<Programs>(ray, payload, place);
    } else if constexpr (Programs::hasClosestHit) {
        ray.recordIndex = object.recordIndex;
        ray.record = findRecord(launch, launch.hitgroupRecords, launch.hitgroupStride, launch.hitgroupCount, object.recordIndex);
        if constexpr (Programs::isValidated)
            placeOfTrace() = place;
        if (ray.flags & RAY_DISABLE_CLOSESTHIT) {
        } else if (ray.record)
            Programs::closestHit(ray, payload, *ray.record);
        else if (Programs::isValidated && ray.recordIndex >= launch.hitgroupCount)
            fault(thread, OXRT_FAULT_HIT_SBT, "the hit object needs a record behind the end of the hit group records", place);
    }
    leaveTrace<Programs>(thread);
}

OXRT_INLINE void makeMissHitObject(HitObject& object, uint32_t missIndex, const float3& origin, const float3& direction, float tmin, float tmax,
                                   float time, uint32_t flags) {
    Ray& ray = object.ray;
    ray.thread = object.thread;
    ray.origin = origin;
    ray.direction = direction;
    ray.tmin = tmin;
    ray.tmax = ray.t = tmax;
    ray.time = time;
    ray.flags = flags & 0xFFFF;
    ray.missIndex = missIndex;
    ray.instance = nullptr;
    ray.path = nullptr;
    object.kind = HitObject::Kind::Miss;
    object.recordIndex = missIndex;
}

/* ---- getters ----------------------------------------------------------------------------------------------------------------------- */

/* Of a hit or a miss. */
#define OXRT_OF_RAY(RESULT, NAME) \
    OXRT_INLINE RESULT hitObjectGet##NAME(const HitObject& object) { return hitObjectIsNop(object) ? RESULT{} : get##NAME(object.ray); }
OXRT_OF_RAY(float3, WorldRayOrigin)
OXRT_OF_RAY(float3, WorldRayDirection)
OXRT_OF_RAY(float, RayTmin)
OXRT_OF_RAY(float, RayTmax)
OXRT_OF_RAY(float, RayTime)
OXRT_OF_RAY(uint32_t, RayFlags)
#undef OXRT_OF_RAY

/* Of a hit only. */
#define OXRT_OF_HIT(RESULT, NAME) \
    OXRT_INLINE RESULT hitObjectGet##NAME(const HitObject& object) { return hitObjectIsHit(object) ? get##NAME(object.ray) : RESULT{}; }
OXRT_HIT_GETTERS(OXRT_OF_HIT)
OXRT_SINGLE_HIT_GETTERS(OXRT_OF_HIT)
#undef OXRT_OF_HIT

OXRT_INLINE float3 hitObjectGetRibbonNormal(const HitObject& object, const float2& parameters) {
    return hitObjectIsHit(object) ? getRibbonNormal(object.ray, parameters) : float3{};
}
OXRT_INLINE uint32_t hitObjectGetSbtRecordIndex(const HitObject& object) { return hitObjectIsNop(object) ? 0 : object.recordIndex; }
/* The data of the record that invoke would use; zero where there is none. */
template <class Record> OXRT_INLINE Record hitObjectGetSbtData(const HitObject& object) {
    const OxrtLaunch& launch = *object.thread->launch;
    const OxrtRecordHeader* record = nullptr;
    if (hitObjectIsHit(object))
        record = findRecord(launch, launch.hitgroupRecords, launch.hitgroupStride, launch.hitgroupCount, object.recordIndex);
    else if (hitObjectIsMiss(object))
        record = findRecord(launch, launch.missRecords, launch.missStride, launch.missCount, object.recordIndex);
    return record ? recordData<Record>(*record) : Record{};
}
OXRT_INLINE constexpr uint32_t hitObjectGetClusterId(const HitObject&) { return ~0u; }
OXRT_INLINE float3x4 hitObjectGetObjectToWorldTransformMatrix(const HitObject& object) {
    return hitObjectIsHit(object) ? getObjectToWorldTransformMatrix(object.ray) : identityTransform();
}
OXRT_INLINE float3x4 hitObjectGetWorldToObjectTransformMatrix(const HitObject& object) {
    return hitObjectIsHit(object) ? getWorldToObjectTransformMatrix(object.ray) : identityTransform();
}
OXRT_INLINE uint64_t hitObjectGetTransformListHandle(const HitObject& object, uint32_t index) {
    return hitObjectIsHit(object) ? getTransformListHandle(object.ray, index) : 0;
}

#define OXRT_TRANSFORM(NAME)                                                                  \
    OXRT_INLINE float3 hitObjectTransform##NAME(const HitObject& object, const float3& value) { \
        return hitObjectIsHit(object) ? transform##NAME(object.ray, value) : value;             \
    }
OXRT_HIT_TRANSFORMS(OXRT_TRANSFORM)
#undef OXRT_TRANSFORM

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
