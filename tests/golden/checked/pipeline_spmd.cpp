/* Made by optixc. Compiled features:
   closesthit programs: shader.py:52
   print: shader.py:46
   loops that poll for cancellation: shader.py:31
   assertions: shader.py:44
   NaN traps: asked for by the pipeline's options
   array bounds checks: shader.py:43
   validation: asked for by the pipeline's options
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
    oxrt::Array<oxrt::float3, 2> values;
    uint64_t scene;
};

struct State {
    oxrt::FixedArray<float, 4> weights;
};

struct Radiance {
    oxrt::float3 color;
};

struct ParamsWide;
struct StateWide;
struct RadianceWide;
}  // namespace
template <> struct oxrt::WideType<Params, 16> { using Type = ParamsWide; };
template <> struct oxrt::WideType<State, 16> { using Type = StateWide; };
template <> struct oxrt::WideType<Radiance, 16> { using Type = RadianceWide; };
namespace {

struct ParamsWide {
    using IsWideStruct = void;
    Wide<oxrt::Array<oxrt::float3, 2>> values;
    Wide<uint64_t> scene;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.values...); f(s.scene...); }
};

struct StateWide {
    using IsWideStruct = void;
    Wide<oxrt::FixedArray<float, 4>> weights;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.weights...); }
};

struct RadianceWide {
    using IsWideStruct = void;
    Wide<oxrt::float3> color;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.color...); }
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_checked, closesthit_white };
}

/* What a trace with a Radiance payload can run. */
struct RadiancePrograms : oxrt::NoPrograms {
    using Payload = Radiance;
    static constexpr bool hasClosestHit = true;
    static constexpr bool isValidated = true;
    static void closestHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
};

struct RadianceProgramsLanes : oxrt::NoLanePrograms {
    using Scalar = RadiancePrograms;
    using Payload = Wide<Radiance>;
    static void closestHit(Rays& trace, Mask mask, Payload& payload);
};

Wide<float> total_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, Wide<State>& state, int32_t count);

#line 29 "shader.py"
Wide<float> total_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, Wide<State>& state, int32_t count) {
    Wide<float> result_ = Wide<float>(0.0f);
    for (int32_t k = 0; k < count; ++k) {
#line 31 "shader.py"
        if (oxrt::isCancelled(thread))
            break;
#line 32 "shader.py"
        result_ = result_ + oxrt::checked(thread, mask).item(state.weights, k);
#line 32 "shader.py"
        oxrt::assertTrue(thread, oxrt::Place::current(), mask, result_ == result_, "result is NaN (result = \001, k = \001)", result_, k);
        if (oxrt::any(oxrt::checked(thread, mask).insideItems(state.weights, k))) oxrt::assign(mask, state.weights[k], 0.0f);
    }
#line 34 "shader.py"
    return result_;
}

#line 38 "shader.py"
void raygen_checked_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 39 "shader.py"
    Wide<oxrt::uint3> i = oxrt::getLaunchIndex(thread);
    [[maybe_unused]] Wide<uint32_t> unread = i.x + 1u;
    Wide<State> state = oxrt::spread<16>(State{oxrt::FixedArray<float, 4>{}});
    oxrt::eachItem(oxrt::checked(thread, mask).insideItems(state.weights, i.x % 4u), state.weights, i.x % 4u, [&,
            value = Wide<float>(1.0f)](auto& item, Mask own) { oxrt::assign(own, item, value); });
#line 43 "shader.py"
    Wide<Radiance> ray = Wide<Radiance>{oxrt::checked(thread, mask).load(params.values, i.y, i.x)};
    Wide<oxrt::float3> value_2 = ray.color;
#line 44 "shader.py"
    oxrt::assertTrue(thread, oxrt::Place::current(), mask, value_2 == value_2,
            "origin of trace is NaN (ray.color.x = \001, ray.color.y = \001, ray.color.z = \001)", ray.color.x, ray.color.y, ray.color.z);
#line 44 "shader.py"
    oxrt::trace<RadianceProgramsLanes>(thread, mask, params.scene, value_2, oxrt::float3(0.0f, 0.0f, 1.0f), 0.0f, __builtin_inff(), 0.0f,
            255u, oxrt::KnownFlags<0>(), 0u, 1u, 0u, ray);
#line 45 "shader.py"
    oxrt::assertTrue(thread, oxrt::Place::current(), mask, ray.color.x >= 0.0f, "radiance is not negative (ray.color.x = \001)",
            ray.color.x);
#line 46 "shader.py"
    oxrt::eachLane(mask, [&](int lane) { oxrt::print(thread.atLane(lane), ", ", "\n", "pixel", oxrt::inLane(i.x, lane), oxrt::inLane(i.y,
            lane), oxrt::inLane(ray.color, lane)); });
#line 47 "shader.py"
    Wide<oxrt::float3> value = ray.color;
#line 47 "shader.py"
    oxrt::assertTrue(thread, oxrt::Place::current(), mask, value == value,
            "value is NaN (ray.color.x = \001, ray.color.y = \001, ray.color.z = \001)", ray.color.x, ray.color.y, ray.color.z);
#line 47 "shader.py"
    Wide<float> result_ = total_lanes(thread, mask, state, 3);
#line 47 "shader.py"
    Wide<oxrt::float3> value_3 = value * result_;
#line 47 "shader.py"
    oxrt::assertTrue(thread, oxrt::Place::current(), mask, value_3 == value_3,
            "an element of params.values is NaN (value.x = \001, value.y = \001, value.z = \001, result = \001)", value.x, value.y, value.z,
            result_);
#line 47 "shader.py"
    oxrt::checked(thread, mask).store(value_3, params.values, i.y, i.x);
    oxrt::eachElement<LANES>(oxrt::checked(thread, mask).inside(params.values, 0, 0), [&, value = Wide<float>(1.0f)](auto& element,
            int lane) { oxrt::extractLane(element.x, value, lane); }, params.values, 0, 0);
}

void closesthit_white_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, Wide<Radiance>& ray) {
    oxrt::assign(mask, ray.color, oxrt::float3(1.0f));
}

#line 149 "pipeline.cpp"
void RadianceProgramsLanes::closestHit(Rays& trace, Mask mask, Payload& payload) {
    const Wide<int32_t> program = oxrt::recordPrograms(trace.records, mask, oxrt::SLOT_CLOSESTHIT);
    if (const Mask own = mask & (program == int32_t(number::closesthit_white)); oxrt::any(own))
        closesthit_white_lanes(*trace.thread, own, payload);
    oxrt::payloadMismatch(trace, mask & !((program == int32_t(number::closesthit_white)) | (program == int32_t(OXRT_NO_PROGRAM))));
}

void run_raygen_checked(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::runBlocks<LANES>(*thread, *tile, [](Lanes& lanes, Mask mask) {
        raygen_checked_lanes(lanes, mask);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__checked", OXRT_KIND_RAYGEN, 0, run_raygen_checked},
    {"__closesthit__white", OXRT_KIND_CLOSESTHIT, 0, nullptr},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 16, programs, 2}};
static_assert(sizeof(Params) == 32);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 32, 1, "0.1.0"};
