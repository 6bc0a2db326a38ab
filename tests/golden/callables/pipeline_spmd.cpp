/* Made by optixc. Compiled features:
   direct callable programs: shader.py:31
   continuation callable programs: shader.py:43
   callables: shader.py:26
   array bounds checks: shader.py:27
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
    oxrt::Array<oxrt::float3, 1> colors;
    uint32_t material;
};

struct Stripes {
    float width;
    uint32_t other;
};

struct ParamsWide;
struct StripesWide;
}  // namespace
template <> struct oxrt::WideType<Params, 16> { using Type = ParamsWide; };
template <> struct oxrt::WideType<Stripes, 16> { using Type = StripesWide; };
namespace {

struct ParamsWide {
    using IsWideStruct = void;
    Wide<oxrt::Array<oxrt::float3, 1>> colors;
    Wide<uint32_t> material;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.colors...); f(s.material...); }
};

struct StripesWide {
    using IsWideStruct = void;
    Wide<float> width;
    Wide<uint32_t> other;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.width...); f(s.other...); }
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_materials, direct_callable_plain, direct_callable_stripes, continuation_callable_glow };
}

Wide<oxrt::float3> directCall_lanes(Lanes& thread, Mask mask, Wide<uint32_t> index, const Wide<oxrt::float2>& a0,
        oxrt::Place place = oxrt::Place::current());
Wide<oxrt::float3> continuationCall_lanes(Lanes& thread, Mask mask, Wide<uint32_t> index, const Wide<oxrt::float3>& a0,
        oxrt::Place place = oxrt::Place::current());

#line 23 "shader.py"
void raygen_materials_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 24 "shader.py"
    Wide<uint32_t> i = oxrt::getLaunchIndex(thread).x;
    Wide<oxrt::float2> uv = Wide<oxrt::float2>(oxrt::convert<float>(i), 0.5f);
    Wide<oxrt::float3> color = directCall_lanes(thread, mask, Wide<uint32_t>(params.material), uv);
    Wide<oxrt::float3> result_2 = continuationCall_lanes(thread, mask, Wide<uint32_t>(0u), color);
#line 27 "shader.py"
    oxrt::checked(thread, mask).store(color + result_2, params.colors, i);
}

#line 31 "shader.py"
Wide<oxrt::float3> direct_callable_plain_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, const Wide<oxrt::float2>& uv) {
    return Wide<oxrt::float3>(uv.x, uv.y, 0.0f);
}

#line 36 "shader.py"
Wide<oxrt::float3> direct_callable_stripes_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, const Wide<oxrt::float2>& uv,
        const Wide<Stripes>& stripes) {
    Wide<oxrt::float3> result{};
    const Mask test = oxrt::fract(uv.x / stripes.width) < 0.5f;
#line 37 "shader.py"
    Mask mask_ = mask & test;
#line 37 "shader.py"
    if (oxrt::any(mask_)) {
        oxrt::assign(mask_, result, Wide<oxrt::float3>(oxrt::float3(1.0f)));
#line 38 "shader.py"
        mask_ = false;
    }
    mask = mask_ | oxrt::without(mask, test);
    if (oxrt::any(mask)) {
#line 39 "shader.py"
        Wide<oxrt::float3> result_ = directCall_lanes(thread, mask, stripes.other, uv);
#line 39 "shader.py"
        oxrt::assign(mask, result, result_);
#line 39 "shader.py"
        mask = false;
    }
    return result;
}

#line 43 "shader.py"
Wide<oxrt::float3> continuation_callable_glow_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask,
        const Wide<oxrt::float3>& color) {
#line 44 "shader.py"
    return 0.1f * color;
}

#line 110 "pipeline.cpp"
Wide<oxrt::float3> directCall_lanes(Lanes& thread, Mask mask, Wide<uint32_t> index, const Wide<oxrt::float2>& a0, oxrt::Place place) {
    Wide<oxrt::float3> result = oxrt::spread<LANES>(oxrt::float3{});
    if (oxrt::isStackFull(*thread.thread)) {
        oxrt::overflowStack<false>(thread.atLane(oxrt::firstLane(mask)), place);
        return result;
    }
    oxrt::RecordLanes<LANES> records;
    const Mask found = oxrt::findCallables(thread, records, mask, index, 0, place);
    if (oxrt::none(found)) {
        return result;
    }
    const Wide<int32_t> program = oxrt::recordPrograms(records, found, 0);
    if (const Mask own = found & (program == int32_t(number::direct_callable_plain)); oxrt::any(own))
        oxrt::assign(own, result, direct_callable_plain_lanes(thread, own, a0));
    if (const Mask own = found & (program == int32_t(number::direct_callable_stripes)); oxrt::any(own))
        oxrt::assign(own, result, direct_callable_stripes_lanes(thread, own, a0, oxrt::loadRecord<Stripes>(records, own)));
    return result;
}

Wide<oxrt::float3> continuationCall_lanes(Lanes& thread, Mask mask, Wide<uint32_t> index, const Wide<oxrt::float3>& a0, oxrt::Place place) {
    Wide<oxrt::float3> result = oxrt::spread<LANES>(oxrt::float3{});
    if (oxrt::isStackFull(*thread.thread)) {
        oxrt::overflowStack<false>(thread.atLane(oxrt::firstLane(mask)), place);
        return result;
    }
    oxrt::RecordLanes<LANES> records;
    const Mask found = oxrt::findCallables(thread, records, mask, index, 1, place);
    if (oxrt::none(found)) {
        return result;
    }
    const Wide<int32_t> program = oxrt::recordPrograms(records, found, 1);
    if (const Mask own = found & (program == int32_t(number::continuation_callable_glow)); oxrt::any(own))
        oxrt::assign(own, result, continuation_callable_glow_lanes(thread, own, a0));
    return result;
}

void run_raygen_materials(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::runBlocks<LANES>(*thread, *tile, [](Lanes& lanes, Mask mask) {
        raygen_materials_lanes(lanes, mask);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__materials", OXRT_KIND_RAYGEN, 0, run_raygen_materials},
    {"__direct_callable__plain", OXRT_KIND_DIRECT_CALLABLE, 0, nullptr},
    {"__direct_callable__stripes", OXRT_KIND_DIRECT_CALLABLE, sizeof(Stripes), nullptr},
    {"__continuation_callable__glow", OXRT_KIND_CONTINUATION_CALLABLE, 0, nullptr},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 16, programs, 4}};
static_assert(sizeof(Params) == 24);
static_assert(sizeof(Stripes) == 8);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 24, 1, "0.1.0"};
