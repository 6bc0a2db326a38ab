/* Made by optixc. Compiled features:
   miss programs: shader.py:60
   closesthit programs: shader.py:50
   anyhit programs: shader.py:66
   recursion: shader.py:55
   array bounds checks: shader.py:40
*/
#include <oxrt/device.h>

namespace {

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

#line 32 "shader.py"
void shade(Path& path, float by) {
    path.color = path.color * by + path.weight;
}

#line 38 "shader.py"
void raygen_main(OxrtThread& thread) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 39 "shader.py"
    uint32_t i = oxrt::getLaunchIndex(thread).x;
    Path path = Path{oxrt::checked(thread).load(params.out, i), 1.0f};
    oxrt::trace<PathPrograms>(thread, params.scene, oxrt::float3(0.0f), oxrt::float3(0.0f, 0.0f, 1.0f), 0.0f, __builtin_inff(), 0.0f, 255u,
            oxrt::KnownFlags<0>(), 0u, 1u, 0u, path);
#line 42 "shader.py"
    path.weight = 0.5f;
    oxrt::trace<PathPrograms>(thread, params.scene, path.color, oxrt::float3(0.0f, 1.0f, 0.0f), 0.0f, __builtin_inff(), 0.0f, 255u,
            oxrt::KnownFlags<0>(), 0u, 1u, 0u, path);
#line 44 "shader.py"
    Count count = Count{0u, i, 0.0f};
    oxrt::trace<CountPrograms>(thread, params.scene, oxrt::float3(0.0f), oxrt::float3(1.0f, 0.0f, 0.0f), 0.0f, __builtin_inff(), 0.0f, 255u,
            oxrt::KnownFlags<0>(), 1u, 1u, 1u, count);
#line 46 "shader.py"
    if (oxrt::checked(thread).contains(params.out, i))
#line 46 "shader.py"
        params.out.at(i) = path.color * float(count.hits);
}

#line 50 "shader.py"
void closesthit_next(oxrt::Ray& trace, Path& path) {
    OxrtThread& thread = *trace.thread;
    const Params& params = oxrt::launchParams<Params>(thread);
#line 51 "shader.py"
    shade(path, oxrt::getRayTmax(trace));
#line 53 "shader.py"
    Path deeper = Path{path.color, 0.3f * path.weight};
    if (path.weight > 0.1f) {
        oxrt::trace<PathPrograms>(thread, params.scene, oxrt::float3(0.0f), oxrt::float3(0.0f, 0.0f, 1.0f), 0.0f, __builtin_inff(), 0.0f,
                255u, oxrt::KnownFlags<0>(), 0u, 1u, 0u, deeper);
    }
#line 56 "shader.py"
    path.color = deeper.color;
}

#line 60 "shader.py"
void miss_sky(Path& path) {
    path.color = path.color + oxrt::float3(1.0f);
}

#line 66 "shader.py"
OXRT_INLINE void anyhit_count(oxrt::Ray& trace, Count& count) {
    count.hits = count.first + 1u;
    count.last = oxrt::getRayTmax(trace);
}

#line 72 "shader.py"
void miss_count(Count& count) {
    count.hits = count.last > 1.0f ? 7u : 8u;
}

#line 119 "pipeline.cpp"
void PathPrograms::closestHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record) {
    if (record.programs[oxrt::SLOT_CLOSESTHIT] == number::closesthit_next)
        closesthit_next(trace, payload);
}

void PathPrograms::miss(oxrt::Ray&, Payload& payload, const OxrtRecordHeader& record) {
    if (record.programs[0] == number::miss_sky)
        miss_sky(payload);
}

void CountPrograms::anyHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record) {
    if (record.programs[oxrt::SLOT_ANYHIT] == number::anyhit_count)
        anyhit_count(trace, payload);
}

void CountPrograms::miss(oxrt::Ray&, Payload& payload, const OxrtRecordHeader& record) {
    if (record.programs[0] == number::miss_count)
        miss_count(payload);
}

void run_raygen_main(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::forEachIndex(*thread, *tile, [thread] {
        raygen_main(*thread);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__main", OXRT_KIND_RAYGEN, 0, run_raygen_main},
    {"__closesthit__next", OXRT_KIND_CLOSESTHIT, 0, nullptr},
    {"__miss__sky", OXRT_KIND_MISS, 0, nullptr},
    {"__anyhit__count", OXRT_KIND_ANYHIT, 0, nullptr},
    {"__miss__count", OXRT_KIND_MISS, 0, nullptr},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 1, programs, 5}};
static_assert(sizeof(Params) == 24);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 24, 1, "0.1.0"};
