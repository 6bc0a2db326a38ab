// Acceleration structures: what is hit, what is refused, what the tables hold.
#include "fixture.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace {

constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

unsigned hitCount(const std::vector<TinyHit>& hits)
{
    unsigned count = 0;
    for (const TinyHit& hit : hits) count += hit.geometry != ~0u;
    return count;
}

} // namespace

TEST(trianglesAreHitWhereTheyAre)
{
    Fixture fixture;
    Triangles mesh = square(2);
    const OxrtAccel accel = fixture.build(mesh.input());
    const OxrtAccelInfo info = fixture.infoOf(accel);
    CHECK_EQUAL(info.isGas, 1u);
    CHECK_EQUAL(info.primitiveCount, 2u);
    CHECK_EQUAL(info.needs, 0u);
    CHECK_EQUAL(info.aabb[5], 2.0f);
    CHECK_EQUAL(info.aabb[3], 8.0f);
    CHECK(info.memoryUsage > 100);
    const auto hits = fixture.trace(info.handle, 10, 8);
    CHECK_EQUAL(hitCount(hits), 64u);
    CHECK_EQUAL(hits[1].t, 3.0f);
    CHECK_EQUAL(hits[1].primitive, 0u);
    CHECK_EQUAL(hits[30].primitive, 1u);
    CHECK_EQUAL(hits[9].geometry, ~0u);
    CHECK_EQUAL(hitCount(fixture.trace(info.handle, 8, 8, 0)), 0u);
    CHECK_EQUAL(hitCount(fixture.trace(0)), 0u);
}

TEST(inputIsCopied)
{
    Fixture fixture;
    Triangles mesh = square(2);
    const OxrtAccel accel = fixture.build(mesh.input());
    for (float& value : mesh.vertices) value = notANumber;
    for (auto& value : mesh.indices) value = 77;
    CHECK_EQUAL(hitCount(fixture.trace(fixture.handleOf(accel))), 64u);
}

TEST(verticesInThreesNeedNoIndices)
{
    Fixture fixture;
    Triangles mesh{{0, 0, 1, 8, 0, 1, 0, 8, 1, 8, 0, 1, 8, 8, 1, 0, 8, 1}, {}};
    CHECK_EQUAL(hitCount(fixture.trace(fixture.handleOf(fixture.build(mesh.input())))), 64u);
    OxrtBuildInput input = mesh.input();
    input.numPrimitives = 3;
    OxrtAccel accel = nullptr;
    CHECK_FAILS(oxrtAccelBuild(fixture.context, nullptr, &input, 1, &accel), OXRT_ERROR_INVALID_VALUE, "need 9 vertices");
}

TEST(severalInputsKeepTheirNumbersAndRecords)
{
    Fixture fixture;
    Triangles far = square(5);
    Triangles near = square(2);
    OxrtBuildInput inputs[3] = {far.input(), near.input(), near.input()};
    const std::uint32_t flags[3] = {0, 0, 1};
    const std::uint32_t offsets[2] = {1, 99}; // clamped to the last record
    inputs[0].numSbtRecords = 4;
    const std::uint32_t farOffsets[2] = {0, 0};
    inputs[0].sbtIndexOffsets = farOffsets;
    inputs[1].numSbtRecords = 3;
    inputs[1].flags = flags;
    inputs[1].sbtIndexOffsets = offsets;
    inputs[2].numPrimitives = 0;
    OxrtAccel accel = nullptr;
    CHECK_SUCCESS(oxrtAccelBuild(fixture.context, nullptr, inputs, 3, &accel));
    CHECK_EQUAL(fixture.infoOf(accel).needs, static_cast<std::uint32_t>(OXRT_SCENE_HAS_GEOMETRY_FLAGS));
    const auto hits = fixture.trace(fixture.handleOf(accel));
    CHECK_EQUAL(hits[1].geometry, 1u);
    CHECK_EQUAL(hits[1].record, 5u);
    CHECK_EQUAL(hits[8].record, 6u);
}

TEST(preTransformIsBaked)
{
    Fixture fixture;
    Triangles mesh = square(2);
    OxrtBuildInput input = mesh.input();
    float matrix[12] = {1, 0, 0, 4, 0, 1, 0, 0, 0, 0, 1, 7};
    input.preTransform = matrix;
    const OxrtAccelInfo info = fixture.infoOf(fixture.build(input));
    CHECK_EQUAL(info.aabb[0], 4.0f);
    CHECK_EQUAL(info.aabb[5], 9.0f);
    matrix[5] = infinity;
    OxrtAccel accel = nullptr;
    CHECK_FAILS(oxrtAccelBuild(fixture.context, nullptr, &input, 1, &accel), OXRT_ERROR_INVALID_VALUE, "preTransform[1][1]");
}

TEST(brokenVerticesAreNeverHitAndKeepTheirNumbers)
{
    Fixture fixture;
    for (const float bad : {notANumber, infinity, -infinity, 1e30f}) {
        Triangles mesh{{0, 0, 1, 8, 0, 1, 0, bad, 1, 0, 0, 2, 8, 0, 2, 0, 8, 2, 3, 3, 0, 3, 3, 0, 3, 3, 0}, {}};
        const auto hits = fixture.trace(fixture.handleOf(fixture.build(mesh.input())));
        CHECK_EQUAL(hits[0].primitive, 1u);
        CHECK_EQUAL(hits[0].t, 3.0f);
        CHECK(hitCount(hits) < 64u);
    }
}

TEST(badIndicesAreNamed)
{
    Fixture fixture;
    Triangles mesh = square(2);
    OxrtAccel accel = nullptr;
    mesh.indices[4] = 4;
    OxrtBuildInput input = mesh.input();
    CHECK_FAILS(oxrtAccelBuild(fixture.context, nullptr, &input, 1, &accel), OXRT_ERROR_INVALID_VALUE,
                "input 0: index 1 of triangle 1 is 4 (4 if signed), but there are 4 vertices");
    mesh.indices[4] = static_cast<std::uint32_t>(-1);
    CHECK_FAILS(oxrtAccelBuild(fixture.context, nullptr, &input, 1, &accel), OXRT_ERROR_INVALID_VALUE, "(-1 if signed)");
    CHECK(accel == nullptr);
}

TEST(misuseOfBuildsIsNamed)
{
    Fixture fixture;
    Triangles mesh = square(2);
    const OxrtBuildInput good = mesh.input();
    OxrtAccel accel = nullptr;
    const auto build = [&](OxrtBuildInput input, std::uint32_t flags = 0) {
        const OxrtAccelBuildOptions options = {flags, {}};
        return oxrtAccelBuild(fixture.context, &options, &input, 1, &accel);
    };
    OxrtBuildInput bad;

    CHECK_FAILS(oxrtAccelBuild(nullptr, nullptr, &good, 1, &accel), OXRT_ERROR_INVALID_DEVICE_CONTEXT, "context is NULL");
    CHECK_FAILS(oxrtAccelBuild(fixture.context, nullptr, &good, 0, &accel), OXRT_ERROR_INVALID_VALUE, "empty");
    CHECK_FAILS(oxrtAccelBuild(fixture.context, nullptr, nullptr, 1, &accel), OXRT_ERROR_INVALID_VALUE, "NULL");
    CHECK_FAILS(oxrtAccelBuild(fixture.context, nullptr, &good, 1, nullptr), OXRT_ERROR_INVALID_VALUE, "`accel` is NULL");
    CHECK_FAILS(build(good, 12), OXRT_ERROR_INVALID_VALUE, "choose one");
    CHECK_FAILS(build(good, 1u << 20), OXRT_ERROR_INVALID_VALUE, "unknown bits");

    bad = good;
    bad.type = 5;
    CHECK_FAILS(build(bad), OXRT_ERROR_INVALID_VALUE, "type is 0x5");
    bad = good;
    bad.numSbtRecords = 0;
    CHECK_FAILS(build(bad), OXRT_ERROR_INVALID_VALUE, "numSbtRecords is 0");
    bad.numSbtRecords = 2;
    CHECK_FAILS(build(bad), OXRT_ERROR_INVALID_VALUE, "sbtIndexOffsets is NULL");
    bad = good;
    const std::uint32_t flags = 64;
    bad.flags = &flags;
    CHECK_FAILS(build(bad), OXRT_ERROR_INVALID_VALUE, "flags[0] is 0x40");
    bad = good;
    bad.numVertices = 0;
    CHECK_FAILS(build(bad), OXRT_ERROR_INVALID_VALUE, "numVertices is 0");
    bad = good;
    bad.vertices = nullptr;
    CHECK_FAILS(build(bad), OXRT_ERROR_INVALID_VALUE, "vertices is NULL");
    const float* nullKeys[1] = {nullptr};
    bad.vertices = nullKeys;
    CHECK_FAILS(build(bad), OXRT_ERROR_INVALID_VALUE, "vertices[0] is NULL");
    bad = good;
    bad.primitiveIndexOffset = 0xFFFFFFFF;
    CHECK_FAILS(build(bad), OXRT_ERROR_INVALID_VALUE, "32 bits");
    bad = good;
    bad.numPrimitives = std::uint64_t(1) << 40;
    CHECK_FAILS(build(bad), OXRT_ERROR_INVALID_VALUE, "2^29");
    bad = good;
    bad.numKeys = 3;
    CHECK_FAILS(build(bad), OXRT_ERROR_INVALID_VALUE, "motion keys");

    Boxes boxes{{0, 0, 0, 1, 1, 1}};
    const OxrtBuildInput mixed[2] = {good, boxes.input()};
    CHECK_FAILS(oxrtAccelBuild(fixture.context, nullptr, mixed, 2, &accel), OXRT_ERROR_INVALID_VALUE, "input 1 is of type 0x2142");
    const OxrtBuildInput twice[2] = {instanceInput({}), instanceInput({})};
    CHECK_FAILS(oxrtAccelBuild(fixture.context, nullptr, twice, 2, &accel), OXRT_ERROR_INVALID_VALUE, "exactly one");
    CHECK(accel == nullptr);
}

TEST(emptyAccelsAreMissed)
{
    Fixture fixture;
    Triangles nothing;
    const OxrtAccelInfo gas = fixture.infoOf(fixture.build(nothing.input()));
    CHECK(gas.aabb[0] > gas.aabb[3]);
    CHECK_EQUAL(hitCount(fixture.trace(gas.handle)), 0u);
    const OxrtAccelInfo ias = fixture.infoOf(fixture.build(instanceInput({})));
    CHECK_EQUAL(hitCount(fixture.trace(ias.handle)), 0u);
    const OxrtAccelInfo over = fixture.infoOf(fixture.build(instanceInput({instanceOf(gas.handle)})));
    CHECK_EQUAL(hitCount(fixture.trace(over.handle)), 0u);
}

TEST(boxesAreVisitedAsOptixDoes)
{
    Fixture fixture;
    // Cell by cell: ordinary, flat in z, point, inverted, NaN, infinite.
    Boxes boxes{{0, 0, 0, 1, 1, 1, 1, 0, 3,          2, 1, 3, 2.5f, .5f,       1,         2.5f, .5f,      1,
                 4, 1, 0, 3, 0, 1, 4, 0, notANumber, 5, 1, 1, 5,    -infinity, -infinity, 6,    infinity, infinity}};
    const OxrtAccelInfo info = fixture.infoOf(fixture.build(boxes.input()));
    CHECK_EQUAL(info.needs, static_cast<std::uint32_t>(OXRT_SCENE_HAS_CUSTOM));
    const auto hits = fixture.trace(info.handle, 6, 1);
    CHECK_EQUAL(hits[0].primitive, 0u);
    CHECK_EQUAL(hits[0].t, 1.0f);
    CHECK_EQUAL(hits[1].primitive, 1u);
    CHECK_EQUAL(hits[1].t, 4.0f);
    CHECK_EQUAL(hits[2].geometry, ~0u);
    CHECK_EQUAL(hits[3].geometry, ~0u);
    CHECK_EQUAL(hits[4].geometry, ~0u);

    // Without an intersection program nothing is hit and nothing crashes.
    std::vector<TinyHit> none(6);
    TinyParams params = {};
    params.hits = none.data();
    params.scene = info.handle;
    params.rayMask = 255;
    params.cellSize = 1;
    CHECK_SUCCESS(fixture.launch("__raygen__trace", params, 6));
    CHECK_EQUAL(hitCount(none), 0u);
}

TEST(infiniteBoxesAreAlwaysVisited)
{
    Fixture fixture;
    Boxes boxes{{-infinity, -infinity, 3, infinity, infinity, infinity}};
    const auto hits = fixture.trace(fixture.handleOf(fixture.build(boxes.input())), 3, 3);
    CHECK_EQUAL(hitCount(hits), 9u);
    CHECK_EQUAL(hits[4].t, 4.0f);
}

TEST(instancesMoveMaskAndKeepTheirChildren)
{
    Fixture fixture;
    Triangles mesh = square(0);
    OxrtAccel child = fixture.build(mesh.input());
    std::vector<OxrtInstance> instances = {instanceOf(fixture.handleOf(child), 0, 0, 5), instanceOf(fixture.handleOf(child), 8, 0, 1),
                                           instanceOf(0), instanceOf(fixture.handleOf(child), 0, 0, 2)};
    instances[0].sbtOffset = 10;
    instances[1].sbtOffset = 20;
    instances[3].visibilityMask = 2;
    const OxrtAccel ias = fixture.build(instanceInput(instances));
    CHECK_EQUAL(fixture.infoOf(ias).needs, static_cast<std::uint32_t>(OXRT_SCENE_HAS_MASKS));
    CHECK_EQUAL(fixture.infoOf(ias).primitiveCount, 4u);
    CHECK_SUCCESS(oxrtAccelDestroy(child));
    CHECK_EQUAL(oxrtAccelDestroy(child), OXRT_ERROR_INVALID_VALUE);

    auto hits = fixture.trace(fixture.handleOf(ias), 16, 8, 1);
    CHECK_EQUAL(hits[0].instance, 0u);
    CHECK_EQUAL(hits[0].t, 6.0f);
    CHECK_EQUAL(hits[0].record, 10u);
    CHECK_EQUAL(hits[12].instance, 1u);
    CHECK_EQUAL(hits[12].t, 2.0f);
    hits = fixture.trace(fixture.handleOf(ias), 16, 8, 2);
    CHECK_EQUAL(hits[0].instance, 3u);
    CHECK_EQUAL(hits[0].t, 3.0f);
}

TEST(badInstancesAreNamed)
{
    Fixture fixture;
    Fixture other;
    Triangles mesh = square(0);
    const OxrtTraversableHandle child = fixture.handleOf(fixture.build(mesh.input()));
    const OxrtTraversableHandle foreign = other.handleOf(other.build(mesh.input()));
    OxrtAccel dead = fixture.build(mesh.input());
    const OxrtTraversableHandle stale = fixture.handleOf(dead);
    CHECK_SUCCESS(oxrtAccelDestroy(dead));
    OxrtAccel accel = nullptr;
    const auto build = [&](OxrtInstance instance) {
        const std::vector<OxrtInstance> instances = {instanceOf(child), instance};
        const OxrtBuildInput input = instanceInput(instances);
        return oxrtAccelBuild(fixture.context, nullptr, &input, 1, &accel);
    };
    OxrtInstance bad = instanceOf(child);
    bad.transform[6] = notANumber;
    CHECK_FAILS(build(bad), OXRT_ERROR_INVALID_VALUE, "instance 1: transform[1][2] is not finite");
    bad = instanceOf(child);
    bad.instanceId = 1u << 28;
    CHECK_FAILS(build(bad), OXRT_ERROR_INVALID_VALUE, "instanceId");
    bad = instanceOf(child);
    bad.sbtOffset = 1u << 28;
    CHECK_FAILS(build(bad), OXRT_ERROR_INVALID_VALUE, "sbtOffset");
    bad = instanceOf(child);
    bad.visibilityMask = 256;
    CHECK_FAILS(build(bad), OXRT_ERROR_INVALID_VALUE, "visibilityMask");
    CHECK_FAILS(build(instanceOf(stale)), OXRT_ERROR_INVALID_VALUE, "instance 1: traversable");
    CHECK_FAILS(build(instanceOf(foreign)), OXRT_ERROR_INVALID_VALUE, "of another context");
    CHECK_FAILS(build(instanceOf(12345)), OXRT_ERROR_INVALID_VALUE, "not alive");
    OxrtBuildInput input = instanceInput({});
    input.numPrimitives = 3;
    CHECK_FAILS(oxrtAccelBuild(fixture.context, nullptr, &input, 1, &accel), OXRT_ERROR_INVALID_VALUE, "instances is NULL");
}

TEST(singularInstancesAreNeverHit)
{
    Fixture fixture;
    Triangles mesh = square(0);
    const OxrtTraversableHandle child = fixture.handleOf(fixture.build(mesh.input()));
    OxrtInstance flat = instanceOf(child, 0, 0, 1);
    flat.transform[0] = 0;
    const OxrtAccel ias = fixture.build(instanceInput({flat, instanceOf(child, 0, 0, 4)}), OXRT_BUILD_FLAG_ALLOW_UPDATE);
    auto hits = fixture.trace(fixture.handleOf(ias));
    CHECK_EQUAL(hits[0].instance, 1u);
    CHECK_EQUAL(hitCount(hits), 64u);

    // An update may cure it and break the other one.
    const std::vector<OxrtInstance> cured = {instanceOf(child, 0, 0, 1), flat};
    const OxrtBuildInput input = instanceInput(cured);
    CHECK_SUCCESS(oxrtAccelUpdate(ias, &input, 1));
    hits = fixture.trace(fixture.handleOf(ias));
    CHECK_EQUAL(hits[0].instance, 0u);
    CHECK_EQUAL(hitCount(hits), 64u);
}

TEST(updatesMoveAndKeepTheHandle)
{
    Fixture fixture;
    Triangles mesh = square(2);
    const OxrtAccel fixed = fixture.build(mesh.input());
    const OxrtBuildInput fixedInput = mesh.input();
    CHECK_FAILS(oxrtAccelUpdate(fixed, &fixedInput, 1), OXRT_ERROR_INVALID_VALUE, "ALLOW_UPDATE");

    const OxrtAccel accel = fixture.build(mesh.input(), OXRT_BUILD_FLAG_ALLOW_UPDATE);
    const OxrtTraversableHandle handle = fixture.handleOf(accel);
    for (const float z : {4.0f, 9.0f, notANumber, 1.0f}) {
        for (std::size_t i = 2; i < mesh.vertices.size(); i += 3) mesh.vertices[i] = z;
        const OxrtBuildInput input = mesh.input();
        CHECK_SUCCESS(oxrtAccelUpdate(accel, &input, 1));
        CHECK_EQUAL(fixture.handleOf(accel), handle);
        const auto hits = fixture.trace(handle);
        CHECK_EQUAL(hitCount(hits), std::isnan(z) ? 0u : 64u);
        if (!std::isnan(z)) CHECK_EQUAL(hits[5].t, z + 1);
    }

    // Other connectivity is allowed.
    const std::vector<std::uint32_t> indices = mesh.indices;
    mesh.indices = {1, 2, 3, 1, 1, 1};
    const OxrtBuildInput rewired = mesh.input();
    CHECK_SUCCESS(oxrtAccelUpdate(accel, &rewired, 1));
    auto hits = fixture.trace(handle);
    CHECK_EQUAL(hits[0].geometry, ~0u);
    CHECK_EQUAL(hits[63].primitive, 0u);
    mesh.indices = indices;
    const OxrtBuildInput restored = mesh.input();
    CHECK_SUCCESS(oxrtAccelUpdate(accel, &restored, 1));
    hits = fixture.trace(handle);
    CHECK_EQUAL(hitCount(hits), 64u);

    Triangles larger{{0, 0, 1, 8, 0, 1, 0, 8, 1}, {}};
    const OxrtBuildInput other = larger.input();
    CHECK_FAILS(oxrtAccelUpdate(accel, &other, 1), OXRT_ERROR_INVALID_VALUE, "keeps");
    mesh.indices[0] = 1000;
    const OxrtBuildInput broken = mesh.input();
    CHECK_FAILS(oxrtAccelUpdate(accel, &broken, 1), OXRT_ERROR_INVALID_VALUE, "index 0 of triangle 0");
    CHECK_EQUAL(fixture.trace(handle)[5].t, 2.0f);
}

TEST(updatesOfBoxesAndInstances)
{
    Fixture fixture;
    Boxes boxes{{0, 0, 2, 8, 8, 3}};
    const OxrtAccel gas = fixture.build(boxes.input(), OXRT_BUILD_FLAG_ALLOW_UPDATE);
    boxes.aabbs[2] = 2.5f;
    OxrtBuildInput input = boxes.input();
    CHECK_SUCCESS(oxrtAccelUpdate(gas, &input, 1));
    CHECK_EQUAL(fixture.trace(fixture.handleOf(gas))[9].t, 3.5f);

    const OxrtTraversableHandle child = fixture.handleOf(gas);
    const OxrtAccel ias = fixture.build(instanceInput({instanceOf(child)}), OXRT_BUILD_FLAG_ALLOW_UPDATE);
    const std::vector<OxrtInstance> moved = {instanceOf(child, 0, 0, 10)};
    input = instanceInput(moved);
    CHECK_SUCCESS(oxrtAccelUpdate(ias, &input, 1));
    CHECK_EQUAL(fixture.trace(fixture.handleOf(ias))[9].t, 13.5f);
    const std::vector<OxrtInstance> otherChild = {instanceOf(0)};
    input = instanceInput(otherChild);
    CHECK_FAILS(oxrtAccelUpdate(ias, &input, 1), OXRT_ERROR_INVALID_VALUE, "keeps the traversables");
}

TEST(buildFlagsAllTrace)
{
    Fixture fixture;
    Triangles mesh = square(2);
    for (const unsigned flags : {1u, 2u, 4u, 8u, 16u, 32u, 65536u, 1u | 2u | 4u | 16u})
        CHECK_EQUAL(hitCount(fixture.trace(fixture.handleOf(fixture.build(mesh.input(), flags)))), 64u);
}

int main(int argc, char** argv)
{
    return check::runAll(argc, argv);
}
