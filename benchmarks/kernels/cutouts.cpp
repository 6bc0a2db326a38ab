// Alpha cut-outs of shaders/cutouts.py by hand: a filter function that rejects hits where the leaf's texture is transparent.
#include "launch.h"
#include "trace.h"

namespace bench {
namespace {

struct Context : RTCRayQueryContext {
    const BenchJob* job;
};

Context contextFor(const BenchJob& job) {
    Context context;
    context.instID[0] = context.instPrimID[0] = RTC_INVALID_GEOMETRY_ID;
    context.job = &job;
    return context;
}

// The nearest texel, R in the low byte.
template <class F> BENCH_INLINE UintOf<F> texel(const BenchJob& job, UintOf<F> primitive, F u, F v, BoolOf<F> mask) {
    using U = UintOf<F>;
    const U at = primitive * U(3u);
    const U c0 = gather(job.triangles, at, mask) * U(2u), c1 = gather(job.triangles + 1, at, mask) * U(2u);
    const U c2 = gather(job.triangles + 2, at, mask) * U(2u);
    const F w = F(1.0f) - u - v;
    const F x = w * gather(job.uvs, c0, mask) + u * gather(job.uvs, c1, mask) + v * gather(job.uvs, c2, mask);
    const F y = w * gather(job.uvs + 1, c0, mask) + u * gather(job.uvs + 1, c1, mask) + v * gather(job.uvs + 1, c2, mask);
    const F width = F(float(job.texelWidth)), height = F(float(job.texelHeight));
    const F last(-1.0f);
    const U column = toInteger(minimum(maximum(x * width, F(0.0f)), width + last));
    const U row = toInteger(minimum(maximum(y * height, F(0.0f)), height + last));
    return gather(reinterpret_cast<const uint32_t*>(job.texels), row * U(job.texelWidth) + column, mask);
}

void alphaFilter(const RTCFilterFunctionNArguments* arguments) {
    const BenchJob& job = *static_cast<const Context*>(arguments->context)->job;
    if (arguments->N == 1) {
        const RTCHit& hit = *static_cast<const RTCHit*>(arguments->hit);
        if (texel<float>(job, hit.primID, hit.u, hit.v, true) >> 24 < 128u) arguments->valid[0] = 0;
        return;
    }
    using PacketHits = decltype(PacketHit::hit);
    const PacketHits& hit = *static_cast<const PacketHits*>(arguments->hit);
    const Mask valid = loadMask(arguments->valid);
    const WideUint alpha = texel<Wide>(job, load(hit.primID), load(hit.u), load(hit.v), valid) >> 24u;
    storeMasked(arguments->valid, valid & (alpha < WideUint(128u)), WideUint(0u));
}

Callbacks callbacksOf(Context& context) {
    Callbacks callbacks;
    callbacks.filter = alphaFilter;
    callbacks.context = &context;
    callbacks.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
    return callbacks;
}

template <class F> BENCH_INLINE Vec<F> colorOf(UintOf<F> texel) {
    using U = UintOf<F>;
    const Vec<F> bytes = {toFloat(texel & U(255u)), toFloat((texel >> 8u) & U(255u)), toFloat((texel >> 16u) & U(255u))};
    return F(1.0f / 255.0f) * bytes;
}

template <NormalFrom from> void scalar(BenchJob& job) {
    launchPixels(job, [&](Worker& worker, uint32_t x, uint32_t y) {
        Context context = contextFor(job);
        const Callbacks callbacks = callbacksOf(context);
        RTCIntersectArguments arguments = intersectArguments(callbacks);
        const Float3 direction = cameraDirection<float>(job, x, imageRow(job, y)), sun(job.sun);
        RTCRayHit hit;
        worker.rays++;
        if (!intersect(job, hit, Float3(job.eye), direction, &arguments)) return writePixel(job, x, y, Float3(job.sky));
        const Float3 n = facing(triangleNormal<from>(job, hit.hit), direction);
        const float cosine = dot(n, sun);
        float light = 0.3f;
        if (cosine > 0.0f) {
            RTCOccludedArguments shadow = occludedArguments(callbacks);
            worker.rays++;
            const Float3 origin = Float3(job.eye) + hit.ray.tfar * direction + job.offset * n;
            if (!occluded(job, origin, sun, 1e16f, &shadow)) light = 0.3f + 0.7f * cosine;
        }
        writePixel(job, x, y, light * colorOf<float>(texel<float>(job, hit.hit.primID, hit.hit.u, hit.hit.v, true)));
    });
}

template <NormalFrom from, Form first, Form shadow> void packet(BenchJob& job) {
    launchBlocks(job, [&](Worker& worker, const Block& block) {
        Context context = contextFor(job);
        const Callbacks callbacks = callbacksOf(context);
        const Wide3 direction = cameraDirection<Wide>(job, block.px, block.py), sun(job.sun);
        worker.rays += countOf(block.active);
        const PacketResult hit = intersect(job, first, block.active, Wide3(job.eye), direction, callbacks);
        Wide3 color(job.sky);
        if (any(hit.hit)) {
            const Wide3 n = facing(triangleNormal<from>(job, hit, hit.hit), direction);
            const Wide cosine = dot(n, sun);
            Wide light(0.3f);
            const Mask towards = hit.hit & (cosine > Wide(0.0f));
            if (any(towards)) {
                worker.rays += countOf(towards);
                const Wide3 origin = Wide3(job.eye) + hit.t * direction + Wide(job.offset) * n;
                const Mask lit = unoccluded(job, shadow, towards, origin, sun, Wide(1e16f), callbacks);
                light = select(lit, Wide(0.3f) + Wide(0.7f) * cosine, light);
            }
            color = select(hit.hit, light * colorOf<Wide>(texel<Wide>(job, hit.primitive, hit.u, hit.v, hit.hit)), color);
        }
        writeBlock(job, block, color);
    });
}

}  // namespace
}  // namespace bench

using bench::Form;
using bench::NormalFrom;
extern "C" __attribute__((visibility("default"))) void cutouts_scalar(BenchJob* job) { bench::scalar<NormalFrom::VERTICES>(*job); }
extern "C" __attribute__((visibility("default"))) void cutouts_scalar_ng(BenchJob* job) { bench::scalar<NormalFrom::HIT>(*job); }
extern "C" __attribute__((visibility("default"))) void cutouts_packet(BenchJob* job) { bench::packet<NormalFrom::VERTICES, Form::COHERENT, Form::PACKET>(*job); }
extern "C" __attribute__((visibility("default"))) void cutouts_coherent(BenchJob* job) { bench::packet<NormalFrom::VERTICES, Form::COHERENT, Form::COHERENT>(*job); }
extern "C" __attribute__((visibility("default"))) void cutouts_plain(BenchJob* job) { bench::packet<NormalFrom::VERTICES, Form::PACKET, Form::PACKET>(*job); }
extern "C" __attribute__((visibility("default"))) void cutouts_single(BenchJob* job) { bench::packet<NormalFrom::VERTICES, Form::SINGLE, Form::SINGLE>(*job); }
extern "C" __attribute__((visibility("default"))) void cutouts_single_shadow(BenchJob* job) { bench::packet<NormalFrom::VERTICES, Form::COHERENT, Form::SINGLE>(*job); }

#ifdef BENCH_RECORD
#include "limit_runs.h"
extern "C" __attribute__((visibility("default"))) int cutouts_limits(BenchJob* job, BenchLimit* results, int capacity) {
    bench::Context context = bench::contextFor(*job);
    return bench::limits(*job, bench::scalar<NormalFrom::VERTICES>, bench::callbacksOf(context), results, capacity);
}
#endif
