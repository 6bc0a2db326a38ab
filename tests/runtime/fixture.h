// A context with the tiny pipeline, and short ways to build and launch.
#pragma once

#include "check.h"
#include "oxrt/oxrt.h"
#include "tiny_params.h"

#include <cstdlib>
#include <string>
#include <vector>

struct alignas(16) RecordBytes {
    unsigned char bytes[64] = {};
};

struct Triangles {
    std::vector<float> vertices;
    std::vector<std::uint32_t> indices;
    const float* keys[1] = {nullptr};

    OxrtBuildInput input()
    {
        keys[0] = vertices.data();
        OxrtBuildInput made = {};
        made.type = OXRT_BUILD_INPUT_TRIANGLES;
        made.numSbtRecords = 1;
        made.numKeys = 1;
        made.vertices = keys;
        made.numVertices = vertices.size() / 3;
        made.indices = indices.empty() ? nullptr : indices.data();
        made.numPrimitives = (indices.empty() ? vertices.size() / 3 : indices.size()) / 3;
        return made;
    }
};

// The square [0, 8]^2 at height z, two triangles.
inline Triangles square(float z)
{
    return {{0, 0, z, 8, 0, z, 8, 8, z, 0, 8, z}, {0, 1, 2, 0, 2, 3}};
}

struct Boxes {
    std::vector<float> aabbs;
    const float* keys[1] = {nullptr};

    OxrtBuildInput input()
    {
        keys[0] = aabbs.data();
        OxrtBuildInput made = {};
        made.type = OXRT_BUILD_INPUT_CUSTOM_PRIMITIVES;
        made.numSbtRecords = 1;
        made.numKeys = 1;
        made.aabbs = keys;
        made.numPrimitives = aabbs.size() / 6;
        return made;
    }
};

inline OxrtInstance instanceOf(OxrtTraversableHandle child, float dx = 0, float dy = 0, float dz = 0)
{
    return {{1, 0, 0, dx, 0, 1, 0, dy, 0, 0, 1, dz}, 0, 0, 255, 0, child};
}

inline OxrtBuildInput instanceInput(const std::vector<OxrtInstance>& instances)
{
    OxrtBuildInput made = {};
    made.type = OXRT_BUILD_INPUT_INSTANCES;
    made.instances = instances.data();
    made.numPrimitives = instances.size();
    return made;
}

class Fixture {
public:
    explicit Fixture(unsigned threads = 2, unsigned validation = 0)
    {
        OxrtContextOptions options = {};
        options.threads = threads;
        options.validation = validation;
        CHECK_SUCCESS(oxrtContextCreate(&options, &context));
        CHECK_SUCCESS(oxrtPipelineLoad(context, TINY_PIPELINE, &pipeline));
    }
    ~Fixture() { CHECK_SUCCESS(oxrtContextDestroy(context)); }
    Fixture(const Fixture&) = delete;
    Fixture& operator=(const Fixture&) = delete;

    OxrtAccel build(const OxrtBuildInput& input, std::uint32_t flags = 0)
    {
        const OxrtAccelBuildOptions options = {flags, {}};
        OxrtAccel accel = nullptr;
        CHECK_SUCCESS(oxrtAccelBuild(context, &options, &input, 1, &accel));
        return accel;
    }

    static OxrtAccelInfo infoOf(OxrtAccel accel)
    {
        OxrtAccelInfo info = {};
        CHECK_SUCCESS(oxrtAccelGetInfo(accel, &info));
        return info;
    }

    static OxrtTraversableHandle handleOf(OxrtAccel accel) { return infoOf(accel).handle; }

    OxrtShaderBindingTable table(const char* raygen)
    {
        OxrtProgramGroupDesc group = {};
        group.kind = OXRT_PROGRAM_GROUP_KIND_RAYGEN;
        group.raygen = raygen;
        CHECK_SUCCESS(oxrtSbtRecordPackHeader(pipeline, &group, sizeof(TinyRecord), record.bytes));
        OxrtShaderBindingTable sbt = {};
        sbt.raygenRecord = record.bytes;
        return sbt;
    }

    OxrtResult launch(const char* raygen, const TinyParams& params, std::uint32_t width, std::uint32_t height = 1, std::uint32_t depth = 1)
    {
        const OxrtShaderBindingTable sbt = table(raygen);
        return oxrtLaunch(pipeline, &params, sizeof params, &sbt, width, height, depth);
    }

    // Rays along +z over cells of size 1.
    std::vector<TinyHit> trace(OxrtTraversableHandle scene, std::uint32_t width = 8, std::uint32_t height = 8, std::uint32_t mask = 255)
    {
        std::vector<TinyHit> hits(std::size_t(width) * height);
        TinyParams params = {};
        params.hits = hits.data();
        params.scene = scene;
        params.rayMask = mask;
        params.cellSize = 1;
        params.useIntersection = 1;
        CHECK_SUCCESS(launch("__raygen__trace", params, width, height));
        return hits;
    }

    OxrtContext context = nullptr;
    OxrtPipeline pipeline = nullptr;
    RecordBytes record;
};
