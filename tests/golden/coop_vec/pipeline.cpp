/* Made by optixc. Compiled features:
   cooperative vectors: shader.py:28
   array bounds checks: shader.py:47
*/
#include <oxrt/device.h>
#include <oxrt/coop_vec.h>

namespace {

struct Params {
    oxrt::Array<oxrt::float3, 2> image;
    oxrt::Array<uint8_t, 1> network;
    oxrt::Array<uint8_t, 1> gradients;
    oxrt::Array<oxrt::half, 1> sums;
    uint32_t layer;
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_infers_and_learns };
}

#line 23 "shader.py"
oxrt::CoopVec<oxrt::half, 32> relu(oxrt::CoopVec<oxrt::half, 32> v) {
    return oxrt::coopVecMax(v, 0.0f);
}

#line 28 "shader.py"
void raygen_infers_and_learns(OxrtThread& thread) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 29 "shader.py"
    oxrt::uint3 i = oxrt::getLaunchIndex(thread);
    oxrt::CoopVec<oxrt::half, 8> v = oxrt::coopVecOf<oxrt::CoopVec<oxrt::half, 8>>(1.0f);
    v[0] = float(i.x);
    oxrt::CoopVec<oxrt::half, 32> first = oxrt::coopVecMatMul<oxrt::CoopVec<oxrt::half, 32>, oxrt::MatrixElement::FLOAT16,
            oxrt::MatrixElement::FLOAT16, oxrt::MatrixLayout::INFERENCING_OPTIMAL, false>(oxrt::checkedSpans(thread,
            oxrt::Place{"shader.py", 32}), v, params.network, 0u, 0u, params.network, 1024u);
    oxrt::CoopVec<oxrt::half, 32> hidden = relu(first);
#line 37 "shader.py"
    uint32_t size = 2048u;
    oxrt::CoopVec<oxrt::half, 3> out = oxrt::coopVecMatMul<oxrt::CoopVec<oxrt::half, 3>, oxrt::MatrixElement::FLOAT16,
            oxrt::MatrixElement::FLOAT16, oxrt::MatrixLayout::INFERENCING_OPTIMAL, false>(oxrt::checkedSpans(thread,
            oxrt::Place{"shader.py", 38}), hidden, params.network, 2048u + i.x * size, 0u);
#line 42 "shader.py"
    oxrt::CoopVec<oxrt::half, 3> shared = oxrt::coopVecLoad<oxrt::CoopVec<oxrt::half, 3>>(oxrt::checkedSpans(thread,
            oxrt::Place{"shader.py", 42}), params.network, params.layer);
#line 43 "shader.py"
    oxrt::CoopVec<oxrt::half, 3> delta = oxrt::coopVecMul(oxrt::coopVecSub(out, shared), oxrt::coopVecOf<oxrt::CoopVec<oxrt::half, 3>>(0.5f,
            0.25f, 1.0f));
#line 44 "shader.py"
    oxrt::coopVecOuterProductAccumulate(oxrt::checkedSpans(thread, oxrt::Place{"shader.py", 44}), delta, hidden, params.gradients,
            params.layer);
#line 45 "shader.py"
    oxrt::coopVecReduceSumAccumulate(oxrt::checkedSpans(thread, oxrt::Place{"shader.py", 45}), delta, params.sums, 0u);
    oxrt::CoopVec<float, 3> whole = oxrt::coopVecCvt<float>(out);
    if (oxrt::checked(thread).contains(params.image, i.y, i.x))
#line 47 "shader.py"
        params.image.at(i.y, i.x) = oxrt::float3(whole[0], whole[1], whole[2]);
}

#line 62 "pipeline.cpp"
void run_raygen_infers_and_learns(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::forEachIndex(*thread, *tile, [thread] {
        raygen_infers_and_learns(*thread);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__infers_and_learns", OXRT_KIND_RAYGEN, 0, run_raygen_infers_and_learns},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 1, programs, 1}};
static_assert(sizeof(Params) == 80);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 80, 1, "0.1.0"};
