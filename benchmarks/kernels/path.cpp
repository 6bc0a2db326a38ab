// The path tracer of shaders/path.py by hand, with its light and its heavy surface.
#include "launch.h"
#include "surface.h"
#include "trace.h"

namespace bench {
namespace {

enum { DEPTH = 8, ROULETTE_FROM = 3 };
enum class Surface { MATTE, PRINCIPLED };
enum { MESH_GEOMETRY = 0, LIGHT_GEOMETRY = 1 };

template <class F> struct State {
    Vec<F> origin, direction, color, throughput;
    Random<F> random;
};

// What shading a hit needs besides the state.
template <class F> struct Point {
    Vec<F> n, position, origin, shadingNormal;
    Principled<F> surface;
};

template <class F> BENCH_INLINE void perturb(const BenchJob& job, Point<F>& point) {
    const Vec<F> q = F(job.noiseScale) * point.position;
    const auto at = [&](float shift) { return octaves(q + Vec<F>(F(shift), F(shift), F(shift)), 4); };
    point.surface.color = (F(0.7f) + F(0.3f) * octaves(q, 4)) * point.surface.color;
    point.surface.roughness = minimum(maximum(point.surface.roughness + F(0.2f) * at(17.0f), F(0.05f)), F(1.0f));
    const Vec<F> slopes = {at(31.0f), at(47.0f), at(61.0f)};
    point.shadingNormal = normalize(point.n + F(0.2f) * slopes);
}

template <class F> struct LightSample {
    Vec<F> wi, incoming;
    F distance;
    BoolOf<F> lit;
};

template <class F> BENCH_INLINE LightSample<F> sampleLight(const BenchJob& job, const Point<F>& point, F u1, F u2) {
    const BenchLight& light = job.light;
    const Vec<F> toLight = Vec<F>(light.corner) + u1 * Vec<F>(light.edgeU) + u2 * Vec<F>(light.edgeV) - point.origin;
    const F distance2 = dot(toLight, toLight);
    LightSample<F> sample;
    sample.distance = squareRoot(distance2);
    sample.wi = (F(1.0f) / sample.distance) * toLight;
    const F cosine = dot(point.shadingNormal, sample.wi), cosineLight = -dot(Vec<F>(light.n), sample.wi);
    sample.lit = both(cosine > F(0.0f), cosineLight > F(0.0f));
    sample.incoming = (cosine * cosineLight * F(light.area) / distance2) * Vec<F>(light.radiance);
    return sample;
}

// ---- scalar

Float3 brdf(const Point<float>& point, Float3 wo, Float3 wi) {
    const float nl = dot(point.shadingNormal, wi), nv = dot(point.shadingNormal, wo);
    if (nl <= 0.0f || nv <= 0.0f) return {0.0f, 0.0f, 0.0f};
    return principledAbove(point.surface, nl, nv, point.shadingNormal, wo, wi);
}

// Adds what is seen at the hit and sets up the next ray; false if the path ends.
template <Surface surface, NormalFrom from>
BENCH_INLINE bool shade(const BenchJob& job, Worker& worker, State<float>& path, const RTCRayHit& hit) {
    Point<float> point;
    point.n = facing(triangleNormal<from>(job, hit.hit), path.direction);
    point.position = path.origin + hit.ray.tfar * path.direction;
    point.origin = point.position + job.offset * point.n;
    point.shadingNormal = point.n;
    const BenchMaterial& material = job.materials[job.materialOf[hit.hit.primID]];
    point.surface.color = Float3(material.color);
    if (surface == Surface::PRINCIPLED) {
        point.surface.metallic = material.metallic;
        point.surface.roughness = material.roughness;
        point.surface.specular = material.specular;
        point.surface.sheen = material.sheen;
        point.surface.clearcoat = material.clearcoat;
        perturb(job, point);
    }
    const float u1 = path.random.next(), u2 = path.random.next();
    const LightSample<float> light = sampleLight(job, point, u1, u2);
    if (light.lit) {
        worker.rays++;
        if (!occluded(job, point.origin, light.wi, 0.999f * light.distance)) {
            const Float3 value = surface == Surface::MATTE ? 0.318309886f * point.surface.color : brdf(point, -path.direction, light.wi);
            path.color = path.color + path.throughput * (value * light.incoming);
        }
    }
    const float u3 = path.random.next(), u4 = path.random.next();
    const Float3 wi = cosineAbout(point.n, u3, u4);
    if (surface == Surface::MATTE) {
        path.throughput = path.throughput * point.surface.color;
    } else {
        const float cosine = dot(point.n, wi);
        if (cosine <= 0.0f) return false;
        const float weight = 3.141592654f * maximum(dot(point.shadingNormal, wi), 0.0f) / cosine;
        path.throughput = path.throughput * (weight * brdf(point, -path.direction, wi));
    }
    path.origin = point.origin;
    path.direction = wi;
    return true;
}

template <Surface surface, NormalFrom from> void scalar(BenchJob& job) {
    launchPixels(job, [&](Worker& worker, uint32_t x, uint32_t y) {
        const uint32_t row = imageRow(job, y);
        State<float> path;
        path.origin = Float3(job.eye);
        path.direction = cameraDirection<float>(job, x, row);
        path.color = {0.0f, 0.0f, 0.0f};
        path.throughput = {1.0f, 1.0f, 1.0f};
        path.random.state = pcgHash(row * job.width + x);
        for (int bounce = 0; bounce < DEPTH; bounce++) {
            RTCRayHit hit;
            worker.rays++;
            if (!intersect(job, hit, path.origin, path.direction)) {
                path.color = path.color + path.throughput * Float3(job.sky);
                break;
            }
            if (hit.hit.geomID == LIGHT_GEOMETRY) {
                if (bounce == 0 && dot(Float3(job.light.n), path.direction) < 0.0f) path.color = path.color + Float3(job.light.radiance);
                break;
            }
            if (!shade<surface, from>(job, worker, path, hit)) break;
            if (bounce >= ROULETTE_FROM) {
                const float brightest = maximum(path.throughput.x, maximum(path.throughput.y, path.throughput.z));
                const float survival = minimum(brightest, 0.95f);
                if (path.random.next() >= survival) break;
                path.throughput = (1.0f / survival) * path.throughput;
            }
        }
        writePixel(job, x, y, path.color);
    });
}

// ---- packets

Wide3 brdf(const Point<Wide>& point, Wide3 wo, Wide3 wi, Mask mask) {
    const Wide nl = dot(point.shadingNormal, wi), nv = dot(point.shadingNormal, wo), zero(0.0f);
    const Mask above = mask & (nl > zero) & (nv > zero);
    if (!any(above)) return {zero, zero, zero};
    return select(above, principledAbove(point.surface, nl, nv, point.shadingNormal, wo, wi), Wide3(zero, zero, zero));
}

BENCH_INLINE void addWhere(Mask mask, Wide3& sum, Wide3 value) { sum = select(mask, sum + value, sum); }

BENCH_INLINE Wide materialField(const BenchJob& job, WideUint material, Mask mask, const float BenchMaterial::*field) {
    return gather(&(job.materials[0].*field), material * WideUint(uint32_t(sizeof(BenchMaterial) / 4)), mask);
}

// The lanes of `mask` whose paths go on.
template <Surface surface, NormalFrom from, Form form>
BENCH_INLINE Mask shade(const BenchJob& job, Worker& worker, State<Wide>& path, const PacketResult& hit, Mask mask) {
    const Wide zero(0.0f);
    Point<Wide> point;
    point.n = facing(triangleNormal<from>(job, hit, mask), path.direction);
    point.position = path.origin + hit.t * path.direction;
    point.origin = point.position + Wide(job.offset) * point.n;
    point.shadingNormal = point.n;
    const WideUint material = gather(job.materialOf, hit.primitive, mask);
    const WideUint at = material * WideUint(uint32_t(sizeof(BenchMaterial) / 4));
    const float* color = job.materials[0].color;
    point.surface.color = {gather(color, at, mask), gather(color + 1, at, mask), gather(color + 2, at, mask)};
    if (surface == Surface::PRINCIPLED) {
        point.surface.metallic = materialField(job, material, mask, &BenchMaterial::metallic);
        point.surface.roughness = materialField(job, material, mask, &BenchMaterial::roughness);
        point.surface.specular = materialField(job, material, mask, &BenchMaterial::specular);
        point.surface.sheen = materialField(job, material, mask, &BenchMaterial::sheen);
        point.surface.clearcoat = materialField(job, material, mask, &BenchMaterial::clearcoat);
        perturb(job, point);
    }
    const Wide u1 = path.random.next(), u2 = path.random.next();
    const LightSample<Wide> light = sampleLight(job, point, u1, u2);
    const Mask lit = light.lit & mask;
    if (any(lit)) {
        worker.rays += countOf(lit);
        const Mask visible = unoccluded(job, form, lit, point.origin, light.wi, Wide(0.999f) * light.distance);
        if (any(visible)) {
            const Wide3 value = surface == Surface::MATTE ? Wide(0.318309886f) * point.surface.color
                                                          : brdf(point, -path.direction, light.wi, visible);
            addWhere(visible, path.color, path.throughput * (value * light.incoming));
        }
    }
    const Wide u3 = path.random.next(), u4 = path.random.next();
    const Wide3 wi = cosineAbout(point.n, u3, u4);
    if (surface == Surface::MATTE) {
        path.throughput = path.throughput * point.surface.color;
    } else {
        const Wide cosine = dot(point.n, wi);
        mask = mask & (cosine > zero);
        const Wide weight = Wide(3.141592654f) * maximum(dot(point.shadingNormal, wi), zero) / cosine;
        path.throughput = path.throughput * (weight * brdf(point, -path.direction, wi, mask));
    }
    path.origin = point.origin;
    path.direction = wi;
    return mask;
}

// `bounces`: how rays after the first trace are traced. `firstShadow`: how the shadow rays of the first hit are.
template <Surface surface, NormalFrom from, Form bounces, Form firstShadow> void packet(BenchJob& job) {
    launchBlocks(job, [&](Worker& worker, const Block& block) {
        State<Wide> path;
        path.origin = Wide3(job.eye);
        path.direction = cameraDirection<Wide>(job, block.px, block.py);
        path.color = Wide3(0.0f, 0.0f, 0.0f);
        path.throughput = Wide3(1.0f, 1.0f, 1.0f);
        path.random.state = pcgHash(block.py * WideUint(job.width) + block.px);
        Mask active = block.active;
        for (int bounce = 0; bounce < DEPTH && any(active); bounce++) {
            worker.rays += countOf(active);
            const PacketResult hit = intersect(job, bounce == 0 ? Form::COHERENT : bounces, active, path.origin, path.direction);
            addWhere(active & !hit.hit, path.color, path.throughput * Wide3(job.sky));
            const Mask onLight = hit.hit & (hit.geometry == WideUint(uint32_t(LIGHT_GEOMETRY)));
            if (bounce == 0 && any(onLight))
                addWhere(onLight & (dot(Wide3(job.light.n), path.direction) < Wide(0.0f)), path.color, Wide3(job.light.radiance));
            active = hit.hit & !onLight;
            if (!any(active)) break;
            active = bounce == 0 ? shade<surface, from, firstShadow>(job, worker, path, hit, active)
                                 : shade<surface, from, bounces>(job, worker, path, hit, active);
            if (bounce >= ROULETTE_FROM) {
                const Wide brightest = maximum(path.throughput.x, maximum(path.throughput.y, path.throughput.z));
                const Wide survival = minimum(brightest, Wide(0.95f));
                active = active & (path.random.next() < survival);
                path.throughput = (Wide(1.0f) / survival) * path.throughput;
            }
        }
        writeBlock(job, block, path.color);
    });
}

}  // namespace
}  // namespace bench

using bench::Form;
using bench::NormalFrom;
using bench::Surface;
extern "C" __attribute__((visibility("default"))) void path_scalar(BenchJob* job) { bench::scalar<Surface::MATTE, NormalFrom::VERTICES>(*job); }
extern "C" __attribute__((visibility("default"))) void path_scalar_ng(BenchJob* job) { bench::scalar<Surface::MATTE, NormalFrom::HIT>(*job); }
extern "C" __attribute__((visibility("default"))) void path_packet(BenchJob* job) { bench::packet<Surface::MATTE, NormalFrom::VERTICES, Form::PACKET, Form::PACKET>(*job); }
extern "C" __attribute__((visibility("default"))) void path_packet_ng(BenchJob* job) { bench::packet<Surface::MATTE, NormalFrom::HIT, Form::PACKET, Form::PACKET>(*job); }
extern "C" __attribute__((visibility("default"))) void path_shadow(BenchJob* job) { bench::packet<Surface::MATTE, NormalFrom::VERTICES, Form::PACKET, Form::COHERENT>(*job); }
extern "C" __attribute__((visibility("default"))) void path_single(BenchJob* job) { bench::packet<Surface::MATTE, NormalFrom::VERTICES, Form::SINGLE, Form::PACKET>(*job); }
extern "C" __attribute__((visibility("default"))) void path_adaptive(BenchJob* job) { bench::packet<Surface::MATTE, NormalFrom::VERTICES, Form::ADAPTIVE, Form::ADAPTIVE>(*job); }
extern "C" __attribute__((visibility("default"))) void heavy_scalar(BenchJob* job) { bench::scalar<Surface::PRINCIPLED, NormalFrom::VERTICES>(*job); }
extern "C" __attribute__((visibility("default"))) void heavy_scalar_ng(BenchJob* job) { bench::scalar<Surface::PRINCIPLED, NormalFrom::HIT>(*job); }
extern "C" __attribute__((visibility("default"))) void heavy_packet_ng(BenchJob* job) { bench::packet<Surface::PRINCIPLED, NormalFrom::HIT, Form::PACKET, Form::PACKET>(*job); }
extern "C" __attribute__((visibility("default"))) void heavy_packet(BenchJob* job) { bench::packet<Surface::PRINCIPLED, NormalFrom::VERTICES, Form::PACKET, Form::PACKET>(*job); }
extern "C" __attribute__((visibility("default"))) void heavy_single(BenchJob* job) { bench::packet<Surface::PRINCIPLED, NormalFrom::VERTICES, Form::SINGLE, Form::PACKET>(*job); }

#ifdef BENCH_RECORD
#include "limit_runs.h"
extern "C" __attribute__((visibility("default"))) int path_limits(BenchJob* job, BenchLimit* results, int capacity) {
    return bench::limits(*job, bench::scalar<Surface::MATTE, NormalFrom::VERTICES>, bench::Callbacks(), results, capacity);
}
extern "C" __attribute__((visibility("default"))) int heavy_limits(BenchJob* job, BenchLimit* results, int capacity) {
    return bench::limits(*job, bench::scalar<Surface::PRINCIPLED, NormalFrom::VERTICES>, bench::Callbacks(), results, capacity);
}
#endif
