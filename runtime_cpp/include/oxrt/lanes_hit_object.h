/* Outgoing hit objects of W lanes: device_hit_object.h for packets.
 *
 * Lanes may fill theirs at different places, with different scenes and flags. What differs stays in lanes; programs and getters see one
 * scene and one word of flags at a time (`eachScene`), which is all lanes at once where they traversed together.
 */
#ifndef OXRT_LANES_HIT_OBJECT_H
#define OXRT_LANES_HIT_OBJECT_H

#include <oxrt/device_make_hit.h>
#include <oxrt/lanes_trace.h>

namespace oxrt {
inline namespace OXRT_ISA {

template <int W> struct HitObjectLanes {
    enum : uint32_t { NOP, HIT, MISS };
    LanesThread<W>* thread;
    Lanes<uint32_t, W> state = NOP; /* not masks: on three that exclude each other clang 19 loops for ever */
    typename Packet<W>::RayHit packet = {};
    Lanes<uint64_t, W> root = 0u; /* addresses of OxrtTraversableView */
    Lanes<uint32_t, W> flags = 0u, recordIndex = 0u, sbtOffset = 0u, sbtStride = 0u, kind = 0u;
    Lanes<float, W> tmin = 0.0f, tmax = 0.0f, t = 0.0f;
    Lanes<uint32_t, W> attributes[8] = {};
    GraphPath paths[W];

    OXRT_INLINE explicit HitObjectLanes(LanesThread<W>& owner) : thread(&owner) {}
    OXRT_INLINE Lanes<bool, W> isHit() const { return state == uint32_t(HIT); }
    OXRT_INLINE Lanes<bool, W> isMiss() const { return state == uint32_t(MISS); }
};

template <int W> OXRT_INLINE Lanes<bool, W> hitObjectIsHit(const HitObjectLanes<W>& object, Lanes<bool, W>) { return object.isHit(); }
template <int W> OXRT_INLINE Lanes<bool, W> hitObjectIsMiss(const HitObjectLanes<W>& object, Lanes<bool, W>) { return object.isMiss(); }
template <int W> OXRT_INLINE Lanes<bool, W> hitObjectIsNop(const HitObjectLanes<W>& object, Lanes<bool, W>) {
    return object.state == uint32_t(object.NOP);
}
template <int W> OXRT_INLINE void makeNopHitObject(HitObjectLanes<W>& object, Lanes<bool, W> mask) {
    object.state = select(mask, uint32_t(object.NOP), object.state);
}
template <int W> OXRT_INLINE void hitObjectSetSbtRecordIndex(HitObjectLanes<W>& object, Lanes<bool, W> mask, Wide<uint32_t, W> index) {
    object.recordIndex = select(mask, index, object.recordIndex);
}
template <int W> OXRT_INLINE void reorder(HitObjectLanes<W>&, Lanes<bool, W>, Wide<uint32_t, W>, Wide<uint32_t, W>) {}

/* ---- one scene at a time --------------------------------------------------------------------------------------------------------- */

/* The object as rays of one scene, `active` the lanes that it is about. */
template <int W> OXRT_INLINE RayLanes<W> raysOf(HitObjectLanes<W>& object, const OxrtTraversableView* root, uint32_t flags, Lanes<bool, W> active) {
    RayLanes<W> ray(object.packet);
    ray.thread = object.thread;
    ray.payload = nullptr;
    ray.root = root;
    ray.paths = root && isGraph(*root) ? object.paths : nullptr;
    ray.tmin = object.tmin;
    ray.tmax = object.tmax;
    ray.t = object.t;
    ray.sbtOffset = object.sbtOffset;
    ray.sbtStride = object.sbtStride;
    ray.missIndex = object.recordIndex;
    ray.flags = flags;
    ray.active = active;
    ray.commonInstance = nullptr;
    ray.commonGeometry = nullptr;
    ray.kind = object.kind;
    for (int i = 0; i < 8; ++i)
        ray.attributes[i] = object.attributes[i];
    return ray;
}

/* f(rays, lanes) for the lanes of each scene and word of flags. */
template <int W, class F> OXRT_INLINE void eachScene(HitObjectLanes<W>& object, Lanes<bool, W> mask, F f) {
    while (any(mask)) {
        const int lane = firstLane(mask);
        const uint64_t root = object.root[lane];
        const uint32_t flags = object.flags[lane];
        const Lanes<bool, W> own = mask & (object.root == root) & (object.flags == flags);
        RayLanes<W> ray = raysOf(object, reinterpret_cast<const OxrtTraversableView*>(root), flags, own);
        f(ray, own);
        mask = without(mask, own);
    }
}

/* Takes over the masked lanes of a traversal, which missed where they did not hit. */
template <int W>
OXRT_INLINE void enterHitObject(HitObjectLanes<W>& object, const RayLanes<W>& ray, Lanes<bool, W> mask, Lanes<bool, W> hit,
                                Lanes<uint32_t, W> recordIndex, int attributeWords) {
    const auto take = [mask](auto& to, const auto& from) { setPacket(to, select(mask, packetLanes<W>(from), packetLanes<W>(to))); };
    const auto& from = ray.packet;
    auto& to = object.packet;
    take(to.ray.org_x, from.ray.org_x);
    take(to.ray.org_y, from.ray.org_y);
    take(to.ray.org_z, from.ray.org_z);
    take(to.ray.dir_x, from.ray.dir_x);
    take(to.ray.dir_y, from.ray.dir_y);
    take(to.ray.dir_z, from.ray.dir_z);
    take(to.ray.time, from.ray.time);
    take(to.ray.mask, from.ray.mask);
    take(to.hit.Ng_x, from.hit.Ng_x);
    take(to.hit.Ng_y, from.hit.Ng_y);
    take(to.hit.Ng_z, from.hit.Ng_z);
    take(to.hit.u, from.hit.u);
    take(to.hit.v, from.hit.v);
    take(to.hit.primID, from.hit.primID);
    take(to.hit.geomID, from.hit.geomID);
    take(to.hit.instID[0], from.hit.instID[0]);
    object.state = select(mask, select(hit, uint32_t(object.HIT), uint32_t(object.MISS)), object.state);
    object.root = select(mask, reinterpret_cast<uint64_t>(ray.root), object.root);
    object.flags = select(mask, ray.flags, object.flags);
    object.recordIndex = select(mask, recordIndex, object.recordIndex);
    object.sbtOffset = select(mask, ray.sbtOffset, object.sbtOffset);
    object.sbtStride = select(mask, ray.sbtStride, object.sbtStride);
    object.tmin = select(mask, ray.tmin, object.tmin);
    object.tmax = select(mask, ray.tmax, object.tmax);
    object.t = select(mask, select(hit, ray.t, ray.tmax), object.t);
    object.kind = select(mask, ray.kind, object.kind);
    for (int i = 0; i < attributeWords; ++i)
        object.attributes[i] = select(mask, ray.attributes[i], object.attributes[i]);
}

/* ---- traverse and invoke ----------------------------------------------------------------------------------------------------------- */

template <class Programs, class Flags, int W>
OXRT_INLINE void traverse(LanesThread<W>& thread, Lanes<bool, W> mask, HitObjectLanes<W>& object, uint64_t handle, const Wide<float3, W>& origin,
                          const Wide<float3, W>& direction, Wide<float, W> tmin, Wide<float, W> tmax, Wide<float, W> time,
                          Wide<uint32_t, W> visibility, Flags flags, Wide<uint32_t, W> sbtOffset, Wide<uint32_t, W> sbtStride,
                          Wide<uint32_t, W> missIndex, typename Programs::Payload& payload, Place place = Place::current()) {
    if (none(mask))
        return;
    PacketMemoryFor<Programs, Flags, W> memory;
    RayLanes<W> ray(memory.rays);
    if (!setRays<Programs>(ray, thread, mask, handle, origin, direction, tmin, tmax, time, visibility, flags, sbtOffset, sbtStride, missIndex,
                           payload, place))
        return;
    GraphPath paths[W];
    if (ray.root && __builtin_expect(isGraph(*ray.root), 0))
        ray.paths = paths;
    clearHits(ray);
    ray.kind = 0u;
    for (int i = 0; i < Programs::attributeWords; ++i)
        ray.attributes[i] = 0u;
    Lanes<bool, W> hit = false;
    const Lanes<bool, W> traced = mask & (ray.tmin <= ray.tmax);
    if (ray.root && ray.root->scene && any(traced)) {
        hit = traverse<Programs, Flags, false>(ray, traced, payload, bundleFor<Programs, false>(ray, mask, origin, direction, tmax),
                                              memory);
        if constexpr (Programs::Scalar::mayThrow) {
            mask = without(mask, thread.thrown);
            hit = hit & mask;
        }
    }
    Lanes<uint32_t, W> recordIndex = missIndex;
    if (any(hit)) {
        enterHits(ray, hit);
        recordIndex = select(hit, instanceSbtOffset(ray) + getSbtGASIndex(ray) * ray.sbtStride + ray.sbtOffset, missIndex);
        if (ray.paths)
            eachLane(hit, [&](int lane) { copyPath(object.paths[lane], paths[lane]); });
    }
    enterHitObject(object, ray, mask, hit, recordIndex, Programs::attributeWords);
}

template <class Programs, int W>
OXRT_INLINE void invoke(LanesThread<W>& thread, Lanes<bool, W> mask, HitObjectLanes<W>& object, typename Programs::Payload& payload,
                        Place place = Place::current()) {
    using Scalar = typename Programs::Scalar;
    const Lanes<bool, W> hits = mask & object.isHit();
    const Lanes<bool, W> misses = mask & object.isMiss();
    makeNopHitObject(object, mask);
    if (none(hits | misses))
        return;
    if (!enterTrace<Scalar>(*thread.thread, ThreadOfAnyLane<W>{thread, hits | misses}, place)) {
        if constexpr (Scalar::depthThrows || Scalar::overflowThrows)
            takeExceptions(thread, hits | misses);
        return;
    }
    if constexpr (Scalar::hasMiss)
        eachScene(object, misses, [&](RayLanes<W>& ray, Lanes<bool, W> own) {
            setPayloadWords<Programs>(ray, payload);
            runMisses<Programs>(ray, own, payload, place);
        });
    if constexpr (Scalar::hasClosestHit)
        eachScene(object, hits & ((object.flags & uint32_t(RAY_DISABLE_CLOSESTHIT)) == 0u), [&](RayLanes<W>& ray, Lanes<bool, W> own) {
            const OxrtLaunch& launch = *thread.thread->launch;
            setPayloadWords<Programs>(ray, payload);
            enterHits(ray, own);
            const Lanes<bool, W> found = findRecords(ray.records, launch, own, launch.hitgroupRecords, launch.hitgroupStride, launch.hitgroupCount,
                                                     object.recordIndex);
            if constexpr (Scalar::isValidated) {
                placeOfTrace() = place;
                fault(thread, own & (object.recordIndex >= launch.hitgroupCount), OXRT_FAULT_HIT_SBT,
                      "the hit object needs a record behind the end of the hit group records", place);
            }
            if (any(found)) {
                ray.active = found;
                Programs::closestHit(ray, found, payload);
            }
        });
    leaveTrace<Scalar>(*thread.thread);
}

/* ---- single lanes -------------------------------------------------------------------------------------------------------------------- */

/* The scalar hit object of one lane. */
template <int W> __attribute__((noinline)) void extractHitObject(HitObject& one, HitObjectLanes<W>& object, int lane) {
    const Lanes<bool, W> own = Lanes<bool, W>::ofBits(1u << lane);
    const auto* root = reinterpret_cast<const OxrtTraversableView*>(object.root[lane]);
    RayLanes<W> ray = raysOf(object, root, object.flags[lane], own);
    const uint32_t state = object.state[lane];
    one.kind = state == object.HIT ? HitObject::Kind::Hit : state == object.MISS ? HitObject::Kind::Miss : HitObject::Kind::Nop;
    one.recordIndex = object.recordIndex[lane];
    scalarRay(one.ray, ray, nullptr, lane);
    one.ray.t = object.t[lane];
    if (state != object.HIT)
        return;
    scalarHit(one.ray, ray, lane);
    for (int i = 0; i < 8; ++i)
        one.ray.committedAttributes[i] = object.attributes[i][lane];
    one.ray.attributes = one.ray.committedAttributes;
}

/* Makes the object of one lane that of a scalar program. */
template <int W> __attribute__((noinline)) void insertHitObject(HitObjectLanes<W>& object, const HitObject& one, int lane) {
    const Lanes<bool, W> own = Lanes<bool, W>::ofBits(1u << lane);
    const Ray& ray = one.ray;
    object.state.set(lane, hitObjectIsHit(one) ? object.HIT : hitObjectIsMiss(one) ? object.MISS : object.NOP);
    if (hitObjectIsNop(one))
        return;
    auto& packet = object.packet;
    const float3 vectors[] = {ray.origin, ray.direction};
    float* places[] = {packet.ray.org_x, packet.ray.org_y, packet.ray.org_z, packet.ray.dir_x, packet.ray.dir_y, packet.ray.dir_z};
    for (int i = 0; i < 6; ++i)
        places[i][lane] = vectors[i / 3][i % 3];
    packet.ray.time[lane] = ray.time;
    object.flags.set(lane, ray.flags);
    object.recordIndex.set(lane, one.recordIndex);
    packet.ray.mask[lane] = 0xFF;
    object.tmin.set(lane, ray.tmin);
    object.tmax.set(lane, ray.tmax);
    object.t.set(lane, ray.t);
    if (!hitObjectIsHit(one))
        return;
    object.root.set(lane, reinterpret_cast<uint64_t>(ray.root));
    RayLanes<W> wide = raysOf(object, ray.root, ray.flags, own);
    enterScalarHit<HitsOfAllKinds, 8>(wide, ray, lane);
    object.kind = wide.kind;
    for (int i = 0; i < 8; ++i)
        object.attributes[i] = wide.attributes[i];
    if (ray.path)
        copyPath(object.paths[lane], *ray.path);
}

/* f(scalar hit object, lane) in the masked lanes; the results as lanes, zero elsewhere. */
template <int W, class F> auto mapHitObjects(HitObjectLanes<W>& object, Lanes<bool, W> mask, F f) {
    HitObject one(*object.thread->thread);
    using R = PlainType<decltype(f(static_cast<const HitObject&>(one), 0))>;
    Wide<R, W> result = spread<W>(R{});
    eachLane(mask, [&](int lane) {
        extractHitObject(one, object, lane);
        insertLane(result, f(static_cast<const HitObject&>(one), lane), lane);
    });
    return result;
}
/* f(scalar hit object, lane) makes the objects of the masked lanes. */
template <int W, class F> void makeHitObjects(HitObjectLanes<W>& object, Lanes<bool, W> mask, F f) {
    eachLane(mask, [&](int lane) {
        HitObject one(object.thread->atLane(lane));
        f(one, lane);
        insertHitObject(object, one, lane);
    });
}

/* ---- getters --------------------------------------------------------------------------------------------------------------------------- */

/* Of a hit or a miss: `value` where the object is no nop, zero elsewhere. */
template <int W, class T> OXRT_INLINE T unlessNop(const HitObjectLanes<W>& object, const T& value) {
    T result = {};
    assign(object.state != uint32_t(object.NOP), result, value);
    return result;
}
template <int W> OXRT_INLINE Wide<float3, W> hitObjectGetWorldRayOrigin(HitObjectLanes<W>& object, Lanes<bool, W>) {
    return unlessNop(object, getWorldRayOrigin(RayLanes<W>(object.packet)));
}
template <int W> OXRT_INLINE Wide<float3, W> hitObjectGetWorldRayDirection(HitObjectLanes<W>& object, Lanes<bool, W>) {
    return unlessNop(object, getWorldRayDirection(RayLanes<W>(object.packet)));
}
template <int W> OXRT_INLINE Lanes<float, W> hitObjectGetRayTmin(HitObjectLanes<W>& object, Lanes<bool, W>) {
    return unlessNop(object, object.tmin);
}
template <int W> OXRT_INLINE Lanes<float, W> hitObjectGetRayTmax(HitObjectLanes<W>& object, Lanes<bool, W>) {
    return unlessNop(object, object.t);
}
template <int W> OXRT_INLINE Lanes<float, W> hitObjectGetRayTime(HitObjectLanes<W>& object, Lanes<bool, W>) {
    return unlessNop(object, packetLanes<W>(object.packet.ray.time));
}
template <int W> OXRT_INLINE Lanes<uint32_t, W> hitObjectGetRayFlags(HitObjectLanes<W>& object, Lanes<bool, W>) {
    return unlessNop(object, object.flags);
}
template <int W> OXRT_INLINE Lanes<uint32_t, W> hitObjectGetSbtRecordIndex(HitObjectLanes<W>& object, Lanes<bool, W>) {
    return unlessNop(object, object.recordIndex);
}
template <int W> OXRT_INLINE Lanes<uint32_t, W> hitObjectGetClusterId(HitObjectLanes<W>&, Lanes<bool, W>) { return ~0u; }

/* What a getter of rays gives for the masked hits, `otherwise` elsewhere. Functions of their own: few programs ask the same thing often. */
template <int W, class T, class F> OXRT_INLINE T ofHits(HitObjectLanes<W>& object, Lanes<bool, W> mask, T otherwise, F getter) {
    eachScene(object, mask & object.isHit(), [&](RayLanes<W>& ray, Lanes<bool, W> own) {
        enterHits(ray, own);
        assign(own, otherwise, T(getter(ray)));
    });
    return otherwise;
}
#define OXRT_OF_HIT(TYPE, NAME)                                                                                                     \
    template <int W> __attribute__((noinline)) Wide<TYPE, W> hitObjectGet##NAME(HitObjectLanes<W>& object, Lanes<bool, W> mask) {   \
        return ofHits(object, mask, spread<W>(TYPE{}), [](const RayLanes<W>& ray) { return get##NAME(ray); });                      \
    }
OXRT_HIT_GETTERS(OXRT_OF_HIT)
#undef OXRT_OF_HIT

#define OXRT_OF_SINGLE_HIT(TYPE, NAME)                                                                                          \
    template <int W> Wide<TYPE, W> hitObjectGet##NAME(HitObjectLanes<W>& object, Lanes<bool, W> mask) {                         \
        return mapHitObjects(object, mask, [](const HitObject& one, int) { return hitObjectGet##NAME(one); });                  \
    }
OXRT_SINGLE_HIT_GETTERS(OXRT_OF_SINGLE_HIT)
OXRT_OF_SINGLE_HIT(float3x4, ObjectToWorldTransformMatrix)
OXRT_OF_SINGLE_HIT(float3x4, WorldToObjectTransformMatrix)
#undef OXRT_OF_SINGLE_HIT
template <int W> Wide<float3, W> hitObjectGetRibbonNormal(HitObjectLanes<W>& object, Lanes<bool, W> mask, const Wide<float2, W>& parameters) {
    return mapHitObjects(object, mask, [&](const HitObject& one, int lane) { return hitObjectGetRibbonNormal(one, inLane(parameters, lane)); });
}
template <int W> Lanes<uint64_t, W> hitObjectGetTransformListHandle(HitObjectLanes<W>& object, Lanes<bool, W> mask, Wide<uint32_t, W> index) {
    return mapHitObjects(object, mask, [&](const HitObject& one, int lane) { return hitObjectGetTransformListHandle(one, index[lane]); });
}

#define OXRT_LANES_TRANSFORM(NAME)                                                                                                     \
    template <int W, class V>                                                                                                          \
    __attribute__((noinline)) Wide<float3, W> hitObjectTransform##NAME(HitObjectLanes<W>& object, Lanes<bool, W> mask, const V& value) { \
        const Wide<float3, W> wide(value);                                                                                             \
        return ofHits(object, mask, wide, [&](const RayLanes<W>& ray) { return transform##NAME(ray, wide); });                         \
    }
OXRT_HIT_TRANSFORMS(OXRT_LANES_TRANSFORM)
#undef OXRT_LANES_TRANSFORM

/* The data of the records that invoke would use; zero where there is none. */
template <class Record, int W> OXRT_INLINE Wide<Record, W> hitObjectGetSbtData(HitObjectLanes<W>& object, Lanes<bool, W> mask) {
    const OxrtLaunch& launch = *object.thread->thread->launch;
    Wide<Record, W> result = spread<W>(Record{});
    const auto load = [&](Lanes<bool, W> lanes, const uint8_t* section, uint32_t stride, uint32_t count) {
        if (none(lanes))
            return;
        RecordLanes<W> records;
        const Lanes<bool, W> found = findRecords(records, launch, lanes, section, stride, count, object.recordIndex);
        if (any(found))
            assign(found, result, loadRecord<Record>(records, found));
    };
    load(mask & object.isHit(), launch.hitgroupRecords, launch.hitgroupStride, launch.hitgroupCount);
    load(mask & object.isMiss(), launch.missRecords, launch.missStride, launch.missCount);
    return result;
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
