/* Made by optixc. Compiled features:
   miss programs: shader.py:66
   closesthit programs: shader.py:52
   recursion: shader.py:61
   occlusion queries: shader.py:39
   array bounds checks: shader.py:48
*/
#include <oxrt/device.h>

namespace {

struct Params {
    oxrt::Array<oxrt::float3, 1> image;
    uint64_t scene;
    oxrt::float3 light;
};

struct Mirror {
    oxrt::float3 tint;
};

struct Radiance {
    oxrt::float3 color;
    /* Nobody reads depth. */
};

struct Light {
    oxrt::Word<bool> visible;
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_image, closesthit_matte, closesthit_mirror, miss_black, miss_visible };
}

/* What a trace with a Radiance payload can run. */
struct RadiancePrograms : oxrt::NoPrograms {
    using Payload = Radiance;
    static constexpr bool hasClosestHit = true;
    static constexpr bool hasMiss = true;
    static constexpr bool countsDepth = true;
    static constexpr bool checksStack = true;
    static constexpr uint32_t maxTraceDepth = 3;
    static void closestHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
    static void miss(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
};

/* What a trace with a Light payload can run. */
struct LightPrograms : oxrt::NoPrograms {
    using Payload = Light;
    static constexpr bool hasMiss = true;
    static constexpr bool countsDepth = true;
    static constexpr bool checksStack = true;
    static constexpr uint32_t maxTraceDepth = 3;
    static void miss(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
};

#line 37 "shader.py"
float lit(OxrtThread& thread, oxrt::float3 point) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 38 "shader.py"
    Light light = Light{false};
    oxrt::trace<LightPrograms>(thread, params.scene, point, params.light - point, 0.001f, 1.0f, 0.0f, 255u, oxrt::KnownFlags<13>(), 0u, 1u,
            1u, light);
#line 40 "shader.py"
    return bool(light.visible) ? 1.0f : 0.0f;
}

#line 44 "shader.py"
void raygen_image(OxrtThread& thread) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 45 "shader.py"
    oxrt::uint3 i = oxrt::getLaunchIndex(thread);
    Radiance ray = Radiance{oxrt::float3(0.0f)};
    oxrt::trace<RadiancePrograms>(thread, params.scene, oxrt::float3(float(i.x), 0.0f, 0.0f), oxrt::float3(0.0f, 0.0f, 1.0f), 0.0f,
            __builtin_inff(), 0.0f, 255u, oxrt::KnownFlags<0>(), 0u, 1u, 0u, ray);
#line 48 "shader.py"
    if (oxrt::checked(thread).contains(params.image, i.x))
#line 48 "shader.py"
        params.image.at(i.x) = ray.color;
}

#line 52 "shader.py"
void closesthit_matte(oxrt::Ray& trace, Radiance& ray) {
    OxrtThread& thread = *trace.thread;
#line 53 "shader.py"
    oxrt::float3 point = oxrt::getWorldRayOrigin(trace) + oxrt::getRayTmax(trace) * oxrt::getWorldRayDirection(trace);
    float result = lit(thread, point);
#line 54 "shader.py"
    ray.color = oxrt::float3(result);
}

#line 58 "shader.py"
void closesthit_mirror(oxrt::Ray& trace, Radiance& ray, const Mirror& mirror) {
    OxrtThread& thread = *trace.thread;
    const Params& params = oxrt::launchParams<Params>(thread);
#line 59 "shader.py"
    oxrt::float3 point = oxrt::getWorldRayOrigin(trace) + oxrt::getRayTmax(trace) * oxrt::getWorldRayDirection(trace);
    Radiance deeper = Radiance{oxrt::float3(0.0f)};
    oxrt::trace<RadiancePrograms>(thread, params.scene, point, -oxrt::getWorldRayDirection(trace), 0.001f, __builtin_inff(), 0.0f, 255u,
            oxrt::KnownFlags<0>(), 0u, 1u, 0u, deeper);
#line 62 "shader.py"
    ray.color = mirror.tint * deeper.color;
}

#line 66 "shader.py"
void miss_black(Radiance& ray) {
    ray.color = oxrt::float3(0.0f);
}

#line 71 "shader.py"
void miss_visible(Light& light) {
    light.visible = true;
}

#line 117 "pipeline.cpp"
void RadiancePrograms::closestHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record) {
    switch (record.programs[oxrt::SLOT_CLOSESTHIT]) {
        case number::closesthit_matte: closesthit_matte(trace, payload); break;
        case number::closesthit_mirror: closesthit_mirror(trace, payload, oxrt::recordData<Mirror>(record)); break;
        default: break;
    }
}

void RadiancePrograms::miss(oxrt::Ray&, Payload& payload, const OxrtRecordHeader& record) {
    if (record.programs[0] == number::miss_black)
        miss_black(payload);
}

void LightPrograms::miss(oxrt::Ray&, Payload& payload, const OxrtRecordHeader& record) {
    if (record.programs[0] == number::miss_visible)
        miss_visible(payload);
}

void run_raygen_image(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::forEachIndex(*thread, *tile, [thread] {
        raygen_image(*thread);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__image", OXRT_KIND_RAYGEN, 0, run_raygen_image},
    {"__closesthit__matte", OXRT_KIND_CLOSESTHIT, 0, nullptr},
    {"__closesthit__mirror", OXRT_KIND_CLOSESTHIT, sizeof(Mirror), nullptr},
    {"__miss__black", OXRT_KIND_MISS, 0, nullptr},
    {"__miss__visible", OXRT_KIND_MISS, 0, nullptr},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 1, programs, 5}};
static_assert(sizeof(Params) == 40);
static_assert(sizeof(Mirror) == 12);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 40, 3, "0.1.0"};
