/* Made by optixc. Compiled features:
   closesthit programs: shader.py:53
   array bounds checks: shader.py:49
*/
#include <oxrt/device.h>

#include <oxrt/lanes_trace.h>

namespace {

enum { LANES = 16 };
template <class T> using Wide = oxrt::Wide<T, LANES>;
using Mask = oxrt::Lanes<bool, LANES>;
using Lanes = oxrt::LanesThread<LANES>;
using Rays = oxrt::RayLanes<LANES>;

struct template_ {
    int32_t double_;
    oxrt::float3 class_;
    int32_t thread;
};

struct Programs_ {
    int32_t int32_t_;
    int32_t trace;
};

struct Params {
    oxrt::Array<int32_t, 1> out;
    uint64_t scene;
    template_ register_;
};

struct template_Wide;
struct Programs_Wide;
struct ParamsWide;
}  // namespace
template <> struct oxrt::WideType<template_, 16> { using Type = template_Wide; };
template <> struct oxrt::WideType<Programs_, 16> { using Type = Programs_Wide; };
template <> struct oxrt::WideType<Params, 16> { using Type = ParamsWide; };
namespace {

struct template_Wide {
    using IsWideStruct = void;
    Wide<int32_t> double_;
    Wide<oxrt::float3> class_;
    Wide<int32_t> thread;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.double_...); f(s.class_...); f(s.thread...); }
};

struct Programs_Wide {
    using IsWideStruct = void;
    Wide<int32_t> int32_t_;
    Wide<int32_t> trace;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.int32_t_...); f(s.trace...); }
};

struct ParamsWide {
    using IsWideStruct = void;
    Wide<oxrt::Array<int32_t, 1>> out;
    Wide<uint64_t> scene;
    Wide<template_> register_;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.out...); f(s.scene...); f(s.register_...); }
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_main, closesthit_delete };
}

/* What a trace with a Programs_ payload can run. */
struct Programs_Programs : oxrt::NoPrograms {
    using Payload = Programs_;
    static constexpr bool hasClosestHit = true;
    static void closestHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
};

struct Programs_ProgramsLanes : oxrt::NoLanePrograms {
    using Scalar = Programs_Programs;
    using Payload = Wide<Programs_>;
    static void closestHit(Rays& trace, Mask mask, Payload& payload);
};

#line 37 "shader.py"
int32_t gruf6udfe(int32_t uf8) {
    return uf8 + 1;
}

#line 90 "pipeline.cpp"
// A comment that ends in a backslash
#line 31 "shader.py"
int32_t namespace_(int32_t auto_, int32_t params_) {
#line 33 "shader.py"
    return auto_ + params_;
}


#line 42 "shader.py"
void raygen_main_lanes([[maybe_unused]] Lanes& thread_, [[maybe_unused]] Mask mask) {
    const Params& params = oxrt::launchParams<Params>(thread_);
#line 43 "shader.py"
    int32_t thread = params.register_.double_;
    int32_t trace = thread + params.register_.thread;
    int32_t long_ = gruf6udfe(trace);
    int32_t oxrt_ = namespace_(long_, trace);
    Wide<Programs_> new_ = oxrt::spread<16>(Programs_{oxrt_, 1});
    oxrt::trace<Programs_ProgramsLanes>(thread_, mask, params.scene, params.register_.class_, oxrt::float3(0.0f, 0.0f, 1.0f), 0.0f,
            __builtin_inff(), 0.0f, 255u, oxrt::KnownFlags<0>(), 0u, 1u, 0u, new_);
#line 49 "shader.py"
    oxrt::checked(thread_, mask).store(new_.int32_t_ + new_.trace, params.out, 0);
}

#line 53 "shader.py"
void closesthit_delete_lanes([[maybe_unused]] Rays& trace_, [[maybe_unused]] Mask mask, Wide<Programs_>& trace) {
    [[maybe_unused]] Lanes& thread_ = *trace_.thread;
    const Params& params = oxrt::launchParams<Params>(thread_);
#line 54 "shader.py"
    int32_t thread = params.register_.thread;
    oxrt::assign(mask, trace.int32_t_, thread);
    oxrt::assign(mask, trace.trace, oxrt::convert<int32_t>(oxrt::getPrimitiveIndex(trace_)));
}

#line 124 "pipeline.cpp"
void Programs_ProgramsLanes::closestHit(Rays& trace, Mask mask, Payload& payload) {
    const Wide<int32_t> program = oxrt::recordPrograms(trace.records, mask, oxrt::SLOT_CLOSESTHIT);
    if (const Mask own = mask & (program == int32_t(number::closesthit_delete)); oxrt::any(own))
        closesthit_delete_lanes(trace, own, payload);
}

void run_raygen_main(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::runBlocks<LANES>(*thread, *tile, [](Lanes& lanes, Mask mask) {
        raygen_main_lanes(lanes, mask);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__main", OXRT_KIND_RAYGEN, 0, run_raygen_main},
    {"__closesthit__delete", OXRT_KIND_CLOSESTHIT, 0, nullptr},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 16, programs, 2}};
static_assert(sizeof(Params) == 48);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 48, 1, "0.1.0"};
