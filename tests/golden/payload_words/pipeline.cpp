/* Made by optixc. Compiled features:
   miss programs: shader.py:55
   closesthit programs: shader.py:42
   array bounds checks: shader.py:36
*/
#include <oxrt/device.h>

namespace {

struct Params {
    oxrt::Array<uint32_t, 1> out;
    uint64_t scene;
};

struct Mixed {
    oxrt::Word<bool> hit;
    oxrt::Word<uint64_t> where;
    oxrt::float2 uv;
    oxrt::Word<uint8_t> kind;
};

struct Alike {
    oxrt::Word<bool> was_hit;
    oxrt::Word<uint64_t> address;
    oxrt::float2 place;
    oxrt::Word<uint8_t> tag;
};

struct PayloadWords_uint32_float32 {
    uint32_t w0;
    float w1;
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_main, closesthit_mixed, closesthit_alike, miss_words, miss_nothing };
}

/* What a trace with a Mixed payload can run. */
struct MixedPrograms : oxrt::NoPrograms {
    using Payload = Mixed;
    static constexpr bool hasClosestHit = true;
    static constexpr bool hasMiss = true;
    static void closestHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
    static void miss(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
};

/* What a trace with a PayloadWords_uint32_float32 payload can run. */
struct PayloadWords_uint32_float32Programs : oxrt::NoPrograms {
    using Payload = PayloadWords_uint32_float32;
    static constexpr bool hasMiss = true;
    static void miss(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
};

#line 33 "shader.py"
void raygen_main(OxrtThread& thread) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 34 "shader.py"
    Mixed mixed = Mixed{false, UINT64_C(1), oxrt::float2(0.0f), uint8_t(3u)};
    oxrt::trace<MixedPrograms>(thread, params.scene, oxrt::float3(0.0f), oxrt::float3(0.0f, 0.0f, 1.0f), 0.0f, __builtin_inff(), 0.0f, 255u,
            oxrt::KnownFlags<0>(), 0u, 1u, 0u, mixed);
#line 36 "shader.py"
    if (oxrt::checked(thread).contains(params.out, 0))
#line 36 "shader.py"
        params.out.at(0) = bool(mixed.hit) ? uint32_t(uint64_t(mixed.where) >> 32u) : uint32_t(uint8_t(mixed.kind));
    PayloadWords_uint32_float32 payload = PayloadWords_uint32_float32{oxrt::checked(thread).load(params.out, 1), 0.5f};
#line 37 "shader.py"
    oxrt::trace<PayloadWords_uint32_float32Programs>(thread, params.scene, oxrt::float3(0.0f), oxrt::float3(0.0f, 0.0f, 1.0f), 0.0f,
            __builtin_inff(), 0.0f, 255u, oxrt::KnownFlags<0>(), 0u, 1u, 0u, payload);
#line 37 "shader.py"
    uint32_t first = payload.w0;
#line 37 "shader.py"
    float second = payload.w1;
    if (oxrt::checked(thread).contains(params.out, 2))
#line 38 "shader.py"
        params.out.at(2) = first + oxrt::convert<uint32_t>(second);
}

#line 42 "shader.py"
void closesthit_mixed(Mixed& mixed) {
    mixed.hit = true;
    mixed.where = uint64_t(mixed.where) + UINT64_C(4294967296);
}

#line 49 "shader.py"
void closesthit_alike(Alike& alike) {
    alike.was_hit = !bool(alike.was_hit);
    alike.tag = 7u;
}

#line 55 "shader.py"
void miss_words(oxrt::Ray& trace) {
    oxrt::setPayload_1(trace, oxrt::getPayload_0(trace) + 1u);
}

#line 60 "shader.py"
void miss_nothing() {
}

#line 101 "pipeline.cpp"
void MixedPrograms::closestHit(oxrt::Ray&, Payload& payload, const OxrtRecordHeader& record) {
    switch (record.programs[oxrt::SLOT_CLOSESTHIT]) {
        case number::closesthit_mixed: closesthit_mixed(payload); break;
        case number::closesthit_alike: closesthit_alike(oxrt::PayloadAs<Alike, Payload>(payload)); break;
        default: break;
    }
}

void MixedPrograms::miss(oxrt::Ray& trace, Payload&, const OxrtRecordHeader& record) {
    switch (record.programs[0]) {
        case number::miss_words: miss_words(trace); break;
        case number::miss_nothing: miss_nothing(); break;
        default: break;
    }
}

void PayloadWords_uint32_float32Programs::miss(oxrt::Ray& trace, Payload&, const OxrtRecordHeader& record) {
    switch (record.programs[0]) {
        case number::miss_words: miss_words(trace); break;
        case number::miss_nothing: miss_nothing(); break;
        default: break;
    }
}

void run_raygen_main(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::forEachIndex(*thread, *tile, [thread] {
        raygen_main(*thread);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__main", OXRT_KIND_RAYGEN, 0, run_raygen_main},
    {"__closesthit__mixed", OXRT_KIND_CLOSESTHIT, 0, nullptr},
    {"__closesthit__alike", OXRT_KIND_CLOSESTHIT, 0, nullptr},
    {"__miss__words", OXRT_KIND_MISS, 0, nullptr},
    {"__miss__nothing", OXRT_KIND_MISS, 0, nullptr},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 1, programs, 5}};
static_assert(sizeof(Params) == 24);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 24, 1, "0.1.0"};
