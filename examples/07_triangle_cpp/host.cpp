// Renders one triangle without Python: the programs of shader.py, compiled by the build, launched through liboxrt.
//
//     triangle [OUTPUT.ppm]

#include <oxrt/oxrt.h>

#include "triangle_shaders.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <type_traits>
#include <vector>

namespace {

constexpr uint32_t kSize = 512;

// Ends the program with the runtime's sentence if a call failed.
void check(OxrtResult result, const char* what)
{
    if (result == OXRT_SUCCESS)
        return;
    std::fprintf(stderr, "%s: %s: %s\n", what, oxrtGetErrorName(result), oxrtGetLastErrorMessage());
    std::exit(1);
}

// An SBT record: the header that the runtime writes, then the program's data. Its size is a multiple of 16.
template <typename Data>
struct alignas(16) Record
{
    unsigned char header[32];
    Data data;
};

struct Nothing
{
};

template <typename Data>
Record<Data> makeRecord(OxrtPipeline pipeline, const OxrtProgramGroupDesc& group, const Data& data)
{
    Record<Data> record{};
    const size_t dataSize = std::is_empty_v<Data> ? 0 : sizeof(Data);
    check(oxrtSbtRecordPackHeader(pipeline, &group, static_cast<uint32_t>(dataSize), &record), "record");
    record.data = data;
    return record;
}

OxrtAccel buildTriangle(OxrtContext context)
{
    const float vertices[] = {-0.5f, -0.5f, 0.0f, 0.5f, -0.5f, 0.0f, 0.0f, 0.5f, 0.0f};
    const float* keys[] = {vertices};
    OxrtBuildInput input{};
    input.type = OXRT_BUILD_INPUT_TRIANGLES;
    input.numSbtRecords = 1;
    input.numKeys = 1;
    input.vertices = keys;
    input.numVertices = 3;
    input.numPrimitives = 1;
    OxrtAccelBuildOptions options{};
    OxrtAccel accel = nullptr;
    check(oxrtAccelBuild(context, &options, &input, 1, &accel), "acceleration structure");
    return accel;
}

unsigned char encode(float linear)
{
    const float x = std::fmin(std::fmax(linear, 0.0f), 1.0f);
    const float code = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
    return static_cast<unsigned char>(code * 255.0f + 0.5f);
}

bool writePpm(const char* path, const std::vector<float>& rgba)
{
    FILE* file = std::fopen(path, "wb");
    if (file == nullptr)
        return false;
    std::fprintf(file, "P6\n%u %u\n255\n", kSize, kSize);
    for (size_t i = 0; i < rgba.size(); i += 4)
        for (size_t channel = 0; channel < 3; ++channel)
            std::fputc(encode(rgba[i + channel]), file);
    return std::fclose(file) == 0;
}

}  // namespace

int main(int argc, char** argv)
{
    const char* output = argc > 1 ? argv[1] : "triangle.ppm";

    OxrtContextOptions contextOptions{};
    OxrtContext context = nullptr;
    check(oxrtContextCreate(&contextOptions, &context), "context");

    OxrtPipeline pipeline = nullptr;
    check(oxrtPipelineLoad(context, TRIANGLE_SHADERS_PATH, &pipeline), "pipeline");

    OxrtAccel accel = buildTriangle(context);
    OxrtAccelInfo info{};
    check(oxrtAccelGetInfo(accel, &info), "acceleration structure");

    OxrtProgramGroupDesc raygen{};
    raygen.kind = OXRT_PROGRAM_GROUP_KIND_RAYGEN;
    raygen.raygen = "__raygen__pinhole";
    OxrtProgramGroupDesc miss{};
    miss.kind = OXRT_PROGRAM_GROUP_KIND_MISS;
    miss.miss = "__miss__background";
    OxrtProgramGroupDesc hit{};
    hit.kind = OXRT_PROGRAM_GROUP_KIND_HITGROUP;
    hit.closesthit = "__closesthit__barycentrics";

    const auto raygenRecord = makeRecord(pipeline, raygen, Nothing{});
    const auto missRecord = makeRecord(pipeline, miss, Background{{0.02f, 0.03f, 0.05f}});
    const auto hitRecord = makeRecord(pipeline, hit, Nothing{});
    OxrtShaderBindingTable table{};
    table.raygenRecord = &raygenRecord;
    table.missRecords = &missRecord;
    table.missStride = sizeof(missRecord);
    table.missCount = 1;
    table.hitgroupRecords = &hitRecord;
    table.hitgroupStride = sizeof(hitRecord);
    table.hitgroupCount = 1;

    std::vector<float> image(size_t{kSize} * kSize * 4);
    const Params params{
        .image = {reinterpret_cast<float(*)[4]>(image.data()), {kSize, kSize}},
        .scene = info.handle,
        .eye = {0.0f, 0.0f, 1.7f},
        .u = {0.4142f, 0.0f, 0.0f},
        .v = {0.0f, 0.4142f, 0.0f},
        .w = {0.0f, 0.0f, -1.0f},
    };
    check(oxrtLaunch(pipeline, &params, sizeof(params), &table, kSize, kSize, 1), "launch");

    const bool written = writePpm(output, image);
    std::printf(written ? "wrote %s\n" : "cannot write %s\n", output);
    check(oxrtContextDestroy(context), "context");
    return written ? 0 : 1;
}
