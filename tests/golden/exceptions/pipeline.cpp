/* Made by optixc. Compiled features:
   closesthit programs: shader.py:41
   exception programs: shader.py:48
   exceptions thrown: shader.py:34
   array bounds checks: shader.py:37
*/
#include <oxrt/device.h>

namespace {

struct Params {
    oxrt::Array<int32_t, 1> codes;
    uint64_t scene;
};

struct Distance {
    float t;
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_throwing, closesthit_throwing, exception_note };
}

/* What a trace with a Distance payload can run. */
struct DistancePrograms : oxrt::NoPrograms {
    using Payload = Distance;
    static constexpr bool hasClosestHit = true;
    static constexpr bool mayThrow = true;
    static void closestHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
};

#line 24 "shader.py"
float check(OxrtThread& thread, float t) {
    if (t < 0.0f) {
        oxrt::throwException(thread, "shader.py:26", 7, 1u, 2u);
        return {};
    }
#line 27 "shader.py"
    return oxrt::sqrt(t);
}

#line 31 "shader.py"
void raygen_throwing(OxrtThread& thread) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 32 "shader.py"
    uint32_t i = oxrt::getLaunchIndex(thread).x;
    if (i == 13u) {
        oxrt::throwException(thread, "shader.py:34", 13);
        return;
    }
#line 35 "shader.py"
    Distance found = Distance{0.0f};
    oxrt::trace<DistancePrograms>(thread, params.scene, oxrt::float3(0.0f), oxrt::float3(0.0f, 0.0f, 1.0f), 0.0f, __builtin_inff(), 0.0f,
            255u, oxrt::KnownFlags<0>(), 0u, 1u, 0u, found);
#line 36 "shader.py"
    if (thread.exceptionPending)
        return;
#line 37 "shader.py"
    float result = check(thread, found.t);
#line 37 "shader.py"
    if (thread.exceptionPending)
        return;
#line 37 "shader.py"
    if (oxrt::checked(thread).contains(params.codes, i))
#line 37 "shader.py"
        params.codes.at(i) = oxrt::convert<int32_t>(result);
}

#line 41 "shader.py"
void closesthit_throwing(oxrt::Ray& trace, Distance& found) {
    OxrtThread& thread = *trace.thread;
#line 42 "shader.py"
    found.t = oxrt::getRayTmax(trace);
    if (oxrt::getPrimitiveIndex(trace) == 5u) {
        oxrt::throwException(thread, "shader.py:44", 5);
        return;
    }
}

#line 48 "shader.py"
void exception_note(OxrtThread& thread) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 49 "shader.py"
    if (oxrt::checked(thread).contains(params.codes, oxrt::getLaunchIndex(thread).x))
#line 49 "shader.py"
        params.codes.at(oxrt::getLaunchIndex(thread).x) = -oxrt::getExceptionCode(thread);
}

#line 91 "pipeline.cpp"
void DistancePrograms::closestHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record) {
    if (record.programs[oxrt::SLOT_CLOSESTHIT] == number::closesthit_throwing)
        closesthit_throwing(trace, payload);
}

void run_raygen_throwing(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::forEachIndex(*thread, *tile, [thread] {
        raygen_throwing(*thread);
        if (thread->exceptionPending)
            switch (oxrt::takeException(*thread)) {
                case number::exception_note: exception_note(*thread); break;
                default: break;
            }
    });
}

const OxrtProgram programs[] = {
    {"__raygen__throwing", OXRT_KIND_RAYGEN, 0, run_raygen_throwing},
    {"__closesthit__throwing", OXRT_KIND_CLOSESTHIT, 0, nullptr},
    {"__exception__note", OXRT_KIND_EXCEPTION, 0, nullptr},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 1, programs, 3}};
static_assert(sizeof(Params) == 24);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 24, 1, "0.1.0"};
