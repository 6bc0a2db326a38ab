// Launches the pipeline that the build compiled and prints what it wrote.
#include <oxrt/oxrt.h>

#include "cubes.h"
#include "squares.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

void check(OxrtResult result)
{
    if (result == OXRT_SUCCESS) return;
    std::fprintf(stderr, "%s: %s\n", oxrtGetErrorName(result), oxrtGetLastErrorMessage());
    std::exit(1);
}

} // namespace

int main()
{
    OxrtContextOptions options{};
    OxrtContext context = nullptr;
    check(oxrtContextCreate(&options, &context));
    OxrtPipeline pipeline = nullptr;
    check(oxrtPipelineLoad(context, SQUARES_PATH, &pipeline));

    alignas(16) unsigned char record[32];
    OxrtProgramGroupDesc group{};
    group.kind = OXRT_PROGRAM_GROUP_KIND_RAYGEN;
    group.raygen = SQUARES_RAYGEN_SQUARES;
    check(oxrtSbtRecordPackHeader(pipeline, &group, 0, record));
    OxrtShaderBindingTable table{};
    table.raygenRecord = record;

    int32_t values[5] = {};
    optixc::squares::Params params{};
    static_assert(sizeof(optixc::squares::Params) == SQUARES_PARAMS_SIZE);
    static_assert(sizeof(optixc::cubes::Params) == CUBES_PARAMS_SIZE);
    params.values.data = values;
    params.values.shape[0] = 5;
    check(oxrtLaunch(pipeline, &params, sizeof params, &table, 5, 1, 1));
    for (int32_t value : values) std::printf("%d ", value);
    std::printf("\n");
    check(oxrtContextDestroy(context));
    return 0;
}
