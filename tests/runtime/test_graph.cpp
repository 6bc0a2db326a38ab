// Graphs of instances and transforms, motion, and what is refused about them.
#include "fixture.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace {

using Handle = OxrtTraversableHandle;

OxrtTransformOptions transformOf(std::uint32_t type, Handle child, const std::vector<float>& keys, std::uint16_t numKeys = 0, float begin = 0,
                                 float end = 1, std::uint16_t flags = 0)
{
    return {type, child, keys.data(), {numKeys, flags, begin, end}};
}

std::vector<float> shifted(float x, float y, float z)
{
    return {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z};
}

std::vector<float> joined(std::vector<float> a, const std::vector<float>& b)
{
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

// A turn about z in the SRT form.
std::vector<float> turned(float degrees, float tx = 0)
{
    const float half = degrees * 3.14159265f / 360;
    return {1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, std::sin(half), std::cos(half), tx, 0, 0};
}

Handle make(Fixture& fixture, const OxrtTransformOptions& options, OxrtTransform* kept = nullptr)
{
    OxrtTransform transform = nullptr;
    CHECK_SUCCESS(oxrtTransformCreate(fixture.context, &options, &transform));
    if (kept) *kept = transform;
    Handle handle = 0;
    CHECK_SUCCESS(oxrtTransformGetHandle(transform, &handle));
    return handle;
}

Handle instanced(Fixture& fixture, std::vector<OxrtInstance> instances, std::uint32_t flags = 0)
{
    return Fixture::handleOf(fixture.build(instanceInput(instances), flags));
}

TinyHit traceAt(Fixture& fixture, Handle scene, float time = 0, std::uint32_t mask = 255)
{
    TinyHit hit = {};
    TinyParams params = {};
    params.hits = &hit;
    params.scene = scene;
    params.rayMask = mask;
    params.cellSize = 2;
    params.time = time;
    CHECK_SUCCESS(fixture.launch("__raygen__graph", params, 1));
    return hit;
}

Handle squareAt(Fixture& fixture, float z)
{
    Triangles triangles = square(z);
    return Fixture::handleOf(fixture.build(triangles.input()));
}

TEST(instancesNest)
{
    Fixture fixture;
    OxrtInstance inner = instanceOf(squareAt(fixture, 0), 0, 0, 1);
    inner.instanceId = 9;
    inner.sbtOffset = 2;
    inner.visibilityMask = 2;
    OxrtInstance outer = instanceOf(instanced(fixture, {inner}), 0, 0, 10);
    outer.instanceId = 5;
    outer.sbtOffset = 4;
    outer.visibilityMask = 3;
    const Handle scene = instanced(fixture, {outer});
    const TinyHit hit = traceAt(fixture, scene);
    CHECK_EQUAL(hit.t, 12.0f);
    CHECK_EQUAL(hit.instance, 9u);
    CHECK_EQUAL(hit.record, 6u);
    CHECK_EQUAL(hit.geometry, 2u); // transforms
    CHECK_EQUAL(traceAt(fixture, scene, 0, 1).t, -1.0f);
    CHECK_EQUAL(traceAt(fixture, scene, 0, 2).t, 12.0f);
}

TEST(graphsOfDepth31AreTheDeepest)
{
    Fixture fixture;
    Handle scene = squareAt(fixture, 0);
    for (int depth = 2; depth <= 31; ++depth) scene = instanced(fixture, {instanceOf(scene, 0, 0, 1)});
    const TinyHit hit = traceAt(fixture, scene);
    CHECK_EQUAL(hit.t, 31.0f);
    CHECK_EQUAL(hit.geometry, 30u);
    const std::vector<OxrtInstance> above = {instanceOf(scene)};
    const OxrtBuildInput input = instanceInput(above);
    OxrtAccel accel = nullptr;
    CHECK_FAILS(oxrtAccelBuild(fixture.context, nullptr, &input, 1, &accel), OXRT_ERROR_INVALID_VALUE, "32 traversables deep");
    const std::vector<float> matrix = shifted(0, 0, 0);
    const OxrtTransformOptions options = transformOf(OXRT_TRANSFORM_STATIC, scene, matrix);
    OxrtTransform transform = nullptr;
    CHECK_FAILS(oxrtTransformCreate(fixture.context, &options, &transform), OXRT_ERROR_INVALID_VALUE, "32 traversables deep");
}

TEST(transformsMove)
{
    Fixture fixture;
    const Handle child = squareAt(fixture, 0);
    const std::vector<float> keys = joined(shifted(0, 0, 0), shifted(0, 0, 8));
    const Handle moving = make(fixture, transformOf(OXRT_TRANSFORM_MATRIX_MOTION, child, keys, 2, 1, 3));
    const Handle scene = instanced(fixture, {instanceOf(moving, 0, 0, 2)});
    CHECK_EQUAL(traceAt(fixture, scene, 2).t, 7.0f);
    CHECK_EQUAL(traceAt(fixture, scene, -5).t, 3.0f);
    CHECK_EQUAL(traceAt(fixture, scene, 9).t, 11.0f);
    CHECK_EQUAL(traceAt(fixture, moving, 2.5f).t, 7.0f); // a root of its own
    const Handle vanishing = make(fixture, transformOf(OXRT_TRANSFORM_MATRIX_MOTION, child, keys, 2, 1, 3, 3));
    CHECK_EQUAL(traceAt(fixture, vanishing, 0.9f).t, -1.0f);
    CHECK_EQUAL(traceAt(fixture, vanishing, 1).t, 1.0f);
    CHECK_EQUAL(traceAt(fixture, vanishing, 3).t, 9.0f);
    CHECK_EQUAL(traceAt(fixture, vanishing, 3.1f).t, -1.0f);
}

// The square turns around its corner: at some time the ray at (1, 1) meets it, at others it does not.
TEST(boxesHoldEveryTurn)
{
    Fixture fixture;
    const std::vector<float> keys = joined(turned(0), turned(170));
    const Handle turning = make(fixture, transformOf(OXRT_TRANSFORM_SRT_MOTION, squareAt(fixture, 0), keys, 2));
    OxrtAccel accel = fixture.build(instanceInput({instanceOf(turning)}));
    const OxrtAccelInfo info = Fixture::infoOf(accel);
    const float reach = 8 * std::sqrt(2.0f);
    CHECK(info.aabb[0] < -reach + 0.01f && info.aabb[3] > 8 && info.aabb[4] > reach - 0.01f);
    CHECK(info.aabb[0] > -reach * 1.2f && info.aabb[4] < reach * 1.2f);
    CHECK_EQUAL(traceAt(fixture, info.handle, 0).t, 1.0f);
    CHECK_EQUAL(traceAt(fixture, info.handle, 0.3f).t, 1.0f);
    CHECK_EQUAL(traceAt(fixture, info.handle, 0.9f).t, -1.0f);
}

TEST(verticesMove)
{
    Fixture fixture;
    Triangles low = square(0);
    Triangles high = square(4);
    const float* keys[2] = {low.vertices.data(), high.vertices.data()};
    OxrtBuildInput input = low.input();
    input.vertices = keys;
    input.numKeys = 2;
    const OxrtAccelBuildOptions options = {0, {2, 0, 10, 20}};
    OxrtAccel accel = nullptr;
    CHECK_SUCCESS(oxrtAccelBuild(fixture.context, &options, &input, 1, &accel));
    const Handle gas = Fixture::handleOf(accel);
    CHECK_EQUAL(traceAt(fixture, gas, 15).t, 3.0f);
    CHECK_EQUAL(traceAt(fixture, gas, 30).t, 5.0f);
    CHECK_EQUAL(traceAt(fixture, instanced(fixture, {instanceOf(gas, 0, 0, 1)}), 12.5f).t, 3.0f);

    CHECK_FAILS(oxrtAccelBuild(fixture.context, nullptr, &input, 1, &accel), OXRT_ERROR_INVALID_VALUE, "2 motion keys");
    const OxrtAccelBuildOptions reversed = {0, {2, 0, 20, 10}};
    CHECK_FAILS(oxrtAccelBuild(fixture.context, &reversed, &input, 1, &accel), OXRT_ERROR_INVALID_VALUE, "is after");
}

TEST(parentsKeepTheirChildren)
{
    Fixture fixture;
    Triangles triangles = square(0);
    OxrtAccel gas = fixture.build(triangles.input());
    const std::vector<float> matrix = shifted(0, 0, 3);
    OxrtTransform transform = nullptr;
    const Handle lifted = make(fixture, transformOf(OXRT_TRANSFORM_STATIC, Fixture::handleOf(gas), matrix), &transform);
    const Handle scene = instanced(fixture, {instanceOf(lifted)});
    CHECK_SUCCESS(oxrtAccelDestroy(gas));
    CHECK_SUCCESS(oxrtTransformDestroy(transform));
    CHECK_EQUAL(traceAt(fixture, scene).t, 4.0f);
    CHECK_EQUAL(traceAt(fixture, lifted).t, -1.0f); // stale
    const std::vector<OxrtInstance> dead = {instanceOf(lifted)};
    const OxrtBuildInput input = instanceInput(dead);
    OxrtAccel accel = nullptr;
    CHECK_FAILS(oxrtAccelBuild(fixture.context, nullptr, &input, 1, &accel), OXRT_ERROR_INVALID_VALUE, "not alive");
    CHECK_FAILS(oxrtTransformDestroy(transform), OXRT_ERROR_INVALID_VALUE, "does not exist");
}

TEST(updatesMoveNestedInstances)
{
    Fixture fixture;
    const Handle inner = instanced(fixture, {instanceOf(squareAt(fixture, 0))});
    std::vector<OxrtInstance> instances = {instanceOf(inner), instanceOf(inner, 100, 0, 0)};
    OxrtAccel accel = fixture.build(instanceInput(instances), OXRT_BUILD_FLAG_ALLOW_UPDATE);
    const Handle scene = Fixture::handleOf(accel);
    CHECK_EQUAL(traceAt(fixture, scene).t, 1.0f);
    instances[0] = instanceOf(inner, 200, 0, 0);
    instances[1] = instanceOf(inner, 0, 0, 5);
    OxrtBuildInput input = instanceInput(instances);
    CHECK_SUCCESS(oxrtAccelUpdate(accel, &input, 1));
    CHECK_EQUAL(traceAt(fixture, scene).t, 6.0f);
    for (int i = 0; i < 12; ++i) instances[1].transform[i] = 0; // singular: never hit
    CHECK_SUCCESS(oxrtAccelUpdate(accel, &input, 1));
    CHECK_EQUAL(traceAt(fixture, scene).t, -1.0f);
    instances[1] = instanceOf(inner, 0, 0, 2);
    CHECK_SUCCESS(oxrtAccelUpdate(accel, &input, 1));
    CHECK_EQUAL(traceAt(fixture, scene).t, 3.0f);
    instances[0].traversable = scene;
    CHECK_FAILS(oxrtAccelUpdate(accel, &input, 1), OXRT_ERROR_INVALID_VALUE, "keeps the traversables");
}

TEST(copiesOutliveWhatTheyWereMadeOf)
{
    Fixture fixture;
    for (const int allowed : {0, int(OXRT_BUILD_FLAG_ALLOW_UPDATE)}) {
        const auto flags = static_cast<std::uint32_t>(allowed);
        Triangles triangles = square(0);
        OxrtAccel gas = fixture.build(triangles.input(), flags | OXRT_BUILD_FLAG_ALLOW_COMPACTION);
        OxrtAccel compacted = nullptr;
        CHECK_SUCCESS(oxrtAccelCompact(gas, &compacted));
        CHECK(Fixture::handleOf(compacted) != Fixture::handleOf(gas));
        CHECK(Fixture::infoOf(compacted).memoryUsage <= Fixture::infoOf(gas).memoryUsage * 2);
        if (flags) { // an update of one leaves the other alone
            Triangles higher = square(3);
            const OxrtBuildInput input = higher.input();
            CHECK_SUCCESS(oxrtAccelUpdate(gas, &input, 1));
        }
        OxrtAccel ias = fixture.build(instanceInput({instanceOf(Fixture::handleOf(gas), 0, 0, 1)}), flags);
        CHECK_SUCCESS(oxrtAccelDestroy(gas));
        CHECK_EQUAL(traceAt(fixture, Fixture::handleOf(compacted)).t, 1.0f);
        OxrtAccel relocated = nullptr;
        CHECK_SUCCESS(oxrtAccelRelocate(ias, nullptr, 0, &relocated));
        CHECK_EQUAL(traceAt(fixture, Fixture::handleOf(relocated)).t, flags ? 5.0f : 2.0f);
        const Handle other = Fixture::handleOf(compacted);
        OxrtAccel replaced = nullptr;
        CHECK_SUCCESS(oxrtAccelRelocate(ias, &other, 1, &replaced));
        CHECK_SUCCESS(oxrtAccelDestroy(ias));
        CHECK_EQUAL(traceAt(fixture, Fixture::handleOf(replaced)).t, 2.0f);
        CHECK_FAILS(oxrtAccelRelocate(relocated, &other, 2, &replaced), OXRT_ERROR_INVALID_VALUE, "2 children");
        CHECK_FAILS(oxrtAccelRelocate(compacted, &other, 1, &replaced), OXRT_ERROR_INVALID_VALUE, "has none");
        CHECK_FAILS(oxrtAccelCompact(relocated, &replaced), OXRT_ERROR_INVALID_VALUE, "ALLOW_COMPACTION");
    }
}

TEST(badTransformsAreRefused)
{
    Fixture fixture;
    const Handle child = squareAt(fixture, 0);
    const std::vector<float> identity = shifted(0, 0, 0);
    const std::vector<float> two = joined(identity, identity);
    std::vector<float> noRotation = joined(turned(0), turned(0));
    for (int i = 25; i < 29; ++i) noRotation[static_cast<std::size_t>(i)] = 0;
    std::vector<float> notANumber = two;
    notANumber[13] = std::numeric_limits<float>::quiet_NaN();
    const struct {
        OxrtTransformOptions options;
        const char* says;
    } cases[] = {
        {transformOf(OXRT_TRANSFORM_MATRIX_MOTION, child, two, 1), "at least 2"},
        {transformOf(OXRT_TRANSFORM_MATRIX_MOTION, child, two, 2, 1, 1), "must be before"},
        {transformOf(OXRT_TRANSFORM_MATRIX_MOTION, child, two, 2, 2, 1), "must be before"},
        {transformOf(OXRT_TRANSFORM_MATRIX_MOTION, child, two, 2, 0, 1, 8), "unknown bits"},
        {transformOf(OXRT_TRANSFORM_MATRIX_MOTION, child, notANumber, 2), "key 1: number 1 is not finite"},
        {transformOf(OXRT_TRANSFORM_SRT_MOTION, child, noRotation, 2), "length zero"},
        {transformOf(7, child, two, 2), "no transform"},
        {transformOf(OXRT_TRANSFORM_STATIC, 0, identity), "not a traversable"},
        {transformOf(OXRT_TRANSFORM_STATIC, child + 1, identity), "not a traversable"},
        {{OXRT_TRANSFORM_STATIC, child, nullptr, {}}, "keys is NULL"},
    };
    for (const auto& one : cases) {
        OxrtTransform transform = nullptr;
        CHECK_FAILS(oxrtTransformCreate(fixture.context, &one.options, &transform), OXRT_ERROR_INVALID_VALUE, one.says);
        CHECK(transform == nullptr);
    }
}

} // namespace

int main(int argc, char** argv)
{
    return check::runAll(argc, argv);
}
