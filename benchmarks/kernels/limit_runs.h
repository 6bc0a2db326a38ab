// Traces recorded rays one by one and in packets; included at the end of a kernel's file, after its limitCallbacks().
#ifndef BENCH_LIMIT_RUNS_H
#define BENCH_LIMIT_RUNS_H

#include <stdio.h>

#include "limit.h"
#include "trace.h"

namespace bench {

inline void traceSingle(const BenchJob& job, const std::vector<RecordedRay>& rays, bool shadow, const Callbacks& callbacks) {
    RTCIntersectArguments intersection = intersectArguments(callbacks);
    RTCOccludedArguments occlusion = occludedArguments(callbacks);
    for (const RecordedRay& ray : rays) {
        if (shadow) {
            RTCRay one;
            setRay(one, ray.origin, ray.direction, ray.tfar);
            rtcOccluded1(sceneOf(job), &one, &occlusion);
        } else {
            RTCRayHit one;
            setRay(one.ray, ray.origin, ray.direction, ray.tfar);
            one.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect1(sceneOf(job), &one, &intersection);
        }
    }
}

inline void tracePackets(const BenchJob& job, const std::vector<RecordedRay>& rays, bool shadow, const Callbacks& callbacks, Form form,
                         bool transpose) {
    alignas(64) float columns[7][LANES];
    for (size_t first = 0; first < rays.size(); first += LANES) {
        const size_t count = rays.size() - first < LANES ? rays.size() - first : size_t(LANES);
        for (size_t lane = 0; lane < count; lane++) {
            const RecordedRay& ray = rays[transpose ? transposed(first + lane, rays.size()) : first + lane];
            const float values[7] = {ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z, ray.tfar};
            for (int i = 0; i < 7; i++) columns[i][lane] = values[i];
        }
        const Mask active = maskOf((1u << count) - 1);
        const Wide3 origin(load(columns[0]), load(columns[1]), load(columns[2]));
        const Wide3 direction(load(columns[3]), load(columns[4]), load(columns[5]));
        if (shadow)
            unoccluded(job, form, active, origin, direction, load(columns[6]), callbacks);
        else
            intersect(job, form, active, origin, direction, callbacks);
    }
}

inline BenchLimit limitOf(const BenchJob& job, const std::vector<RecordedRay>& rays, bool shadow, unsigned depth, const Callbacks& callbacks) {
    BenchLimit limit;
    snprintf(limit.name, sizeof limit.name, "%s %u", shadow ? "shadow" : "bounce", depth);
    if (!shadow && depth == 0) snprintf(limit.name, sizeof limit.name, "primary");
    limit.rays = rays.size();
    limit.single = limit.packet = limit.coherent = 1e9;
    const auto keep = [](double& best, double seconds) { best = seconds < best ? seconds : best; };
    for (int round = 0; round < 3; round++) {
        keep(limit.single, secondsOf([&] { traceSingle(job, rays, shadow, callbacks); }));
        for (bool transpose : {false, true}) {
            if (transpose && !shadow) continue;
            keep(limit.packet, secondsOf([&] { tracePackets(job, rays, shadow, callbacks, Form::PACKET, transpose); }));
            keep(limit.coherent, secondsOf([&] { tracePackets(job, rays, shadow, callbacks, Form::COHERENT, transpose); }));
        }
    }
    return limit;
}

// Runs `kernel` once to note its rays, then times every class; the number of classes.
inline int limits(BenchJob& job, void (*kernel)(BenchJob&), const Callbacks& callbacks, BenchLimit* results, int capacity) {
    recorder() = Recorder();
    kernel(job);
    const Recorder recorded = recorder();
    int count = 0;
    for (unsigned depth = 0; depth < recorded.hits.size() && count < capacity; depth++)
        results[count++] = limitOf(job, recorded.hits[depth], false, depth, callbacks);
    for (unsigned depth = 0; depth < recorded.shadows.size() && count < capacity; depth++)
        results[count++] = limitOf(job, recorded.shadows[depth], true, depth, callbacks);
    return count;
}

}  // namespace bench
#endif
