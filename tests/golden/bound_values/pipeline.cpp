/* Made by optixc. Compiled features:
   miss programs: shader.py:51
   array bounds checks: shader.py:47
   bound values: asked for by the pipeline's options
*/
#include <oxrt/device.h>

namespace {

struct Params {
    oxrt::Array<oxrt::float3, 1> image;
    uint64_t scene;
    bool shadows;
    int32_t samples;
};

struct Radiance {
    oxrt::float3 color;
};

struct Shadow {
    float light;
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_image, miss_white };
}

/* What a trace with a Radiance payload can run. */
struct RadiancePrograms : oxrt::NoPrograms {
    using Payload = Radiance;
    static constexpr bool hasMiss = true;
    static void miss(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
};

#line 38 "shader.py"
void raygen_image(OxrtThread& thread) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 39 "shader.py"
    uint32_t i = oxrt::getLaunchIndex(thread).x;
    oxrt::float3 color = oxrt::float3(0.0f);
    for (int32_t unused = 0; unused < 4; ++unused) {
        Radiance ray = Radiance{oxrt::float3(0.0f)};
        oxrt::trace<RadiancePrograms>(thread, params.scene, oxrt::float3(0.0f), oxrt::float3(0.0f, 0.0f, 1.0f), 0.0f, __builtin_inff(),
                0.0f, 255u, oxrt::KnownFlags<0>(), 0u, 1u, 0u, ray);
#line 44 "shader.py"
        color = color + ray.color;
    }
#line 47 "shader.py"
    if (oxrt::checked(thread).contains(params.image, i))
#line 47 "shader.py"
        params.image.at(i) = color / 4.0f;
}

#line 51 "shader.py"
void miss_white(Radiance& ray) {
    ray.color = oxrt::float3(1.0f);
}

#line 62 "pipeline.cpp"
void RadiancePrograms::miss(oxrt::Ray&, Payload& payload, const OxrtRecordHeader& record) {
    if (record.programs[0] == number::miss_white)
        miss_white(payload);
}

void run_raygen_image(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::forEachIndex(*thread, *tile, [thread] {
        raygen_image(*thread);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__image", OXRT_KIND_RAYGEN, 0, run_raygen_image},
    {"__miss__white", OXRT_KIND_MISS, 0, nullptr},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 1, programs, 2}};
static_assert(sizeof(Params) == 32);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 32, 1, "0.1.0"};
