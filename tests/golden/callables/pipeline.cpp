/* Made by optixc. Compiled features:
   direct callable programs: shader.py:31
   continuation callable programs: shader.py:43
   callables: shader.py:26
   array bounds checks: shader.py:27
*/
#include <oxrt/device.h>

namespace {

struct Params {
    oxrt::Array<oxrt::float3, 1> colors;
    uint32_t material;
};

struct Stripes {
    float width;
    uint32_t other;
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_materials, direct_callable_plain, direct_callable_stripes, continuation_callable_glow };
}

oxrt::float3 directCall(OxrtThread& thread, uint32_t index, oxrt::float2 a0, oxrt::Place place = oxrt::Place::current());
oxrt::float3 continuationCall(OxrtThread& thread, uint32_t index, oxrt::float3 a0, oxrt::Place place = oxrt::Place::current());

#line 23 "shader.py"
void raygen_materials(OxrtThread& thread) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 24 "shader.py"
    uint32_t i = oxrt::getLaunchIndex(thread).x;
    oxrt::float2 uv = oxrt::float2(float(i), 0.5f);
    oxrt::float3 color = directCall(thread, params.material, uv);
    oxrt::float3 result_2 = continuationCall(thread, 0u, color);
#line 27 "shader.py"
    if (oxrt::checked(thread).contains(params.colors, i))
#line 27 "shader.py"
        params.colors.at(i) = color + result_2;
}

#line 31 "shader.py"
oxrt::float3 direct_callable_plain(oxrt::float2 uv) {
    return oxrt::float3(uv.x, uv.y, 0.0f);
}

#line 36 "shader.py"
oxrt::float3 direct_callable_stripes(OxrtThread& thread, oxrt::float2 uv, const Stripes& stripes) {
    if (oxrt::fract(uv.x / stripes.width) < 0.5f) {
        return oxrt::float3(1.0f);
    }
#line 39 "shader.py"
    oxrt::float3 result = directCall(thread, stripes.other, uv);
#line 39 "shader.py"
    return result;
}

#line 43 "shader.py"
oxrt::float3 continuation_callable_glow(oxrt::float3 color) {
    return 0.1f * color;
}

#line 65 "pipeline.cpp"
oxrt::float3 directCall(OxrtThread& thread, uint32_t index, oxrt::float2 a0, oxrt::Place place) {
    if (!oxrt::enterCallable<false>(thread, place)) return {};
    const OxrtRecordHeader* record = oxrt::findCallable(thread, index, 0, place);
    switch (record ? record->programs[0] : OXRT_NO_PROGRAM) {
        case number::direct_callable_plain: return direct_callable_plain(a0);
        case number::direct_callable_stripes: return direct_callable_stripes(thread, a0, oxrt::recordData<Stripes>(*record));
        default: return {};
    }
}

oxrt::float3 continuationCall(OxrtThread& thread, uint32_t index, oxrt::float3 a0, oxrt::Place place) {
    if (!oxrt::enterCallable<false>(thread, place)) return {};
    const OxrtRecordHeader* record = oxrt::findCallable(thread, index, 1, place);
    switch (record ? record->programs[1] : OXRT_NO_PROGRAM) {
        case number::continuation_callable_glow: return continuation_callable_glow(a0);
        default: return {};
    }
}

void run_raygen_materials(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::forEachIndex(*thread, *tile, [thread] {
        raygen_materials(*thread);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__materials", OXRT_KIND_RAYGEN, 0, run_raygen_materials},
    {"__direct_callable__plain", OXRT_KIND_DIRECT_CALLABLE, 0, nullptr},
    {"__direct_callable__stripes", OXRT_KIND_DIRECT_CALLABLE, sizeof(Stripes), nullptr},
    {"__continuation_callable__glow", OXRT_KIND_CONTINUATION_CALLABLE, 0, nullptr},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 1, programs, 4}};
static_assert(sizeof(Params) == 24);
static_assert(sizeof(Stripes) == 8);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 24, 1, "0.1.0"};
