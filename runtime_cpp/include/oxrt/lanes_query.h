/* Embree's queries for packets, and which of them a trace takes.
 *
 * Rays that start near each other in about one direction go to Embree as COHERENT packets, others one by one, which is quicker than a
 * packet (measured: README); with any-hit and intersection programs over lanes as callbacks they are packets too. Divergent rays with any-hit programs on triangles are traced one by one with the scalar programs: candidates
 * come in another order for each lane, and packets with rejecting filters are slower (measured: README).
 */
#ifndef OXRT_LANES_QUERY_H
#define OXRT_LANES_QUERY_H

#include <oxrt/lanes_graph.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* ---- packets ------------------------------------------------------------------------------------------------------------------ */

/* How the active rays lie to each other: in about one direction from origins near each other, only the latter, or neither. */
enum class Bundle { Coherent, Near, Apart };

/* At least half the lanes, all origins within half the length of the first ray, all directions within 60 degrees of it. Rays that end at
   any hit visit less; theirs may be 80 degrees apart. Measured on ambient occlusion, in strata and without, and on path tracing, whose
   rays after the first bounce are quickest alone; the angle without the origins, or these without the angle, make some slower by half.
   Coherent packets visit nodes for all rays together. Where triangles are smaller than the distance of the origins, as on a scanned statue,
   rays that end at any hit and are not nearly parallel have little in common: ambient occlusion there gains 4.6 % as plain packets. */
template <bool ANY, int W>
OXRT_INLINE Bundle bundleOf(Lanes<bool, W> mask, const Wide<float3, W>& origin, const Wide<float3, W>& direction, Lanes<float, W> tmax,
                            float triangleDensity) {
    if (__builtin_popcount(mask.bits()) < W / 2)
        return Bundle::Apart;
    const int lane = firstLane(mask);
    const Wide<float3, W> apart = origin - spreadLane(origin, lane);
    const Wide<float3, W> first = spreadLane(direction, lane);
    const Lanes<float, W> reach = 0.5f * spreadLane(tmax, lane);
    const Lanes<float, W> length2 = dot(first, first);
    const Lanes<float, W> distance2 = dot(apart, apart);
    if (any(mask & (distance2 > reach * reach * length2)))
        return Bundle::Apart;
    constexpr float cosine2 = ANY ? 0.03f : 0.25f;
    const Lanes<float, W> cosine = dot(direction, first);
    const Lanes<float, W> lengths2 = dot(direction, direction) * length2;
    if constexpr (ANY)
        if (any(mask & (distance2 * triangleDensity > 2.25f)) && any(without(mask, cosine * abs(cosine) > lengths2 * 0.8f)))
            return Bundle::Near;
    return none(without(mask, cosine * abs(cosine) > lengths2 * cosine2)) ? Bundle::Coherent : Bundle::Near;
}

/* Nothing is hit. Programs compute in lanes without a hit as well. What lay in memory would often be denormal numbers there, and each operation on one
   costs more than the rest of a short program. */
template <int W> OXRT_INLINE void clearHits(RayLanes<W>& ray) {
    setPacket<W>(ray.packet.hit.geomID, RTC_INVALID_GEOMETRY_ID);
    setPacket<W>(ray.packet.hit.instID[0], RTC_INVALID_GEOMETRY_ID);
    setPacket(ray.packet.hit.u, Lanes<float, W>(0.0f));
    setPacket(ray.packet.hit.v, Lanes<float, W>(0.0f));
}

/* No component of the active rays' directions has two signs. */
template <int W> OXRT_INLINE bool isInOneOctant(Lanes<bool, W> mask, const Wide<float3, W>& direction) {
    const auto hasOneSign = [mask](const Lanes<float, W>& component) {
        const Lanes<bool, W> isNegative = mask & (component < 0.0f);
        return none(isNegative) || none(without(mask, isNegative));
    };
    return hasOneSign(direction.x) && hasOneSign(direction.y) && hasOneSign(direction.z);
}

/* The masked lanes as one packet without callbacks; the lanes that hit something. */
template <bool ANY, int W> OXRT_INLINE Lanes<bool, W> traversePacket(RayLanes<W>& ray, Lanes<bool, W> mask, bool isCoherent) {
    alignas(4 * W) int valid[W];
    storeLanes<int32_t, W>(valid, select(mask, int32_t(-1), int32_t(0)));
    const OxrtServices& services = *ray.thread->thread->launch->services;
    const unsigned flags = isCoherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    if constexpr (ANY) {
        RTCOccludedArguments arguments = {flags, RTC_FEATURE_FLAG_ALL, nullptr, nullptr, nullptr, 0.0f};
        Packet<W>::occluded(services, valid, ray.root->scene, ray.packet.whole(), &arguments);
        return mask & (packetLanes<W>(ray.packet.ray.tfar) < 0.0f);
    } else {
        RTCIntersectArguments arguments = {flags, RTC_FEATURE_FLAG_ALL, nullptr, nullptr, nullptr, 0.0f};
        clearHits(ray);
        Packet<W>::intersect(services, valid, ray.root->scene, ray.packet.whole(), &arguments);
        ray.t = packetLanes<W>(ray.packet.ray.tfar);
        return mask & (packetLanes<W>(ray.packet.hit.geomID) != RTC_INVALID_GEOMETRY_ID);
    }
}

/* The masked lanes without callbacks one after the other; the lanes that hit something. */
template <bool ANY, int W> OXRT_INLINE Lanes<bool, W> traverseSingly(RayLanes<W>& ray, Lanes<bool, W> mask) {
    const OxrtServices& services = *ray.thread->thread->launch->services;
    auto& rays = ray.packet.ray;
    auto& hits = ray.packet.hit;
    uint32_t found = 0;
    if constexpr (!ANY)
        clearHits(ray);
    eachLane(mask, [&](int lane) {
        RTCRayHit query;
        setEmbreeRay(query.ray, {rays.org_x[lane], rays.org_y[lane], rays.org_z[lane]}, rays.tnear[lane],
                     {rays.dir_x[lane], rays.dir_y[lane], rays.dir_z[lane]}, rays.time[lane], rays.tfar[lane], rays.mask[lane]);
        if constexpr (ANY) {
            services.occluded1(ray.root->scene, &query.ray, nullptr);
            found |= uint32_t(query.ray.tfar < 0.0f) << lane;
        } else {
            query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
            services.intersect1(ray.root->scene, &query, nullptr);
            if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
                return;
            found |= 1u << lane;
            rays.tfar[lane] = query.ray.tfar;
            hits.Ng_x[lane] = query.hit.Ng_x;
            hits.Ng_y[lane] = query.hit.Ng_y;
            hits.Ng_z[lane] = query.hit.Ng_z;
            hits.u[lane] = query.hit.u;
            hits.v[lane] = query.hit.v;
            hits.primID[lane] = query.hit.primID;
            hits.geomID[lane] = query.hit.geomID;
            hits.instID[0][lane] = query.hit.instID[0];
        }
    });
    if constexpr (!ANY)
        ray.t = packetLanes<W>(rays.tfar);
    return Lanes<bool, W>::ofBits(found);
}

/* ---- packets with callbacks --------------------------------------------------------------------------------------------------- */

/* What the callbacks of a trace need of its ray; nothing found yet. */
template <class Programs, int W>
OXRT_INLINE void beginCandidates(CandidateLanes<W>& candidates, const RayLanes<W>& ray, void* payload, bool isCoherent) {
    candidates.thread = ray.thread;
    candidates.payload = payload;
    candidates.readWord = ray.readWord;
    candidates.writeWord = ray.writeWord;
    candidates.root = ray.root;
    candidates.tmin = ray.tmin;
    candidates.tmax = ray.tmax;
    candidates.flags = ray.flags;
    candidates.ended = false;
    candidates.isTerminated = false;
    candidates.common.thread = ray.thread->thread;
    candidates.common.root = ray.root;
    candidates.common.path = nullptr;
    candidates.commonOffset = ray.sbtOffset[0];
    candidates.commonStride = ray.sbtStride[0];
    candidates.hasCommonRecord = none((ray.sbtOffset != candidates.commonOffset) | (ray.sbtStride != candidates.commonStride));
    if (Programs::Scalar::hasAnyHit || !candidates.hasCommonRecord) {
        candidates.sbtOffset = ray.sbtOffset;
        candidates.sbtStride = ray.sbtStride;
    }
    candidates.isCoherent = isCoherent;
    candidates.closest = ray.tmax;
    candidates.closestInEmbree = packetLanes<W>(ray.packet.ray.tfar);
    candidates.committedKind = NO_REPORT;
    for (int i = 0; i < Programs::attributeWords; ++i)
        candidates.committedAttributes[i] = 0u;
}

/* Embree turns rays into object space in place; programs see the world's. */
template <class PacketRay> OXRT_INLINE void copyRays(PacketRay& to, const PacketRay& from) {
    __builtin_memcpy(to.org_x, from.org_x, sizeof(from.org_x));
    __builtin_memcpy(to.org_y, from.org_y, sizeof(from.org_y));
    __builtin_memcpy(to.org_z, from.org_z, sizeof(from.org_z));
    __builtin_memcpy(to.dir_x, from.dir_x, sizeof(from.dir_x));
    __builtin_memcpy(to.dir_y, from.dir_y, sizeof(from.dir_y));
    __builtin_memcpy(to.dir_z, from.dir_z, sizeof(from.dir_z));
    __builtin_memcpy(to.time, from.time, sizeof(from.time));
    __builtin_memcpy(to.mask, from.mask, sizeof(from.mask));
}

/* Embree drops lanes whose interval is empty or one number before it calls back; reports may be accepted in one number. */
template <int W>
OXRT_INLINE void openEmptyIntervals(CandidateLanes<W>& candidates, typename CandidateLanes<W>::PacketRay& packet, Lanes<bool, W> mask) {
    const Lanes<bool, W> isEmpty = mask & (packetLanes<W>(packet.tnear) >= packetLanes<W>(packet.tfar));
    if (none(isEmpty))
        return;
    setPacket(packet.tnear, select(isEmpty, candidates.tmin, packetLanes<W>(packet.tnear)));
    setPacket(packet.tfar, select(isEmpty, nextUp(candidates.tmax), packetLanes<W>(packet.tfar)));
    candidates.closestInEmbree = packetLanes<W>(packet.tfar);
}

template <class Programs, class Flags, int W> using PacketMemoryFor = PacketMemory<W, hasCallbacks<typename Programs::Scalar, Flags>>;

/* The query of the masked lanes, whose candidates the programs judge. */
template <class Programs, class Flags, bool ANY, int W>
__attribute__((noinline)) void queryCandidates(CandidateLanes<W>& candidates, typename Packet<W>::RayHit& packet, Lanes<bool, W> mask) {
    using Scalar = typename Programs::Scalar;
    QueryLanes<W> query = {{{RTC_INVALID_GEOMETRY_ID}, {RTC_INVALID_GEOMETRY_ID}}, &candidates};
    alignas(4 * W) int valid[W];
    storeLanes<int32_t, W>(valid, select(mask, int32_t(-1), int32_t(0)));
    const OxrtServices& services = *candidates.thread->thread->launch->services;
    unsigned flags = candidates.isCoherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    RTCFilterFunctionN filter = nullptr;
    if constexpr (mayHaveCandidates<Scalar, Flags>) {
        if (mayFilter<Scalar>(candidates.flags, *candidates.root))
            filter = filterCandidates<Programs, FlagTraits<Flags>::mayCull, W>;
        if (filtersEverything<Scalar>(candidates.flags, *candidates.root))
            flags |= RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
    }
    if constexpr (Scalar::hasIntersection)
        openEmptyIntervals(candidates, packet.ray, mask);
    if constexpr (ANY) {
        RTCOccludedArguments arguments = {flags, RTC_FEATURE_FLAG_ALL, &query.context, filter, nullptr, 0.0f};
        if constexpr (Scalar::hasIntersection)
            arguments.occluded = occludeCustoms<Programs, W>;
        Packet<W>::occluded(services, valid, candidates.root->scene, packet, &arguments);
    } else {
        RTCIntersectArguments arguments = {flags, RTC_FEATURE_FLAG_ALL, &query.context, filter, nullptr, 0.0f};
        if constexpr (Scalar::hasIntersection)
            arguments.intersect = intersectCustoms<Programs, W>;
        Packet<W>::intersect(services, valid, candidates.root->scene, packet, &arguments);
    }
}

/* The masked lanes as one packet with callbacks; the lanes that hit something. Ray and payload keep their addresses to themselves: what
   callbacks see are copies, so that the rest of the program can hold its own in registers. */
template <class Programs, class Flags, bool ANY, int W>
OXRT_INLINE Lanes<bool, W> traverseCandidates(RayLanes<W>& ray, Lanes<bool, W> mask, typename Programs::Payload& payload, bool isCoherent,
                                              PacketMemory<W, true>& memory) {
    using Scalar = typename Programs::Scalar;
    if (ray.root->instances)
        copyRays(memory.world, ray.packet.ray);
    CandidateLanes<W>& candidates =
        *new (memory.candidates) CandidateLanes<W>(PacketParts<W>(ray.root->instances ? memory.world : ray.packet.ray, memory.hits));
    typename Programs::Payload payloadCopy;
    if constexpr (Programs::callbacksUsePayload)
        payloadCopy = payload;
    beginCandidates<Programs>(candidates, ray, &payloadCopy, isCoherent);
    if constexpr (mayHaveSoleRecord<Scalar, FlagTraits<Flags>::mayCull>)
        candidates.soleRecord =
            candidates.hasCommonRecord ? findSoleRecord(*ray.thread->thread->launch, *ray.root, ray.flags, candidates.commonOffset) : nullptr;
    if constexpr (!ANY)
        clearHits(ray);
    queryCandidates<Programs, Flags, ANY>(candidates, ray.packet.whole(), mask);
    if constexpr (Programs::callbacksUsePayload)
        payload = payloadCopy;
    const Lanes<float, W> tfar = packetLanes<W>(ray.packet.ray.tfar);
    if constexpr (ANY)
        return mask & (candidates.isTerminated | (tfar < 0.0f));
    else {
        Lanes<bool, W> isOwn = candidates.isTerminated;
        if constexpr (Scalar::hasIntersection) {
            isOwn |= (tfar == candidates.closestInEmbree) & (candidates.committedKind != NO_REPORT);
            ray.kind = candidates.committedKind;
            for (int i = 0; i < Programs::attributeWords; ++i)
                ray.attributes[i] = candidates.committedAttributes[i];
        }
        ray.t = select(isOwn, candidates.closest, tfar);
        return mask & (packetLanes<W>(ray.packet.hit.geomID) != RTC_INVALID_GEOMETRY_ID);
    }
}

/* ---- one lane after the other ------------------------------------------------------------------------------------------------- */

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
    one.mask = packet.mask[lane];
    one.flags = ray.flags;
    one.sbtOffset = ray.sbtOffset[lane];
    one.sbtStride = ray.sbtStride[lane];
    one.missIndex = ray.missIndex[lane];
}

/* For hits whose kind of primitive nothing says beforehand. */
struct HitsOfAllKinds {
    static constexpr bool hasIntersection = true;
};

/* Enters the closest hit of one lane. */
template <class Scalar, int WORDS, int W> OXRT_INLINE void enterScalarHit(RayLanes<W>& ray, const Ray& one, int lane) {
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
            for (int i = 0; i < WORDS; ++i)
                ray.attributes[i].set(lane, one.attributes[i]);
        }
}

/* The masked lanes one after the other, with the scalar programs as callbacks; the lanes that hit something. */
template <class Programs, class Flags, bool ANY, int W>
Lanes<bool, W> traverseLanes(RayLanes<W>& ray, Lanes<bool, W> mask, typename Programs::Payload& payload) {
    using Scalar = typename Programs::Scalar;
    uint32_t hits = 0;
    clearHits(ray);
    if constexpr (!ANY && Scalar::hasIntersection)
        for (int i = 0; i < Programs::attributeWords; ++i)
            ray.attributes[i] = 0u;
    eachLane(mask, [&](int lane) {
        typename Scalar::Payload own;
        if constexpr (Programs::callbacksUsePayload)
            extractLane(own, payload, lane);
        Ray one;
        scalarRay(one, ray, &own, lane);
        bool isHit;
        if constexpr (ANY)
            isHit = ray.paths ? traverseGraphAny<Scalar, Flags>(one, ray.paths[lane]) : traverseAny<Scalar, Flags>(one);
        else
            isHit = ray.paths ? traverseGraphClosest<Scalar, Flags>(one, ray.paths[lane]) : traverseClosest<Scalar, Flags>(one);
        if constexpr (Programs::callbacksUsePayload)
            insertLane(payload, own, lane);
        if constexpr (Scalar::mayThrow)
            if (one.thread->exceptionPending) {
                takeExceptions(*ray.thread, Lanes<bool, W>::ofBits(1u << lane));
                return;
            }
        if (isHit) {
            hits |= 1u << lane;
            if constexpr (!ANY)
                enterScalarHit<Scalar, Programs::attributeWords>(ray, one, lane);
        }
    });
    return Lanes<bool, W>::ofBits(hits);
}

/* ---- which query -------------------------------------------------------------------------------------------------------------- */

/* What a traversal apart from the usual ones found. */
template <class Payload, int W> struct FoundLanes {
    Lanes<bool, W> hit;
    Lanes<float, W> t;
    Lanes<uint32_t, W> kind;
    Lanes<uint32_t, W> attributes[8];
    Payload payload;
};

/* Lane by lane, or through a graph. Ray and payload are the caller's copies. */
template <class Programs, class Flags, bool ANY, int W>
__attribute__((noinline)) FoundLanes<typename Programs::Payload, W> traverseApart(RayLanes<W>& ray, Lanes<bool, W> mask,
                                                                                  typename Programs::Payload& payload, bool isCoherent) {
    using Scalar = typename Programs::Scalar;
    Lanes<bool, W> hit;
    const uint32_t calling = OXRT_SCENE_HAS_SPHERES | OXRT_SCENE_HAS_CURVES |
                             (Scalar::hasIntersection ? uint32_t(OXRT_SCENE_HAS_CUSTOM) : 0u);
    bool isPacket = ray.paths && isCoherent && !(ray.root->needs & calling);
    if constexpr (mayHaveCandidates<Scalar, Flags>)
        isPacket = isPacket && !mayFilter<Scalar>(ray.flags, *ray.root);
    if (isPacket)
        hit = traverseGraphPacket<Scalar, ANY>(ray, mask, isCoherent);
    else
        hit = traverseLanes<Programs, Flags, ANY>(ray, mask, payload);
    FoundLanes<typename Programs::Payload, W> found;
    found.hit = hit;
    if constexpr (Programs::callbacksUsePayload)
        found.payload = payload;
    if constexpr (!ANY)
        found.t = ray.t;
    if constexpr (!ANY && Scalar::hasIntersection) {
        found.kind = ray.kind;
        for (int i = 0; i < Programs::attributeWords; ++i)
            found.attributes[i] = ray.attributes[i];
    }
    return found;
}

template <class Programs, class Flags, bool ANY, int W>
OXRT_INLINE Lanes<bool, W> traverse(RayLanes<W>& ray, Lanes<bool, W> mask, typename Programs::Payload& payload, Bundle bundle,
                                    [[maybe_unused]] PacketMemoryFor<Programs, Flags, W>& memory) {
    using Scalar = typename Programs::Scalar;
    const bool isCoherent = bundle == Bundle::Coherent;
    bool isApart = ray.paths != nullptr;
    if constexpr (hasCallbacks<Scalar, Flags>) {
        const uint32_t needs = ray.root->needs;
        bool calls = Scalar::hasIntersection && (needs & OXRT_SCENE_HAS_CUSTOM);
        if constexpr (mayHaveCandidates<Scalar, Flags>)
            if (mayFilter<Scalar>(ray.flags, *ray.root)) {
                calls = true;
                const bool isDivergent = !isCoherent && !(needs & OXRT_SCENE_HAS_CUSTOM);
                isApart = isApart || isDivergent || (needs & OXRT_SCENE_HAS_CURVES);
            }
        if (calls && !isApart)
            return traverseCandidates<Programs, Flags, ANY>(ray, mask, payload, isCoherent, memory);
    }
    if (!__builtin_expect(isApart, false)) {
        const bool isPacket = isCoherent || (ANY && bundle == Bundle::Near);
        return isPacket ? traversePacket<ANY>(ray, mask, isCoherent) : traverseSingly<ANY>(ray, mask);
    }
    RayLanes<W> copy = ray;
    typename Programs::Payload payloadCopy;
    if constexpr (Programs::callbacksUsePayload)
        payloadCopy = payload;
    const auto found = traverseApart<Programs, Flags, ANY>(copy, mask, payloadCopy, isCoherent);
    if constexpr (Programs::callbacksUsePayload)
        payload = found.payload;
    if constexpr (!ANY)
        ray.t = found.t;
    if constexpr (!ANY && Scalar::hasIntersection) {
        ray.kind = found.kind;
        for (int i = 0; i < Programs::attributeWords; ++i)
            ray.attributes[i] = found.attributes[i];
    }
    return found.hit;
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
