/* Made by optixc. Compiled features:
   miss programs: shader.py:66
   closesthit programs: shader.py:52
   recursion: shader.py:61
   occlusion queries: shader.py:39
   array bounds checks: shader.py:48
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
    oxrt::Array<oxrt::float3, 1> image;
    uint64_t scene;
    oxrt::float3 light;
};

struct Mirror {
    oxrt::float3 tint;
};

struct Radiance {
    oxrt::float3 color;
    /* Nobody reads depth. */
};

struct Light {
    oxrt::Word<bool> visible;
};

struct ParamsWide;
struct MirrorWide;
struct RadianceWide;
struct LightWide;
}  // namespace
template <> struct oxrt::WideType<Params, 16> { using Type = ParamsWide; };
template <> struct oxrt::WideType<Mirror, 16> { using Type = MirrorWide; };
template <> struct oxrt::WideType<Radiance, 16> { using Type = RadianceWide; };
template <> struct oxrt::WideType<Light, 16> { using Type = LightWide; };
namespace {

struct ParamsWide {
    using IsWideStruct = void;
    Wide<oxrt::Array<oxrt::float3, 1>> image;
    Wide<uint64_t> scene;
    Wide<oxrt::float3> light;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.image...); f(s.scene...); f(s.light...); }
};

struct MirrorWide {
    using IsWideStruct = void;
    Wide<oxrt::float3> tint;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.tint...); }
};

struct RadianceWide {
    using IsWideStruct = void;
    Wide<oxrt::float3> color;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.color...); }
};

struct LightWide {
    using IsWideStruct = void;
    Wide<bool> visible;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.visible...); }
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_image, closesthit_matte, closesthit_mirror, miss_black, miss_visible };
}

/* What a trace with a Radiance payload can run. */
struct RadiancePrograms : oxrt::NoPrograms {
    using Payload = Radiance;
    static constexpr bool hasClosestHit = true;
    static constexpr bool hasMiss = true;
    static constexpr bool countsDepth = true;
    static constexpr bool checksStack = true;
    static constexpr uint32_t maxTraceDepth = 3;
    static void closestHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
    static void miss(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
};

/* What a trace with a Light payload can run. */
struct LightPrograms : oxrt::NoPrograms {
    using Payload = Light;
    static constexpr bool hasMiss = true;
    static constexpr bool countsDepth = true;
    static constexpr bool checksStack = true;
    static constexpr uint32_t maxTraceDepth = 3;
    static void miss(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
};

struct RadianceProgramsLanes : oxrt::NoLanePrograms {
    using Scalar = RadiancePrograms;
    using Payload = Wide<Radiance>;
    static void closestHit(Rays& trace, Mask mask, Payload& payload);
    static void miss(Rays& trace, Mask mask, Payload& payload);
};

struct LightProgramsLanes : oxrt::NoLanePrograms {
    using Scalar = LightPrograms;
    using Payload = Wide<Light>;
    static void miss(Rays& trace, Mask mask, Payload& payload);
};

Wide<float> lit_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, const Wide<oxrt::float3>& point);

#line 44 "shader.py"
void raygen_image_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 45 "shader.py"
    Wide<oxrt::uint3> i = oxrt::getLaunchIndex(thread);
    Wide<Radiance> ray = oxrt::spread<16>(Radiance{oxrt::float3(0.0f)});
    oxrt::trace<RadianceProgramsLanes>(thread, mask, params.scene, Wide<oxrt::float3>(oxrt::convert<float>(i.x), 0.0f, 0.0f),
            oxrt::float3(0.0f, 0.0f, 1.0f), 0.0f, __builtin_inff(), 0.0f, 255u, oxrt::KnownFlags<0>(), 0u, 1u, 0u, ray);
#line 48 "shader.py"
    oxrt::checked(thread, mask).store(ray.color, params.image, i.x);
}

#line 37 "shader.py"
Wide<float> lit_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, const Wide<oxrt::float3>& point) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 38 "shader.py"
    Wide<Light> light = oxrt::spread<16>(Light{false});
    oxrt::trace<LightProgramsLanes>(thread, mask, params.scene, point, params.light - point, 0.001f, 1.0f, 0.0f, 255u,
            oxrt::KnownFlags<13>(), 0u, 1u, 1u, light);
#line 40 "shader.py"
    return oxrt::select(Wide<bool>(light.visible), Wide<float>(1.0f), Wide<float>(0.0f));
}

#line 52 "shader.py"
void closesthit_matte_lanes([[maybe_unused]] Rays& trace, [[maybe_unused]] Mask mask, Wide<Radiance>& ray) {
    [[maybe_unused]] Lanes& thread = *trace.thread;
#line 53 "shader.py"
    Wide<oxrt::float3> point = oxrt::getWorldRayOrigin(trace) + oxrt::getRayTmax(trace) * oxrt::getWorldRayDirection(trace);
    Wide<float> result_ = lit_lanes(thread, mask, point);
#line 54 "shader.py"
    oxrt::assign(mask, ray.color, Wide<oxrt::float3>(result_));
}

#line 58 "shader.py"
void closesthit_mirror_lanes([[maybe_unused]] Rays& trace, [[maybe_unused]] Mask mask, Wide<Radiance>& ray, const Wide<Mirror>& mirror) {
    [[maybe_unused]] Lanes& thread = *trace.thread;
    const Params& params = oxrt::launchParams<Params>(thread);
#line 59 "shader.py"
    Wide<oxrt::float3> point = oxrt::getWorldRayOrigin(trace) + oxrt::getRayTmax(trace) * oxrt::getWorldRayDirection(trace);
    Wide<Radiance> deeper = oxrt::spread<16>(Radiance{oxrt::float3(0.0f)});
    oxrt::trace<RadianceProgramsLanes>(thread, mask, params.scene, point, -oxrt::getWorldRayDirection(trace), 0.001f, __builtin_inff(),
            0.0f, 255u, oxrt::KnownFlags<0>(), 0u, 1u, 0u, deeper);
#line 62 "shader.py"
    oxrt::assign(mask, ray.color, mirror.tint * deeper.color);
}

#line 66 "shader.py"
void miss_black_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, Wide<Radiance>& ray) {
    oxrt::assign(mask, ray.color, oxrt::float3(0.0f));
}

#line 71 "shader.py"
void miss_visible_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, Wide<Light>& light) {
    oxrt::assign(mask, light.visible, true);
}

#line 175 "pipeline.cpp"
void RadianceProgramsLanes::closestHit(Rays& trace, Mask mask, Payload& payload) {
    const Wide<int32_t> program = oxrt::recordPrograms(trace.records, mask, oxrt::SLOT_CLOSESTHIT);
    if (const Mask own = mask & (program == int32_t(number::closesthit_matte)); oxrt::any(own))
        closesthit_matte_lanes(trace, own, payload);
    if (const Mask own = mask & (program == int32_t(number::closesthit_mirror)); oxrt::any(own))
        closesthit_mirror_lanes(trace, own, payload, oxrt::loadRecord<Mirror>(trace.records, own));
}

void RadianceProgramsLanes::miss(Rays& trace, Mask mask, Payload& payload) {
    const Wide<int32_t> program = oxrt::recordPrograms(trace.records, mask, 0);
    if (const Mask own = mask & (program == int32_t(number::miss_black)); oxrt::any(own))
        miss_black_lanes(*trace.thread, own, payload);
}

void LightProgramsLanes::miss(Rays& trace, Mask mask, Payload& payload) {
    const Wide<int32_t> program = oxrt::recordPrograms(trace.records, mask, 0);
    if (const Mask own = mask & (program == int32_t(number::miss_visible)); oxrt::any(own))
        miss_visible_lanes(*trace.thread, own, payload);
}

void run_raygen_image(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::runBlocks<LANES>(*thread, *tile, [](Lanes& lanes, Mask mask) {
        raygen_image_lanes(lanes, mask);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__image", OXRT_KIND_RAYGEN, 0, run_raygen_image},
    {"__closesthit__matte", OXRT_KIND_CLOSESTHIT, 0, nullptr},
    {"__closesthit__mirror", OXRT_KIND_CLOSESTHIT, sizeof(Mirror), nullptr},
    {"__miss__black", OXRT_KIND_MISS, 0, nullptr},
    {"__miss__visible", OXRT_KIND_MISS, 0, nullptr},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 16, programs, 5}};
static_assert(sizeof(Params) == 40);
static_assert(sizeof(Mirror) == 12);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 40, 3, "0.1.0"};
