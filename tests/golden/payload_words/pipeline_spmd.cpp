/* Made by optixc. Compiled features:
   miss programs: shader.py:55
   closesthit programs: shader.py:42
   array bounds checks: shader.py:36
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
    oxrt::Array<uint32_t, 1> out;
    uint64_t scene;
};

struct Mixed {
    oxrt::Word<bool> hit;
    oxrt::Word<uint64_t> where;
    oxrt::float2 uv;
    oxrt::Word<uint8_t> kind;
};

struct Alike {
    oxrt::Word<bool> was_hit;
    oxrt::Word<uint64_t> address;
    oxrt::float2 place;
    oxrt::Word<uint8_t> tag;
};

struct PayloadWords_uint32_float32 {
    uint32_t w0;
    float w1;
};

struct ParamsWide;
struct MixedWide;
struct AlikeWide;
struct PayloadWords_uint32_float32Wide;
}  // namespace
template <> struct oxrt::WideType<Params, 16> { using Type = ParamsWide; };
template <> struct oxrt::WideType<Mixed, 16> { using Type = MixedWide; };
template <> struct oxrt::WideType<Alike, 16> { using Type = AlikeWide; };
template <> struct oxrt::WideType<PayloadWords_uint32_float32, 16> { using Type = PayloadWords_uint32_float32Wide; };
namespace {

struct ParamsWide {
    using IsWideStruct = void;
    Wide<oxrt::Array<uint32_t, 1>> out;
    Wide<uint64_t> scene;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.out...); f(s.scene...); }
};

struct MixedWide {
    using IsWideStruct = void;
    Wide<bool> hit;
    Wide<uint64_t> where;
    Wide<oxrt::float2> uv;
    Wide<uint8_t> kind;
    template <class F, class... S> static OXRT_INLINE void each(const F& f,
            S&... s) { f(s.hit...); f(s.where...); f(s.uv...); f(s.kind...); }
};

struct AlikeWide {
    using IsWideStruct = void;
    Wide<bool> was_hit;
    Wide<uint64_t> address;
    Wide<oxrt::float2> place;
    Wide<uint8_t> tag;
    template <class F, class... S> static OXRT_INLINE void each(const F& f,
            S&... s) { f(s.was_hit...); f(s.address...); f(s.place...); f(s.tag...); }
};

struct PayloadWords_uint32_float32Wide {
    using IsWideStruct = void;
    Wide<uint32_t> w0;
    Wide<float> w1;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.w0...); f(s.w1...); }
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_main, closesthit_mixed, closesthit_alike, miss_words, miss_nothing };
}

/* What a trace with a Mixed payload can run. */
struct MixedPrograms : oxrt::NoPrograms {
    using Payload = Mixed;
    static constexpr bool hasClosestHit = true;
    static constexpr bool hasMiss = true;
    static void closestHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
    static void miss(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
};

/* What a trace with a PayloadWords_uint32_float32 payload can run. */
struct PayloadWords_uint32_float32Programs : oxrt::NoPrograms {
    using Payload = PayloadWords_uint32_float32;
    static constexpr bool hasMiss = true;
    static void miss(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
};

struct MixedProgramsLanes : oxrt::NoLanePrograms {
    using Scalar = MixedPrograms;
    using Payload = Wide<Mixed>;
    static constexpr bool usesPayloadWords = true;
    static void closestHit(Rays& trace, Mask mask, Payload& payload);
    static void miss(Rays& trace, Mask mask, Payload& payload);
};

struct PayloadWords_uint32_float32ProgramsLanes : oxrt::NoLanePrograms {
    using Scalar = PayloadWords_uint32_float32Programs;
    using Payload = Wide<PayloadWords_uint32_float32>;
    static constexpr bool usesPayloadWords = true;
    static void miss(Rays& trace, Mask mask, Payload& payload);
};


#line 33 "shader.py"
void raygen_main_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 34 "shader.py"
    Wide<Mixed> mixed = oxrt::spread<16>(Mixed{false, UINT64_C(1), oxrt::float2(0.0f), uint8_t(3u)});
    oxrt::trace<MixedProgramsLanes>(thread, mask, params.scene, oxrt::float3(0.0f), oxrt::float3(0.0f, 0.0f, 1.0f), 0.0f, __builtin_inff(),
            0.0f, 255u, oxrt::KnownFlags<0>(), 0u, 1u, 0u, mixed);
#line 36 "shader.py"
    oxrt::checked(thread, mask).store(oxrt::select(Wide<bool>(mixed.hit), oxrt::convert<uint32_t>(Wide<uint64_t>(mixed.where) >> 32u),
            oxrt::convert<uint32_t>(Wide<uint8_t>(mixed.kind))), params.out, 0);
#line 37 "shader.py"
    Wide<PayloadWords_uint32_float32> payload = oxrt::spread<16>(PayloadWords_uint32_float32{oxrt::checkedCommon(thread,
            mask).load(params.out, 1), 0.5f});
#line 37 "shader.py"
    oxrt::trace<PayloadWords_uint32_float32ProgramsLanes>(thread, mask, params.scene, oxrt::float3(0.0f), oxrt::float3(0.0f, 0.0f, 1.0f),
            0.0f, __builtin_inff(), 0.0f, 255u, oxrt::KnownFlags<0>(), 0u, 1u, 0u, payload);
#line 37 "shader.py"
    Wide<uint32_t> first = payload.w0;
#line 37 "shader.py"
    Wide<float> second = payload.w1;
    oxrt::checked(thread, mask).store(first + oxrt::convert<uint32_t>(second), params.out, 2);
}

#line 42 "shader.py"
void closesthit_mixed_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, Wide<Mixed>& mixed) {
    oxrt::assign(mask, mixed.hit, true);
    oxrt::assign(mask, mixed.where, Wide<uint64_t>(mixed.where) + UINT64_C(4294967296));
}

#line 49 "shader.py"
void closesthit_alike_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, Wide<Alike>& alike) {
    oxrt::assign(mask, alike.was_hit, !Wide<bool>(alike.was_hit));
    oxrt::assign(mask, alike.tag, oxrt::convert<uint8_t>(7u));
}

#line 55 "shader.py"
void miss_words_lanes([[maybe_unused]] Rays& trace, [[maybe_unused]] Mask mask) {
    [[maybe_unused]] Lanes& thread = *trace.thread;
#line 56 "shader.py"
    oxrt::setPayloadWord(trace, mask, 1, oxrt::payloadWord(trace, 0) + 1u);
}

#line 60 "shader.py"
void miss_nothing_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask) {
}

#line 171 "pipeline.cpp"
void MixedProgramsLanes::closestHit(Rays& trace, Mask mask, Payload& payload) {
    const Wide<int32_t> program = oxrt::recordPrograms(trace.records, mask, oxrt::SLOT_CLOSESTHIT);
    if (const Mask own = mask & (program == int32_t(number::closesthit_mixed)); oxrt::any(own))
        closesthit_mixed_lanes(*trace.thread, own, payload);
    if (const Mask own = mask & (program == int32_t(number::closesthit_alike)); oxrt::any(own))
        closesthit_alike_lanes(*trace.thread, own, oxrt::WidePayloadAs<Alike, Mixed, LANES>(payload));
}

void MixedProgramsLanes::miss(Rays& trace, Mask mask, Payload&) {
    const Wide<int32_t> program = oxrt::recordPrograms(trace.records, mask, 0);
    if (const Mask own = mask & (program == int32_t(number::miss_words)); oxrt::any(own))
        miss_words_lanes(trace, own);
    if (const Mask own = mask & (program == int32_t(number::miss_nothing)); oxrt::any(own))
        miss_nothing_lanes(*trace.thread, own);
}

void PayloadWords_uint32_float32ProgramsLanes::miss(Rays& trace, Mask mask, Payload&) {
    const Wide<int32_t> program = oxrt::recordPrograms(trace.records, mask, 0);
    if (const Mask own = mask & (program == int32_t(number::miss_words)); oxrt::any(own))
        miss_words_lanes(trace, own);
    if (const Mask own = mask & (program == int32_t(number::miss_nothing)); oxrt::any(own))
        miss_nothing_lanes(*trace.thread, own);
}

void run_raygen_main(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::runBlocks<LANES>(*thread, *tile, [](Lanes& lanes, Mask mask) {
        raygen_main_lanes(lanes, mask);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__main", OXRT_KIND_RAYGEN, 0, run_raygen_main},
    {"__closesthit__mixed", OXRT_KIND_CLOSESTHIT, 0, nullptr},
    {"__closesthit__alike", OXRT_KIND_CLOSESTHIT, 0, nullptr},
    {"__miss__words", OXRT_KIND_MISS, 0, nullptr},
    {"__miss__nothing", OXRT_KIND_MISS, 0, nullptr},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 16, programs, 5}};
static_assert(sizeof(Params) == 24);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 24, 1, "0.1.0"};
