/* Made by optixc. Compiled features:
   closesthit programs: shader.py:38
   hit objects: shader.py:30
   array bounds checks: shader.py:34
*/
#include <oxrt/device.h>
#include <oxrt/device_make_hit.h>

namespace {

struct Params {
    oxrt::Array<oxrt::float3, 1> seen;
    uint64_t scene;
};

struct Radiance {
    oxrt::float3 color;
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_main, closesthit_white };
}

/* What a trace with a Radiance payload can run. */
struct RadiancePrograms : oxrt::NoPrograms {
    using Payload = Radiance;
    static constexpr bool hasClosestHit = true;
    static void closestHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
};

#line 22 "shader.py"
bool is_near(oxrt::HitObject& hitObject) {
    return oxrt::hitObjectIsHit(hitObject) && oxrt::hitObjectGetRayTmax(hitObject) < 1.0f;
}

#line 27 "shader.py"
void raygen_main(OxrtThread& thread) {
    const Params& params = oxrt::launchParams<Params>(thread);
    oxrt::HitObject hitObject(thread);
#line 28 "shader.py"
    uint32_t i = oxrt::getLaunchIndex(thread).x;
    Radiance ray = Radiance{oxrt::float3(0.0f)};
    oxrt::traverse<RadiancePrograms>(thread, hitObject, params.scene, oxrt::float3(0.0f), oxrt::float3(0.0f, 0.0f, 1.0f), 0.0f,
            __builtin_inff(), 0.0f, 255u, oxrt::KnownFlags<0>(), 0u, 1u, 0u, ray);
#line 31 "shader.py"
    if (is_near(hitObject)) {
        oxrt::invoke<RadiancePrograms>(thread, hitObject, ray);
    }
#line 33 "shader.py"
    oxrt::trace<RadiancePrograms>(thread, params.scene, oxrt::float3(0.0f), oxrt::float3(0.0f, 1.0f, 0.0f), 0.0f, __builtin_inff(), 0.0f,
            255u, oxrt::KnownFlags<0>(), 0u, 1u, 0u, ray);
#line 33 "shader.py"
    oxrt::makeNopHitObject(hitObject);
    if (oxrt::checked(thread).contains(params.seen, i))
#line 34 "shader.py"
        params.seen.at(i) = ray.color;
}

#line 38 "shader.py"
void closesthit_white(Radiance& ray) {
    ray.color = oxrt::float3(1.0f);
}

#line 66 "pipeline.cpp"
void RadiancePrograms::closestHit(oxrt::Ray&, Payload& payload, const OxrtRecordHeader& record) {
    if (record.programs[oxrt::SLOT_CLOSESTHIT] == number::closesthit_white)
        closesthit_white(payload);
}

void run_raygen_main(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::forEachIndex(*thread, *tile, [thread] {
        raygen_main(*thread);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__main", OXRT_KIND_RAYGEN, 0, run_raygen_main},
    {"__closesthit__white", OXRT_KIND_CLOSESTHIT, 0, nullptr},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 1, programs, 2}};
static_assert(sizeof(Params) == 24);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 24, 1, "0.1.0"};
