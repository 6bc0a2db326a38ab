/* Embree's filter callback for packets: candidates of all lanes judged at once. The order of decisions is that of device_candidate.h. */
#ifndef OXRT_LANES_CANDIDATE_H
#define OXRT_LANES_CANDIDATE_H

#include <oxrt/lanes_loops.h>
#include <oxrt/lanes_opacity.h>
#include <oxrt/lanes_records.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* The candidates of one trace while its callbacks run. `packet` holds the world's rays; Embree's own packet may be in object space. */
template <int W> struct CandidateLanes : RayLanes<W> {
    using PacketRay = decltype(Packet<W>::RayHit::ray);
    using PacketHit = decltype(Packet<W>::RayHit::hit);
    PacketRay* objectRay;
    PacketHit* embreeHit; /* null in occlusion queries */
    Lanes<bool, W> ignored, stopped; /* what any-hit programs decided */
    Lanes<bool, W> ended;            /* lanes whose program called something that does not return */
    Lanes<bool, W> isTerminated;
    Lanes<float, W> closest;         /* t of the closest accepted hits, or the callers' tmax */
    Lanes<float, W> closestInEmbree; /* what stands for `closest` in Embree's packet */
    Lanes<uint32_t, W> committedKind;
    Lanes<uint32_t, W> committedAttributes[8];

    /* while an intersection program runs: what all lanes share */
    Ray common;
    uint32_t embreeGeometry;
    bool runsAnyHit;
    bool isCoherent;
    bool hasCommonRecord; /* SBT offset and stride are the same in all lanes: */
    uint32_t commonOffset, commonStride;
    const OxrtRecordHeader* soleRecord; /* of all candidates on built-in primitives, or null */

    OXRT_INLINE explicit CandidateLanes(PacketParts<W> rays) : RayLanes<W>(rays) {}
    static OXRT_INLINE void* operator new(__SIZE_TYPE__, void* place) { return place; }
};

/* The memory of a trace's packet, with what callbacks use of it beside. Loads wait for stores that lie a multiple of 4096 bytes apart, and frames
   of programs that trace are larger than that; rays and candidates are smaller. */
template <int W, bool CALLS_BACK> struct PacketMemory {
    typename Packet<W>::RayHit rays;
};
template <int W> struct PacketMemory<W, true> {
    typename Packet<W>::RayHit rays;
    alignas(CandidateLanes<W>) unsigned char candidates[sizeof(CandidateLanes<W>)];
    typename CandidateLanes<W>::PacketHit hits;
    typename CandidateLanes<W>::PacketRay world;
};

/* What Embree hands to the callbacks. */
template <int W> struct QueryLanes {
    RTCRayQueryContext context;
    CandidateLanes<W>* candidates;
};

template <int W> OXRT_INLINE CandidateLanes<W>& candidatesOf(RayLanes<W>& ray) { return static_cast<CandidateLanes<W>&>(ray); }
template <int W> OXRT_INLINE const CandidateLanes<W>& candidatesOf(const RayLanes<W>& ray) {
    return static_cast<const CandidateLanes<W>&>(ray);
}

/* What an intersection program takes for the end of the interval. */
template <int W> OXRT_INLINE Lanes<float, W> getRayTmax(const CandidateLanes<W>& ray) { return ray.closest; }

template <int W> OXRT_INLINE Wide<float3, W> getObjectRayOrigin(const RayLanes<W>& ray) {
    const auto& r = *candidatesOf(ray).objectRay;
    return {packetLanes<W>(r.org_x), packetLanes<W>(r.org_y), packetLanes<W>(r.org_z)};
}
template <int W> OXRT_INLINE Wide<float3, W> getObjectRayDirection(const RayLanes<W>& ray) {
    const auto& r = *candidatesOf(ray).objectRay;
    return {packetLanes<W>(r.dir_x), packetLanes<W>(r.dir_y), packetLanes<W>(r.dir_z)};
}

/* ---- ends of any-hit programs: the lanes leave the program right after -------------------------------------------------------- */

template <int W> OXRT_INLINE void ignoreIntersection(RayLanes<W>& ray, Lanes<bool, W> mask) {
    candidatesOf(ray).ignored |= mask;
    candidatesOf(ray).ended |= mask;
}
template <int W> OXRT_INLINE void terminateRay(RayLanes<W>& ray, Lanes<bool, W> mask) {
    candidatesOf(ray).stopped |= mask;
    candidatesOf(ray).ended |= mask;
}
/* The lanes whose program or a helper has called something that does not return. */
template <int W> OXRT_INLINE Lanes<bool, W> endedLanes(const RayLanes<W>& ray) { return candidatesOf(ray).ended; }

/* ---- judgement ---------------------------------------------------------------------------------------------------------------- */

/* The flag word of each candidate's record. */
template <int W> OXRT_INLINE Lanes<uint32_t, W> geometryFlags(const RayLanes<W>& ray) {
    const Lanes<uint32_t, W> record = localRecord(ray);
    if (ray.commonGeometry && !ray.commonGeometry->recordOffsets)
        return ray.commonGeometry->recordFlags[0];
    if (ray.commonGeometry)
        return gather<uint32_t, W>(placesIn<uint32_t, W>(ray.commonGeometry->recordFlags, record), 0, ray.active);
    const Lanes<uint64_t, W> flags = OXRT_GEOMETRY_FIELD(uint64_t, ray, recordFlags);
    return gather<uint32_t, W>(AddressPlaces<W>{flags + convert<uint64_t>(record) * uint64_t(4)}, 0, ray.active);
}

template <int W>
OXRT_INLINE Lanes<bool, W> anyHitEnabled(const RayLanes<W>& ray, Lanes<uint32_t, W> instanceFlags, Lanes<uint32_t, W> flags) {
    if (ray.flags & (RAY_DISABLE_ANYHIT | RAY_ENFORCE_ANYHIT))
        return bool(ray.flags & RAY_ENFORCE_ANYHIT);
    const Lanes<bool, W> byInstance = (instanceFlags & (INSTANCE_DISABLE_ANYHIT | INSTANCE_ENFORCE_ANYHIT)) != 0u;
    return select(byInstance, (instanceFlags & INSTANCE_ENFORCE_ANYHIT) != 0u, (flags & GEOMETRY_DISABLE_ANYHIT) == 0u);
}

/* The candidates that the ray's culling flags drop. */
template <int W>
OXRT_INLINE Lanes<bool, W> culledLanes(const RayLanes<W>& ray, Lanes<uint32_t, W> instanceFlags, Lanes<uint32_t, W> flags,
                                       Lanes<bool, W> runsAnyHit) {
    Lanes<bool, W> culled = false;
    if (ray.flags & RAY_CULL_ENFORCED_ANYHIT)
        culled |= runsAnyHit;
    if (ray.flags & RAY_CULL_DISABLED_ANYHIT)
        culled |= !runsAnyHit;
    if (ray.flags & (RAY_CULL_BACK_FACING | RAY_CULL_FRONT_FACING)) {
        const Lanes<bool, W> exempt = ((instanceFlags & INSTANCE_DISABLE_FACE_CULLING) | (flags & GEOMETRY_DISABLE_FACE_CULLING)) != 0u;
        const Lanes<bool, W> isTriangle = geometryType(ray) == uint32_t(OXRT_PRIMITIVE_TRIANGLE);
        const auto& hit = ray.packet.hit;
        const Wide<float3, W> normal = {packetLanes<W>(hit.Ng_x), packetLanes<W>(hit.Ng_y), packetLanes<W>(hit.Ng_z)};
        const Wide<float3, W> direction = transformVectorFromWorldToObjectSpace(ray, getWorldRayDirection(ray));
        const Lanes<float, W> cosine = normal.x * direction.x + normal.y * direction.y + normal.z * direction.z;
        const Lanes<bool, W> isFront = (cosine < 0.0f) ^ ((instanceFlags & INSTANCE_FLIP_FACING) != 0u);
        const Lanes<bool, W> front = bool(ray.flags & RAY_CULL_FRONT_FACING);
        const Lanes<bool, W> back = bool(ray.flags & RAY_CULL_BACK_FACING);
        culled |= without(isTriangle, exempt) & ((isFront & front) | without(back, isFront));
    }
    return culled;
}

/* Runs the any-hit programs of the active lanes; which of these are accepted. */
template <class Programs, int W> OXRT_INLINE Lanes<bool, W> runAnyHits(CandidateLanes<W>& ray) {
    const Lanes<bool, W> before = ray.ended;
    ray.ignored = ray.stopped = ray.ended = false;
    Programs::anyHit(ray, ray.active, *static_cast<typename Programs::Payload*>(ray.payload));
    ray.ended = before;
    if constexpr (Programs::Scalar::mayThrow)
        ray.stopped |= ray.active & ray.thread->thrown;
    return without(ray.active, ray.ignored);
}

template <int W> OXRT_INLINE void stopTraversals(CandidateLanes<W>& ray, Lanes<bool, W> mask) {
    ray.isTerminated |= mask;
    auto& tfar = ray.objectRay->tfar;
    storeLanes<float, W>(tfar, select(mask, -__builtin_inff(), packetLanes<W>(tfar)));
}

template <int W> OXRT_INLINE Lanes<bool, W> loadValid(const int* valid) {
    int32_t values[W];
    __builtin_memcpy(values, valid, sizeof(values));
    return loadLanes<int32_t, W>(values) == int32_t(-1);
}

/* The geometry's, the instance's, the micromap's and the ray's word on culling and any-hit programs: the candidates that are accepted
   unless their programs object. The active lanes are those whose programs run, their records are known. */
template <class Programs, bool MAY_CULL, int W>
OXRT_INLINE Lanes<bool, W> findCandidatePrograms(CandidateLanes<W>& ray, Lanes<bool, W> offered) {
    enterHits(ray, offered);
    Lanes<uint32_t, W> flags = geometryFlags(ray);
    const Lanes<uint32_t, W> instanceFlags = instanceField<uint32_t>(ray, OXRT_FIELD_OFFSET(OxrtInstanceView, flags), 0u);
    Lanes<bool, W> accepted = offered;
    if constexpr (Programs::Scalar::usesMicromaps)
        accepted = passesMicromaps(ray, offered, instanceFlags, flags);
    const Lanes<bool, W> runs = anyHitEnabled(ray, instanceFlags, flags);
    if constexpr (MAY_CULL)
        accepted = without(accepted, culledLanes(ray, instanceFlags, flags, runs));
    if constexpr (Programs::Scalar::hasAnyHit) {
        ray.active = accepted & runs;
        if (any(ray.active))
            ray.active = findHitRecords(ray);
    }
    return accepted;
}

/* Embree's filter callback: candidates on built-in primitives. */
template <class Programs, bool MAY_CULL, int W> void filterCandidates(const RTCFilterFunctionNArguments* arguments) {
    CandidateLanes<W>& ray = *reinterpret_cast<QueryLanes<W>*>(arguments->context)->candidates;
    const Lanes<bool, W> offered = loadValid<W>(arguments->valid);
    if (none(offered))
        return;
    __builtin_memcpy(&ray.packet.hit, arguments->hit, sizeof(ray.packet.hit));
    ray.objectRay = static_cast<typename CandidateLanes<W>::PacketRay*>(arguments->ray);
    ray.t = packetLanes<W>(ray.objectRay->tfar);
    Lanes<bool, W> accepted = offered;
    Lanes<bool, W> stopped = false;
    ray.records.common = mayHaveSoleRecord<typename Programs::Scalar, MAY_CULL> ? ray.soleRecord : nullptr;
    if (ray.records.common) {
        ray.active = offered;
        ray.commonInstance = nullptr;
        ray.commonGeometry = ray.root->geometries;
    } else
        accepted = findCandidatePrograms<Programs, MAY_CULL>(ray, offered);
    if constexpr (Programs::Scalar::hasAnyHit)
        if (const Lanes<bool, W> asked = ray.active; any(asked)) {
            accepted = without(accepted, asked) | runAnyHits<Programs>(ray);
            stopped = ray.stopped;
        }
    if (ray.flags & RAY_TERMINATE_ON_FIRST_HIT)
        stopped |= accepted;
    storeLanes<int32_t, W>(*reinterpret_cast<int32_t(*)[W]>(arguments->valid), select(accepted, int32_t(-1), int32_t(0)));
    if (any(stopped)) {
        ray.closest = select(stopped, ray.t, ray.closest);
        stopTraversals(ray, stopped);
    }
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
