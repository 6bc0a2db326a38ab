// Primary rays, coloured by the interpolated vertex normal: shaders/primary.py by hand.
#include "launch.h"
#include "trace.h"

namespace bench {
namespace {

Float3 shade(const BenchJob& job, const RTCHit& hit) {
    const uint32_t* corners = job.triangles + 3 * size_t(hit.primID);
    const Float3 n0(job.normals + 3 * size_t(corners[0])), n1(job.normals + 3 * size_t(corners[1]));
    const Float3 n2(job.normals + 3 * size_t(corners[2]));
    const Float3 n = normalize((1.0f - hit.u - hit.v) * n0 + hit.u * n1 + hit.v * n2);
    return 0.5f * n + Float3(0.5f, 0.5f, 0.5f);
}

Wide3 shade(const BenchJob& job, const PacketResult& hit) {
    const WideUint at = hit.primitive * WideUint(3u);
    const Wide3 n0 = gather3<Wide>(job.normals, gather(job.triangles, at, hit.hit), hit.hit);
    const Wide3 n1 = gather3<Wide>(job.normals, gather(job.triangles + 1, at, hit.hit), hit.hit);
    const Wide3 n2 = gather3<Wide>(job.normals, gather(job.triangles + 2, at, hit.hit), hit.hit);
    const Wide3 n = normalize((Wide(1.0f) - hit.u - hit.v) * n0 + hit.u * n1 + hit.v * n2);
    const Wide half(0.5f), zero(0.0f);
    return select(hit.hit, half * n + Wide3(half, half, half), Wide3(zero, zero, zero));
}

void scalar(BenchJob& job) {
    launchPixels(job, [&](Worker& worker, uint32_t x, uint32_t y) {
        RTCRayHit hit;
        worker.rays++;
        const bool found = intersect(job, hit, Float3(job.eye), cameraDirection<float>(job, x, imageRow(job, y)));
        writePixel(job, x, y, found ? shade(job, hit.hit) : Float3(0.0f, 0.0f, 0.0f));
    });
}

template <Form form> void packet(BenchJob& job) {
    launchBlocks(job, [&](Worker& worker, const Block& block) {
        worker.rays += countOf(block.active);
        const PacketResult hit = intersect(job, form, block.active, Wide3(job.eye), cameraDirection<Wide>(job, block.px, block.py));
        writeBlock(job, block, shade(job, hit));
    });
}

}  // namespace
}  // namespace bench

extern "C" __attribute__((visibility("default"))) void primary_scalar(BenchJob* job) { bench::scalar(*job); }
extern "C" __attribute__((visibility("default"))) void primary_coherent(BenchJob* job) { bench::packet<bench::Form::COHERENT>(*job); }
extern "C" __attribute__((visibility("default"))) void primary_packet(BenchJob* job) { bench::packet<bench::Form::PACKET>(*job); }

#ifdef BENCH_RECORD
#include "limit_runs.h"
extern "C" __attribute__((visibility("default"))) int primary_limits(BenchJob* job, BenchLimit* results, int capacity) {
    return bench::limits(*job, bench::scalar, bench::Callbacks(), results, capacity);
}
#endif
