/* Made by optixc. Compiled features:
   closesthit programs: shader.py:53
   array bounds checks: shader.py:49
*/
#include <oxrt/device.h>

namespace {

struct template_ {
    int32_t double_;
    oxrt::float3 class_;
    int32_t thread;
};

struct Programs_ {
    int32_t int32_t_;
    int32_t trace;
};

struct Params {
    oxrt::Array<int32_t, 1> out;
    uint64_t scene;
    template_ register_;
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_main, closesthit_delete };
}

/* What a trace with a Programs_ payload can run. */
struct Programs_Programs : oxrt::NoPrograms {
    using Payload = Programs_;
    static constexpr bool hasClosestHit = true;
    static void closestHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
};

#line 37 "shader.py"
int32_t gruf6udfe(int32_t uf8) {
    return uf8 + 1;
}

#line 44 "pipeline.cpp"
// A comment that ends in a backslash
#line 31 "shader.py"
int32_t namespace_(int32_t auto_, int32_t params_) {
#line 33 "shader.py"
    return auto_ + params_;
}

#line 42 "shader.py"
void raygen_main(OxrtThread& thread_) {
    const Params& params = oxrt::launchParams<Params>(thread_);
#line 43 "shader.py"
    int32_t thread = params.register_.double_;
    int32_t trace = thread + params.register_.thread;
    int32_t long_ = gruf6udfe(trace);
    int32_t oxrt_ = namespace_(long_, trace);
    Programs_ new_ = Programs_{oxrt_, 1};
    oxrt::trace<Programs_Programs>(thread_, params.scene, params.register_.class_, oxrt::float3(0.0f, 0.0f, 1.0f), 0.0f, __builtin_inff(),
            0.0f, 255u, oxrt::KnownFlags<0>(), 0u, 1u, 0u, new_);
#line 49 "shader.py"
    if (oxrt::checked(thread_).contains(params.out, 0))
#line 49 "shader.py"
        params.out.at(0) = new_.int32_t_ + new_.trace;
}

#line 53 "shader.py"
void closesthit_delete(oxrt::Ray& trace_, Programs_& trace) {
    OxrtThread& thread_ = *trace_.thread;
    const Params& params = oxrt::launchParams<Params>(thread_);
#line 54 "shader.py"
    int32_t thread = params.register_.thread;
    trace.int32_t_ = thread;
    trace.trace = int32_t(oxrt::getPrimitiveIndex(trace_));
}

#line 79 "pipeline.cpp"
void Programs_Programs::closestHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record) {
    if (record.programs[oxrt::SLOT_CLOSESTHIT] == number::closesthit_delete)
        closesthit_delete(trace, payload);
}

void run_raygen_main(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::forEachIndex(*thread, *tile, [thread] {
        raygen_main(*thread);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__main", OXRT_KIND_RAYGEN, 0, run_raygen_main},
    {"__closesthit__delete", OXRT_KIND_CLOSESTHIT, 0, nullptr},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 1, programs, 2}};
static_assert(sizeof(Params) == 48);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 48, 1, "0.1.0"};
