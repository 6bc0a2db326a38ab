/* Made by optixc. Compiled features:
   miss programs: shader.py:50
   closesthit programs: shader.py:42
   array bounds checks: shader.py:38
*/
#include <oxrt/device.h>

#include <oxrt/lanes_trace.h>

namespace {

enum { LANES = 16 };
template <class T> using Wide = oxrt::Wide<T, LANES>;
using Mask = oxrt::Lanes<bool, LANES>;
using Lanes = oxrt::LanesThread<LANES>;
using Rays = oxrt::RayLanes<LANES>;

struct Params {
    oxrt::Array<oxrt::float4, 2> image;
    uint64_t scene;
    oxrt::float3 eye;
    oxrt::float3 u;
    oxrt::float3 v;
    oxrt::float3 w;
};

struct Material {
    oxrt::float3 albedo;
};

struct Radiance {
    oxrt::float3 color;
};

struct ParamsWide;
struct MaterialWide;
struct RadianceWide;
}  // namespace
template <> struct oxrt::WideType<Params, 16> { using Type = ParamsWide; };
template <> struct oxrt::WideType<Material, 16> { using Type = MaterialWide; };
template <> struct oxrt::WideType<Radiance, 16> { using Type = RadianceWide; };
namespace {

struct ParamsWide {
    using IsWideStruct = void;
    Wide<oxrt::Array<oxrt::float4, 2>> image;
    Wide<uint64_t> scene;
    Wide<oxrt::float3> eye;
    Wide<oxrt::float3> u;
    Wide<oxrt::float3> v;
    Wide<oxrt::float3> w;
    template <class F, class... S> static OXRT_INLINE void each(const F& f,
            S&... s) { f(s.image...); f(s.scene...); f(s.eye...); f(s.u...); f(s.v...); f(s.w...); }
};

struct MaterialWide {
    using IsWideStruct = void;
    Wide<oxrt::float3> albedo;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.albedo...); }
};

struct RadianceWide {
    using IsWideStruct = void;
    Wide<oxrt::float3> color;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.color...); }
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_pinhole, closesthit_matte, miss_sky };
}

/* What a trace with a Radiance payload can run. */
struct RadiancePrograms : oxrt::NoPrograms {
    using Payload = Radiance;
    static constexpr bool hasClosestHit = true;
    static constexpr bool hasMiss = true;
    static void closestHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
    static void miss(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
};

struct RadianceProgramsLanes : oxrt::NoLanePrograms {
    using Scalar = RadiancePrograms;
    using Payload = Wide<Radiance>;
    static void closestHit(Rays& trace, Mask mask, Payload& payload);
    static void miss(Rays& trace, Mask mask, Payload& payload);
};


#line 31 "shader.py"
void raygen_pinhole_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 32 "shader.py"
    Wide<oxrt::uint3> i = oxrt::getLaunchIndex(thread);
#line 32 "shader.py"
    oxrt::uint3 size = oxrt::getLaunchDimensions(thread);
    Wide<float> x = 2.0f * (oxrt::convert<float>(i.x) + 0.5f) / float(size.x) - 1.0f;
    Wide<float> y = 1.0f - 2.0f * (oxrt::convert<float>(i.y) + 0.5f) / float(size.y);
    Wide<Radiance> ray = oxrt::spread<16>(Radiance{oxrt::float3(0.0f)});
    Wide<oxrt::float3> direction = oxrt::normalize(x * params.u + y * params.v + params.w);
    oxrt::trace<RadianceProgramsLanes>(thread, mask, params.scene, params.eye, direction, 0.0f, 1e16f, 0.0f, 255u, oxrt::KnownFlags<0>(),
            0u, 1u, 0u, ray);
#line 38 "shader.py"
    oxrt::checked(thread, mask).store(Wide<oxrt::float4>(ray.color, 1.0f), params.image, i.y, i.x);
}

#line 108 "pipeline.cpp"
// Brighter where the surface faces the ray.
#line 42 "shader.py"
void closesthit_matte_lanes([[maybe_unused]] Rays& trace, [[maybe_unused]] Mask mask, Wide<Radiance>& ray, const Wide<Material>& material) {
    [[maybe_unused]] Lanes& thread = *trace.thread;
    Wide<oxrt::Tuple<oxrt::float3, oxrt::float3, oxrt::float3>> items = oxrt::getTriangleVertexData(trace);
#line 44 "shader.py"
    Wide<oxrt::float3> p0 = oxrt::get<0>(items);
#line 44 "shader.py"
    Wide<oxrt::float3> p1 = oxrt::get<1>(items);
#line 44 "shader.py"
    Wide<oxrt::float3> p2 = oxrt::get<2>(items);
    Wide<oxrt::float3> n = oxrt::transformNormalFromObjectToWorldSpace(trace, oxrt::cross(p1 - p0, p2 - p0));
    oxrt::assign(mask, ray.color, material.albedo * oxrt::abs(oxrt::dot(oxrt::normalize(n), oxrt::getWorldRayDirection(trace))));
}

#line 50 "shader.py"
void miss_sky_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, Wide<Radiance>& ray) {
    oxrt::assign(mask, ray.color, oxrt::float3(0.5f, 0.7f, 1.0f));
}

#line 129 "pipeline.cpp"
void RadianceProgramsLanes::closestHit(Rays& trace, Mask mask, Payload& payload) {
    const Wide<int32_t> program = oxrt::recordPrograms(trace.records, mask, oxrt::SLOT_CLOSESTHIT);
    if (const Mask own = mask & (program == int32_t(number::closesthit_matte)); oxrt::any(own))
        closesthit_matte_lanes(trace, own, payload, oxrt::loadRecord<Material>(trace.records, own));
}

void RadianceProgramsLanes::miss(Rays& trace, Mask mask, Payload& payload) {
    const Wide<int32_t> program = oxrt::recordPrograms(trace.records, mask, 0);
    if (const Mask own = mask & (program == int32_t(number::miss_sky)); oxrt::any(own))
        miss_sky_lanes(*trace.thread, own, payload);
}

void run_raygen_pinhole(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::runBlocks<LANES>(*thread, *tile, [](Lanes& lanes, Mask mask) {
        raygen_pinhole_lanes(lanes, mask);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__pinhole", OXRT_KIND_RAYGEN, 0, run_raygen_pinhole},
    {"__closesthit__matte", OXRT_KIND_CLOSESTHIT, sizeof(Material), nullptr},
    {"__miss__sky", OXRT_KIND_MISS, 0, nullptr},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 16, programs, 3}};
static_assert(sizeof(Params) == 80);
static_assert(sizeof(Material) == 12);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 80, 1, "0.1.0"};
