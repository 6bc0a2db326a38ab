/* Made by optixc. Compiled features:
   miss programs: shader.py:60
   closesthit programs: shader.py:50
   anyhit programs: shader.py:66
   recursion: shader.py:55
   array bounds checks: shader.py:40
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
    oxrt::Array<oxrt::float3, 1> out;
    uint64_t scene;
};

struct Path {
    oxrt::float3 color;
    float weight;
    /* Nobody reads seen, note. */
};

struct Count {
    uint32_t hits;
    uint32_t first;
    float last;
};

struct ParamsWide;
struct PathWide;
struct CountWide;
}  // namespace
template <> struct oxrt::WideType<Params, 16> { using Type = ParamsWide; };
template <> struct oxrt::WideType<Path, 16> { using Type = PathWide; };
template <> struct oxrt::WideType<Count, 16> { using Type = CountWide; };
namespace {

struct ParamsWide {
    using IsWideStruct = void;
    Wide<oxrt::Array<oxrt::float3, 1>> out;
    Wide<uint64_t> scene;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.out...); f(s.scene...); }
};

struct PathWide {
    using IsWideStruct = void;
    Wide<oxrt::float3> color;
    Wide<float> weight;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.color...); f(s.weight...); }
};

struct CountWide {
    using IsWideStruct = void;
    Wide<uint32_t> hits;
    Wide<uint32_t> first;
    Wide<float> last;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.hits...); f(s.first...); f(s.last...); }
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_main, closesthit_next, miss_sky, anyhit_count, miss_count };
}

/* What a trace with a Path payload can run. */
struct PathPrograms : oxrt::NoPrograms {
    using Payload = Path;
    static constexpr bool hasClosestHit = true;
    static constexpr bool hasMiss = true;
    static constexpr bool countsDepth = true;
    static constexpr bool checksStack = true;
    static constexpr uint32_t maxTraceDepth = 1;
    static void closestHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
    static void miss(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
};

/* What a trace with a Count payload can run. */
struct CountPrograms : oxrt::NoPrograms {
    using Payload = Count;
    static constexpr bool hasAnyHit = true;
    static constexpr bool inlinesAnyHit = true;
    static constexpr bool hasMiss = true;
    static constexpr bool countsDepth = true;
    static constexpr bool checksStack = true;
    static constexpr uint32_t maxTraceDepth = 1;
    static OXRT_INLINE void anyHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
    static void miss(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
};

struct PathProgramsLanes : oxrt::NoLanePrograms {
    using Scalar = PathPrograms;
    using Payload = Wide<Path>;
    static void closestHit(Rays& trace, Mask mask, Payload& payload);
    static void miss(Rays& trace, Mask mask, Payload& payload);
};

struct CountProgramsLanes : oxrt::NoLanePrograms {
    using Scalar = CountPrograms;
    using Payload = Wide<Count>;
    static constexpr bool callbacksUsePayload = true;
    static void anyHit(Rays& trace, Mask mask, Payload& payload);
    static void miss(Rays& trace, Mask mask, Payload& payload);
};

#line 66 "shader.py"
OXRT_INLINE void anyhit_count(oxrt::Ray& trace, Count& count) {
    count.hits = count.first + 1u;
    count.last = oxrt::getRayTmax(trace);
}

#line 120 "pipeline.cpp"
void shade_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, Wide<Path>& path, Wide<float> by);

#line 38 "shader.py"
void raygen_main_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 39 "shader.py"
    Wide<uint32_t> i = oxrt::getLaunchIndex(thread).x;
    Wide<Path> path = Wide<Path>{oxrt::checked(thread, mask).load(params.out, i), 1.0f};
    oxrt::trace<PathProgramsLanes>(thread, mask, params.scene, oxrt::float3(0.0f), oxrt::float3(0.0f, 0.0f, 1.0f), 0.0f, __builtin_inff(),
            0.0f, 255u, oxrt::KnownFlags<0>(), 0u, 1u, 0u, path);
#line 42 "shader.py"
    path.weight = 0.5f;
    oxrt::trace<PathProgramsLanes>(thread, mask, params.scene, path.color, oxrt::float3(0.0f, 1.0f, 0.0f), 0.0f, __builtin_inff(), 0.0f,
            255u, oxrt::KnownFlags<0>(), 0u, 1u, 0u, path);
#line 44 "shader.py"
    Wide<Count> count = Wide<Count>{0u, i, 0.0f};
    oxrt::trace<CountProgramsLanes>(thread, mask, params.scene, oxrt::float3(0.0f), oxrt::float3(1.0f, 0.0f, 0.0f), 0.0f, __builtin_inff(),
            0.0f, 255u, oxrt::KnownFlags<0>(), 1u, 1u, 1u, count);
#line 46 "shader.py"
    oxrt::checked(thread, mask).store(path.color * oxrt::convert<float>(count.hits), params.out, i);
}

#line 32 "shader.py"
void shade_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, Wide<Path>& path, Wide<float> by) {
    oxrt::assign(mask, path.color, path.color * by + path.weight);
}

#line 50 "shader.py"
void closesthit_next_lanes([[maybe_unused]] Rays& trace, [[maybe_unused]] Mask mask, Wide<Path>& path) {
    [[maybe_unused]] Lanes& thread = *trace.thread;
    const Params& params = oxrt::launchParams<Params>(thread);
#line 51 "shader.py"
    shade_lanes(thread, mask, path, oxrt::getRayTmax(trace));
#line 53 "shader.py"
    Wide<Path> deeper = Wide<Path>{path.color, 0.3f * path.weight};
    const Mask test = path.weight > 0.1f;
#line 54 "shader.py"
    Mask mask_ = mask & test;
#line 54 "shader.py"
    if (oxrt::any(mask_)) {
        oxrt::trace<PathProgramsLanes>(thread, mask_, params.scene, oxrt::float3(0.0f), oxrt::float3(0.0f, 0.0f, 1.0f), 0.0f,
                __builtin_inff(), 0.0f, 255u, oxrt::KnownFlags<0>(), 0u, 1u, 0u, deeper);
    }
#line 56 "shader.py"
    oxrt::assign(mask, path.color, deeper.color);
}

#line 60 "shader.py"
void miss_sky_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, Wide<Path>& path) {
    oxrt::assign(mask, path.color, path.color + oxrt::float3(1.0f));
}

#line 66 "shader.py"
OXRT_INLINE void anyhit_count_lanes([[maybe_unused]] Rays& trace, [[maybe_unused]] Mask mask, Wide<Count>& count) {
    [[maybe_unused]] Lanes& thread = *trace.thread;
#line 67 "shader.py"
    oxrt::assign(mask, count.hits, count.first + 1u);
    oxrt::assign(mask, count.last, oxrt::getRayTmax(trace));
}

#line 72 "shader.py"
void miss_count_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, Wide<Count>& count) {
    oxrt::assign(mask, count.hits, oxrt::select(count.last > 1.0f, Wide<uint32_t>(7u), Wide<uint32_t>(8u)));
}

#line 186 "pipeline.cpp"
void PathProgramsLanes::closestHit(Rays& trace, Mask mask, Payload& payload) {
    const Wide<int32_t> program = oxrt::recordPrograms(trace.records, mask, oxrt::SLOT_CLOSESTHIT);
    if (const Mask own = mask & (program == int32_t(number::closesthit_next)); oxrt::any(own))
        closesthit_next_lanes(trace, own, payload);
}

void PathProgramsLanes::miss(Rays& trace, Mask mask, Payload& payload) {
    const Wide<int32_t> program = oxrt::recordPrograms(trace.records, mask, 0);
    if (const Mask own = mask & (program == int32_t(number::miss_sky)); oxrt::any(own))
        miss_sky_lanes(*trace.thread, own, payload);
}

void CountPrograms::anyHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record) {
    if (record.programs[oxrt::SLOT_ANYHIT] == number::anyhit_count)
        anyhit_count(trace, payload);
}

void CountProgramsLanes::anyHit(Rays& trace, Mask mask, Payload& payload) {
    const Wide<int32_t> program = oxrt::recordPrograms(trace.records, mask, oxrt::SLOT_ANYHIT);
    if (const Mask own = mask & (program == int32_t(number::anyhit_count)); oxrt::any(own))
        anyhit_count_lanes(trace, own, payload);
}

void CountProgramsLanes::miss(Rays& trace, Mask mask, Payload& payload) {
    const Wide<int32_t> program = oxrt::recordPrograms(trace.records, mask, 0);
    if (const Mask own = mask & (program == int32_t(number::miss_count)); oxrt::any(own))
        miss_count_lanes(*trace.thread, own, payload);
}

void run_raygen_main(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::runBlocks<LANES>(*thread, *tile, [](Lanes& lanes, Mask mask) {
        raygen_main_lanes(lanes, mask);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__main", OXRT_KIND_RAYGEN, 0, run_raygen_main},
    {"__closesthit__next", OXRT_KIND_CLOSESTHIT, 0, nullptr},
    {"__miss__sky", OXRT_KIND_MISS, 0, nullptr},
    {"__anyhit__count", OXRT_KIND_ANYHIT, 0, nullptr},
    {"__miss__count", OXRT_KIND_MISS, 0, nullptr},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 16, programs, 5}};
static_assert(sizeof(Params) == 24);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 24, 1, "0.1.0"};
