/* Made by optixc. Compiled features:
   miss programs: shader.py:50
   closesthit programs: shader.py:42
   array bounds checks: shader.py:38
*/
#include <oxrt/device.h>

namespace {

struct Params {
    oxrt::Array<oxrt::float4, 2> image;
    uint64_t scene;
    oxrt::float3 eye;
    oxrt::float3 u;
    oxrt::float3 v;
    oxrt::float3 w;
};

struct Material {
    oxrt::float3 albedo;
};

struct Radiance {
    oxrt::float3 color;
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_pinhole, closesthit_matte, miss_sky };
}

/* What a trace with a Radiance payload can run. */
struct RadiancePrograms : oxrt::NoPrograms {
    using Payload = Radiance;
    static constexpr bool hasClosestHit = true;
    static constexpr bool hasMiss = true;
    static void closestHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
    static void miss(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
};

#line 31 "shader.py"
void raygen_pinhole(OxrtThread& thread) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 32 "shader.py"
    oxrt::uint3 i = oxrt::getLaunchIndex(thread);
#line 32 "shader.py"
    oxrt::uint3 size = oxrt::getLaunchDimensions(thread);
    float x = 2.0f * (float(i.x) + 0.5f) / float(size.x) - 1.0f;
    float y = 1.0f - 2.0f * (float(i.y) + 0.5f) / float(size.y);
    Radiance ray = Radiance{oxrt::float3(0.0f)};
    oxrt::float3 direction = oxrt::normalize(x * params.u + y * params.v + params.w);
    oxrt::trace<RadiancePrograms>(thread, params.scene, params.eye, direction, 0.0f, 1e16f, 0.0f, 255u, oxrt::KnownFlags<0>(), 0u, 1u, 0u,
            ray);
#line 38 "shader.py"
    if (oxrt::checked(thread).contains(params.image, i.y, i.x))
#line 38 "shader.py"
        params.image.at(i.y, i.x) = oxrt::float4(ray.color, 1.0f);
}

#line 61 "pipeline.cpp"
// Brighter where the surface faces the ray.
#line 42 "shader.py"
void closesthit_matte(oxrt::Ray& trace, Radiance& ray, const Material& material) {
#line 44 "shader.py"
    oxrt::Tuple<oxrt::float3, oxrt::float3, oxrt::float3> items = oxrt::getTriangleVertexData(trace);
#line 44 "shader.py"
    oxrt::float3 p0 = oxrt::get<0>(items);
#line 44 "shader.py"
    oxrt::float3 p1 = oxrt::get<1>(items);
#line 44 "shader.py"
    oxrt::float3 p2 = oxrt::get<2>(items);
    oxrt::float3 n = oxrt::transformNormalFromObjectToWorldSpace(trace, oxrt::cross(p1 - p0, p2 - p0));
    ray.color = material.albedo * oxrt::abs(oxrt::dot(oxrt::normalize(n), oxrt::getWorldRayDirection(trace)));
}

#line 50 "shader.py"
void miss_sky(Radiance& ray) {
    ray.color = oxrt::float3(0.5f, 0.7f, 1.0f);
}

#line 82 "pipeline.cpp"
void RadiancePrograms::closestHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record) {
    if (record.programs[oxrt::SLOT_CLOSESTHIT] == number::closesthit_matte)
        closesthit_matte(trace, payload, oxrt::recordData<Material>(record));
}

void RadiancePrograms::miss(oxrt::Ray&, Payload& payload, const OxrtRecordHeader& record) {
    if (record.programs[0] == number::miss_sky)
        miss_sky(payload);
}

void run_raygen_pinhole(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::forEachIndex(*thread, *tile, [thread] {
        raygen_pinhole(*thread);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__pinhole", OXRT_KIND_RAYGEN, 0, run_raygen_pinhole},
    {"__closesthit__matte", OXRT_KIND_CLOSESTHIT, sizeof(Material), nullptr},
    {"__miss__sky", OXRT_KIND_MISS, 0, nullptr},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 1, programs, 3}};
static_assert(sizeof(Params) == 80);
static_assert(sizeof(Material) == 12);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 80, 1, "0.1.0"};
