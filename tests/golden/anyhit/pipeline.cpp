/* Made by optixc. Compiled features:
   miss programs: shader.py:64
   anyhit programs: shader.py:52
   occlusion queries: shader.py:39
   face and any-hit culling: shader.py:39
   array bounds checks: shader.py:39
*/
#include <oxrt/device.h>

namespace {

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

#line 30 "shader.py"
OXRT_INLINE void stop_if_dark(oxrt::Ray& trace, const Shadow& shadow) {
    if (shadow.light.x < 0.01f) {
        oxrt::terminateRay(trace);
        return;
    }
}

#line 36 "shader.py"
void raygen_lights(OxrtThread& thread) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 37 "shader.py"
    uint32_t i = oxrt::getLaunchIndex(thread).x;
    Shadow shadow = Shadow{oxrt::float3(1.0f), 0};
    oxrt::trace<ShadowPrograms>(thread, params.scene, oxrt::checked(thread).load(params.light, i), oxrt::float3(0.0f, 1.0f, 0.0f), 0.0f,
            __builtin_inff(), 0.0f, 255u, params.flags, 0u, 1u, 0u, shadow);
#line 40 "shader.py"
    oxrt::trace<ShadowPrograms>(thread, params.scene, oxrt::checked(thread).load(params.light, i), oxrt::float3(0.0f, 0.0f, 1.0f), 0.0f,
            __builtin_inff(), 0.0f, 255u, oxrt::KnownFlags<12>(), 1u, 1u, 0u, shadow);
#line 48 "shader.py"
    if (oxrt::checked(thread).contains(params.light, i))
#line 48 "shader.py"
        params.light.at(i) = shadow.light;
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

#line 64 "shader.py"
void miss_dark(Shadow& shadow) {
    shadow.light = oxrt::float3(0.0f);
}

#line 95 "pipeline.cpp"
void ShadowPrograms::anyHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record) {
    if (record.programs[oxrt::SLOT_ANYHIT] == number::anyhit_glass)
        anyhit_glass(trace, payload, oxrt::recordData<Glass>(record));
}

void ShadowPrograms::miss(oxrt::Ray&, Payload& payload, const OxrtRecordHeader& record) {
    if (record.programs[0] == number::miss_dark)
        miss_dark(payload);
}

void run_raygen_lights(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::forEachIndex(*thread, *tile, [thread] {
        raygen_lights(*thread);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__lights", OXRT_KIND_RAYGEN, 0, run_raygen_lights},
    {"__anyhit__glass", OXRT_KIND_ANYHIT, sizeof(Glass), nullptr},
    {"__miss__dark", OXRT_KIND_MISS, 0, nullptr},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 1, programs, 3}};
static_assert(sizeof(Params) == 32);
static_assert(sizeof(Glass) == 16);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 32, 1, "0.1.0"};
