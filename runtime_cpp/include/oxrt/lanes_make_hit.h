/* Hit objects that programs take apart and make, W at a time: device_make_hit.h for packets.
 *
 * Lanes with one handle and one word of flags are made together; below graphs that kernels walk through themselves, each on its own.
 */
#ifndef OXRT_LANES_MAKE_HIT_H
#define OXRT_LANES_MAKE_HIT_H

#include <oxrt/lanes_hit_object.h>

namespace oxrt {
inline namespace OXRT_ISA {

template <int W> __attribute__((noinline)) Wide<TraverseData, W> hitObjectGetTraverseData(HitObjectLanes<W>& object, Lanes<bool, W> mask) {
    Wide<TraverseData, W> data = spread<W>(TraverseData{});
    eachScene(object, mask & object.isHit(), [&](RayLanes<W>& ray, Lanes<bool, W> own) {
        const auto put = [&](int64_t offset, Lanes<uint32_t, W> word) { data.items[offset / 4] = select(own, word, data.items[offset / 4]); };
        const auto putNumber = [&](int64_t offset, Lanes<float, W> number) { put(offset, floatAsUint(number)); };
        if (ray.paths) {
            assign(own, data, mapHitObjects(object, own, [](const HitObject& one, int) { return hitObjectGetTraverseData(one); }));
            return;
        }
        enterHits(ray, own);
        const auto& hit = ray.packet.hit;
        put(OXRT_FIELD_OFFSET(TraverseWords, isHit), 1u);
        put(OXRT_FIELD_OFFSET(TraverseWords, geometry), packetLanes<W>(hit.geomID));
        put(OXRT_FIELD_OFFSET(TraverseWords, primitive), packetLanes<W>(hit.primID));
        put(OXRT_FIELD_OFFSET(TraverseWords, instance), getInstanceIndex(ray));
        put(OXRT_FIELD_OFFSET(TraverseWords, recordIndex), object.recordIndex);
        put(OXRT_FIELD_OFFSET(TraverseWords, kind), getHitKind(ray));
        putNumber(OXRT_FIELD_OFFSET(TraverseWords, t), ray.t);
        putNumber(OXRT_FIELD_OFFSET(TraverseWords, u), packetLanes<W>(hit.u));
        putNumber(OXRT_FIELD_OFFSET(TraverseWords, v), packetLanes<W>(hit.v));
        putNumber(OXRT_FIELD_OFFSET(TraverseWords, normal), packetLanes<W>(hit.Ng_x));
        putNumber(OXRT_FIELD_OFFSET(TraverseWords, normal) + 4, packetLanes<W>(hit.Ng_y));
        putNumber(OXRT_FIELD_OFFSET(TraverseWords, normal) + 8, packetLanes<W>(hit.Ng_z));
        if (ray.root->needs & OXRT_SCENE_HAS_CUSTOM) {
            own &= geometryType(ray) == uint32_t(OXRT_PRIMITIVE_CUSTOM);
            for (int i = 0; i < 8; ++i)
                put(OXRT_FIELD_OFFSET(TraverseWords, attributes) + 4 * i, ray.attributes[i]);
        }
    });
    return data;
}

/* What makers are told of the ray. */
template <int W> struct ToldRay {
    Lanes<uint64_t, W> handle;
    Wide<float3, W> origin, direction;
    Lanes<float, W> tmin, time;
    Lanes<uint32_t, W> flags;
};

/* together(ray, lanes) for the lanes of each scene and word of flags, whose ray is entered; apart(scalar object, lane) below graphs. */
template <int W, class Together, class Apart>
OXRT_INLINE void makeByScene(HitObjectLanes<W>& object, Lanes<bool, W> mask, const ToldRay<W>& told, Together together, Apart apart) {
    while (any(mask)) {
        const int lane = firstLane(mask);
        const uint64_t handle = told.handle[lane];
        const uint32_t flags = told.flags[lane];
        const Lanes<bool, W> own = mask & (told.handle == handle) & (told.flags == flags);
        mask = without(mask, own);
        const OxrtTraversableView* root = findTraversable(*object.thread->thread->launch, handle);
        if (root && isGraph(*root)) {
            makeHitObjects(object, own, apart);
            continue;
        }
        typename Packet<W>::RayHit packet;
        RayLanes<W> ray(packet);
        ray.thread = object.thread;
        ray.payload = nullptr;
        ray.root = root;
        setPacket(packet.ray.org_x, told.origin.x);
        setPacket(packet.ray.org_y, told.origin.y);
        setPacket(packet.ray.org_z, told.origin.z);
        setPacket(packet.ray.dir_x, told.direction.x);
        setPacket(packet.ray.dir_y, told.direction.y);
        setPacket(packet.ray.dir_z, told.direction.z);
        setPacket(packet.ray.time, told.time);
        setPacket<W>(packet.ray.mask, 0xFFu);
        ray.tmin = told.tmin;
        ray.flags = flags & 0xFFFF;
        ray.sbtOffset = ray.missIndex = 0u;
        ray.sbtStride = 1u;
        ray.commonInstance = nullptr;
        ray.commonGeometry = nullptr;
        together(ray, own);
    }
}

/* ---- the way to the hit -------------------------------------------------------------------------------------------------------------- */

/* The GAS of each lane, and the lanes that have one. `common`: the one of all of them, null if they differ. */
template <int W> struct HolderLanes {
    Lanes<bool, W> found;
    const OxrtTraversableView* common;
    Lanes<uint64_t, W> geometries;
    Lanes<uint32_t, W> geometryCount;

    /* A 4-byte field of the build input of each lane. */
    OXRT_INLINE Lanes<uint32_t, W> field(Lanes<uint32_t, W> geometry, int64_t offset, Lanes<bool, W> mask) const {
        if (common)
            return gather<uint32_t, W>(placesIn<OxrtGeometry, W>(common->geometries, geometry), offset, mask);
        const AddressPlaces<W> places{geometries + convert<uint64_t>(geometry) * uint64_t(sizeof(OxrtGeometry))};
        return gather<uint32_t, W>(places, offset, mask);
    }
};
/* The GAS below an instance, null if there is none. */
OXRT_INLINE const OxrtTraversableView* holderBelow(const OxrtTraversableView& ias, uint32_t instance) {
    return instance < ias.instanceCount ? ias.instances[instance].child : nullptr;
}
template <int W> OXRT_INLINE HolderLanes<W> holdersOf(RayLanes<W>& ray, Lanes<bool, W> mask, Lanes<uint32_t, W> instance) {
    HolderLanes<W> holders = {};
    const OxrtTraversableView* root = ray.root;
    setPacket<W>(ray.packet.hit.instID[0], RTC_INVALID_GEOMETRY_ID);
    if (none(mask) || !root || (root->type != OXRT_TRAVERSABLE_GAS && root->type != OXRT_TRAVERSABLE_IAS))
        return holders;
    const uint32_t first = instance[firstLane(mask)];
    holders.common = root;
    if (root->type == OXRT_TRAVERSABLE_IAS) {
        setPacket(ray.packet.hit.instID[0], instance);
        holders.common = none(mask & (instance != first)) ? holderBelow(*root, first) : nullptr;
        if (!holders.common) {
            mask &= instance < root->instanceCount;
            const WordPlaces<W> instances = placesIn<OxrtInstanceView, W>(root->instances, instance);
            const AddressPlaces<W> views{gather<uint64_t, W>(instances, OXRT_FIELD_OFFSET(OxrtInstanceView, child), mask)};
            mask &= views.addresses != uint64_t(0);
            holders.found = mask;
            holders.geometries = gather<uint64_t, W>(views, OXRT_FIELD_OFFSET(OxrtTraversableView, geometries), mask);
            holders.geometryCount = gather<uint32_t, W>(views, OXRT_FIELD_OFFSET(OxrtTraversableView, geometryCount), mask);
            return holders;
        }
    }
    holders.found = mask;
    holders.geometryCount = holders.common->geometryCount;
    return holders;
}

/* The build input of each lane's hit that holds an SBT GAS index, ~0 where there is none. */
template <int W> OXRT_INLINE Lanes<uint32_t, W> geometriesOfRecords(const HolderLanes<W>& holders, Lanes<uint32_t, W> sbtGasIndex) {
    Lanes<uint32_t, W> result = ~0u;
    Lanes<bool, W> open = holders.found;
    for (uint32_t i = 0;; ++i) {
        open &= holders.geometryCount > i;
        if (none(open))
            return result;
        const Lanes<uint32_t, W> behindFirst = sbtGasIndex - holders.field(i, OXRT_FIELD_OFFSET(OxrtGeometry, recordBase), open);
        const Lanes<bool, W> own = open & (behindFirst < holders.field(i, OXRT_FIELD_OFFSET(OxrtGeometry, recordCount), open));
        result = select(own, i, result);
        open = without(open, own);
    }
}

/* Which side of a triangle was hit is told, not computed: where the normal says otherwise, one that agrees. */
template <int W>
OXRT_INLINE Wide<float3, W> turnedTowards(const RayLanes<W>& ray, Lanes<bool, W> mask, Wide<float3, W> normal, Lanes<uint32_t, W> hitKind) {
    const Wide<float3, W> direction = transformVectorFromWorldToObjectSpace(ray, getWorldRayDirection(ray));
    Lanes<bool, W> wrong = mask & (triangleKind(ray, normal, direction) != hitKind);
    if (none(wrong))
        return normal;
    normal = select(wrong, direction, normal);
    wrong &= triangleKind(ray, normal, direction) != hitKind;
    return select(wrong, -normal, normal);
}

/* Enters the hits: `there`, those of the lanes `own` that exist, with the build input and the index there of each one's primitive. */
template <int W>
OXRT_INLINE void enterMade(HitObjectLanes<W>& object, RayLanes<W>& ray, Lanes<bool, W> own, Lanes<bool, W> there,
                           Lanes<uint32_t, W> geometry, Lanes<uint32_t, W> primitive, const Wide<float3, W>* toldNormal, Lanes<uint32_t, W> recordIndex,
                           Place place) {
    auto& hit = ray.packet.hit;
    setPacket(hit.geomID, geometry);
    setPacket(hit.primID, primitive);
    makeNopHitObject(object, own);
    if (any(there)) {
        enterHits(ray, there);
        Lanes<bool, W> triangles = there;
        if (ray.root->needs & (OXRT_SCENE_HAS_CUSTOM | OXRT_SCENE_HAS_CURVES | OXRT_SCENE_HAS_SPHERES))
            triangles &= geometryType(ray) == uint32_t(OXRT_PRIMITIVE_TRIANGLE);
        Wide<float3, W> normal = float3(0.0f);
        if (toldNormal)
            normal = *toldNormal;
        else if (any(triangles)) {
            const Wide<TriangleVertices, W> corners = getTriangleVertexData(ray);
            const Wide<float3, W> across = cross(get<1>(corners) - get<0>(corners), get<2>(corners) - get<0>(corners));
            normal = select(triangles, across, normal);
        }
        normal = turnedTowards(ray, triangles, normal, ray.kind);
        setPacket(hit.Ng_x, normal.x);
        setPacket(hit.Ng_y, normal.y);
        setPacket(hit.Ng_z, normal.z);
        enterHitObject(object, ray, there, there, recordIndex, 8);
    }
    if (object.thread->thread->launch->validation)
        fault(*object.thread, without(own, there), OXRT_FAULT_DATA_ACCESS, NO_SUCH_HIT, place);
}

/* ---- making ---------------------------------------------------------------------------------------------------------------------------- */

template <int W, int SIZE>
__attribute__((noinline)) void makeHitObject(HitObjectLanes<W>& object, Lanes<bool, W> mask, Wide<uint64_t, W> handle, const Wide<float3, W>& origin,
                                             const Wide<float3, W>& direction, Wide<float, W> tmin, Wide<float, W> time, Wide<uint32_t, W> flags,
                                             const Wide<TraverseData, W>& data, const FixedArray<Lanes<uint64_t, W>, SIZE>& transforms,
                                             Wide<uint32_t, W> count, Place place = Place::current()) {
    const Lanes<uint32_t, W>* words = data.items;
    const auto word = [words](int64_t offset) { return words[offset / 4]; };
    const auto number = [&word](int64_t offset) { return uintAsFloat(word(offset)); };
    const auto together = [&](RayLanes<W>& ray, Lanes<bool, W> own) {
        const Lanes<bool, W> told = own & (word(OXRT_FIELD_OFFSET(TraverseWords, isHit)) != 0u);
        const HolderLanes<W> holders = holdersOf(ray, told, word(OXRT_FIELD_OFFSET(TraverseWords, instance)));
        const Lanes<uint32_t, W> geometry = word(OXRT_FIELD_OFFSET(TraverseWords, geometry));
        const Lanes<uint32_t, W> primitive = word(OXRT_FIELD_OFFSET(TraverseWords, primitive));
        Lanes<bool, W> there = holders.found & (geometry < holders.geometryCount);
        there &= primitive < holders.field(geometry, OXRT_FIELD_OFFSET(OxrtGeometry, primitiveCount), there);
        ray.t = ray.tmax = number(OXRT_FIELD_OFFSET(TraverseWords, t));
        setPacket(ray.packet.hit.u, number(OXRT_FIELD_OFFSET(TraverseWords, u)));
        setPacket(ray.packet.hit.v, number(OXRT_FIELD_OFFSET(TraverseWords, v)));
        ray.kind = word(OXRT_FIELD_OFFSET(TraverseWords, kind));
        for (int i = 0; i < 8; ++i)
            ray.attributes[i] = word(OXRT_FIELD_OFFSET(TraverseWords, attributes) + 4 * i);
        constexpr int64_t first = OXRT_FIELD_OFFSET(TraverseWords, normal);
        const Wide<float3, W> normal = {number(first), number(first + 4), number(first + 8)};
        enterMade(object, ray, own, there, geometry, primitive, &normal, word(OXRT_FIELD_OFFSET(TraverseWords, recordIndex)), place);
    };
    makeByScene(object, mask, ToldRay<W>{handle, origin, direction, tmin, time, flags}, together, [&](HitObject& one, int lane) {
        makeHitObject(one, handle[lane], inLane(origin, lane), inLane(direction, lane), tmin[lane], time[lane], flags[lane], inLane(data, lane),
                      inLane(transforms, lane), count[lane], place);
    });
}

/* OptiX 8's forms: from numbers, the record by the formula or (WithRecord) by its index. */
template <int W, int SIZE>
__attribute__((noinline)) void makeHitObject(HitObjectLanes<W>& object, Lanes<bool, W> mask, Wide<uint64_t, W> handle, const Wide<float3, W>& origin,
                                             const Wide<float3, W>& direction, Wide<float, W> tmin, Wide<float, W> t, Wide<float, W> time,
                                             Wide<uint32_t, W> sbtOffset, Wide<uint32_t, W> sbtStride, Wide<uint32_t, W> instance,
                                             const FixedArray<Lanes<uint64_t, W>, SIZE>& transforms, Wide<uint32_t, W> count,
                                             Wide<uint32_t, W> sbtGasIndex, Wide<uint32_t, W> primitive, Wide<uint32_t, W> hitKind, Wide<uint32_t, W> a0,
                                             Wide<uint32_t, W> a1, Wide<uint32_t, W> a2, Wide<uint32_t, W> a3, Wide<uint32_t, W> a4,
                                             Wide<uint32_t, W> a5, Wide<uint32_t, W> a6, Wide<uint32_t, W> a7, Place place = Place::current()) {
    const Lanes<uint32_t, W> attributes[8] = {a0, a1, a2, a3, a4, a5, a6, a7};
    const auto together = [&](RayLanes<W>& ray, Lanes<bool, W> own) {
        const HolderLanes<W> holders = holdersOf(ray, own, instance);
        const Lanes<uint32_t, W> geometry = geometriesOfRecords(holders, sbtGasIndex);
        Lanes<bool, W> there = holders.found & (geometry != ~0u);
        const Lanes<uint32_t, W> local = primitive - holders.field(geometry, OXRT_FIELD_OFFSET(OxrtGeometry, primitiveIndexOffset), there);
        there &= local < holders.field(geometry, OXRT_FIELD_OFFSET(OxrtGeometry, primitiveCount), there);
        ray.t = ray.tmax = t;
        setPacket(ray.packet.hit.u, uintAsFloat(a0));
        setPacket(ray.packet.hit.v, uintAsFloat(a1));
        ray.kind = hitKind;
        for (int i = 0; i < 8; ++i)
            ray.attributes[i] = attributes[i];
        ray.active = there;
        Lanes<uint32_t, W> recordIndex = sbtGasIndex * (sbtStride & 15u) + (sbtOffset & 15u);
        if (any(there))
            recordIndex = recordIndex + instanceSbtOffset(ray);
        enterMade(object, ray, own, there, geometry, local, nullptr, recordIndex, place);
    };
    makeByScene(object, mask, ToldRay<W>{handle, origin, direction, tmin, time, 0u}, together, [&](HitObject& one, int lane) {
        makeHitObject(one, handle[lane], inLane(origin, lane), inLane(direction, lane), tmin[lane], t[lane], time[lane], sbtOffset[lane], sbtStride[lane],
                      instance[lane], inLane(transforms, lane), count[lane], sbtGasIndex[lane], primitive[lane], hitKind[lane], a0[lane], a1[lane],
                      a2[lane], a3[lane], a4[lane], a5[lane], a6[lane], a7[lane], place);
    });
}
template <int W>
OXRT_INLINE void makeHitObject(HitObjectLanes<W>& object, Lanes<bool, W> mask, Wide<uint64_t, W> handle, const Wide<float3, W>& origin,
                               const Wide<float3, W>& direction, Wide<float, W> tmin, Wide<float, W> t, Wide<float, W> time, Wide<uint32_t, W> sbtOffset,
                               Wide<uint32_t, W> sbtStride, Wide<uint32_t, W> instance, Wide<uint32_t, W> sbtGasIndex, Wide<uint32_t, W> primitive,
                               Wide<uint32_t, W> hitKind, Wide<uint32_t, W> a0, Wide<uint32_t, W> a1, Wide<uint32_t, W> a2, Wide<uint32_t, W> a3,
                               Wide<uint32_t, W> a4, Wide<uint32_t, W> a5, Wide<uint32_t, W> a6, Wide<uint32_t, W> a7, Place place = Place::current()) {
    const FixedArray<Lanes<uint64_t, W>, 1> noTransforms = {{uint64_t(0)}};
    makeHitObject(object, mask, handle, origin, direction, tmin, t, time, sbtOffset, sbtStride, instance, noTransforms, 0u, sbtGasIndex, primitive,
                  hitKind, a0, a1, a2, a3, a4, a5, a6, a7, place);
}
template <int W, int SIZE>
OXRT_INLINE void makeHitObjectWithRecord(HitObjectLanes<W>& object, Lanes<bool, W> mask, Wide<uint64_t, W> handle, const Wide<float3, W>& origin,
                                         const Wide<float3, W>& direction, Wide<float, W> tmin, Wide<float, W> t, Wide<float, W> time,
                                         Wide<uint32_t, W> recordIndex, Wide<uint32_t, W> instance,
                                         const FixedArray<Lanes<uint64_t, W>, SIZE>& transforms, Wide<uint32_t, W> count, Wide<uint32_t, W> sbtGasIndex,
                                         Wide<uint32_t, W> primitive, Wide<uint32_t, W> hitKind, Wide<uint32_t, W> a0, Wide<uint32_t, W> a1,
                                         Wide<uint32_t, W> a2, Wide<uint32_t, W> a3, Wide<uint32_t, W> a4, Wide<uint32_t, W> a5, Wide<uint32_t, W> a6,
                                         Wide<uint32_t, W> a7, Place place = Place::current()) {
    makeHitObject(object, mask, handle, origin, direction, tmin, t, time, 0u, 0u, instance, transforms, count, sbtGasIndex, primitive, hitKind, a0, a1, a2,
                  a3, a4, a5, a6, a7, place);
    hitObjectSetSbtRecordIndex(object, mask, recordIndex);
}

template <int W>
OXRT_INLINE void makeMissHitObject(HitObjectLanes<W>& object, Lanes<bool, W> mask, Wide<uint32_t, W> missIndex, const Wide<float3, W>& origin,
                                   const Wide<float3, W>& direction, Wide<float, W> tmin, Wide<float, W> tmax, Wide<float, W> time,
                                   Wide<uint32_t, W> flags) {
    const auto take = [mask](auto& to, const auto& from) { setPacket(to, select(mask, from, packetLanes<W>(to))); };
    auto& ray = object.packet.ray;
    take(ray.org_x, origin.x);
    take(ray.org_y, origin.y);
    take(ray.org_z, origin.z);
    take(ray.dir_x, direction.x);
    take(ray.dir_y, direction.y);
    take(ray.dir_z, direction.z);
    take(ray.time, time);
    object.state = select(mask, uint32_t(object.MISS), object.state);
    object.root = select(mask, uint64_t(0), object.root);
    object.flags = select(mask, flags & 0xFFFFu, object.flags);
    object.recordIndex = select(mask, missIndex, object.recordIndex);
    object.tmin = select(mask, tmin, object.tmin);
    object.tmax = select(mask, tmax, object.tmax);
    object.t = select(mask, tmax, object.t);
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
