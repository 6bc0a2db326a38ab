/* Packets of rays through scenes that kernels walk through themselves: device_graph.h for lanes that need no callbacks of programs.
 *
 * All lanes of a packet go down together: the way above a structure is the same for them, only transforms at a time may differ.
 */
#ifndef OXRT_LANES_GRAPH_H
#define OXRT_LANES_GRAPH_H

#include <oxrt/lanes_custom.h>

namespace oxrt {
inline namespace OXRT_ISA {

template <int W> struct GraphPacketWalk {
    RTCRayQueryContext context; /* first: Embree hands its address to the callbacks */
    const OxrtServices* services;
    GraphPath path; /* of all lanes; the direction in it is not used */
    GraphPath* committed;
    Lanes<float, W> time;
    Lanes<uint32_t, W> mask;
    RTCIntersectArguments intersectInstances, intersectPrimitives;
    RTCOccludedArguments occludeInstances, occludePrimitives;
};

/* The parent-to-child matrix of each lane; the lanes that have one. */
template <int W> __attribute__((noinline)) Lanes<bool, W> inversesAt(const OxrtTraversableView& node, Lanes<bool, W> mask, Lanes<float, W> time,
                                                                     MatrixLanes<W>& inverses) {
    Affine inverse = {};
    bool exists = false;
    uint32_t found = 0;
    float last = 0.0f;
    bool isFirst = true;
    eachLane(mask, [&](int lane) {
        if (isFirst || time[lane] != last)
            exists = inverseAt(node, time[lane], inverse);
        if (isFirst)
            for (int i = 0; i < 12; ++i)
                inverses.m[i] = inverse.m[i];
        else
            for (int i = 0; i < 12; ++i)
                inverses.m[i].set(lane, inverse.m[i]);
        last = time[lane];
        isFirst = false;
        found |= uint32_t(exists) << lane;
    });
    return Lanes<bool, W>::ofBits(found);
}

template <int W> OXRT_INLINE Lanes<bool, W> vanished(const OxrtTraversableView& view, Lanes<float, W> time) {
    Lanes<bool, W> gone = false;
    if (view.motionFlags & MOTION_START_VANISH)
        gone |= time < view.timeBegin;
    if (view.motionFlags & MOTION_END_VANISH)
        gone |= time > view.timeEnd;
    return gone;
}

template <int W> OXRT_INLINE Lanes<float, W> relativeTimes(const OxrtTraversableView& view, Lanes<float, W> time) {
    const Lanes<float, W> relative = (time - view.timeBegin) / (view.timeEnd - view.timeBegin);
    return select(relative > 0.0f, select(relative < 1.0f, relative, Lanes<float, W>(1.0f)), Lanes<float, W>(0.0f));
}

/* The hits of the child's packet that are nearer than what the parent's knew. */
template <int W, class Packets> OXRT_INLINE void takeHits(Packets& outer, const Packets& inner, Lanes<bool, W> hit) {
    const auto take = [hit](auto& to, const auto& from) { setPacket(to, select(hit, packetLanes<W>(from), packetLanes<W>(to))); };
    take(outer.ray.tfar, inner.ray.tfar);
    take(outer.hit.Ng_x, inner.hit.Ng_x);
    take(outer.hit.Ng_y, inner.hit.Ng_y);
    take(outer.hit.Ng_z, inner.hit.Ng_z);
    take(outer.hit.u, inner.hit.u);
    take(outer.hit.v, inner.hit.v);
    take(outer.hit.primID, inner.hit.primID);
    take(outer.hit.geomID, inner.hit.geomID);
    take(outer.hit.instID[0], inner.hit.instID[0]);
}

/* Asks Embree about the structure with the packet that was made for it; `outer` is shortened to what was found. */
template <bool ANY, int W, class Outer>
OXRT_INLINE void askStructure(GraphPacketWalk<W>& walk, const OxrtTraversableView& view, Lanes<bool, W> mask, typename Packet<W>::RayHit& query,
                              Outer& outer) {
    const bool isInner = view.type == OXRT_TRAVERSABLE_IAS && !view.hasNativeInstances;
    alignas(4 * W) int valid[W];
    storeLanes<int32_t, W>(valid, select(mask, int32_t(-1), int32_t(0)));
    walk.path.structure = &view;
    if constexpr (ANY) {
        Packet<W>::occluded(*walk.services, valid, view.scene, query, isInner ? &walk.occludeInstances : &walk.occludePrimitives);
        setPacket(outer.tfar, select(mask, packetLanes<W>(query.ray.tfar), packetLanes<W>(outer.tfar)));
    } else {
        setPacket<W>(query.hit.geomID, RTC_INVALID_GEOMETRY_ID);
        setPacket<W>(query.hit.instID[0], RTC_INVALID_GEOMETRY_ID);
        Packet<W>::intersect(*walk.services, valid, view.scene, query, isInner ? &walk.intersectInstances : &walk.intersectPrimitives);
        const Lanes<bool, W> hit = mask & (packetLanes<W>(query.hit.geomID) != RTC_INVALID_GEOMETRY_ID);
        if (none(hit))
            return;
        takeHits<W>(outer, query, hit);
        if (isInner)
            return;
        eachLane(hit, [&](int lane) {
            GraphPath& path = walk.committed[lane];
            copyPath(path, walk.path);
            const uint32_t instance = query.hit.instID[0][lane];
            path.native = instance == RTC_INVALID_GEOMETRY_ID ? nullptr : view.instances + instance;
            path.direction = {query.ray.dir_x[lane], query.ray.dir_y[lane], query.ray.dir_z[lane]};
        });
    }
}

/* Goes through transforms to the next structure and asks it. The rays are given in the space of `view`'s parent. */
template <class Programs, bool ANY, int W, class Outer, class PacketRay>
OXRT_INLINE void descend(GraphPacketWalk<W>& walk, const OxrtTraversableView* view, Lanes<bool, W> mask, Wide<float3, W> origin,
                         Wide<float3, W> direction, const PacketRay& parent, Outer& outer) {
    for (; view->child; view = view->child) {
        if constexpr (Programs::usesTime) {
            if (view->type != OXRT_TRAVERSABLE_STATIC)
                mask = without(mask, vanished(*view, walk.time));
            MatrixLanes<W> inverses;
            mask &= inversesAt(*view, mask, walk.time, inverses);
            if (none(mask))
                return;
            origin = pointThrough(inverses.m, origin);
            direction = vectorThrough(inverses.m, direction);
        } else {
            if (view->type != OXRT_TRAVERSABLE_STATIC)
                return;
            origin = pointThrough(view->transformKeys + 12, origin);
            direction = vectorThrough(view->transformKeys + 12, direction);
        }
        walk.path.nodes[walk.path.size++] = view;
    }
    const bool moves = view->keyCount > 1;
    if (moves)
        mask = without(mask, vanished(*view, walk.time));
    if (!view->scene || none(mask))
        return;
    typename Packet<W>::RayHit query;
    auto& ray = query.ray;
    setPacket(ray.org_x, origin.x);
    setPacket(ray.org_y, origin.y);
    setPacket(ray.org_z, origin.z);
    setPacket(ray.dir_x, direction.x);
    setPacket(ray.dir_y, direction.y);
    setPacket(ray.dir_z, direction.z);
    setPacket(ray.time, moves ? relativeTimes(*view, walk.time) : Lanes<float, W>(0.0f));
    __builtin_memcpy(ray.tnear, parent.tnear, sizeof(ray.tnear));
    __builtin_memcpy(ray.tfar, parent.tfar, sizeof(ray.tfar));
    __builtin_memcpy(ray.mask, parent.mask, sizeof(ray.mask));
    setPacket<W>(ray.flags, 0u);
    askStructure<ANY>(walk, *view, mask, query, outer);
}

/* One instance of the IAS that Embree is asked about: down into its child with the lanes that meet its box, and back. */
template <class Programs, bool ANY, int W, class Outer, class PacketRay>
OXRT_INLINE void enterInstance(GraphPacketWalk<W>& walk, uint32_t index, Lanes<bool, W> mask, const PacketRay& parent, Outer& outer) {
    const OxrtTraversableView& structure = *walk.path.structure;
    const OxrtInstanceView& instance = structure.instances[index];
    mask &= (walk.mask & instance.visibilityMask) != 0u;
    if (none(mask) || !instance.child || !instance.child->scene)
        return;
    const Wide<float3, W> worldDirection = {packetLanes<W>(parent.dir_x), packetLanes<W>(parent.dir_y), packetLanes<W>(parent.dir_z)};
    const Wide<float3, W> worldOrigin = {packetLanes<W>(parent.org_x), packetLanes<W>(parent.org_y), packetLanes<W>(parent.org_z)};
    if (structure.instanceBoxes) {
        mask &= meetingBox<W>(worldOrigin, inverseOf(worldDirection), structure.instanceBoxes + 6 * uint64_t(index),
                              packetLanes<W>(parent.tnear), packetLanes<W>(parent.tfar));
        if (none(mask))
            return;
    }
    const float* m = instance.worldToObject;
    const Wide<float3, W> direction = vectorThrough(m, worldDirection);
    mask = without(mask, (direction.x == 0.0f) & (direction.y == 0.0f) & (direction.z == 0.0f));
    GraphPath& path = walk.path;
    const OxrtInstanceView* outerInstance = path.instance;
    const uint32_t outerIndex = path.instanceIndex;
    const uint32_t outerSize = path.size;
    path.nodes[path.size++] = structure.instanceTraversables + index;
    path.instance = &instance;
    path.instanceIndex = index;
    path.sbtOffset += instance.sbtOffset;
    descend<Programs, ANY>(walk, instance.child, mask, pointThrough(m, worldOrigin), direction, parent, outer);
    path.structure = &structure;
    path.instance = outerInstance;
    path.instanceIndex = outerIndex;
    path.size = outerSize;
    path.sbtOffset -= instance.sbtOffset;
}
template <class Programs, int W> void intersectInstances(const RTCIntersectFunctionNArguments* arguments) {
    auto& rayhit = *static_cast<typename Packet<W>::RayHit*>(arguments->rayhit);
    enterInstance<Programs, false, W>(*reinterpret_cast<GraphPacketWalk<W>*>(arguments->context), arguments->primID,
                                      loadValid<W>(arguments->valid), rayhit.ray, rayhit);
}
template <class Programs, int W> void occludeInstances(const RTCOccludedFunctionNArguments* arguments) {
    auto& ray = *static_cast<decltype(Packet<W>::RayHit::ray)*>(arguments->ray);
    enterInstance<Programs, true, W>(*reinterpret_cast<GraphPacketWalk<W>*>(arguments->context), arguments->primID,
                                     loadValid<W>(arguments->valid), ray, ray);
}

/* The masked lanes as packets without callbacks of programs; the lanes that hit something, their ways in ray.paths. */
template <class Programs, bool ANY, int W>
__attribute__((noinline)) Lanes<bool, W> traverseGraphPacket(RayLanes<W>& ray, Lanes<bool, W> mask, bool isCoherent) {
    const unsigned flags = isCoherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    GraphPacketWalk<W> walk;
    walk.context = {{RTC_INVALID_GEOMETRY_ID}, {RTC_INVALID_GEOMETRY_ID}};
    walk.services = ray.thread->thread->launch->services;
    walk.path.native = nullptr;
    walk.path.instance = nullptr;
    walk.path.instanceIndex = 0;
    walk.path.sbtOffset = 0;
    walk.path.size = 0;
    walk.committed = ray.paths;
    walk.time = packetLanes<W>(ray.packet.ray.time);
    walk.mask = packetLanes<W>(ray.packet.ray.mask);
    const Wide<float3, W> origin = getWorldRayOrigin(ray);
    const Wide<float3, W> direction = getWorldRayDirection(ray);
    if constexpr (ANY) {
        walk.occludePrimitives = {flags, RTC_FEATURE_FLAG_ALL, &walk.context, nullptr, nullptr, 0.0f};
        walk.occludeInstances = walk.occludePrimitives;
        walk.occludeInstances.occluded = occludeInstances<Programs, W>;
        descend<Programs, true>(walk, ray.root, mask, origin, direction, ray.packet.ray, ray.packet.ray);
        return mask & (packetLanes<W>(ray.packet.ray.tfar) < 0.0f);
    } else {
        walk.intersectPrimitives = {flags, RTC_FEATURE_FLAG_ALL, &walk.context, nullptr, nullptr, 0.0f};
        walk.intersectInstances = walk.intersectPrimitives;
        walk.intersectInstances.intersect = intersectInstances<Programs, W>;
        setPacket<W>(ray.packet.hit.geomID, RTC_INVALID_GEOMETRY_ID);
        setPacket<W>(ray.packet.hit.instID[0], RTC_INVALID_GEOMETRY_ID);
        descend<Programs, false>(walk, ray.root, mask, origin, direction, ray.packet.ray, ray.packet.whole());
        ray.t = packetLanes<W>(ray.packet.ray.tfar);
        return mask & (packetLanes<W>(ray.packet.hit.geomID) != RTC_INVALID_GEOMETRY_ID);
    }
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
