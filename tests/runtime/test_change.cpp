// What changes after it was built: updates of every kind of input, moving ones too, opacity micromaps, and changes while launches run.
#include "fixture.h"

#include <atomic>
#include <cmath>
#include <cstdint>
#include <thread>
#include <utility>

namespace {

using Handle = OxrtTraversableHandle;

constexpr std::uint32_t updatable = OXRT_BUILD_FLAG_ALLOW_UPDATE;
constexpr float missed = -1;

// One ray up along +z through (1, 1), from z = -1.
float distance(Fixture& fixture, Handle scene, float time = 0)
{
    TinyHit hit = {};
    TinyParams params = {};
    params.hits = &hit;
    params.scene = scene;
    params.rayMask = 255;
    params.cellSize = 2;
    params.time = time;
    CHECK_SUCCESS(fixture.launch("__raygen__graph", params, 1));
    return hit.t;
}

// Spheres or curves at the keys' heights, with a radius for each key.
struct RoundShapes {
    std::uint32_t type;
    std::vector<std::vector<float>> vertices, radii;
    std::vector<std::uint32_t> indices;
    std::vector<const float*> vertexKeys, radiusKeys;

    RoundShapes(std::uint32_t inputType, std::vector<float> heights, float radius) : type(inputType)
    {
        for (const float z : heights) {
            if (type == OXRT_BUILD_INPUT_SPHERES)
                vertices.push_back({1, 1, z, 50, 50, z});
            else
                vertices.push_back({-3, 1, z, -1, 1, z, 1, 1, z, 3, 1, z, 5, 1, z});
            radii.emplace_back(vertices.back().size() / 3, radius);
        }
        for (std::size_t key = 0; key < heights.size(); ++key) {
            vertexKeys.push_back(vertices[key].data());
            radiusKeys.push_back(radii[key].data());
        }
        if (type == OXRT_BUILD_INPUT_CURVES) indices = {0, 1};
    }

    OxrtBuildInput input(std::uint32_t curveType) const
    {
        OxrtBuildInput made = {};
        made.type = type;
        made.numSbtRecords = 1;
        made.numKeys = static_cast<std::uint32_t>(vertices.size());
        made.vertices = vertexKeys.data();
        made.radii = radiusKeys.data();
        made.numVertices = vertices[0].size() / 3;
        made.indices = indices.empty() ? nullptr : indices.data();
        made.numPrimitives = indices.empty() ? made.numVertices : indices.size();
        made.curveType = curveType;
        return made;
    }
};

TEST(roundShapesFollowUpdates)
{
    Fixture fixture;
    const std::uint32_t kinds[][2] = {{OXRT_BUILD_INPUT_SPHERES, 0},
                                      {OXRT_BUILD_INPUT_CURVES, OXRT_PRIMITIVE_CUBIC_BSPLINE},
                                      {OXRT_BUILD_INPUT_CURVES, OXRT_PRIMITIVE_CUBIC_BSPLINE_ROCAPS}};
    for (const auto& [type, curveType] : kinds) {
        const RoundShapes low(type, {5}, 0.5f);
        const RoundShapes high(type, {9}, 0.25f);
        OxrtBuildInput input = low.input(curveType);
        OxrtAccel accel = fixture.build(input, updatable);
        const Handle scene = Fixture::handleOf(accel);
        CHECK(std::abs(distance(fixture, scene) - 5.5f) < 1e-3f);
        input = high.input(curveType);
        CHECK_SUCCESS(oxrtAccelUpdate(accel, &input, 1));
        CHECK(std::abs(distance(fixture, scene) - 9.75f) < 1e-3f);
        input.primitiveIndexOffset = 1;
        CHECK_FAILS(oxrtAccelUpdate(accel, &input, 1), OXRT_ERROR_INVALID_VALUE, "an update keeps");
        CHECK(std::abs(distance(fixture, scene) - 9.75f) < 1e-3f);
    }
}

TEST(movingShapesFollowUpdates)
{
    Fixture fixture;
    const std::uint32_t kinds[][2] = {{OXRT_BUILD_INPUT_SPHERES, 0}, {OXRT_BUILD_INPUT_CURVES, OXRT_PRIMITIVE_CUBIC_BSPLINE}};
    for (const auto& [type, curveType] : kinds) {
        const OxrtAccelBuildOptions options = {updatable, {2, 0, 0, 1}};
        const RoundShapes atRest(type, {5}, 0.5f);
        OxrtBuildInput input = atRest.input(curveType);
        OxrtAccel accel = nullptr;
        CHECK_FAILS(oxrtAccelBuild(fixture.context, &options, &input, 1, &accel), OXRT_ERROR_INVALID_VALUE, "1 motion keys");
        const RoundShapes slow(type, {5, 7}, 0.5f);
        const RoundShapes quick(type, {5, 25}, 0.5f);
        input = slow.input(curveType);
        CHECK_SUCCESS(oxrtAccelBuild(fixture.context, &options, &input, 1, &accel));
        const Handle child = Fixture::handleOf(accel);
        OxrtAccel above = fixture.build(instanceInput({instanceOf(child, 0, 0, 1)}), updatable);
        const Handle scene = Fixture::handleOf(above);
        CHECK(std::abs(distance(fixture, scene, 0.5f) - 7.5f) < 1e-3f);
        input = quick.input(curveType);
        CHECK_SUCCESS(oxrtAccelUpdate(accel, &input, 1));
        const std::vector<OxrtInstance> higher = {instanceOf(child, 0, 0, 2)};
        const OxrtBuildInput instances = instanceInput(higher);
        CHECK_SUCCESS(oxrtAccelUpdate(above, &instances, 1));
        CHECK(std::abs(distance(fixture, scene, 0.5f) - 17.5f) < 1e-3f);
        CHECK(std::abs(distance(fixture, scene, 3) - 27.5f) < 1e-3f);
        const RoundShapes three(type, {5, 6, 7}, 0.5f);
        input = three.input(curveType);
        CHECK_FAILS(oxrtAccelUpdate(accel, &input, 1), OXRT_ERROR_INVALID_VALUE, "3 motion keys");
    }
}

OxrtOpacityMicromapArray micromaps(Fixture& fixture, std::vector<std::uint8_t> data, std::vector<OxrtOpacityMicromapDesc> descs)
{
    std::vector<OxrtOpacityMicromapCount> histogram;
    for (const OxrtOpacityMicromapDesc& desc : descs) histogram.push_back({1, desc.subdivisionLevel, desc.format});
    const OxrtOpacityMicromapArrayOptions options = {
        0, static_cast<std::uint32_t>(descs.size()), data.data(), data.size(), descs.data(), histogram.data(),
        static_cast<std::uint32_t>(histogram.size())};
    OxrtOpacityMicromapArray array = nullptr;
    CHECK_SUCCESS(oxrtOpacityMicromapArrayBuild(fixture.context, &options, &array));
    return array;
}

// The ray meets the lower triangle of the square, in the middle micro-triangle of level 1 and in none of the others.
TEST(micromapsFollowUpdates)
{
    Fixture fixture;
    OxrtOpacityMicromapArray array =
        micromaps(fixture, {0xFF, 0x00}, {{0, 1, OXRT_OPACITY_MICROMAP_FORMAT_2_STATE}, {1, 1, OXRT_OPACITY_MICROMAP_FORMAT_2_STATE}});
    Triangles triangles = square(0);
    OxrtBuildInput input = triangles.input();
    std::vector<std::int32_t> indices = {0, 0};
    OxrtOpacityMicromapInput maps = {array, OXRT_OPACITY_MICROMAP_INDEXING_INDEXED, 0, indices.data(), nullptr, 0};
    input.opacityMicromap = &maps;
    OxrtAccel fixed = fixture.build(input, updatable);
    OxrtAccel accel = fixture.build(input, updatable | OXRT_BUILD_FLAG_ALLOW_OPACITY_MICROMAP_UPDATE);
    CHECK_SUCCESS(oxrtOpacityMicromapArrayDestroy(array)); // accels keep it
    CHECK_EQUAL(distance(fixture, Fixture::handleOf(accel)), 1.0f);
    maps.array = micromaps(fixture, {0xFF, 0x00}, {{0, 1, OXRT_OPACITY_MICROMAP_FORMAT_2_STATE}, {1, 1, OXRT_OPACITY_MICROMAP_FORMAT_2_STATE}});
    for (const auto& [index, expected] : {std::pair(1, missed), std::pair(-2, 1.0f), std::pair(-1, missed), std::pair(0, 1.0f)}) {
        indices = {index, index};
        CHECK_SUCCESS(oxrtAccelUpdate(accel, &input, 1));
        CHECK_EQUAL(distance(fixture, Fixture::handleOf(accel)), expected);
    }
    indices = {1, 1};
    CHECK_FAILS(oxrtAccelUpdate(fixed, &input, 1), OXRT_ERROR_INVALID_VALUE, "ALLOW_OPACITY_MICROMAP_UPDATE");
    indices = {2, 0};
    CHECK_FAILS(oxrtAccelUpdate(accel, &input, 1), OXRT_ERROR_INVALID_VALUE, "the array holds 2");
    CHECK_EQUAL(distance(fixture, Fixture::handleOf(accel)), 1.0f);
    CHECK_EQUAL(distance(fixture, Fixture::handleOf(fixture.build(instanceInput({instanceOf(Fixture::handleOf(accel), 0, 0, 3)})))), 4.0f);
}

TEST(badMicromapsAreNamed)
{
    Fixture fixture;
    const std::uint8_t data[2] = {0, 0};
    const struct {
        OxrtOpacityMicromapDesc desc;
        std::uint32_t counted;
        const char* says;
    } cases[] = {{{0, 13, 1}, 1, "level 13"}, {{0, 1, 3}, 1, "format 3"},  {{2, 1, 1}, 1, "do not fit"},
                 {{0, 12, 2}, 1, "do not fit"}, {{~0u, 0, 1}, 1, "do not fit"}, {{0, 1, 1}, 2, "histogram"}};
    for (const auto& one : cases) {
        const OxrtOpacityMicromapCount count = {one.counted, one.desc.subdivisionLevel, one.desc.format};
        const OxrtOpacityMicromapArrayOptions options = {0, 1, data, sizeof data, &one.desc, &count, 1};
        OxrtOpacityMicromapArray array = nullptr;
        CHECK_FAILS(oxrtOpacityMicromapArrayBuild(fixture.context, &options, &array), OXRT_ERROR_INVALID_VALUE, one.says);
        CHECK(array == nullptr);
    }
}

// A launch sees what was there before an update or after it, never something between; updates wait for nobody and say so.
TEST(changesWhileLaunchesRun)
{
    Fixture fixture;
    Triangles low = square(0);
    Triangles high = square(4);
    OxrtBuildInput inputs[2] = {low.input(), high.input()};
    OxrtAccel accel = fixture.build(inputs[0], updatable);
    std::vector<OxrtInstance> placed = {instanceOf(Fixture::handleOf(accel), 0, 0, 1)};
    OxrtBuildInput instances = instanceInput(placed);
    OxrtAccel above = fixture.build(instances, updatable);
    const Handle nested = Fixture::handleOf(fixture.build(instanceInput({instanceOf(Fixture::handleOf(above))})));
    std::atomic<bool> stop = false;
    std::atomic<int> updates = 0;
    std::thread changer([&] {
        for (int number = 0; !stop; ++number) {
            const OxrtResult result = number % 2 ? oxrtAccelUpdate(above, &instances, 1) : oxrtAccelUpdate(accel, &inputs[number / 2 % 2], 1);
            CHECK(result == OXRT_SUCCESS || result == OXRT_ERROR_INVALID_OPERATION);
            updates += result == OXRT_SUCCESS;
        }
    });
    std::thread builder([&] {
        while (!stop) {
            OxrtAccel other = fixture.build(inputs[0], OXRT_BUILD_FLAG_ALLOW_COMPACTION);
            OxrtAccel copy = nullptr;
            CHECK_SUCCESS(oxrtAccelCompact(other, &copy));
            CHECK_SUCCESS(oxrtAccelDestroy(other));
            CHECK_SUCCESS(oxrtAccelDestroy(copy));
        }
    });
    for (int launch = 0; launch < 200 || updates == 0; ++launch) {
        const float t = distance(fixture, nested);
        CHECK(t == 2.0f || t == 6.0f || t == missed); // the box above may be that of before
    }
    stop = true;
    changer.join();
    builder.join();
}

} // namespace

int main(int argc, char** argv)
{
    return check::runAll(argc, argv);
}
