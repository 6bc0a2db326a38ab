/* Tracing W rays at once: traversal, then the programs of the lanes; and the blocks of a launch.
 *
 * `Programs` is what the pipeline emits for each payload class: masked programs over lanes, and as `Scalar` the scalar Programs of
 * device_candidate.h; `Flags`: see device_query.h.
 */
#ifndef OXRT_LANES_TRACE_H
#define OXRT_LANES_TRACE_H

#include <oxrt/lanes_query.h>

namespace oxrt {
inline namespace OXRT_ISA {

template <class Programs, int W>
OXRT_INLINE void runMisses(RayLanes<W>& ray, Lanes<bool, W> mask, typename Programs::Payload& payload, Place place) {
    const OxrtLaunch& launch = *ray.thread->thread->launch;
    ray.t = ray.tmax;
    ray.active = mask;
    const Lanes<bool, W> found = findRecords(ray.records, launch, mask, launch.missRecords, launch.missStride, launch.missCount,
                                             ray.missIndex);
    if constexpr (Programs::Scalar::isValidated) {
        placeOfTrace() = place;
        fault(*ray.thread, mask & (ray.missIndex >= launch.missCount), OXRT_FAULT_MISS_SBT,
              "miss_sbt_index is not below the number of miss records", place);
    }
    if (any(found))
        Programs::miss(ray, found, payload);
}

template <class Programs, int W> OXRT_INLINE void runClosestHits(RayLanes<W>& ray, typename Programs::Payload& payload, Place place) {
    const Lanes<bool, W> found = findHitRecords(ray);
    if constexpr (Programs::Scalar::isValidated) {
        placeOfTrace() = place;
        fault(*ray.thread, without(ray.active, found), OXRT_FAULT_HIT_SBT,
              "the hit needs a record behind the end of the hit group records", place);
    }
    if (any(found)) {
        ray.active = found;
        Programs::closestHit(ray, found, payload);
    }
}

/* Whether a trace ends at any hit and nothing is asked about it. */
template <class Programs, class Flags> inline constexpr bool endsAnywhere =
    FlagTraits<Flags>::alwaysTerminates && !(Programs::Scalar::hasClosestHit && FlagTraits<Flags>::mayRunClosestHit);

/* Traversal, then the closest-hit and miss programs of the lanes. */
template <class Programs, class Flags, int W>
OXRT_INLINE void traceNow(RayLanes<W>& ray, Lanes<bool, W> mask, typename Programs::Payload& payload, Bundle bundle,
                          PacketMemoryFor<Programs, Flags, W>& memory, Place place) {
    using Scalar = typename Programs::Scalar;
    constexpr bool runsClosestHit = Scalar::hasClosestHit && FlagTraits<Flags>::mayRunClosestHit;
    Lanes<bool, W> hit = false;
    const Lanes<bool, W> traced = mask & (ray.tmin <= ray.tmax);
    if (ray.root && ray.root->scene && any(traced)) {
        hit = traverse<Programs, Flags, endsAnywhere<Programs, Flags>>(ray, traced, payload, bundle, memory);
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

template <class Scalar, int W> OXRT_INLINE void checkRays(const RayLanes<W>& ray, Lanes<bool, W> mask, uint64_t handle, Place place) {
    eachLane(mask, [&](int lane) {
        Ray one;
        scalarRay(one, ray, nullptr, lane);
        checkRay<Scalar>(one, handle, place);
    });
}

/* Payload registers by number, where programs use them. */
template <class Programs, int W> OXRT_INLINE void setPayloadWords(RayLanes<W>& ray, typename Programs::Payload& payload) {
    if constexpr (Programs::usesPayloadWords) {
        ray.payload = &payload;
        ray.readWord = readPayloadWord<typename Programs::Scalar::Payload, W>;
        ray.writeWord = writePayloadWord<typename Programs::Scalar::Payload, W>;
    }
}

/* Enters what the caller of a trace gave; false if that was an exception of all lanes. The handle and the flags are the same for them. */
template <class Programs, int W>
OXRT_INLINE bool setRays(RayLanes<W>& ray, LanesThread<W>& thread, Lanes<bool, W> mask, uint64_t handle, const Wide<float3, W>& origin,
                         const Wide<float3, W>& direction, Wide<float, W> tmin, Wide<float, W> tmax, Wide<float, W> time,
                         Wide<uint32_t, W> visibility, uint32_t flags, Wide<uint32_t, W> sbtOffset, Wide<uint32_t, W> sbtStride,
                         Wide<uint32_t, W> missIndex, typename Programs::Payload& payload, Place place) {
    using Scalar = typename Programs::Scalar;
    ray.thread = &thread;
    setPayloadWords<Programs>(ray, payload);
    ray.root = findTraversable(*thread.thread->launch, handle);
    auto& packet = ray.packet.ray;
    setPacket(packet.org_x, origin.x);
    setPacket(packet.org_y, origin.y);
    setPacket(packet.org_z, origin.z);
    setPacket(packet.tnear, nextUp(tmin));
    setPacket(packet.dir_x, direction.x);
    setPacket(packet.dir_y, direction.y);
    setPacket(packet.dir_z, direction.z);
    setPacket(packet.time, Scalar::usesTime ? time : Lanes<float, W>(0.0f));
    setPacket(packet.tfar, nextDown(tmax));
    setPacket(packet.mask, visibility & 0xFFu);
    setPacket<W>(packet.flags, 0u);
    ray.tmin = tmin;
    ray.tmax = tmax;
    ray.flags = flags & 0xFFFF;
    ray.sbtOffset = (sbtOffset | (sbtStride >> 4u)) & 15u;
    ray.sbtStride = sbtStride & 15u;
    ray.missIndex = missIndex;
    if constexpr (Scalar::isValidated) {
        placeOfTrace() = place;
        checkRays<Scalar>(ray, mask, handle, place);
    }
    if constexpr (Scalar::graphDepthThrows)
        if (__builtin_expect(isTooDeep(*thread.thread, ray.root), 0)) {
            ray.root = nullptr;
            throwException(thread.atLane(firstLane(mask)), nullptr, OXRT_FAULT_TRACE_DEPTH);
            takeExceptions(thread, mask);
            return false;
        }
    return true;
}

/* Whether the rays go to Embree together. */
template <class Programs, bool ANY, int W>
OXRT_INLINE Bundle bundleFor(const RayLanes<W>& ray, Lanes<bool, W> mask, const Wide<float3, W>& origin, const Wide<float3, W>& direction,
                             Wide<float, W> tmax) {
    const uint32_t needs = ray.root && Programs::Scalar::hasIntersection ? ray.root->needs : 0;
    if (!(needs & OXRT_SCENE_HAS_CUSTOM))
        return bundleOf<ANY>(mask, origin, direction, tmax, ray.root ? ray.root->triangleDensity : 0.0f);
    // coherent packets offer a custom primitive to lanes that miss its box, which costs more than they save among few primitives: measured on
    // clouds of spheres, 0.82 times the speed of plain packets for 10, the same for 256, 1.24 times for 100,000
    return (needs & OXRT_SCENE_HAS_MANY_CUSTOM) && isInOneOctant(mask, direction) ? Bundle::Coherent : Bundle::Apart;
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
    if (!enterTrace<Scalar>(*thread.thread, ThreadOfAnyLane<W>{thread, mask}, place)) {
        if constexpr (Scalar::depthThrows || Scalar::overflowThrows)
            takeExceptions(thread, mask);
        return;
    }
    PacketMemoryFor<Programs, Flags, W> memory;
    RayLanes<W> ray(memory.rays);
    GraphPath paths[W];
    if (setRays<Programs>(ray, thread, mask, handle, origin, direction, tmin, tmax, time, visibility, flags, sbtOffset, sbtStride, missIndex,
                          payload, place)) {
        if (ray.root && __builtin_expect(isGraph(*ray.root), 0))
            ray.paths = paths;
        const Bundle bundle = bundleFor<Programs, endsAnywhere<Programs, Flags>>(ray, mask, origin, direction, tmax);
        traceNow<Programs, Flags>(ray, mask, payload, bundle, memory, place);
    }
    leaveTrace<Scalar>(*thread.thread);
}

/* ---- a tile of launch indices ------------------------------------------------------------------------------------------------- */

/* Before a call of what has one caller: clang else optimises it alone first and then again where it is inlined, which takes a tenth of the
   compile time of a path tracer. */
#if defined(__clang__) && defined(__OPTIMIZE__)
#define OXRT_INLINE_CALL [[clang::always_inline]]
#else
#define OXRT_INLINE_CALL
#endif

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
                OXRT_INLINE_CALL raygen(thread, (dx < tile.end[0] - x) & (dy < tile.end[1] - y));
            }
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
