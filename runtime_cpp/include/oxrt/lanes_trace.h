/* Tracing W rays at once: the query, the records of the hits, the dispatch of programs; and the blocks of a launch.
 *
 * `Programs` is what the pipeline emits for each payload class: masked programs over lanes, and as `Scalar` the scalar Programs of
 * device_trace.h. Rays go to Embree as packets, COHERENT where they start at one point in about one direction, with any-hit and
 * intersection programs over lanes as callbacks. Divergent rays with any-hit programs on triangles are traced one by one with the scalar
 * programs: candidates come in another order for each lane, and packets with rejecting filters are slower (measured: README).
 */
#ifndef OXRT_LANES_TRACE_H
#define OXRT_LANES_TRACE_H

#include <oxrt/lanes_graph.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* ---- queries ------------------------------------------------------------------------------------------------------------------ */

/* Whether to trace the active rays together: at least half the lanes, all directions within 60 degrees of the first ray's, all origins
   within a quarter of its length. Measured on ambient occlusion, in strata (a quarter faster) and without (no slower), and on path tracing
   (no slower); the angle alone or the origins alone make some of them slower by half. */
template <int W>
OXRT_INLINE bool areCoherent(Lanes<bool, W> mask, const Wide<float3, W>& origin, const Wide<float3, W>& direction, Lanes<float, W> tmax) {
    if (__builtin_popcount(mask.bits()) < W / 2)
        return false;
    const int lane = firstLane(mask);
    const Wide<float3, W> apart = origin - float3(origin.x[lane], origin.y[lane], origin.z[lane]);
    const float3 first(direction.x[lane], direction.y[lane], direction.z[lane]);
    const float reach = 0.25f * tmax[lane];
    const float length2 = dot(first, first);
    const Lanes<float, W> cosine = dot(direction, first);
    const Lanes<bool, W> isNear = dot(apart, apart) <= reach * reach * length2;
    return none(mask & !(isNear & (cosine * abs(cosine) > dot(direction, direction) * (0.25f * length2))));
}

/* Programs compute in lanes without a hit as well. What lay in memory would often be denormal numbers there, and each operation on one
   costs more than the rest of a short program. */
template <int W> OXRT_INLINE void clearHit(RayLanes<W>& ray) {
    setPacket(ray.packet.hit.u, Lanes<float, W>(0.0f));
    setPacket(ray.packet.hit.v, Lanes<float, W>(0.0f));
}

/* The masked lanes as one packet without callbacks; the lanes that hit something. */
template <class Flags, bool ANY, int W> OXRT_INLINE Lanes<bool, W> traversePacket(RayLanes<W>& ray, Lanes<bool, W> mask, bool isCoherent) {
    alignas(4 * W) int valid[W];
    storeLanes<int32_t, W>(valid, select(mask, int32_t(-1), int32_t(0)));
    const OxrtServices& services = *ray.thread->thread->launch->services;
    const unsigned flags = isCoherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    if constexpr (ANY) {
        RTCOccludedArguments arguments = {flags, RTC_FEATURE_FLAG_ALL, nullptr, nullptr, nullptr, 0.0f};
        Packet<W>::occluded(services, valid, ray.root->scene, ray.packet, &arguments);
        return mask & (packetLanes<W>(ray.packet.ray.tfar) < 0.0f);
    } else {
        RTCIntersectArguments arguments = {flags, RTC_FEATURE_FLAG_ALL, nullptr, nullptr, nullptr, 0.0f};
        setPacket<W>(ray.packet.hit.geomID, RTC_INVALID_GEOMETRY_ID);
        setPacket<W>(ray.packet.hit.instID[0], RTC_INVALID_GEOMETRY_ID);
        clearHit(ray);
        Packet<W>::intersect(services, valid, ray.root->scene, ray.packet, &arguments);
        ray.t = packetLanes<W>(ray.packet.ray.tfar);
        return mask & (packetLanes<W>(ray.packet.hit.geomID) != RTC_INVALID_GEOMETRY_ID);
    }
}

/* Prepares the candidates of a trace with callbacks: the world's rays, and nothing found yet. */
template <int W> OXRT_INLINE void beginCandidates(CandidateLanes<W>& candidates, const RayLanes<W>& ray, void* payload, bool isCoherent) {
    candidates.thread = ray.thread;
    candidates.payload = payload;
    candidates.readWord = ray.readWord;
    candidates.writeWord = ray.writeWord;
    candidates.root = ray.root;
    candidates.tmin = ray.tmin;
    candidates.tmax = ray.tmax;
    candidates.mask = ray.mask;
    candidates.sbtOffset = ray.sbtOffset;
    candidates.sbtStride = ray.sbtStride;
    candidates.flags = ray.flags;
    candidates.ended = false;
    candidates.isTerminated = false;
    candidates.common.thread = ray.thread->thread;
    candidates.common.root = ray.root;
    candidates.common.path = nullptr;
    const Lanes<bool, W> differ = (ray.sbtOffset != ray.sbtOffset[0]) | (ray.sbtStride != ray.sbtStride[0]);
    candidates.hasCommonRecord = none(differ);
    candidates.isCoherent = isCoherent;
    if (isCoherent)
        candidates.inverseDirection = inverseOf(getWorldRayDirection(ray));
    candidates.closest = ray.tmax;
    candidates.closestInEmbree = packetLanes<W>(ray.packet.ray.tfar);
    candidates.committedKind = NO_REPORT;
    for (int i = 0; i < 8; ++i)
        candidates.committedAttributes[i] = 0u;
    auto& world = candidates.packet.ray;
    const auto& own = ray.packet.ray;
    __builtin_memcpy(world.org_x, own.org_x, sizeof(own.org_x));
    __builtin_memcpy(world.org_y, own.org_y, sizeof(own.org_y));
    __builtin_memcpy(world.org_z, own.org_z, sizeof(own.org_z));
    __builtin_memcpy(world.dir_x, own.dir_x, sizeof(own.dir_x));
    __builtin_memcpy(world.dir_y, own.dir_y, sizeof(own.dir_y));
    __builtin_memcpy(world.dir_z, own.dir_z, sizeof(own.dir_z));
    __builtin_memcpy(world.time, own.time, sizeof(own.time));
}

/* Embree drops lanes whose interval is empty or one number before it calls back; reports may be accepted in one number. */
template <int W> OXRT_INLINE void openEmptyIntervals(CandidateLanes<W>& candidates, typename CandidateLanes<W>::PacketRay& packet) {
    const Lanes<bool, W> isEmpty = packetLanes<W>(packet.tnear) >= packetLanes<W>(packet.tfar);
    setPacket(packet.tnear, select(isEmpty, candidates.tmin, packetLanes<W>(packet.tnear)));
    setPacket(packet.tfar, select(isEmpty, nextUp(candidates.tmax), packetLanes<W>(packet.tfar)));
    candidates.closestInEmbree = packetLanes<W>(packet.tfar);
}

/* The masked lanes as one packet whose candidates the programs judge; the lanes that hit something. */
template <class Programs, class Flags, bool ANY, int W>
OXRT_INLINE Lanes<bool, W> traverseCandidates(RayLanes<W>& ray, Lanes<bool, W> mask, void* payload, bool isCoherent) {
    using Scalar = typename Programs::Scalar;
    using Known = FlagTraits<Flags>;
    typename Packet<W>::RayHit worlds;
    CandidateLanes<W> candidates(worlds);
    beginCandidates(candidates, ray, payload, isCoherent);
    QueryLanes<W> query = {{{RTC_INVALID_GEOMETRY_ID}, {RTC_INVALID_GEOMETRY_ID}}, &candidates};
    alignas(4 * W) int valid[W];
    storeLanes<int32_t, W>(valid, select(mask, int32_t(-1), int32_t(0)));
    const OxrtServices& services = *ray.thread->thread->launch->services;
    unsigned flags = isCoherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    RTCFilterFunctionN filter = nullptr;
    if constexpr (mayHaveCandidates<Scalar, Flags>) {
        if (mayFilter<Scalar>(ray.flags, *ray.root))
            filter = filterCandidates<Programs, Known::mayCull, W>;
        if (filtersEverything<Scalar>(ray.flags, *ray.root))
            flags |= RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
    }
    auto& packet = ray.packet;
    if constexpr (Scalar::hasIntersection)
        openEmptyIntervals(candidates, packet.ray);
    if constexpr (ANY) {
        RTCOccludedArguments arguments = {flags, RTC_FEATURE_FLAG_ALL, &query.context, filter, nullptr, 0.0f};
        if constexpr (Scalar::hasIntersection)
            arguments.occluded = occludeCustoms<Programs, W>;
        Packet<W>::occluded(services, valid, ray.root->scene, packet, &arguments);
        return mask & (candidates.isTerminated | (packetLanes<W>(packet.ray.tfar) < 0.0f));
    } else {
        RTCIntersectArguments arguments = {flags, RTC_FEATURE_FLAG_ALL, &query.context, filter, nullptr, 0.0f};
        if constexpr (Scalar::hasIntersection)
            arguments.intersect = intersectCustoms<Programs, W>;
        setPacket<W>(packet.hit.geomID, RTC_INVALID_GEOMETRY_ID);
        setPacket<W>(packet.hit.instID[0], RTC_INVALID_GEOMETRY_ID);
        clearHit(ray);
        Packet<W>::intersect(services, valid, ray.root->scene, packet, &arguments);
        const Lanes<float, W> tfar = packetLanes<W>(packet.ray.tfar);
        Lanes<bool, W> isOwn = candidates.isTerminated;
        if constexpr (Scalar::hasIntersection) {
            isOwn |= (tfar == candidates.closestInEmbree) & (candidates.committedKind != NO_REPORT);
            ray.kind = candidates.committedKind;
            for (int i = 0; i < 8; ++i)
                ray.attributes[i] = candidates.committedAttributes[i];
        }
        ray.t = select(isOwn, candidates.closest, tfar);
        return mask & (packetLanes<W>(packet.hit.geomID) != RTC_INVALID_GEOMETRY_ID);
    }
}

/* One lane's ray for the scalar query. */
template <int W> OXRT_INLINE void scalarRay(Ray& one, const RayLanes<W>& ray, void* payload, int lane) {
    const auto& packet = ray.packet.ray;
    one.thread = &ray.thread->atLane(lane);
    one.payload = payload;
    one.root = ray.root;
    one.path = nullptr;
    one.origin = {packet.org_x[lane], packet.org_y[lane], packet.org_z[lane]};
    one.direction = {packet.dir_x[lane], packet.dir_y[lane], packet.dir_z[lane]};
    one.tmin = ray.tmin[lane];
    one.tmax = ray.tmax[lane];
    one.time = packet.time[lane];
    one.mask = ray.mask[lane];
    one.flags = ray.flags;
    one.sbtOffset = ray.sbtOffset[lane];
    one.sbtStride = ray.sbtStride[lane];
    one.missIndex = ray.missIndex[lane];
}

/* Enters the closest hit of one lane. */
template <class Scalar, int W> OXRT_INLINE void enterScalarHit(RayLanes<W>& ray, const Ray& one, int lane) {
    auto& hit = ray.packet.hit;
    hit.Ng_x[lane] = one.normal.x;
    hit.Ng_y[lane] = one.normal.y;
    hit.Ng_z[lane] = one.normal.z;
    hit.u[lane] = one.u;
    hit.v[lane] = one.v;
    hit.primID[lane] = one.primitive;
    hit.geomID[lane] = unsigned(one.geometry - holderOf(one).geometries);
    const bool isNative = one.path ? one.path->native != nullptr : one.instance != nullptr;
    hit.instID[0][lane] = isNative ? getInstanceIndex(one) : RTC_INVALID_GEOMETRY_ID;
    ray.t.set(lane, one.t);
    if constexpr (Scalar::hasIntersection)
        if (isCustomGeometry(one)) {
            ray.kind.set(lane, one.kind);
            for (int i = 0; i < 8; ++i)
                ray.attributes[i].set(lane, one.attributes[i]);
        }
}

/* The masked lanes one after the other, with the scalar programs as callbacks; the lanes that hit something. */
template <class Programs, class Flags, bool ANY, int W>
Lanes<bool, W> traverseLanes(RayLanes<W>& ray, Lanes<bool, W> mask, typename Programs::Payload& payload) {
    using Scalar = typename Programs::Scalar;
    uint32_t hits = 0;
    clearHit(ray);
    if constexpr (!ANY && Scalar::hasIntersection)
        for (int i = 0; i < 8; ++i)
            ray.attributes[i] = 0u;
    eachLane(mask, [&](int lane) {
        typename Scalar::Payload own;
        if constexpr (!isSame<typename Scalar::Payload, NoPayload>)
            extractLane(own, payload, lane);
        Ray one;
        scalarRay(one, ray, &own, lane);
        bool isHit;
        if constexpr (ANY)
            isHit = ray.paths ? traverseGraphAny<Scalar, Flags>(one, ray.paths[lane]) : traverseAny<Scalar, Flags>(one);
        else
            isHit = ray.paths ? traverseGraphClosest<Scalar, Flags>(one, ray.paths[lane]) : traverseClosest<Scalar, Flags>(one);
        if constexpr (!isSame<typename Scalar::Payload, NoPayload>)
            insertLane(payload, own, lane);
        if constexpr (Scalar::mayThrow)
            if (one.thread->exceptionPending) {
                takeExceptions(*ray.thread, Lanes<bool, W>::ofBits(1u << lane));
                return;
            }
        if (isHit) {
            hits |= 1u << lane;
            if constexpr (!ANY)
                enterScalarHit<Scalar>(ray, one, lane);
        }
    });
    return Lanes<bool, W>::ofBits(hits);
}

/* ---- trace -------------------------------------------------------------------------------------------------------------------- */

/* What a traversal with programs of ours in it found. */
template <class Payload, int W> struct FoundLanes {
    Lanes<bool, W> hit;
    Lanes<float, W> t;
    Lanes<uint32_t, W> kind;
    Lanes<uint32_t, W> attributes[8];
    Payload payload;
};

/* Traversals that call back, or walk a graph. Ray and payload are the caller's copies: if its own were seen from here, it could not keep
   them in registers, not even where nothing calls back. */
template <class Programs, class Flags, bool ANY, int W>
__attribute__((noinline)) FoundLanes<typename Programs::Payload, W> traverseApart(RayLanes<W>& ray, Lanes<bool, W> mask,
                                                                                  typename Programs::Payload& payload, bool isCoherent) {
    using Scalar = typename Programs::Scalar;
    constexpr bool filters = mayHaveCandidates<Scalar, Flags>;
    const bool mayFilterHere = filters && mayFilter<Scalar>(ray.flags, *ray.root);
    Lanes<bool, W> hit = false;
    if (ray.paths) {
        const uint32_t calling = OXRT_SCENE_HAS_SPHERES | OXRT_SCENE_HAS_CURVES | OXRT_SCENE_HAS_MICROMAPS |
                                 (Scalar::hasIntersection ? uint32_t(OXRT_SCENE_HAS_CUSTOM) : 0u);
        if (!isCoherent || (ray.root->needs & calling) || mayFilterHere)
            hit = traverseLanes<Programs, Flags, ANY>(ray, mask, payload);
        else
            hit = traverseGraphPacket<Scalar, ANY>(ray, mask, isCoherent);
    } else if constexpr (hasCallbacks<Scalar, Flags>) {
        const bool oneByOne = (!isCoherent && !(ray.root->needs & OXRT_SCENE_HAS_CUSTOM)) || (ray.root->needs & OXRT_SCENE_HAS_CURVES) || Scalar::usesMicromaps;
        if (filters && oneByOne)
            hit = traverseLanes<Programs, Flags, ANY>(ray, mask, payload);
        else
            hit = traverseCandidates<Programs, Flags, ANY>(ray, mask, &payload, isCoherent);
    }
    FoundLanes<typename Programs::Payload, W> found;
    found.hit = hit;
    found.payload = payload;
    if constexpr (!ANY)
        found.t = ray.t;
    if constexpr (!ANY && Scalar::hasIntersection) {
        found.kind = ray.kind;
        for (int i = 0; i < 8; ++i)
            found.attributes[i] = ray.attributes[i];
    }
    return found;
}

template <class Programs, class Flags, bool ANY, int W>
OXRT_INLINE Lanes<bool, W> traverse(RayLanes<W>& ray, Lanes<bool, W> mask, typename Programs::Payload& payload, bool isCoherent) {
    using Scalar = typename Programs::Scalar;
    bool isApart = ray.paths != nullptr;
    if constexpr (hasCallbacks<Scalar, Flags>) {
        constexpr bool filters = mayHaveCandidates<Scalar, Flags>;
        isApart = isApart || (Scalar::hasIntersection && (ray.root->needs & OXRT_SCENE_HAS_CUSTOM)) || (filters && mayFilter<Scalar>(ray.flags, *ray.root));
    }
    if (!__builtin_expect(isApart, hasCallbacks<Scalar, Flags>))
        return traversePacket<Flags, ANY>(ray, mask, isCoherent);
    RayLanes<W> copy = ray;
    typename Programs::Payload payloadCopy = payload;
    const auto found = traverseApart<Programs, Flags, ANY>(copy, mask, payloadCopy, isCoherent);
    if constexpr (Scalar::hasAnyHit || Scalar::hasIntersection)
        payload = found.payload;
    if constexpr (!ANY)
        ray.t = found.t;
    if constexpr (!ANY && Scalar::hasIntersection) {
        ray.kind = found.kind;
        for (int i = 0; i < 8; ++i)
            ray.attributes[i] = found.attributes[i];
    }
    return found.hit;
}

template <class Programs, int W>
OXRT_INLINE void runMisses(RayLanes<W>& ray, Lanes<bool, W> mask, typename Programs::Payload& payload, Place place) {
    const OxrtLaunch& launch = *ray.thread->thread->launch;
    ray.t = ray.tmax;
    ray.active = mask;
    const Lanes<bool, W> found = findRecords(ray.records, launch, mask, launch.missRecords, launch.missStride, launch.missCount,
                                             ray.missIndex);
    if constexpr (Programs::Scalar::isValidated)
        fault(*ray.thread, mask & (ray.missIndex >= launch.missCount), OXRT_FAULT_MISS_SBT,
              "miss_sbt_index is not below the number of miss records", place);
    if (any(found))
        Programs::miss(ray, found, payload);
}

template <class Programs, int W> OXRT_INLINE void runClosestHits(RayLanes<W>& ray, typename Programs::Payload& payload, Place place) {
    const Lanes<bool, W> found = findHitRecords(ray);
    if constexpr (Programs::Scalar::isValidated)
        fault(*ray.thread, without(ray.active, found), OXRT_FAULT_HIT_SBT,
              "the hit needs a record behind the end of the hit group records", place);
    if (any(found)) {
        ray.active = found;
        Programs::closestHit(ray, found, payload);
    }
}

/* Traversal, then the closest-hit and miss programs of the lanes. */
template <class Programs, class Flags, int W>
OXRT_INLINE void traceNow(RayLanes<W>& ray, Lanes<bool, W> mask, typename Programs::Payload& payload, bool isCoherent, Place place) {
    using Scalar = typename Programs::Scalar;
    using Known = FlagTraits<Flags>;
    constexpr bool runsClosestHit = Scalar::hasClosestHit && Known::mayRunClosestHit;
    Lanes<bool, W> hit = false;
    const Lanes<bool, W> traced = mask & (ray.tmin <= ray.tmax);
    if (ray.root && ray.root->scene && any(traced)) {
        hit = traverse<Programs, Flags, Known::alwaysTerminates && !runsClosestHit>(ray, traced, payload, isCoherent);
        if constexpr (Scalar::mayThrow) {
            mask = without(mask, ray.thread->thrown);
            hit = hit & mask;
        }
    }
    if constexpr (runsClosestHit)
        if (any(hit) && !(ray.flags & RAY_DISABLE_CLOSESTHIT)) {
            enterHits(ray, hit);
            runClosestHits<Programs>(ray, payload, place);
        }
    if constexpr (Scalar::hasMiss) {
        const Lanes<bool, W> missed = without(mask, hit);
        if (any(missed))
            runMisses<Programs>(ray, missed, payload, place);
    }
}

template <int W> OXRT_INLINE void checkRays(const RayLanes<W>& ray, Lanes<bool, W> mask, uint64_t handle, Place place) {
    eachLane(mask, [&](int lane) {
        Ray one;
        scalarRay(one, ray, nullptr, lane);
        if (!isValidRay(one))
            faultWithValues(*one.thread, OXRT_FAULT_INVALID_RAY, "invalid ray (origin, direction, tmin, tmax)", place, one.origin.x,
                            one.origin.y, one.origin.z, one.direction.x, one.direction.y, one.direction.z, one.tmin, one.tmax);
        else if (!ray.root && handle != 0)
            fault(*one.thread, OXRT_FAULT_INVALID_TRAVERSABLE,
                  "the handle names no traversable of this context, or one that was destroyed", place);
    });
}

/* The trace of the masked lanes. The handle and the flags are the same for all of them. */
template <class Programs, class Flags, int W>
OXRT_INLINE void trace(LanesThread<W>& thread, Lanes<bool, W> mask, uint64_t handle, const Wide<float3, W>& origin,
                       const Wide<float3, W>& direction, Wide<float, W> tmin, Wide<float, W> tmax, Wide<float, W> time, Wide<uint32_t, W> visibility, Flags flags,
                       Wide<uint32_t, W> sbtOffset, Wide<uint32_t, W> sbtStride, Wide<uint32_t, W> missIndex,
                       typename Programs::Payload& payload, Place place = Place::current()) {
    using Scalar = typename Programs::Scalar;
    if (none(mask))
        return;
    OxrtThread& one = Scalar::countsDepth ? thread.atLane(firstLane(mask)) : *thread.thread;
    if (!enterTrace<Scalar>(one, place)) {
        if constexpr (Scalar::depthThrows || Scalar::overflowThrows)
            takeExceptions(thread, mask);
        return;
    }
    typename Packet<W>::RayHit rays;
    RayLanes<W> ray(rays);
    ray.thread = &thread;
    if constexpr (Programs::usesPayloadWords) {
        ray.payload = &payload;
        ray.readWord = readPayloadWord<typename Scalar::Payload, W>;
        ray.writeWord = writePayloadWord<typename Scalar::Payload, W>;
    }
    ray.root = findTraversable(*thread.thread->launch, handle);
    GraphPath paths[W];
    if (ray.root && __builtin_expect(isGraph(*ray.root), 0))
        ray.paths = paths;
    auto& packet = rays.ray;
    setPacket(packet.org_x, origin.x);
    setPacket(packet.org_y, origin.y);
    setPacket(packet.org_z, origin.z);
    setPacket(packet.tnear, nextUp(tmin));
    setPacket(packet.dir_x, direction.x);
    setPacket(packet.dir_y, direction.y);
    setPacket(packet.dir_z, direction.z);
    setPacket(packet.time, Scalar::usesTime ? time : Lanes<float, W>(0.0f));
    setPacket(packet.tfar, nextDown(tmax));
    ray.mask = visibility & 0xFFu;
    setPacket(packet.mask, ray.mask);
    setPacket<W>(packet.flags, 0u);
    ray.tmin = tmin;
    ray.tmax = tmax;
    ray.flags = flags & 0xFFFF;
    ray.sbtOffset = (sbtOffset | (sbtStride >> 4u)) & 15u;
    ray.sbtStride = sbtStride & 15u;
    ray.missIndex = missIndex;
    if constexpr (Scalar::isValidated)
        checkRays(ray, mask, handle, place);
    traceNow<Programs, Flags>(ray, mask, payload, areCoherent(mask, origin, direction, tmax), place);
    leaveTrace<Scalar>(*thread.thread);
}

/* ---- groups of equal lanes ---------------------------------------------------------------------------------------------------- */

/* f(value, lanes that have it) for each distinct value among the lanes of the mask. */
template <class T, int W, class F> OXRT_INLINE void eachValue(Lanes<bool, W> mask, Lanes<T, W> values, F f) {
    while (any(mask)) {
        const T value = values[firstLane(mask)];
        const Lanes<bool, W> equal = mask & (values == value);
        f(value, equal);
        mask = without(mask, equal);
    }
}
template <class T, int W, class F> requires Scalar<T> OXRT_INLINE void eachValue(Lanes<bool, W> mask, T value, F f) { f(value, mask); }

/* ---- a tile of launch indices ------------------------------------------------------------------------------------------------- */

/* Runs the ray generation program on blocks of W indices: squarish in two dimensions, strips in one; lanes outside the tile are masked. */
template <int W, class Raygen> OXRT_INLINE void runBlocks(OxrtThread& scalar, const OxrtTile& tile, Raygen raygen) {
    const uint32_t columns = tile.end[0] - tile.begin[0];
    const uint32_t rows = tile.end[1] - tile.begin[1];
    const uint32_t shift = rows <= 1 ? (W == 16 ? 4 : 3) : columns >= 4 ? 2 : columns >= 2 ? 1 : 0;
    const uint32_t width = 1u << shift;
    const uint32_t height = W >> shift;
    const Lanes<uint32_t, W> lane = laneIndex<W>();
    const Lanes<uint32_t, W> dx = lane & (width - 1);
    const Lanes<uint32_t, W> dy = lane >> shift;
    LanesThread<W> thread;
    thread.thread = &scalar;
    for (uint32_t z = tile.begin[2]; z < tile.end[2]; ++z)
        for (uint32_t y = tile.begin[1]; y < tile.end[1]; y += height)
            for (uint32_t x = tile.begin[0]; x < tile.end[0]; x += width) {
                if (isCancelled(scalar))
                    return;
                thread.index[0] = dx + x;
                thread.index[1] = dy + y;
                thread.index[2] = z;
                thread.thrown = false;
                raygen(thread, (dx < tile.end[0] - x) & (dy < tile.end[1] - y));
            }
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
