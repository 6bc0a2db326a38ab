/* Made by optixc. Compiled features:
   closesthit programs: shader.py:41
   exception programs: shader.py:48
   exceptions thrown: shader.py:34
   array bounds checks: shader.py:37
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
    oxrt::Array<int32_t, 1> codes;
    uint64_t scene;
};

struct Distance {
    float t;
};

struct ParamsWide;
struct DistanceWide;
}  // namespace
template <> struct oxrt::WideType<Params, 16> { using Type = ParamsWide; };
template <> struct oxrt::WideType<Distance, 16> { using Type = DistanceWide; };
namespace {

struct ParamsWide {
    using IsWideStruct = void;
    Wide<oxrt::Array<int32_t, 1>> codes;
    Wide<uint64_t> scene;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.codes...); f(s.scene...); }
};

struct DistanceWide {
    using IsWideStruct = void;
    Wide<float> t;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.t...); }
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_throwing, closesthit_throwing, exception_note };
}

/* What a trace with a Distance payload can run. */
struct DistancePrograms : oxrt::NoPrograms {
    using Payload = Distance;
    static constexpr bool hasClosestHit = true;
    static constexpr bool mayThrow = true;
    static void closestHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
};

struct DistanceProgramsLanes : oxrt::NoLanePrograms {
    using Scalar = DistancePrograms;
    using Payload = Wide<Distance>;
    static void closestHit(Rays& trace, Mask mask, Payload& payload);
};

#line 48 "shader.py"
void exception_note(OxrtThread& thread) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 49 "shader.py"
    if (oxrt::checked(thread).contains(params.codes, oxrt::getLaunchIndex(thread).x))
#line 49 "shader.py"
        params.codes.at(oxrt::getLaunchIndex(thread).x) = -oxrt::getExceptionCode(thread);
}

#line 77 "pipeline.cpp"
Wide<float> check_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, Wide<float> t);

#line 24 "shader.py"
Wide<float> check_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, Wide<float> t) {
    Wide<float> result{};
    const Mask test = t < 0.0f;
#line 25 "shader.py"
    Mask mask_ = mask & test;
#line 25 "shader.py"
    if (oxrt::any(mask_)) {
        oxrt::throwException(thread, mask_, "shader.py:26", 7, 1u, 2u);
#line 26 "shader.py"
        mask_ = false;
    }
    mask = mask_ | oxrt::without(mask, test);
    if (oxrt::any(mask)) {
#line 27 "shader.py"
        oxrt::assign(mask, result, oxrt::sqrt(t));
#line 27 "shader.py"
        mask = false;
    }
    return result;
}

#line 31 "shader.py"
void raygen_throwing_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 32 "shader.py"
    Wide<uint32_t> i = oxrt::getLaunchIndex(thread).x;
    const Mask test = i == 13u;
#line 33 "shader.py"
    Mask mask_ = mask & test;
#line 33 "shader.py"
    if (oxrt::any(mask_)) {
        oxrt::throwException(thread, mask_, "shader.py:34", 13);
#line 34 "shader.py"
        mask_ = false;
    }
    mask = mask_ | oxrt::without(mask, test);
    if (oxrt::any(mask)) {
#line 35 "shader.py"
        Wide<Distance> found = oxrt::spread<16>(Distance{0.0f});
        oxrt::trace<DistanceProgramsLanes>(thread, mask, params.scene, oxrt::float3(0.0f), oxrt::float3(0.0f, 0.0f, 1.0f), 0.0f,
                __builtin_inff(), 0.0f, 255u, oxrt::KnownFlags<0>(), 0u, 1u, 0u, found);
#line 36 "shader.py"
        mask = oxrt::without(mask, thread.thrown);
        if (oxrt::any(mask)) {
#line 37 "shader.py"
            Wide<float> result_ = check_lanes(thread, mask, found.t);
#line 37 "shader.py"
            mask = oxrt::without(mask, thread.thrown);
            if (oxrt::any(mask)) {
#line 37 "shader.py"
                oxrt::checked(thread, mask).store(oxrt::convert<int32_t>(result_), params.codes, i);
            }
        }
    }
}

#line 41 "shader.py"
void closesthit_throwing_lanes([[maybe_unused]] Rays& trace, [[maybe_unused]] Mask mask, Wide<Distance>& found) {
    [[maybe_unused]] Lanes& thread = *trace.thread;
#line 42 "shader.py"
    oxrt::assign(mask, found.t, oxrt::getRayTmax(trace));
    const Mask test = oxrt::getPrimitiveIndex(trace) == 5u;
#line 43 "shader.py"
    Mask mask_ = mask & test;
#line 43 "shader.py"
    if (oxrt::any(mask_)) {
        oxrt::throwException(thread, mask_, "shader.py:44", 5);
#line 44 "shader.py"
        mask_ = false;
    }
    mask = mask_ | oxrt::without(mask, test);
}

#line 154 "pipeline.cpp"
void DistanceProgramsLanes::closestHit(Rays& trace, Mask mask, Payload& payload) {
    const Wide<int32_t> program = oxrt::recordPrograms(trace.records, mask, oxrt::SLOT_CLOSESTHIT);
    if (const Mask own = mask & (program == int32_t(number::closesthit_throwing)); oxrt::any(own))
        closesthit_throwing_lanes(trace, own, payload);
}

void run_raygen_throwing(OxrtThread* caller, const OxrtTile* tile) {
    oxrt::runBlocks<LANES>(*caller, *tile, [](Lanes& lanes, Mask mask) {
        raygen_throwing_lanes(lanes, mask);
        oxrt::eachLane(lanes.thrown, [&](int lane) {
            OxrtThread* thread = &oxrt::throwingLane(lanes, lane);
            switch (oxrt::takeException(*thread)) {
                case number::exception_note: exception_note(*thread); break;
                default: break;
            }
        });
    });
}

const OxrtProgram programs[] = {
    {"__raygen__throwing", OXRT_KIND_RAYGEN, 0, run_raygen_throwing},
    {"__closesthit__throwing", OXRT_KIND_CLOSESTHIT, 0, nullptr},
    {"__exception__note", OXRT_KIND_EXCEPTION, 0, nullptr},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 16, programs, 3}};
static_assert(sizeof(Params) == 24);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 24, 1, "0.1.0"};
