// What a host in C can do wrong and one in Python cannot: null, destroyed, foreign and misaligned pointers, numbers out of range. Each is an
// error with a name, and what is good works afterwards.
#include "fixture.h"

#include <cstdint>
#include <limits>

namespace {

// An address that is no multiple of 4.
template <class T>
T* crooked(T* pointer)
{
    return reinterpret_cast<T*>(reinterpret_cast<std::uintptr_t>(pointer) + 1);
}

struct Broken {
    const char* text;
    OxrtBuildInput input;
};

void refuses(const Fixture& fixture, const OxrtBuildInput& input, const char* text)
{
    OxrtAccel accel = reinterpret_cast<OxrtAccel>(&accel);
    CHECK_FAILS(oxrtAccelBuild(fixture.context, nullptr, &input, 1, &accel), OXRT_ERROR_INVALID_VALUE, text);
    CHECK(accel == nullptr);
}

} // namespace

TEST(nullAndForeignObjectsAreNamed)
{
    Fixture fixture;
    int foreign[16] = {};
    const auto eachPointer = [&](auto call) {
        CHECK_FAILS(call(nullptr), OXRT_ERROR_INVALID_VALUE, "is NULL");
        CHECK_FAILS(call(static_cast<void*>(foreign)), OXRT_ERROR_INVALID_VALUE, "does not exist");
        CHECK_FAILS(call(static_cast<void*>(fixture.context)), OXRT_ERROR_INVALID_VALUE, "does not exist");
    };
    OxrtAccelInfo accelInfo;
    OxrtAccel accel = nullptr;
    eachPointer([&](void* p) { return oxrtAccelGetInfo(static_cast<OxrtAccel>(p), &accelInfo); });
    eachPointer([&](void* p) { return oxrtAccelUpdate(static_cast<OxrtAccel>(p), nullptr, 0); });
    eachPointer([&](void* p) { return oxrtAccelCompact(static_cast<OxrtAccel>(p), &accel); });
    eachPointer([&](void* p) { return oxrtAccelRelocate(static_cast<OxrtAccel>(p), nullptr, 0, &accel); });
    eachPointer([&](void* p) { return oxrtAccelEmitProperty(static_cast<OxrtAccel>(p), OXRT_PROPERTY_TYPE_AABBS, foreign, 24); });
    eachPointer([&](void* p) { return oxrtAccelDestroy(static_cast<OxrtAccel>(p)); });
    OxrtTraversableHandle handle = 0;
    eachPointer([&](void* p) { return oxrtTransformGetHandle(static_cast<OxrtTransform>(p), &handle); });
    eachPointer([&](void* p) { return oxrtTransformDestroy(static_cast<OxrtTransform>(p)); });
    eachPointer([&](void* p) { return oxrtOpacityMicromapArrayDestroy(static_cast<OxrtOpacityMicromapArray>(p)); });
    OxrtPipelineInfo pipelineInfo;
    OxrtLaunchReport report;
    OxrtProgramGroupDesc group = {};
    std::int32_t program = 0;
    std::uint64_t done = 0;
    std::uint64_t total = 0;
    int isDone = 0;
    eachPointer([&](void* p) { return oxrtPipelineGetInfo(static_cast<OxrtPipeline>(p), &pipelineInfo); });
    eachPointer([&](void* p) { return oxrtPipelineFindProgram(static_cast<OxrtPipeline>(p), "x", &program); });
    eachPointer([&](void* p) { return oxrtPipelineSetFrames(static_cast<OxrtPipeline>(p), 1); });
    eachPointer([&](void* p) { return oxrtPipelineSetStackDepths(static_cast<OxrtPipeline>(p), 1, 1); });
    eachPointer([&](void* p) { return oxrtSbtRecordPackHeader(static_cast<OxrtPipeline>(p), &group, 0, foreign); });
    eachPointer([&](void* p) { return oxrtLaunch(static_cast<OxrtPipeline>(p), foreign, 4, nullptr, 1, 1, 1); });
    eachPointer([&](void* p) { return oxrtLaunchBegin(static_cast<OxrtPipeline>(p), foreign, 4, nullptr, 1, 1, 1); });
    eachPointer([&](void* p) { return oxrtLaunchWait(static_cast<OxrtPipeline>(p), 1, &isDone); });
    eachPointer([&](void* p) { return oxrtLaunchCancel(static_cast<OxrtPipeline>(p)); });
    eachPointer([&](void* p) { return oxrtLaunchGetProgress(static_cast<OxrtPipeline>(p), &done, &total); });
    eachPointer([&](void* p) { return oxrtPipelineGetLaunchReport(static_cast<OxrtPipeline>(p), &report); });
    eachPointer([&](void* p) { return oxrtPipelineDestroy(static_cast<OxrtPipeline>(p)); });
    const auto context = reinterpret_cast<OxrtContext>(fixture.pipeline);
    CHECK_FAILS(oxrtPipelineLoad(context, TINY_PIPELINE, &fixture.pipeline), OXRT_ERROR_INVALID_DEVICE_CONTEXT, "does not exist");
    CHECK_FAILS(oxrtContextSetLogCallback(nullptr, nullptr, nullptr, 0), OXRT_ERROR_INVALID_DEVICE_CONTEXT, "NULL");
    CHECK_FAILS(oxrtContextDestroy(nullptr), OXRT_ERROR_INVALID_DEVICE_CONTEXT, "NULL");
}

TEST(nullResultsAreNamed)
{
    Fixture fixture;
    Triangles mesh = square(1);
    const OxrtAccel accel = fixture.build(mesh.input(), OXRT_BUILD_FLAG_ALLOW_COMPACTION);
    const OxrtBuildInput input = mesh.input();
    std::uint64_t number = 0;
    CHECK_FAILS(oxrtContextCreate(nullptr, nullptr), OXRT_ERROR_INVALID_VALUE, "`context` is NULL");
    CHECK_FAILS(oxrtContextGetInfo(fixture.context, nullptr), OXRT_ERROR_INVALID_VALUE, "`info` is NULL");
    CHECK_FAILS(oxrtAccelBuild(fixture.context, nullptr, &input, 1, nullptr), OXRT_ERROR_INVALID_VALUE, "`accel` is NULL");
    CHECK_FAILS(oxrtAccelGetInfo(accel, nullptr), OXRT_ERROR_INVALID_VALUE, "`info` is NULL");
    CHECK_FAILS(oxrtAccelCompact(accel, nullptr), OXRT_ERROR_INVALID_VALUE, "`compacted` is NULL");
    CHECK_FAILS(oxrtAccelRelocate(accel, nullptr, 0, nullptr), OXRT_ERROR_INVALID_VALUE, "`relocated` is NULL");
    CHECK_FAILS(oxrtAccelEmitProperty(accel, OXRT_PROPERTY_TYPE_AABBS, nullptr, 24), OXRT_ERROR_INVALID_VALUE, "`result` is NULL");
    CHECK_FAILS(oxrtAccelEmitProperty(accel, OXRT_PROPERTY_TYPE_AABBS, &number, 8), OXRT_ERROR_INVALID_VALUE, "resultSize is 8; AABBS takes 24");
    CHECK_FAILS(oxrtAccelEmitProperty(accel, 7, &number, 8), OXRT_ERROR_INVALID_VALUE, "property type 0x7");
    CHECK_FAILS(oxrtTransformCreate(fixture.context, nullptr, nullptr), OXRT_ERROR_INVALID_VALUE, "`transform` is NULL");
    CHECK_FAILS(oxrtTextureCreate(fixture.context, nullptr, &number), OXRT_ERROR_INVALID_VALUE, "options is NULL");
    CHECK_FAILS(oxrtOpacityMicromapArrayBuild(fixture.context, nullptr, nullptr), OXRT_ERROR_INVALID_VALUE, "options is NULL");
    CHECK_FAILS(oxrtPipelineLoad(fixture.context, TINY_PIPELINE, nullptr), OXRT_ERROR_INVALID_VALUE, "`pipeline` is NULL");
    CHECK_FAILS(oxrtPipelineGetInfo(fixture.pipeline, nullptr), OXRT_ERROR_INVALID_VALUE, "`info` is NULL");
    CHECK_FAILS(oxrtPipelineFindProgram(fixture.pipeline, nullptr, nullptr), OXRT_ERROR_INVALID_VALUE, "name is NULL");
    CHECK_FAILS(oxrtPipelineGetLaunchReport(fixture.pipeline, nullptr), OXRT_ERROR_INVALID_VALUE, "`report` is NULL");
    CHECK_FAILS(oxrtLaunchGetProgress(fixture.pipeline, nullptr, &number), OXRT_ERROR_INVALID_VALUE, "`done` is NULL");
    CHECK_FAILS(oxrtLaunchWait(fixture.pipeline, 1, nullptr), OXRT_ERROR_INVALID_VALUE, "`done` is NULL");
}

TEST(buildInputsOutOfRangeAreNamed)
{
    Fixture fixture;
    Triangles mesh = square(1);
    const OxrtBuildInput good = mesh.input();
    const auto changed = [&](auto change) {
        OxrtBuildInput input = good;
        change(input);
        return input;
    };
    const float* const noKey[2] = {mesh.vertices.data(), nullptr};
    const float* const crookedKey[1] = {crooked(mesh.vertices.data())};
    const std::uint32_t offsets[2] = {0, 0};
    const std::uint32_t flags[2] = {8, 0};
    const Broken broken[] = {
        {"type is 0x1", changed([](auto& i) { i.type = 1; })},
        {"numSbtRecords is 0", changed([](auto& i) { i.numSbtRecords = 0; })},
        {"numSbtRecords is 4294967295", changed([](auto& i) { i.numSbtRecords = ~0u; })},
        {"sbtIndexOffsets is NULL", changed([](auto& i) { i.numSbtRecords = 2; })},
        {"flags[0] is 0x8", changed([&](auto& i) { i.flags = flags; })},
        {"flags is not aligned to 4 bytes", changed([&](auto& i) { i.flags = crooked(flags); })},
        {"sbtIndexOffsets is not aligned", changed([&](auto& i) { i.numSbtRecords = 2, i.sbtIndexOffsets = crooked(offsets); })},
        {"indices is not aligned", changed([&](auto& i) { i.indices = crooked(mesh.indices.data()); })},
        {"preTransform is not aligned", changed([&](auto& i) { i.preTransform = crooked(mesh.vertices.data()); })},
        {"vertices[0] is not aligned", changed([&](auto& i) { i.vertices = crookedKey; })},
        {"vertices is NULL", changed([](auto& i) { i.vertices = nullptr; })},
        {"has 2 motion keys", changed([&](auto& i) { i.numKeys = 2, i.vertices = noKey; })},
        {"has 4294967295 motion keys", changed([](auto& i) { i.numKeys = ~0u; })},
        {"at most 2^29", changed([](auto& i) { i.numPrimitives = ~std::uint64_t(0); })},
        {"does not fit 32 bits", changed([](auto& i) { i.primitiveIndexOffset = ~0u; })},
        {"numVertices is 0", changed([](auto& i) { i.numVertices = 0; })},
        {"numVertices is 18446744073709551615", changed([](auto& i) { i.numVertices = ~std::uint64_t(0); })},
    };
    for (const Broken& one : broken) refuses(fixture, one.input, one.text);

    OxrtAccel accel = nullptr;
    OxrtAccelBuildOptions options = {};
    CHECK_FAILS(oxrtAccelBuild(fixture.context, nullptr, nullptr, 1, &accel), OXRT_ERROR_INVALID_VALUE, "NULL");
    CHECK_FAILS(oxrtAccelBuild(fixture.context, nullptr, &good, 0, &accel), OXRT_ERROR_INVALID_VALUE, "empty");
    options.motion = {2, 0, 0, 1};
    const OxrtBuildInput second = changed([&](auto& i) { i.numKeys = 2, i.vertices = noKey; });
    CHECK_FAILS(oxrtAccelBuild(fixture.context, &options, &second, 1, &accel), OXRT_ERROR_INVALID_VALUE, "vertices[1] is NULL");
    options.motion = {2, 8, 0, 1};
    CHECK_FAILS(oxrtAccelBuild(fixture.context, &options, &second, 1, &accel), OXRT_ERROR_INVALID_VALUE, "motion.flags is 0x8");
    options = {};
    options.buildFlags = 1u << 31;
    CHECK_FAILS(oxrtAccelBuild(fixture.context, &options, &good, 1, &accel), OXRT_ERROR_INVALID_VALUE, "unknown bits");
    fixture.build(good);
}

TEST(instancesAndTransformsOfAnotherContextAreNamed)
{
    Fixture fixture;
    Fixture other;
    Triangles mesh = square(1);
    const OxrtAccel accel = fixture.build(mesh.input());
    const OxrtTraversableHandle foreign = other.handleOf(other.build(mesh.input()));
    const OxrtTraversableHandle own = fixture.handleOf(accel);
    std::vector<OxrtInstance> instances = {instanceOf(foreign)};
    refuses(fixture, instanceInput(instances), "instance 0");
    instances[0].traversable = own ^ (std::uint64_t(1) << 40);
    refuses(fixture, instanceInput(instances), "instance 0");
    OxrtBuildInput input = instanceInput(instances);
    input.instances = crooked(instances.data());
    refuses(fixture, input, "instances is not aligned to 8 bytes");
    input.instances = nullptr;
    refuses(fixture, input, "instances is NULL");
    input = instanceInput(instances);
    input.numPrimitives = ~std::uint64_t(0);
    refuses(fixture, input, "at most 2^28");

    float keys[24] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    OxrtTransform transform = nullptr;
    OxrtTransformOptions options = {OXRT_TRANSFORM_STATIC, foreign, keys, {}};
    const auto create = [&] { return oxrtTransformCreate(fixture.context, &options, &transform); };
    CHECK_FAILS(create(), OXRT_ERROR_INVALID_VALUE, "not a traversable that is alive in this context");
    options.child = own;
    options.keys = nullptr;
    CHECK_FAILS(create(), OXRT_ERROR_INVALID_VALUE, "keys is NULL");
    options.keys = crooked(keys);
    CHECK_FAILS(create(), OXRT_ERROR_INVALID_VALUE, "keys is not aligned");
    options.keys = keys;
    options.type = 9;
    CHECK_FAILS(create(), OXRT_ERROR_INVALID_VALUE, "type is 9");
    options.type = OXRT_TRANSFORM_MATRIX_MOTION;
    options.motion = {1, 0, 0, 1};
    CHECK_FAILS(create(), OXRT_ERROR_INVALID_VALUE, "needs at least 2");
    options.type = OXRT_TRANSFORM_STATIC;
    CHECK_SUCCESS(create());
    CHECK_SUCCESS(oxrtTransformDestroy(transform));
    CHECK_FAILS(oxrtTransformDestroy(transform), OXRT_ERROR_INVALID_VALUE, "does not exist");

    // Rays through handles of another context miss, and so does a stale one.
    CHECK_EQUAL(fixture.trace(foreign, 1, 1)[0].geometry, ~0u);
    CHECK_SUCCESS(oxrtAccelDestroy(accel));
    CHECK_FAILS(oxrtAccelDestroy(accel), OXRT_ERROR_INVALID_VALUE, "does not exist");
    CHECK_EQUAL(fixture.trace(own, 1, 1)[0].geometry, ~0u);
}

TEST(micromapsOfAnotherContextAreNamed)
{
    Fixture fixture;
    Fixture other;
    const std::uint8_t states[4] = {0x55, 0x55, 0x55, 0x55};
    const OxrtOpacityMicromapDesc descs[2] = {{0, 0, OXRT_OPACITY_MICROMAP_FORMAT_2_STATE}, {1, 0, OXRT_OPACITY_MICROMAP_FORMAT_2_STATE}};
    const OxrtOpacityMicromapCount histogram = {2, 0, OXRT_OPACITY_MICROMAP_FORMAT_2_STATE};
    OxrtOpacityMicromapArrayOptions options = {0, 2, states, sizeof states, descs, &histogram, 1};
    OxrtOpacityMicromapArray array = nullptr;
    const auto build = [&](OxrtContext context) { return oxrtOpacityMicromapArrayBuild(context, &options, &array); };
    options.descs = crooked(descs);
    CHECK_FAILS(build(other.context), OXRT_ERROR_INVALID_VALUE, "descs is not aligned");
    options.descs = nullptr;
    CHECK_FAILS(build(other.context), OXRT_ERROR_INVALID_VALUE, "descs or histogram is NULL");
    options.descs = descs;
    options.dataSize = 1;
    CHECK_FAILS(build(other.context), OXRT_ERROR_INVALID_VALUE, "do not fit into the 1 bytes of data");
    options.dataSize = sizeof states;
    CHECK_SUCCESS(build(other.context));

    Triangles mesh = square(1);
    OxrtBuildInput input = mesh.input();
    OxrtOpacityMicromapInput micromap = {array, OXRT_OPACITY_MICROMAP_INDEXING_LINEAR, 0, nullptr, nullptr, 0};
    input.opacityMicromap = &micromap;
    refuses(fixture, input, "the opacity micromap array is of another context");
    other.build(input);
    micromap.indexOffset = ~0u;
    refuses(other, input, "triangle 0 has micromap 4294967295, but the array holds 2");
    micromap.indexOffset = 0;
    micromap.indexingMode = 5;
    refuses(other, input, "indexing mode 5");
    CHECK_SUCCESS(oxrtOpacityMicromapArrayDestroy(array));
    micromap.indexingMode = OXRT_OPACITY_MICROMAP_INDEXING_LINEAR;
    refuses(other, input, "does not exist");
}

TEST(texturesAndRelocationsOutOfRangeAreNamed)
{
    Fixture fixture;
    Fixture other;
    const float texels[4] = {};
    std::uint64_t handle = 0;
    OxrtTextureOptions options = {texels, 2, 2, 1, OXRT_TEXTURE_FLOAT32, OXRT_FILTER_LINEAR, OXRT_WRAP_REPEAT, OXRT_WRAP_REPEAT, 0};
    CHECK_SUCCESS(oxrtTextureCreate(fixture.context, &options, &handle));
    CHECK_FAILS(oxrtTextureDestroy(other.context, handle), OXRT_ERROR_INVALID_VALUE, "not alive in this context");
    CHECK_FAILS(oxrtTextureDestroy(fixture.context, ~std::uint64_t(0)), OXRT_ERROR_INVALID_VALUE, "not alive");
    options.width = ~0u;
    CHECK_FAILS(oxrtTextureCreate(fixture.context, &options, &handle), OXRT_ERROR_INVALID_VALUE, "4294967295 x 2");
    options.width = 2;
    options.texels = nullptr;
    CHECK_FAILS(oxrtTextureCreate(fixture.context, &options, &handle), OXRT_ERROR_INVALID_VALUE, "texels is NULL");

    Triangles mesh = square(1);
    const OxrtTraversableHandle foreign = other.handleOf(other.build(mesh.input()));
    const OxrtAccel accel = fixture.build(mesh.input());
    const OxrtAccel ias = fixture.build(instanceInput({instanceOf(fixture.handleOf(accel))}));
    OxrtAccel made = nullptr;
    CHECK_FAILS(oxrtAccelRelocate(ias, &foreign, 1, &made), OXRT_ERROR_INVALID_VALUE, "is not alive in this context");
    CHECK_FAILS(oxrtAccelRelocate(ias, &foreign, 2, &made), OXRT_ERROR_INVALID_VALUE, "2 children for 1 instances");
    CHECK_FAILS(oxrtAccelRelocate(accel, &foreign, 1, &made), OXRT_ERROR_INVALID_VALUE, "1 children");
    CHECK_FAILS(oxrtAccelRelocate(ias, nullptr, 1, &made), OXRT_ERROR_INVALID_VALUE, "children is NULL");
    CHECK(made == nullptr);
}

TEST(pipelinesTakeOddNumbers)
{
    Fixture fixture;
    TinyParams params = {};
    std::uint32_t visits[16] = {};
    params.visits = visits;
    CHECK_FAILS(oxrtPipelineSetFrames(fixture.pipeline, ~std::uint64_t(0)), OXRT_ERROR_INVALID_VALUE, "no stack is larger");
    CHECK_SUCCESS(oxrtPipelineSetFrames(fixture.pipeline, std::uint64_t(1) << 39));
    CHECK_FAILS(fixture.launch("__raygen__count", params, 16), OXRT_ERROR_LAUNCH_FAILURE, "more stack than this thread has");
    CHECK_SUCCESS(oxrtPipelineSetFrames(fixture.pipeline, 0));
    for (const std::uint32_t depth : {0u, ~0u}) {
        CHECK_SUCCESS(oxrtPipelineSetStackDepths(fixture.pipeline, depth, depth));
        CHECK_SUCCESS(fixture.launch("__raygen__count", params, 16));
    }
    int done = 0;
    CHECK_FAILS(oxrtLaunchWait(fixture.pipeline, 0, &done), OXRT_ERROR_INVALID_OPERATION, "no launch of this pipeline was begun");
    CHECK_SUCCESS(oxrtLaunchCancel(fixture.pipeline));
    OxrtShaderBindingTable sbt = fixture.table("__raygen__count");
    sbt.hitgroupRecords = fixture.record.bytes;
    sbt.hitgroupCount = 1;
    sbt.hitgroupStride = 40;
    CHECK_FAILS(oxrtLaunch(fixture.pipeline, &params, sizeof params, &sbt, 4, 4, 1), OXRT_ERROR_INVALID_VALUE, "hitgroup stride is 40");
    sbt.hitgroupStride = 64;
    sbt.hitgroupRecords = fixture.record.bytes + 4;
    CHECK_FAILS(oxrtLaunch(fixture.pipeline, &params, sizeof params, &sbt, 4, 4, 1), OXRT_ERROR_INVALID_VALUE, "not aligned to 16 bytes");
    CHECK_SUCCESS(oxrtPipelineDestroy(fixture.pipeline));
    CHECK_FAILS(oxrtLaunch(fixture.pipeline, &params, sizeof params, &sbt, 4, 4, 1), OXRT_ERROR_INVALID_VALUE, "does not exist");
    CHECK_FAILS(oxrtPipelineDestroy(fixture.pipeline), OXRT_ERROR_INVALID_VALUE, "does not exist");
}

int main(int argc, char** argv)
{
    return check::runAll(argc, argv);
}
