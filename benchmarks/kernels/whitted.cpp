// Whitted's picture of shaders/whitted.py by hand: spheres and a floor as user geometry, recursion, shadow rays that glass attenuates.
#include "launch.h"
#include "trace.h"

namespace bench {
namespace {

constexpr int DEPTH = 6;
constexpr float FAINTEST = 0.02f;
enum { SPHERES = 0, FLOOR = 1 };
enum { GLASS = 0, METAL = 1, PAINT = 2 };

// Goes with every query to the callbacks. Lane i's share of light is attenuation[i].
struct Context : RTCRayQueryContext {
    const BenchJob* job;
    float* attenuation;
};

Context contextFor(const BenchJob& job, float* attenuation) {
    Context context;
    context.instID[0] = context.instPrimID[0] = RTC_INVALID_GEOMETRY_ID;
    context.job = &job;
    context.attenuation = attenuation;
    return context;
}

// ---- intersection, for one ray or many

template <class F> struct Candidate {
    BoolOf<F> hit;
    F t;
};

template <class F> BENCH_INLINE Candidate<F> hitSphere(const float* sphere, Vec<F> origin, Vec<F> direction, F tnear, F tfar) {
    const Vec<F> o = origin - Vec<F>(sphere);
    const F b = dot(o, direction);
    const Vec<F> perpendicular = o - b * direction;
    const F discriminant = F(sphere[3]) * F(sphere[3]) - dot(perpendicular, perpendicular);
    const F root = squareRoot(maximum(discriminant, F(0.0f)));
    const F first = -b - root;
    const F t = select(first < tnear, -b + root, first);
    return {both(discriminant > F(0.0f), both(t >= tnear, t <= tfar)), t};
}

// One ray leaves early.
BENCH_INLINE Candidate<float> hitSphere(const float* sphere, Float3 origin, Float3 direction, float tnear, float tfar) {
    const Float3 o = origin - Float3(sphere);
    const float b = dot(o, direction);
    const Float3 perpendicular = o - b * direction;
    const float discriminant = sphere[3] * sphere[3] - dot(perpendicular, perpendicular);
    if (discriminant <= 0.0f) return {false, 0.0f};
    const float root = squareRoot(discriminant);
    float t = -b - root;
    if (t < tnear) t = -b + root;
    return {t >= tnear && t <= tfar, t};
}

template <class F> BENCH_INLINE Candidate<F> hitFloor(float size, Vec<F> origin, Vec<F> direction, F tnear, F tfar) {
    const F t = -origin.y / direction.y;
    const F x = origin.x + t * direction.x, z = origin.z + t * direction.z;
    return {both(both(absolute(x) < F(size), absolute(z) < F(size)), both(t >= tnear, t <= tfar)), t};
}

template <class F> BENCH_INLINE Candidate<F> hitPrimitive(const BenchJob& job, unsigned geometry, unsigned primitive, Vec<F> origin,
                                                          Vec<F> direction, F tnear, F tfar) {
    if (geometry == SPHERES) return hitSphere(job.spheres + 4 * size_t(primitive), origin, direction, tnear, tfar);
    return hitFloor(job.floorSize, origin, direction, tnear, tfar);
}

bool isGlass(const BenchJob& job, unsigned geometry, unsigned primitive) {
    return geometry == SPHERES && job.materials[job.materialOf[primitive]].kind == GLASS;
}

void intersectOne(const RTCIntersectFunctionNArguments* arguments, const Context& context) {
    RTCRayHit& hit = *static_cast<RTCRayHit*>(arguments->rayhit);
    RTCRay& ray = hit.ray;
    const Candidate<float> found =
        hitPrimitive<float>(*context.job, arguments->geomID, arguments->primID, {ray.org_x, ray.org_y, ray.org_z},
                            {ray.dir_x, ray.dir_y, ray.dir_z}, ray.tnear, ray.tfar);
    if (!found.hit) return;
    ray.tfar = found.t;
    hit.hit.primID = arguments->primID;
    hit.hit.geomID = arguments->geomID;
}

void intersectCallback(const RTCIntersectFunctionNArguments* arguments) {
    const Context& context = *static_cast<const Context*>(arguments->context);
    if (arguments->N == 1) return intersectOne(arguments, context);
    PacketHit& packet = *static_cast<PacketHit*>(arguments->rayhit);
    const PacketRay& ray = packet.ray;
    const Candidate<Wide> found =
        hitPrimitive<Wide>(*context.job, arguments->geomID, arguments->primID, {load(ray.org_x), load(ray.org_y), load(ray.org_z)},
                           {load(ray.dir_x), load(ray.dir_y), load(ray.dir_z)}, load(ray.tnear), load(ray.tfar));
    const Mask hit = found.hit & loadMask(arguments->valid);
    storeMasked(packet.ray.tfar, hit, found.t);
    storeMasked(reinterpret_cast<int*>(packet.hit.primID), hit, WideUint(arguments->primID));
    storeMasked(reinterpret_cast<int*>(packet.hit.geomID), hit, WideUint(arguments->geomID));
}

void occludedOne(const RTCOccludedFunctionNArguments* arguments, const Context& context) {
    RTCRay& ray = *static_cast<RTCRay*>(arguments->ray);
    const Candidate<float> found =
        hitPrimitive<float>(*context.job, arguments->geomID, arguments->primID, {ray.org_x, ray.org_y, ray.org_z},
                            {ray.dir_x, ray.dir_y, ray.dir_z}, ray.tnear, ray.tfar);
    if (!found.hit) return;
    if (isGlass(*context.job, arguments->geomID, arguments->primID))
        context.attenuation[ray.id] *= 0.8f;
    else
        ray.tfar = -__builtin_inff();
}

void occludedCallback(const RTCOccludedFunctionNArguments* arguments) {
    const Context& context = *static_cast<const Context*>(arguments->context);
    if (arguments->N == 1) return occludedOne(arguments, context);
    PacketRay& ray = *static_cast<PacketRay*>(arguments->ray);
    const Candidate<Wide> found =
        hitPrimitive<Wide>(*context.job, arguments->geomID, arguments->primID, {load(ray.org_x), load(ray.org_y), load(ray.org_z)},
                           {load(ray.dir_x), load(ray.dir_y), load(ray.dir_z)}, load(ray.tnear), load(ray.tfar));
    const Mask hit = found.hit & loadMask(arguments->valid);
    if (isGlass(*context.job, arguments->geomID, arguments->primID))
        storeMasked(context.attenuation, hit, load(context.attenuation) * Wide(0.8f));
    else
        storeMasked(ray.tfar, hit, Wide(-__builtin_inff()));
}

Callbacks callbacksOf(Context& context) {
    Callbacks callbacks;
    callbacks.intersect = intersectCallback;
    callbacks.occluded = occludedCallback;
    callbacks.context = &context;
    return callbacks;
}

template <class F> BENCH_INLINE Vec<F> skyColor(const BenchJob& job, Vec<F> direction) {
    const F t = F(0.5f) * direction.y + F(0.5f), white = F(1.0f) - t;
    return Vec<F>(white, white, white) + t * Vec<F>(job.sky);
}

// Which ways light goes on from glass, and how much of it.
template <class F> struct Fresnel {
    BoolOf<F> refracts;
    F reflectance;
    Vec<F> refracted, reflected, n;
};

template <class F> BENCH_INLINE Fresnel<F> fresnel(Vec<F> outward, Vec<F> direction) {
    const F one(1.0f), signedCosine = -dot(outward, direction);
    const BoolOf<F> entering = signedCosine > F(0.0f);
    Fresnel<F> result;
    result.n = select(entering, outward, -outward);
    const F cosine = absolute(signedCosine);
    const F eta = select(entering, F(1.0f / 1.5f), F(1.5f));
    const F k = one - eta * eta * (one - cosine * cosine);
    const F cosineT = squareRoot(maximum(k, F(0.0f)));
    const F m = one - select(entering, cosine, cosineT);
    result.refracts = k > F(0.0f);
    result.reflectance = select(result.refracts, F(0.04f) + F(0.96f) * (m * m * (m * m) * m), one);
    result.refracted = eta * direction + (eta * cosine - cosineT) * result.n;
    result.reflected = direction + F(2.0f) * cosine * result.n;
    return result;
}

template <class F> BENCH_INLINE F checkerShade(Vec<F> point) {
    using U = UintOf<F>;
    const U odd = (toInteger(roundDown(point.x)) + toInteger(roundDown(point.z))) & U(1u);
    return select(odd == U(1u), F(0.35f), F(1.0f));
}

// ---- scalar

float directLight(const BenchJob& job, Worker& worker, Float3 point, Float3 n) {
    const Float3 toLight = Float3(job.light.corner) - point;
    const float distance = length(toLight);
    const Float3 wi = (1.0f / distance) * toLight;
    const float cosine = dot(n, wi);
    if (cosine <= 0.0f) return 0.0f;
    worker.rays++;
    float attenuation = 1.0f;
    Context context = contextFor(job, &attenuation);
    RTCOccludedArguments arguments = occludedArguments(callbacksOf(context));
    if (occluded(job, point + job.offset * n, wi, distance, &arguments)) return 0.0f;
    return cosine * attenuation;
}

Float3 radiance(const BenchJob& job, Worker& worker, Float3 origin, Float3 direction, float importance, int depth) {
    RTCRayHit hit;
    Context context = contextFor(job, nullptr);
    RTCIntersectArguments arguments = intersectArguments(callbacksOf(context));
    worker.rays++;
    if (!intersect(job, hit, origin, direction, &arguments)) return skyColor(job, direction);
    const Float3 point = origin + hit.ray.tfar * direction;
    if (hit.hit.geomID == FLOOR) {
        const float light = directLight(job, worker, point, {0.0f, 1.0f, 0.0f});
        return (checkerShade(point) * (0.2f + 0.8f * light)) * Float3(job.materials[BENCH_MATERIALS - 1].color);
    }
    const float* sphere = job.spheres + 4 * size_t(hit.hit.primID);
    const BenchMaterial& material = job.materials[job.materialOf[hit.hit.primID]];
    const Float3 n = (1.0f / sphere[3]) * (point - Float3(sphere)), color(material.color);
    if (material.kind == PAINT) return (0.2f + 0.8f * directLight(job, worker, point, n)) * color;
    if (material.kind == METAL) {
        Float3 sum = (0.1f + 0.2f * directLight(job, worker, point, n)) * color;
        importance = 0.7f * importance;
        if (depth < DEPTH && importance > FAINTEST) {
            const Float3 reflected = direction - (2.0f * dot(n, direction)) * n;
            sum = sum + 0.7f * color * radiance(job, worker, point + job.offset * n, reflected, importance, depth + 1);
        }
        return sum;
    }
    const Fresnel<float> ways = fresnel(n, direction);
    Float3 sum(0.0f, 0.0f, 0.0f);
    const float through = (1.0f - ways.reflectance) * importance, back = ways.reflectance * importance;
    if (depth < DEPTH && ways.refracts && through > FAINTEST)
        sum = ((1.0f - ways.reflectance) * color) *
              radiance(job, worker, point - job.offset * ways.n, ways.refracted, through, depth + 1);
    if (depth < DEPTH && back > FAINTEST)
        sum = sum + ways.reflectance * radiance(job, worker, point + job.offset * ways.n, ways.reflected, back, depth + 1);
    return sum;
}

void scalar(BenchJob& job) {
    launchPixels(job, [&](Worker& worker, uint32_t x, uint32_t y) {
        writePixel(job, x, y, radiance(job, worker, Float3(job.eye), cameraDirection<float>(job, x, imageRow(job, y)), 1.0f, 0));
    });
}

// ---- packets

template <Form shadow> Wide directLight(const BenchJob& job, Worker& worker, Mask mask, Wide3 point, Wide3 n) {
    const Wide3 toLight = Wide3(job.light.corner) - point;
    const Wide distance = length(toLight);
    const Wide3 wi = (Wide(1.0f) / distance) * toLight;
    const Wide cosine = dot(n, wi);
    mask = mask & (cosine > Wide(0.0f));
    if (!any(mask)) return Wide(0.0f);
    worker.rays += countOf(mask);
    alignas(64) float attenuation[LANES];
    store(attenuation, Wide(1.0f));
    Context context = contextFor(job, attenuation);
    const Mask lit = unoccluded(job, shadow, mask, point + Wide(job.offset) * n, wi, distance, callbacksOf(context));
    return select(lit, cosine * load(attenuation), Wide(0.0f));
}

template <Form first, Form bounces, Form shadow>
Wide3 radiance(const BenchJob& job, Worker& worker, Mask active, Wide3 origin, Wide3 direction, Wide importance, int depth) {
    const Wide zero(0.0f), one(1.0f), offset(job.offset);
    Context context = contextFor(job, nullptr);
    worker.rays += countOf(active);
    const PacketResult hit = intersect(job, first, active, origin, direction, callbacksOf(context));
    Wide3 sum = skyColor(job, direction);
    if (!any(hit.hit)) return sum;
    const Wide3 point = origin + hit.t * direction;
    const Mask onFloor = hit.hit & (hit.geometry == WideUint(uint32_t(FLOOR))), onSphere = hit.hit & !onFloor;
    const WideUint at = hit.primitive * WideUint(4u);
    const Wide3 centre(gather(job.spheres, at, onSphere), gather(job.spheres + 1, at, onSphere), gather(job.spheres + 2, at, onSphere));
    Wide3 n = (one / gather(job.spheres + 3, at, onSphere)) * (point - centre);
    n = select(onFloor, Wide3(zero, one, zero), n);
    const WideUint material = select(onFloor, WideUint(uint32_t(BENCH_MATERIALS - 1)), gather(job.materialOf, hit.primitive, onSphere));
    const WideUint record = material * WideUint(uint32_t(sizeof(BenchMaterial) / 4));
    const float* colors = job.materials[0].color;
    const Wide3 color(gather(colors, record, hit.hit), gather(colors + 1, record, hit.hit), gather(colors + 2, record, hit.hit));
    const WideUint kind = gather(&job.materials[0].kind, record, hit.hit);
    const Mask onMetal = onSphere & (kind == WideUint(uint32_t(METAL))), onGlass = onSphere & (kind == WideUint(uint32_t(GLASS)));
    const Mask lightened = hit.hit & !onGlass;
    if (any(lightened)) {
        const Wide light = directLight<shadow>(job, worker, lightened, point, n);
        const Wide painted = select(onFloor, checkerShade(point), one) * (Wide(0.2f) + Wide(0.8f) * light);
        sum = select(lightened, select(onMetal, Wide(0.1f) + Wide(0.2f) * light, painted) * color, sum);
    }
    sum = select(onGlass, Wide3(zero, zero, zero), sum);
    if (depth >= DEPTH || !any(onMetal | onGlass)) return sum;

    // one reflected ray for metal and glass alike, one refracted ray for glass
    Wide3 reflected = direction - (Wide(2.0f) * dot(n, direction)) * n;
    Wide3 weight = Wide(0.7f) * color;
    Wide back = Wide(0.7f) * importance;
    if (any(onGlass)) {
        const Fresnel<Wide> ways = fresnel(n, direction);
        const Wide through = (one - ways.reflectance) * importance;
        const Mask refracts = onGlass & ways.refracts & (through > Wide(FAINTEST));
        if (any(refracts)) {
            const Wide3 passed = radiance<bounces, bounces, shadow>(job, worker, refracts, point - offset * ways.n, ways.refracted, through,
                                                                    depth + 1);
            sum = select(refracts, ((one - ways.reflectance) * color) * passed, sum);
        }
        reflected = select(onGlass, ways.reflected, reflected);
        n = select(onGlass, ways.n, n);
        weight = select(onGlass, Wide3(ways.reflectance, ways.reflectance, ways.reflectance), weight);
        back = select(onGlass, ways.reflectance * importance, back);
    }
    const Mask reflects = (onMetal | onGlass) & (back > Wide(FAINTEST));
    if (any(reflects)) {
        const Wide3 mirrored = radiance<bounces, bounces, shadow>(job, worker, reflects, point + offset * n, reflected, back, depth + 1);
        sum = select(reflects, sum + weight * mirrored, sum);
    }
    return sum;
}

template <Form bounces, Form shadow> void packet(BenchJob& job) {
    launchBlocks(job, [&](Worker& worker, const Block& block) {
        const Wide3 direction = cameraDirection<Wide>(job, block.px, block.py);
        writeBlock(job, block, radiance<Form::COHERENT, bounces, shadow>(job, worker, block.active, Wide3(job.eye), direction, Wide(1.0f), 0));
    });
}

}  // namespace
}  // namespace bench

using bench::Form;
extern "C" __attribute__((visibility("default"))) void whitted_scalar(BenchJob* job) { bench::scalar(*job); }
extern "C" __attribute__((visibility("default"))) void whitted_packet(BenchJob* job) { bench::packet<Form::PACKET, Form::PACKET>(*job); }
extern "C" __attribute__((visibility("default"))) void whitted_coherent(BenchJob* job) { bench::packet<Form::PACKET, Form::COHERENT>(*job); }
extern "C" __attribute__((visibility("default"))) void whitted_all_coherent(BenchJob* job) { bench::packet<Form::COHERENT, Form::COHERENT>(*job); }
extern "C" __attribute__((visibility("default"))) void whitted_single(BenchJob* job) { bench::packet<Form::SINGLE, Form::SINGLE>(*job); }
extern "C" __attribute__((visibility("default"))) void whitted_adaptive(BenchJob* job) { bench::packet<Form::ADAPTIVE, Form::ADAPTIVE>(*job); }
extern "C" __attribute__((visibility("default"))) void whitted_single_shadow(BenchJob* job) { bench::packet<Form::PACKET, Form::SINGLE>(*job); }

#ifdef BENCH_RECORD
#include "limit_runs.h"
extern "C" __attribute__((visibility("default"))) int whitted_limits(BenchJob* job, BenchLimit* results, int capacity) {
    alignas(64) float attenuation[bench::LANES] = {};
    bench::Context context = bench::contextFor(*job, attenuation);
    return bench::limits(*job, bench::scalar, bench::callbacksOf(context), results, capacity);
}
#endif
