// Rays to Embree and back, one at a time and in packets.
#ifndef BENCH_TRACE_H
#define BENCH_TRACE_H

#include <oxrt/embree.h>

#include "algebra.h"
#ifdef BENCH_RECORD
#include "limit.h"
#endif

namespace bench {

#if defined(__AVX512F__)
using PacketHit = RTCRayHit16;
using PacketRay = RTCRay16;
BENCH_INLINE void intersectN(const int* valid, RTCScene scene, PacketHit* packet, RTCIntersectArguments* arguments) {
    rtcIntersect16(valid, scene, packet, arguments);
}
BENCH_INLINE void occludedN(const int* valid, RTCScene scene, PacketRay* packet, RTCOccludedArguments* arguments) {
    rtcOccluded16(valid, scene, packet, arguments);
}
#else
using PacketHit = RTCRayHit8;
using PacketRay = RTCRay8;
BENCH_INLINE void intersectN(const int* valid, RTCScene scene, PacketHit* packet, RTCIntersectArguments* arguments) {
    rtcIntersect8(valid, scene, packet, arguments);
}
BENCH_INLINE void occludedN(const int* valid, RTCScene scene, PacketRay* packet, RTCOccludedArguments* arguments) {
    rtcOccluded8(valid, scene, packet, arguments);
}
#endif

BENCH_INLINE RTCScene sceneOf(const BenchJob& job) { return static_cast<RTCScene>(job.scene); }

// Where a kernel needs them: callbacks, context and flags. Triangles alone need none of it.
struct Callbacks {
    RTCFilterFunctionN filter = nullptr;
    RTCIntersectFunctionN intersect = nullptr;
    RTCOccludedFunctionN occluded = nullptr;
    RTCRayQueryContext* context = nullptr;
    unsigned flags = 0;
};

BENCH_INLINE RTCIntersectArguments intersectArguments(const Callbacks& c) {
    return {c.flags, RTC_FEATURE_FLAG_ALL, c.context, c.filter, c.intersect, 0.0f};
}
BENCH_INLINE RTCOccludedArguments occludedArguments(const Callbacks& c) {
    return {c.flags, RTC_FEATURE_FLAG_ALL, c.context, c.filter, c.occluded, 0.0f};
}

// ---- one ray

BENCH_INLINE void setRay(RTCRay& ray, Float3 origin, Float3 direction, float tfar) {
#ifdef BENCH_TUNED
    // Embree loads each four at once, right away; stored apart they would stall it. Few programs do this: it is measured as a form of its own.
    _mm_store_ps(&ray.org_x, _mm_setr_ps(origin.x, origin.y, origin.z, 0.0f));
    _mm_store_ps(&ray.dir_x, _mm_setr_ps(direction.x, direction.y, direction.z, 0.0f));
#else
    ray.org_x = origin.x;
    ray.org_y = origin.y;
    ray.org_z = origin.z;
    ray.tnear = 0.0f;
    ray.dir_x = direction.x;
    ray.dir_y = direction.y;
    ray.dir_z = direction.z;
    ray.time = 0.0f;
#endif
    ray.tfar = tfar;
    ray.mask = 0xFFFFFFFFu;
    ray.id = 0;
    ray.flags = 0;
}

// True if something was hit.
BENCH_INLINE bool intersect(const BenchJob& job, RTCRayHit& hit, Float3 origin, Float3 direction, RTCIntersectArguments* arguments = nullptr) {
    setRay(hit.ray, origin, direction, 1e16f);
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#ifdef BENCH_RECORD
    recorder().seek({origin, direction, 1e16f});
#endif
    rtcIntersect1(sceneOf(job), &hit, arguments);
    return hit.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

BENCH_INLINE bool occluded(const BenchJob& job, Float3 origin, Float3 direction, float tfar, RTCOccludedArguments* arguments = nullptr) {
    RTCRay ray;
    setRay(ray, origin, direction, tfar);
#ifdef BENCH_RECORD
    recorder().shadow({origin, direction, tfar});
#endif
    rtcOccluded1(sceneOf(job), &ray, arguments);
    return ray.tfar < 0.0f;
}

// ---- packets

// How the rays of a packet are traced: together along one path, together, one by one, or as the first where the rays' directions are
// alike and as the second where not.
enum class Form { COHERENT, PACKET, SINGLE, ADAPTIVE };

// Directions of one octant that lie close together: the rays visit much the same nodes.
BENCH_INLINE bool alike(Mask active, Wide3 direction) {
    const Wide zero(0.0f);
    const unsigned bits = bitsOf(active);
    const auto mixed = [&](Wide v) {
        const unsigned negative = bitsOf(active & (v < zero));
        return negative != 0 && negative != bits;
    };
    return !mixed(direction.x) && !mixed(direction.y) && !mixed(direction.z);
}

BENCH_INLINE void setRays(PacketRay& ray, Wide3 origin, Wide3 direction, Wide tfar) {
    store(ray.org_x, origin.x);
    store(ray.org_y, origin.y);
    store(ray.org_z, origin.z);
    store(ray.tnear, Wide(0.0f));
    store(ray.dir_x, direction.x);
    store(ray.dir_y, direction.y);
    store(ray.dir_z, direction.z);
    store(ray.time, Wide(0.0f));
    store(ray.tfar, tfar);
    store(ray.mask, WideUint(0xFFFFFFFFu));
    store(ray.flags, WideUint(0u));
}

struct PacketResult {
    Mask hit;
    Wide t, u, v;
    Wide3 ng;
    WideUint primitive, geometry;
};

BENCH_INLINE PacketResult resultOf(const PacketHit& packet, Mask active) {
    PacketResult result;
    result.geometry = load(packet.hit.geomID);
    result.hit = active & !(result.geometry == WideUint(RTC_INVALID_GEOMETRY_ID));
    result.t = load(packet.ray.tfar);
    result.u = load(packet.hit.u);
    result.v = load(packet.hit.v);
    result.ng = {load(packet.hit.Ng_x), load(packet.hit.Ng_y), load(packet.hit.Ng_z)};
    result.primitive = load(packet.hit.primID);
    return result;
}

inline void intersectLanes(RTCScene scene, PacketHit& packet, Mask active, RTCIntersectArguments* arguments) {
    for (unsigned bits = bitsOf(active); bits; bits &= bits - 1) {
        const unsigned i = unsigned(__builtin_ctz(bits));
        RTCRayHit one;
        setRay(one.ray, {packet.ray.org_x[i], packet.ray.org_y[i], packet.ray.org_z[i]},
               {packet.ray.dir_x[i], packet.ray.dir_y[i], packet.ray.dir_z[i]}, packet.ray.tfar[i]);
        one.ray.id = i;
        one.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        one.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene, &one, arguments);
        packet.ray.tfar[i] = one.ray.tfar;
        packet.hit.Ng_x[i] = one.hit.Ng_x;
        packet.hit.Ng_y[i] = one.hit.Ng_y;
        packet.hit.Ng_z[i] = one.hit.Ng_z;
        packet.hit.u[i] = one.hit.u;
        packet.hit.v[i] = one.hit.v;
        packet.hit.primID[i] = one.hit.primID;
        packet.hit.geomID[i] = one.hit.geomID;
    }
}

inline void occludedLanes(RTCScene scene, PacketRay& packet, Mask active, RTCOccludedArguments* arguments) {
    for (unsigned bits = bitsOf(active); bits; bits &= bits - 1) {
        const unsigned i = unsigned(__builtin_ctz(bits));
        RTCRay one;
        setRay(one, {packet.org_x[i], packet.org_y[i], packet.org_z[i]}, {packet.dir_x[i], packet.dir_y[i], packet.dir_z[i]},
               packet.tfar[i]);
        one.id = i;
        rtcOccluded1(scene, &one, arguments);
        packet.tfar[i] = one.tfar;
    }
}

BENCH_INLINE PacketResult intersect(const BenchJob& job, Form form, Mask active, Wide3 origin, Wide3 direction,
                                    const Callbacks& callbacks = {}) {
    alignas(64) PacketHit packet;
    alignas(64) int valid[LANES];
    setRays(packet.ray, origin, direction, Wide(1e16f));
    store(packet.ray.id, laneIndices());
    store(packet.hit.geomID, WideUint(RTC_INVALID_GEOMETRY_ID));
    store(packet.hit.instID[0], WideUint(RTC_INVALID_GEOMETRY_ID));
    RTCIntersectArguments arguments = intersectArguments(callbacks);
    if (form == Form::SINGLE) {
        intersectLanes(sceneOf(job), packet, active, &arguments);
    } else {
        if (form == Form::COHERENT || (form == Form::ADAPTIVE && alike(active, direction))) arguments.flags |= RTC_RAY_QUERY_FLAG_COHERENT;
        storeMask(valid, active);
        intersectN(valid, sceneOf(job), &packet, &arguments);
    }
    return resultOf(packet, active);
}

// The active lanes that reach tfar.
BENCH_INLINE Mask unoccluded(const BenchJob& job, Form form, Mask active, Wide3 origin, Wide3 direction, Wide tfar,
                             const Callbacks& callbacks = {}) {
    alignas(64) PacketRay packet;
    alignas(64) int valid[LANES];
    setRays(packet, origin, direction, tfar);
    store(packet.id, laneIndices());
    RTCOccludedArguments arguments = occludedArguments(callbacks);
    if (form == Form::SINGLE) {
        occludedLanes(sceneOf(job), packet, active, &arguments);
    } else {
        if (form == Form::COHERENT || (form == Form::ADAPTIVE && alike(active, direction))) arguments.flags |= RTC_RAY_QUERY_FLAG_COHERENT;
        storeMask(valid, active);
        occludedN(valid, sceneOf(job), &packet, &arguments);
    }
    return active & (load(packet.tfar) >= Wide(0.0f));
}

// ---- normals of triangles, from the vertices as a shader reads them or from Embree's hit

enum class NormalFrom { VERTICES, HIT };

template <NormalFrom from> BENCH_INLINE Float3 triangleNormal(const BenchJob& job, const RTCHit& hit) {
    if (from == NormalFrom::HIT) return normalize(Float3(hit.Ng_x, hit.Ng_y, hit.Ng_z));
    const uint32_t* corners = job.triangles + 3 * size_t(hit.primID);
    const Float3 p0(job.vertices + 3 * size_t(corners[0])), p1(job.vertices + 3 * size_t(corners[1]));
    const Float3 p2(job.vertices + 3 * size_t(corners[2]));
    return normalize(cross(p1 - p0, p2 - p0));
}

template <NormalFrom from> BENCH_INLINE Wide3 triangleNormal(const BenchJob& job, const PacketResult& hit, Mask mask) {
    if (from == NormalFrom::HIT) return normalize(hit.ng);
    const WideUint at = hit.primitive * WideUint(3u);
    const Wide3 p0 = gather3<Wide>(job.vertices, gather(job.triangles, at, mask), mask);
    const Wide3 p1 = gather3<Wide>(job.vertices, gather(job.triangles + 1, at, mask), mask);
    const Wide3 p2 = gather3<Wide>(job.vertices, gather(job.triangles + 2, at, mask), mask);
    return normalize(cross(p1 - p0, p2 - p0));
}

}  // namespace bench
#endif
