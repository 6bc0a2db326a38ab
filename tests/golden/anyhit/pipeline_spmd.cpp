/* Made by optixc. Compiled features:
   miss programs: shader.py:64
   anyhit programs: shader.py:52
   occlusion queries: shader.py:39
   face and any-hit culling: shader.py:39
   array bounds checks: shader.py:39
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
    oxrt::Array<oxrt::float3, 1> light;
    uint64_t scene;
    uint32_t flags;
};

struct Glass {
    oxrt::float3 tint;
    float opacity;
};

struct Shadow {
    oxrt::float3 light;
    int32_t hits;
};

struct ParamsWide;
struct GlassWide;
struct ShadowWide;
}  // namespace
template <> struct oxrt::WideType<Params, 16> { using Type = ParamsWide; };
template <> struct oxrt::WideType<Glass, 16> { using Type = GlassWide; };
template <> struct oxrt::WideType<Shadow, 16> { using Type = ShadowWide; };
namespace {

struct ParamsWide {
    using IsWideStruct = void;
    Wide<oxrt::Array<oxrt::float3, 1>> light;
    Wide<uint64_t> scene;
    Wide<uint32_t> flags;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.light...); f(s.scene...); f(s.flags...); }
};

struct GlassWide {
    using IsWideStruct = void;
    Wide<oxrt::float3> tint;
    Wide<float> opacity;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.tint...); f(s.opacity...); }
};

struct ShadowWide {
    using IsWideStruct = void;
    Wide<oxrt::float3> light;
    Wide<int32_t> hits;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.light...); f(s.hits...); }
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_lights, anyhit_glass, miss_dark };
}

/* What a trace with a Shadow payload can run. */
struct ShadowPrograms : oxrt::NoPrograms {
    using Payload = Shadow;
    static constexpr bool hasAnyHit = true;
    static constexpr bool inlinesAnyHit = true;
    static constexpr bool hasMiss = true;
    static OXRT_INLINE void anyHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
    static void miss(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
};

struct ShadowProgramsLanes : oxrt::NoLanePrograms {
    using Scalar = ShadowPrograms;
    using Payload = Wide<Shadow>;
    static constexpr bool callbacksUsePayload = true;
    static void anyHit(Rays& trace, Mask mask, Payload& payload);
    static void miss(Rays& trace, Mask mask, Payload& payload);
};

#line 30 "shader.py"
OXRT_INLINE void stop_if_dark(oxrt::Ray& trace, const Shadow& shadow) {
    if (shadow.light.x < 0.01f) {
        oxrt::terminateRay(trace);
        return;
    }
}

#line 52 "shader.py"
OXRT_INLINE void anyhit_glass(oxrt::Ray& trace, Shadow& shadow, const Glass& glass) {
    shadow.hits = shadow.hits + 1;
    oxrt::float2 uv = oxrt::getTriangleBarycentrics(trace);
    if (uv.x + uv.y < glass.opacity) {
        oxrt::ignoreIntersection(trace);
        return;
    }
#line 57 "shader.py"
    shadow.light = shadow.light * glass.tint;
    stop_if_dark(trace, shadow);
#line 58 "shader.py"
    if (oxrt::hasEnded(trace))
        return;
#line 59 "shader.py"
    if (oxrt::isFrontFaceHit(trace)) {
        oxrt::ignoreIntersection(trace);
        return;
    }
}

#line 120 "pipeline.cpp"
OXRT_INLINE void stop_if_dark_lanes([[maybe_unused]] Rays& trace, [[maybe_unused]] Mask mask, const Wide<Shadow>& shadow);

#line 36 "shader.py"
void raygen_lights_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 37 "shader.py"
    Wide<uint32_t> i = oxrt::getLaunchIndex(thread).x;
    Wide<Shadow> shadow = oxrt::spread<16>(Shadow{oxrt::float3(1.0f), 0});
    oxrt::trace<ShadowProgramsLanes>(thread, mask, params.scene, oxrt::checked(thread, mask).load(params.light, i), oxrt::float3(0.0f, 1.0f,
            0.0f), 0.0f, __builtin_inff(), 0.0f, 255u, params.flags, 0u, 1u, 0u, shadow);
#line 40 "shader.py"
    oxrt::trace<ShadowProgramsLanes>(thread, mask, params.scene, oxrt::checked(thread, mask).load(params.light, i), oxrt::float3(0.0f, 0.0f,
            1.0f), 0.0f, __builtin_inff(), 0.0f, 255u, oxrt::KnownFlags<12>(), 1u, 1u, 0u, shadow);
#line 48 "shader.py"
    oxrt::checked(thread, mask).store(shadow.light, params.light, i);
}

#line 30 "shader.py"
OXRT_INLINE void stop_if_dark_lanes([[maybe_unused]] Rays& trace, [[maybe_unused]] Mask mask, const Wide<Shadow>& shadow) {
    [[maybe_unused]] Lanes& thread = *trace.thread;
    const Mask test = shadow.light.x < 0.01f;
#line 31 "shader.py"
    Mask mask_ = mask & test;
#line 31 "shader.py"
    if (oxrt::any(mask_)) {
        oxrt::terminateRay(trace, mask_);
#line 32 "shader.py"
        mask_ = false;
    }
    mask = mask_ | oxrt::without(mask, test);
}

#line 52 "shader.py"
OXRT_INLINE void anyhit_glass_lanes([[maybe_unused]] Rays& trace, [[maybe_unused]] Mask mask, Wide<Shadow>& shadow,
        const Wide<Glass>& glass) {
    [[maybe_unused]] Lanes& thread = *trace.thread;
#line 53 "shader.py"
    oxrt::assign(mask, shadow.hits, shadow.hits + 1);
    Wide<oxrt::float2> uv = oxrt::getTriangleBarycentrics(trace);
    const Mask test = uv.x + uv.y < glass.opacity;
#line 55 "shader.py"
    Mask mask_ = mask & test;
#line 55 "shader.py"
    if (oxrt::any(mask_)) {
        oxrt::ignoreIntersection(trace, mask_);
#line 56 "shader.py"
        mask_ = false;
    }
    mask = mask_ | oxrt::without(mask, test);
    if (oxrt::any(mask)) {
#line 57 "shader.py"
        oxrt::assign(mask, shadow.light, shadow.light * glass.tint);
        stop_if_dark_lanes(trace, mask, shadow);
#line 58 "shader.py"
        mask = oxrt::without(mask, oxrt::endedLanes(trace));
        if (oxrt::any(mask)) {
            const Mask test_ = oxrt::isFrontFaceHit(trace);
#line 59 "shader.py"
            Mask mask_2 = mask & test_;
#line 59 "shader.py"
            if (oxrt::any(mask_2)) {
                oxrt::ignoreIntersection(trace, mask_2);
#line 60 "shader.py"
                mask_2 = false;
            }
            mask = mask_2 | oxrt::without(mask, test_);
        }
    }
}

#line 64 "shader.py"
void miss_dark_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, Wide<Shadow>& shadow) {
    oxrt::assign(mask, shadow.light, oxrt::float3(0.0f));
}

#line 196 "pipeline.cpp"
void ShadowPrograms::anyHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record) {
    if (record.programs[oxrt::SLOT_ANYHIT] == number::anyhit_glass)
        anyhit_glass(trace, payload, oxrt::recordData<Glass>(record));
}

void ShadowProgramsLanes::anyHit(Rays& trace, Mask mask, Payload& payload) {
    const Wide<int32_t> program = oxrt::recordPrograms(trace.records, mask, oxrt::SLOT_ANYHIT);
    if (const Mask own = mask & (program == int32_t(number::anyhit_glass)); oxrt::any(own))
        anyhit_glass_lanes(trace, own, payload, oxrt::loadRecord<Glass>(trace.records, own));
}

void ShadowProgramsLanes::miss(Rays& trace, Mask mask, Payload& payload) {
    const Wide<int32_t> program = oxrt::recordPrograms(trace.records, mask, 0);
    if (const Mask own = mask & (program == int32_t(number::miss_dark)); oxrt::any(own))
        miss_dark_lanes(*trace.thread, own, payload);
}

void run_raygen_lights(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::runBlocks<LANES>(*thread, *tile, [](Lanes& lanes, Mask mask) {
        raygen_lights_lanes(lanes, mask);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__lights", OXRT_KIND_RAYGEN, 0, run_raygen_lights},
    {"__anyhit__glass", OXRT_KIND_ANYHIT, sizeof(Glass), nullptr},
    {"__miss__dark", OXRT_KIND_MISS, 0, nullptr},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 16, programs, 3}};
static_assert(sizeof(Params) == 32);
static_assert(sizeof(Glass) == 16);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 32, 1, "0.1.0"};
