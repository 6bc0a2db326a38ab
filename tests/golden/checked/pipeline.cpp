/* Made by optixc. Compiled features:
   closesthit programs: shader.py:52
   print: shader.py:46
   loops that poll for cancellation: shader.py:31
   assertions: shader.py:44
   NaN traps: asked for by the pipeline's options
   array bounds checks: shader.py:43
   validation: asked for by the pipeline's options
*/
#include <oxrt/device.h>

namespace {

struct Params {
    oxrt::Array<oxrt::float3, 2> values;
    uint64_t scene;
};

struct State {
    oxrt::FixedArray<float, 4> weights;
};

struct Radiance {
    oxrt::float3 color;
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_checked, closesthit_white };
}

/* What a trace with a Radiance payload can run. */
struct RadiancePrograms : oxrt::NoPrograms {
    using Payload = Radiance;
    static constexpr bool hasClosestHit = true;
    static constexpr bool isValidated = true;
    static void closestHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
};

#line 29 "shader.py"
float total(OxrtThread& thread, State& state, int32_t count) {
    float result = 0.0f;
    for (int32_t k = 0; k < count; ++k) {
#line 31 "shader.py"
        if (oxrt::isCancelled(thread))
            break;
#line 32 "shader.py"
        result = result + oxrt::checked(thread).item(state.weights, k);
#line 32 "shader.py"
        oxrt::assertTrue(thread, oxrt::Place::current(), result == result, "result is NaN (result = \001, k = \001)", result, k);
        if (oxrt::checked(thread).containsItem(state.weights, k))
#line 33 "shader.py"
            state.weights[k] = 0.0f;
    }
#line 34 "shader.py"
    return result;
}

#line 38 "shader.py"
void raygen_checked(OxrtThread& thread) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 39 "shader.py"
    oxrt::uint3 i = oxrt::getLaunchIndex(thread);
    [[maybe_unused]] uint32_t unread = i.x + 1u;
    State state = State{oxrt::FixedArray<float, 4>{}};
    if (oxrt::checked(thread).containsItem(state.weights, i.x % 4u))
#line 42 "shader.py"
        state.weights[i.x % 4u] = 1.0f;
    Radiance ray = Radiance{oxrt::checked(thread).load(params.values, i.y, i.x)};
    oxrt::float3 value_2 = ray.color;
#line 44 "shader.py"
    oxrt::assertTrue(thread, oxrt::Place::current(), value_2 == value_2,
            "origin of trace is NaN (ray.color.x = \001, ray.color.y = \001, ray.color.z = \001)", ray.color.x, ray.color.y, ray.color.z);
#line 44 "shader.py"
    oxrt::trace<RadiancePrograms>(thread, params.scene, value_2, oxrt::float3(0.0f, 0.0f, 1.0f), 0.0f, __builtin_inff(), 0.0f, 255u,
            oxrt::KnownFlags<0>(), 0u, 1u, 0u, ray);
#line 45 "shader.py"
    oxrt::assertTrue(thread, oxrt::Place::current(), ray.color.x >= 0.0f, "radiance is not negative (ray.color.x = \001)", ray.color.x);
    oxrt::print(thread, ", ", "\n", "pixel", i.x, i.y, ray.color);
    oxrt::float3 value = ray.color;
#line 47 "shader.py"
    oxrt::assertTrue(thread, oxrt::Place::current(), value == value,
            "value is NaN (ray.color.x = \001, ray.color.y = \001, ray.color.z = \001)", ray.color.x, ray.color.y, ray.color.z);
#line 47 "shader.py"
    float result = total(thread, state, 3);
#line 47 "shader.py"
    oxrt::float3 value_3 = value * result;
#line 47 "shader.py"
    oxrt::assertTrue(thread, oxrt::Place::current(), value_3 == value_3,
            "an element of params.values is NaN (value.x = \001, value.y = \001, value.z = \001, result = \001)", value.x, value.y, value.z,
            result);
#line 47 "shader.py"
    if (oxrt::checked(thread).contains(params.values, i.y, i.x))
#line 47 "shader.py"
        params.values.at(i.y, i.x) = value_3;
    if (oxrt::checked(thread).contains(params.values, 0, 0))
#line 48 "shader.py"
        params.values.at(0, 0).x = 1.0f;
}

#line 52 "shader.py"
void closesthit_white(Radiance& ray) {
    ray.color = oxrt::float3(1.0f);
}

#line 107 "pipeline.cpp"
void RadiancePrograms::closestHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record) {
    switch (record.programs[oxrt::SLOT_CLOSESTHIT]) {
        case number::closesthit_white: closesthit_white(payload); break;
        case OXRT_NO_PROGRAM: break;
        default: oxrt::payloadMismatch(*trace.thread); break;
    }
}

void run_raygen_checked(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::forEachIndex(*thread, *tile, [thread] {
        raygen_checked(*thread);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__checked", OXRT_KIND_RAYGEN, 0, run_raygen_checked},
    {"__closesthit__white", OXRT_KIND_CLOSESTHIT, 0, nullptr},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 1, programs, 2}};
static_assert(sizeof(Params) == 32);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 32, 1, "0.1.0"};
