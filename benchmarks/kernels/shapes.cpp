// Primary rays against Embree's round curves or spheres: shaders/shapes.py by hand.
#include "launch.h"
#include "trace.h"

namespace bench {
namespace {

void scalar(BenchJob& job) {
    launchPixels(job, [&](Worker& worker, uint32_t x, uint32_t y) {
        RTCRayHit hit;
        worker.rays++;
        const bool found = intersect(job, hit, Float3(job.eye), cameraDirection<float>(job, x, imageRow(job, y)));
        const uint32_t number = hit.hit.primID;
        writePixel(job, x, y, found ? Float3(hit.ray.tfar, float(number & 255), float(number >> 8 & 255)) : Float3(0.0f, 0.0f, 0.0f));
    });
}

template <Form form> void packet(BenchJob& job) {
    launchBlocks(job, [&](Worker& worker, const Block& block) {
        worker.rays += countOf(block.active);
        const PacketResult hit = intersect(job, form, block.active, Wide3(job.eye), cameraDirection<Wide>(job, block.px, block.py));
        const WideUint low(255u);
        const Wide zero(0.0f);
        const Wide3 value(hit.t, toFloat(hit.primitive & low), toFloat((hit.primitive >> 8u) & low));
        writeBlock(job, block, select(hit.hit, value, Wide3(zero, zero, zero)));
    });
}

}  // namespace
}  // namespace bench

extern "C" __attribute__((visibility("default"))) void shapes_scalar(BenchJob* job) { bench::scalar(*job); }
extern "C" __attribute__((visibility("default"))) void shapes_coherent(BenchJob* job) { bench::packet<bench::Form::COHERENT>(*job); }
extern "C" __attribute__((visibility("default"))) void shapes_packet(BenchJob* job) { bench::packet<bench::Form::PACKET>(*job); }

#ifdef BENCH_RECORD
#include "limit_runs.h"
extern "C" __attribute__((visibility("default"))) int shapes_limits(BenchJob* job, BenchLimit* results, int capacity) {
    return bench::limits(*job, bench::scalar, bench::Callbacks(), results, capacity);
}
#endif
