// Ambient occlusion with 16 rays: shaders/ambient_occlusion.py by hand. The packet kernels differ in what a packet of occlusion rays
// is: one ray each of 16 pixels, or all rays of one pixel.
#include "launch.h"
#include "trace.h"

namespace bench {
namespace {

constexpr int SAMPLES = 16;

// Direction number `index` about +z, one from each of 4x4 strata.
template <class F> BENCH_INLINE Vec<F> sample(UintOf<F> index, Random<F>& random) {
    using U = UintOf<F>;
    const F column = toFloat(index & U(3u)), row = toFloat(index >> 2u);
    const F u1 = (column + random.next()) * F(0.25f), u2 = (row + random.next()) * F(0.25f);
    return cosineHemisphere(u1, u2);
}

template <NormalFrom from> void scalar(BenchJob& job) {
    launchPixels(job, [&](Worker& worker, uint32_t x, uint32_t y) {
        const uint32_t row = imageRow(job, y);
        const Float3 direction = cameraDirection<float>(job, x, row);
        RTCRayHit hit;
        worker.rays++;
        float open = 0.0f;
        if (intersect(job, hit, Float3(job.eye), direction)) {
            const Float3 n = facing(triangleNormal<from>(job, hit.hit), direction);
            const Float3 origin = Float3(job.eye) + hit.ray.tfar * direction + job.offset * n;
            Float3 s, t;
            tangents(n, s, t);
            Random<float> random{pcgHash(row * job.width + x)};
            worker.rays += SAMPLES;
            for (int i = 0; i < SAMPLES; i++) {
                const Float3 local = sample<float>(uint32_t(i), random);
                if (!occluded(job, origin, local.x * s + local.y * t + local.z * n, job.radius)) open += 1.0f;
            }
        }
        open *= 1.0f / float(SAMPLES);
        writePixel(job, x, y, {open, open, open});
    });
}

template <NormalFrom from, Form form> void packet(BenchJob& job) {
    launchBlocks(job, [&](Worker& worker, const Block& block) {
        const Wide3 direction = cameraDirection<Wide>(job, block.px, block.py);
        worker.rays += countOf(block.active);
        const PacketResult hit = intersect(job, Form::COHERENT, block.active, Wide3(job.eye), direction);
        Wide open(0.0f);
        if (any(hit.hit)) {
            const Wide3 n = facing(triangleNormal<from>(job, hit, hit.hit), direction);
            const Wide3 origin = Wide3(job.eye) + hit.t * direction + Wide(job.offset) * n;
            Wide3 s, t;
            tangents(n, s, t);
            Random<Wide> random{pcgHash(block.py * WideUint(job.width) + block.px)};
            worker.rays += unsigned(SAMPLES) * countOf(hit.hit);
            for (int i = 0; i < SAMPLES; i++) {
                const Wide3 local = sample<Wide>(WideUint(uint32_t(i)), random);
                const Mask visible =
                    unoccluded(job, form, hit.hit, origin, local.x * s + local.y * t + local.z * n, Wide(job.radius));
                open = select(visible, open + Wide(1.0f), open);
            }
        }
        open = open * Wide(1.0f / float(SAMPLES));
        writeBlock(job, block, {open, open, open});
    });
}

// Where a lane's PCG stream stands after 2 x lane numbers: state x multiplier + increment.
struct Jump {
    alignas(64) uint32_t multiplier[SAMPLES], increment[SAMPLES];
    Jump() {
        uint32_t m = 1, c = 0;
        for (int lane = 0; lane < SAMPLES; lane++) {
            multiplier[lane] = m;
            increment[lane] = c;
            for (int i = 0; i < 2; i++) {
                c = pcgStep(c);
                m *= 747796405u;
            }
        }
    }
};

template <NormalFrom from> void samples(BenchJob& job) {
    const Jump jump;
    launchBlocks(job, [&](Worker& worker, const Block& block) {
        const Wide3 direction = cameraDirection<Wide>(job, block.px, block.py);
        worker.rays += countOf(block.active);
        const PacketResult hit = intersect(job, Form::COHERENT, block.active, Wide3(job.eye), direction);
        alignas(64) float open[LANES] = {};
        if (any(hit.hit)) {
            const Wide3 n = facing(triangleNormal<from>(job, hit, hit.hit), direction);
            const Wide3 origin = Wide3(job.eye) + hit.t * direction + Wide(job.offset) * n;
            Wide3 s, t;
            tangents(n, s, t);
            alignas(64) float frame[12][LANES];
            const Wide columns[12] = {origin.x, origin.y, origin.z, s.x, s.y, s.z, t.x, t.y, t.z, n.x, n.y, n.z};
            for (int i = 0; i < 12; i++) store(frame[i], columns[i]);
            alignas(64) unsigned seeds[LANES];
            store(seeds, pcgHash(block.py * WideUint(job.width) + block.px));
            worker.rays += unsigned(SAMPLES) * countOf(hit.hit);
            for (unsigned bits = bitsOf(hit.hit); bits; bits &= bits - 1) {
                const unsigned lane = unsigned(__builtin_ctz(bits));
                const auto vector = [&](int row) { return Wide3(frame[row][lane], frame[row + 1][lane], frame[row + 2][lane]); };
                unsigned visible = 0;
                for (int first = 0; first < SAMPLES; first += LANES) {
                    Random<Wide> random{WideUint(seeds[lane]) * load(jump.multiplier + first) + load(jump.increment + first)};
                    const Wide3 local = sample<Wide>(laneIndices() + WideUint(uint32_t(first)), random);
                    visible += countOf(unoccluded(job, Form::PACKET, maskOf((1u << LANES) - 1), vector(0),
                                                  local.x * vector(3) + local.y * vector(6) + local.z * vector(9), Wide(job.radius)));
                }
                open[lane] = float(visible) * (1.0f / float(SAMPLES));
            }
        }
        const Wide value = load(open);
        writeBlock(job, block, {value, value, value});
    });
}

}  // namespace
}  // namespace bench

using bench::Form;
using bench::NormalFrom;
extern "C" __attribute__((visibility("default"))) void ambient_occlusion_scalar(BenchJob* job) { bench::scalar<NormalFrom::VERTICES>(*job); }
extern "C" __attribute__((visibility("default"))) void ambient_occlusion_scalar_ng(BenchJob* job) { bench::scalar<NormalFrom::HIT>(*job); }
extern "C" __attribute__((visibility("default"))) void ambient_occlusion_packet(BenchJob* job) { bench::packet<NormalFrom::VERTICES, Form::PACKET>(*job); }
extern "C" __attribute__((visibility("default"))) void ambient_occlusion_packet_ng(BenchJob* job) { bench::packet<NormalFrom::HIT, Form::PACKET>(*job); }
extern "C" __attribute__((visibility("default"))) void ambient_occlusion_single(BenchJob* job) { bench::packet<NormalFrom::VERTICES, Form::SINGLE>(*job); }
extern "C" __attribute__((visibility("default"))) void ambient_occlusion_coherent(BenchJob* job) { bench::packet<NormalFrom::VERTICES, Form::COHERENT>(*job); }
extern "C" __attribute__((visibility("default"))) void ambient_occlusion_adaptive(BenchJob* job) { bench::packet<NormalFrom::VERTICES, Form::ADAPTIVE>(*job); }
extern "C" __attribute__((visibility("default"))) void ambient_occlusion_samples(BenchJob* job) { bench::samples<NormalFrom::VERTICES>(*job); }

#ifdef BENCH_RECORD
#include "limit_runs.h"
extern "C" __attribute__((visibility("default"))) int ambient_occlusion_limits(BenchJob* job, BenchLimit* results, int capacity) {
    return bench::limits(*job, bench::scalar<NormalFrom::VERTICES>, bench::Callbacks(), results, capacity);
}
#endif
