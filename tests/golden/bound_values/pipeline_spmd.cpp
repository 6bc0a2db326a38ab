/* Made by optixc. Compiled features:
   miss programs: shader.py:51
   array bounds checks: shader.py:47
   bound values: asked for by the pipeline's options
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
    bool shadows;
    int32_t samples;
};

struct Radiance {
    oxrt::float3 color;
};

struct Shadow {
    float light;
};

struct ParamsWide;
struct RadianceWide;
struct ShadowWide;
}  // namespace
template <> struct oxrt::WideType<Params, 16> { using Type = ParamsWide; };
template <> struct oxrt::WideType<Radiance, 16> { using Type = RadianceWide; };
template <> struct oxrt::WideType<Shadow, 16> { using Type = ShadowWide; };
namespace {

struct ParamsWide {
    using IsWideStruct = void;
    Wide<oxrt::Array<oxrt::float3, 1>> image;
    Wide<uint64_t> scene;
    Wide<bool> shadows;
    Wide<int32_t> samples;
    template <class F, class... S> static OXRT_INLINE void each(const F& f,
            S&... s) { f(s.image...); f(s.scene...); f(s.shadows...); f(s.samples...); }
};

struct RadianceWide {
    using IsWideStruct = void;
    Wide<oxrt::float3> color;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.color...); }
};

struct ShadowWide {
    using IsWideStruct = void;
    Wide<float> light;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.light...); }
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_image, miss_white };
}

/* What a trace with a Radiance payload can run. */
struct RadiancePrograms : oxrt::NoPrograms {
    using Payload = Radiance;
    static constexpr bool hasMiss = true;
    static void miss(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
};

struct RadianceProgramsLanes : oxrt::NoLanePrograms {
    using Scalar = RadiancePrograms;
    using Payload = Wide<Radiance>;
    static void miss(Rays& trace, Mask mask, Payload& payload);
};


#line 38 "shader.py"
void raygen_image_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 39 "shader.py"
    Wide<uint32_t> i = oxrt::getLaunchIndex(thread).x;
    Wide<oxrt::float3> color = Wide<oxrt::float3>(oxrt::float3(0.0f));
    for ([[maybe_unused]] int32_t unused = 0; unused < 4; ++unused) {
        Wide<Radiance> ray = oxrt::spread<16>(Radiance{oxrt::float3(0.0f)});
        oxrt::trace<RadianceProgramsLanes>(thread, mask, params.scene, oxrt::float3(0.0f), oxrt::float3(0.0f, 0.0f, 1.0f), 0.0f,
                __builtin_inff(), 0.0f, 255u, oxrt::KnownFlags<0>(), 0u, 1u, 0u, ray);
#line 44 "shader.py"
        color = color + ray.color;
    }
#line 47 "shader.py"
    oxrt::checked(thread, mask).store(color / 4.0f, params.image, i);
}

#line 51 "shader.py"
void miss_white_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, Wide<Radiance>& ray) {
    oxrt::assign(mask, ray.color, oxrt::float3(1.0f));
}

#line 106 "pipeline.cpp"
void RadianceProgramsLanes::miss(Rays& trace, Mask mask, Payload& payload) {
    const Wide<int32_t> program = oxrt::recordPrograms(trace.records, mask, 0);
    if (const Mask own = mask & (program == int32_t(number::miss_white)); oxrt::any(own))
        miss_white_lanes(*trace.thread, own, payload);
}

void run_raygen_image(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::runBlocks<LANES>(*thread, *tile, [](Lanes& lanes, Mask mask) {
        raygen_image_lanes(lanes, mask);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__image", OXRT_KIND_RAYGEN, 0, run_raygen_image},
    {"__miss__white", OXRT_KIND_MISS, 0, nullptr},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 16, programs, 2}};
static_assert(sizeof(Params) == 32);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 32, 1, "0.1.0"};
