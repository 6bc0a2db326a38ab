/* Made by optixc. Compiled features:
   closesthit programs: shader.py:38
   hit objects: shader.py:30
   array bounds checks: shader.py:34
*/
#include <oxrt/device.h>
#include <oxrt/device_make_hit.h>

#include <oxrt/lanes_make_hit.h>

namespace {

enum { LANES = 16 };
template <class T> using Wide = oxrt::Wide<T, LANES>;
using Mask = oxrt::Lanes<bool, LANES>;
using Lanes = oxrt::LanesThread<LANES>;
using Rays = oxrt::RayLanes<LANES>;

struct Params {
    oxrt::Array<oxrt::float3, 1> seen;
    uint64_t scene;
};

struct Radiance {
    oxrt::float3 color;
};

struct ParamsWide;
struct RadianceWide;
}  // namespace
template <> struct oxrt::WideType<Params, 16> { using Type = ParamsWide; };
template <> struct oxrt::WideType<Radiance, 16> { using Type = RadianceWide; };
namespace {

struct ParamsWide {
    using IsWideStruct = void;
    Wide<oxrt::Array<oxrt::float3, 1>> seen;
    Wide<uint64_t> scene;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.seen...); f(s.scene...); }
};

struct RadianceWide {
    using IsWideStruct = void;
    Wide<oxrt::float3> color;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.color...); }
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_main, closesthit_white };
}

/* What a trace with a Radiance payload can run. */
struct RadiancePrograms : oxrt::NoPrograms {
    using Payload = Radiance;
    static constexpr bool hasClosestHit = true;
    static void closestHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
};

struct RadianceProgramsLanes : oxrt::NoLanePrograms {
    using Scalar = RadiancePrograms;
    using Payload = Wide<Radiance>;
    static void closestHit(Rays& trace, Mask mask, Payload& payload);
};

Wide<bool> is_near_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, oxrt::HitObjectLanes<LANES>& hitObject);

#line 22 "shader.py"
Wide<bool> is_near_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, oxrt::HitObjectLanes<LANES>& hitObject) {
    return oxrt::hitObjectIsHit(hitObject, mask) & (oxrt::hitObjectGetRayTmax(hitObject, mask) < 1.0f);
}

#line 27 "shader.py"
void raygen_main_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask) {
    const Params& params = oxrt::launchParams<Params>(thread);
    oxrt::HitObjectLanes<LANES> hitObject(thread);
#line 28 "shader.py"
    Wide<uint32_t> i = oxrt::getLaunchIndex(thread).x;
    Wide<Radiance> ray = oxrt::spread<16>(Radiance{oxrt::float3(0.0f)});
    oxrt::traverse<RadianceProgramsLanes>(thread, mask, hitObject, params.scene, oxrt::float3(0.0f), oxrt::float3(0.0f, 0.0f, 1.0f), 0.0f,
            __builtin_inff(), 0.0f, 255u, oxrt::KnownFlags<0>(), 0u, 1u, 0u, ray);
    const Mask test = is_near_lanes(thread, mask, hitObject);
#line 31 "shader.py"
    Mask mask_ = mask & test;
#line 31 "shader.py"
    if (oxrt::any(mask_)) {
        oxrt::invoke<RadianceProgramsLanes>(thread, mask_, hitObject, ray);
    }
#line 33 "shader.py"
    oxrt::trace<RadianceProgramsLanes>(thread, mask, params.scene, oxrt::float3(0.0f), oxrt::float3(0.0f, 1.0f, 0.0f), 0.0f,
            __builtin_inff(), 0.0f, 255u, oxrt::KnownFlags<0>(), 0u, 1u, 0u, ray);
#line 33 "shader.py"
    oxrt::makeNopHitObject(hitObject, mask);
    oxrt::checked(thread, mask).store(ray.color, params.seen, i);
}

#line 38 "shader.py"
void closesthit_white_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, Wide<Radiance>& ray) {
    oxrt::assign(mask, ray.color, oxrt::float3(1.0f));
}

#line 103 "pipeline.cpp"
void RadianceProgramsLanes::closestHit(Rays& trace, Mask mask, Payload& payload) {
    const Wide<int32_t> program = oxrt::recordPrograms(trace.records, mask, oxrt::SLOT_CLOSESTHIT);
    if (const Mask own = mask & (program == int32_t(number::closesthit_white)); oxrt::any(own))
        closesthit_white_lanes(*trace.thread, own, payload);
}

void run_raygen_main(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::runBlocks<LANES>(*thread, *tile, [](Lanes& lanes, Mask mask) {
        raygen_main_lanes(lanes, mask);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__main", OXRT_KIND_RAYGEN, 0, run_raygen_main},
    {"__closesthit__white", OXRT_KIND_CLOSESTHIT, 0, nullptr},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 16, programs, 2}};
static_assert(sizeof(Params) == 24);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 24, 1, "0.1.0"};
