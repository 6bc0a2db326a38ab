// See geometry.h.
#include "geometry.h"

#include "curve_basis.h"
#include "error.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace oxrt {

namespace {

constexpr std::uint64_t maxPrimitives = std::uint64_t(1) << 29;
constexpr std::uint32_t maxRecords = 1u << 24;
constexpr std::uint32_t knownGeometryFlags = 7;
constexpr std::uint32_t flagDisableAnyHit = 1;
constexpr std::uint32_t manyCustomPrimitives = 256; // from here on bundled packets are traversed as one

void checkArrays(const OxrtBuildInput& input, unsigned number)
{
    const std::pair<const void*, const char*> arrays[] = {{input.flags, "flags"},
                                                          {input.sbtIndexOffsets, "sbtIndexOffsets"},
                                                          {input.indices, "indices"},
                                                          {input.preTransform, "preTransform"}};
    for (const auto& [array, name] : arrays) checkAligned(array, alignof(std::uint32_t), formatText("input %u: %s", number, name).c_str());
}

void checkRecords(const OxrtBuildInput& input, unsigned number)
{
    if (input.numSbtRecords == 0 || input.numSbtRecords > maxRecords)
        fail(OXRT_ERROR_INVALID_VALUE, "input %u: numSbtRecords is %u; give 1 to %u", number, input.numSbtRecords, maxRecords);
    for (std::uint32_t i = 0; input.flags && i < input.numSbtRecords; ++i)
        if (input.flags[i] & ~knownGeometryFlags)
            fail(OXRT_ERROR_INVALID_VALUE, "input %u: flags[%u] is 0x%x, which has unknown bits; combine GeometryFlags", number, i,
                 input.flags[i]);
    if (input.numSbtRecords > 1 && !input.sbtIndexOffsets && input.numPrimitives != 0)
        fail(OXRT_ERROR_INVALID_VALUE, "input %u: numSbtRecords is %u but sbtIndexOffsets is NULL; give one offset per primitive", number,
             input.numSbtRecords);
}

void checkCounts(const OxrtBuildInput& input, unsigned number)
{
    if (input.numPrimitives > maxPrimitives)
        fail(OXRT_ERROR_INVALID_VALUE, "input %u: %llu primitives; a GAS holds at most 2^29", number,
             static_cast<unsigned long long>(input.numPrimitives));
    if (input.primitiveIndexOffset + input.numPrimitives > std::uint64_t(1) << 32)
        fail(OXRT_ERROR_INVALID_VALUE, "input %u: primitiveIndexOffset %u plus %llu primitives does not fit 32 bits", number,
             input.primitiveIndexOffset, static_cast<unsigned long long>(input.numPrimitives));
}

} // namespace

void checkKeys(const float* const* keys, const OxrtBuildInput& input, unsigned number, const char* name)
{
    if (!keys)
        fail(OXRT_ERROR_INVALID_VALUE, "input %u: %s is NULL but numPrimitives is %llu", number, name,
             static_cast<unsigned long long>(input.numPrimitives));
    for (std::uint32_t key = 0; key < std::max(1u, input.numKeys); ++key)
        if (!keys[key])
            fail(OXRT_ERROR_INVALID_VALUE, "input %u: %s[%u] is NULL", number, name, key);
        else
            checkAligned(keys[key], alignof(float), formatText("input %u: %s[%u]", number, name, key).c_str());
}

namespace {

void checkTriangles(const OxrtBuildInput& input, unsigned number)
{
    const auto triangles = static_cast<unsigned long long>(input.numPrimitives);
    const auto available = static_cast<unsigned long long>(input.numVertices);
    if (input.preTransform)
        for (int i = 0; i < 12; ++i)
            if (!std::isfinite(input.preTransform[i]))
                fail(OXRT_ERROR_INVALID_VALUE, "input %u: preTransform[%d][%d] is not finite", number, i / 4, i % 4);
    if (input.numPrimitives == 0) return;
    if (input.numVertices == 0 || input.numVertices > std::uint64_t(1) << 32)
        fail(OXRT_ERROR_INVALID_VALUE, "input %u: numVertices is %llu; give 1 to 2^32", number, available);
    checkKeys(input.vertices, input, number, "vertices");
    if (!input.indices && input.numPrimitives * 3 > input.numVertices)
        fail(OXRT_ERROR_INVALID_VALUE, "input %u: %llu triangles without indices need %llu vertices, but there are %llu", number, triangles,
             triangles * 3, available);
    for (std::uint64_t i = 0; input.indices && i < input.numPrimitives * 3; ++i)
        if (input.indices[i] >= input.numVertices)
            fail(OXRT_ERROR_INVALID_VALUE, "input %u: index %u of triangle %llu is %u (%d if signed), but there are %llu vertices", number,
                 static_cast<unsigned>(i % 3), static_cast<unsigned long long>(i / 3), input.indices[i], static_cast<int>(input.indices[i]),
                 available);
}

void transformPoints(const float* matrix, float* points, std::uint64_t count)
{
    for (std::uint64_t i = 0; i < count; ++i) {
        float* p = points + 3 * i;
        const float x = p[0];
        const float y = p[1];
        const float z = p[2];
        for (int row = 0; row < 3; ++row)
            p[row] = matrix[4 * row] * x + matrix[4 * row + 1] * y + matrix[4 * row + 2] * z + matrix[4 * row + 3];
    }
}

void boxBounds(const RTCBoundsFunctionArguments* arguments)
{
    const auto& geometry = *static_cast<const OxrtGeometry*>(arguments->geometryUserPtr);
    const float* const box = geometry.vertices + 6 * (geometry.vertexCount * arguments->timeStep + arguments->primID);
    *arguments->bounds_o = boundsOfBox(box);
}

// Runs where a pipeline without intersection programs meets custom primitives: nothing is hit.
void intersectNothing(const RTCIntersectFunctionNArguments*)
{}
void occludeNothing(const RTCOccludedFunctionNArguments*)
{}

} // namespace

void Geometry::check(const Context& context, const OxrtBuildInput& input, unsigned number)
{
    checkArrays(input, number);
    switch (input.type) {
    case OXRT_BUILD_INPUT_TRIANGLES:
        checkCounts(input, number);
        checkRecords(input, number);
        checkTriangles(input, number);
        if (input.opacityMicromap) checkMicromaps(*input.opacityMicromap, context, input.numPrimitives, number);
        break;
    case OXRT_BUILD_INPUT_CUSTOM_PRIMITIVES:
        checkCounts(input, number);
        checkRecords(input, number);
        if (input.numPrimitives != 0) checkKeys(input.aabbs, input, number, "aabbs");
        break;
    case OXRT_BUILD_INPUT_SPHERES:
        checkCounts(input, number);
        checkRecords(input, number);
        checkSpheres(input, number);
        break;
    case OXRT_BUILD_INPUT_CURVES:
        checkCounts(input, number);
        checkRecords(input, number);
        checkCurves(input, number);
        break;
    default:
        fail(OXRT_ERROR_INVALID_VALUE,
             "input %u: type is 0x%x, which is no geometry; give OXRT_BUILD_INPUT_TRIANGLES, _CUSTOM_PRIMITIVES, _CURVES or _SPHERES", number,
             input.type);
    }
}

namespace {

std::unique_ptr<Shape> makeShape(const OxrtBuildInput& input)
{
    if (input.type == OXRT_BUILD_INPUT_SPHERES) return makeSpheres(input);
    if (input.type != OXRT_BUILD_INPUT_CURVES) return nullptr;
    CurveKind kind;
    findCurveKind(input.curveType, kind);
    if (kind.isRibbon) return makeRibbons(input);
    return kind.isRounded ? makeRoundedCurves(input) : makeCurves(input);
}

} // namespace

Geometry::Geometry(const OxrtBuildInput& input, std::uint32_t recordBase, RTCBuildQuality buildQuality)
    : inputType(input.type), quality(buildQuality), shape(makeShape(input))
{
    view.primitiveCount = static_cast<std::uint32_t>(input.numPrimitives);
    view.primitiveIndexOffset = input.primitiveIndexOffset;
    view.recordBase = recordBase;
    view.recordCount = input.numSbtRecords;
    view.keyCount = std::max(1u, input.numKeys);
    recordFlags = Array<std::uint32_t>(input.numSbtRecords);
    if (input.sbtIndexOffsets && input.numSbtRecords > 1) recordOffsets = Array<std::uint32_t>(view.primitiveCount);

    if (inputType == OXRT_BUILD_INPUT_TRIANGLES) {
        view.primitiveType = OXRT_PRIMITIVE_TRIANGLE;
        view.vertexCount = input.numPrimitives == 0 ? 0 : input.numVertices;
        vertices = Array<float>(3 * view.vertexCount * view.keyCount);
        indices = Array<std::uint32_t>(3 * std::size_t(view.primitiveCount));
    } else if (inputType == OXRT_BUILD_INPUT_CUSTOM_PRIMITIVES) {
        view.primitiveType = OXRT_PRIMITIVE_CUSTOM;
        view.vertexCount = view.primitiveCount;
        vertices = Array<float>(6 * view.vertexCount * view.keyCount);
    }
    // In leaves of quick builds and of updatable ones lie several primitives. Those of an intersection program have their boxes anyhow.
    const bool isOffered = quality != RTC_BUILD_QUALITY_MEDIUM || view.primitiveCount == 1;
    if (shape && shape->isOwn() && view.keyCount == 1 && isOffered) boxes = Array<float>(6 * std::size_t(view.primitiveCount));
    describe();
    update(input);
}

Geometry::Geometry(const Geometry& original)
    : inputType(original.inputType), quality(original.quality), view(original.view), recordFlags(original.recordFlags),
      recordOffsets(original.recordOffsets), vertices(original.vertices), indices(original.indices), boxes(original.boxes),
      shape(original.shape ? original.shape->clone() : nullptr), micromaps(original.micromaps)
{
    describe();
    micromaps.describe(view);
}

// Where the arrays are that kernels read.
void Geometry::describe()
{
    view.recordFlags = recordFlags.data();
    view.recordOffsets = recordOffsets.data();
    view.vertices = vertices.data();
    view.indices = indices.data();
    view.boxes = boxes.data();
    if (shape) shape->describe(view);
}

void Geometry::update(const OxrtBuildInput& input)
{
    copyRecords(input);
    if (view.primitiveCount == 0) return;
    if (shape) {
        shape->copy(input);
    } else if (inputType == OXRT_BUILD_INPUT_TRIANGLES) {
        copyTriangles(input);
        micromaps.copy(input);
        micromaps.describe(view);
    } else {
        copyBoxes(input);
    }
}

void Geometry::copyRecords(const OxrtBuildInput& input)
{
    for (std::uint32_t i = 0; i < view.recordCount; ++i) recordFlags[i] = input.flags ? input.flags[i] : 0;
    for (std::size_t i = 0; i < recordOffsets.size(); ++i) recordOffsets[i] = std::min(input.sbtIndexOffsets[i], view.recordCount - 1);
}

void Geometry::copyTriangles(const OxrtBuildInput& input)
{
    const std::size_t floats = 3 * view.vertexCount;
    for (std::uint32_t key = 0; key < view.keyCount; ++key) {
        float* target = vertices.data() + floats * key;
        std::copy_n(input.vertices[key], floats, target);
        if (input.preTransform) transformPoints(input.preTransform, target, view.vertexCount);
    }
    indicesChanged = input.indices && !std::equal(indices.data(), indices.data() + indices.size(), input.indices);
    if (indicesChanged) std::copy_n(input.indices, indices.size(), indices.data());
    for (std::size_t i = 0; !input.indices && i < indices.size(); ++i) {
        indicesChanged = indicesChanged || indices[i] != i;
        indices[i] = static_cast<std::uint32_t>(i);
    }
}

void Geometry::copyBoxes(const OxrtBuildInput& input)
{
    const std::size_t floats = 6 * view.vertexCount;
    for (std::uint32_t key = 0; key < view.keyCount; ++key) std::copy_n(input.aabbs[key], floats, vertices.data() + floats * key);
}

bool Geometry::anyHitPossible() const
{
    if (view.opacityMicromaps) return true; // the states of micromaps beat the flags
    return std::any_of(recordFlags.data(), recordFlags.data() + view.recordCount,
                       [](std::uint32_t flags) { return (flags & flagDisableAnyHit) == 0; });
}

std::uint32_t Geometry::needs() const
{
    std::uint32_t result = view.primitiveType == OXRT_PRIMITIVE_CUSTOM ? OXRT_SCENE_HAS_CUSTOM : 0;
    if (result && view.primitiveCount >= manyCustomPrimitives) result |= OXRT_SCENE_HAS_MANY_CUSTOM;
    for (std::uint32_t i = 0; i < view.recordCount; ++i)
        if (recordFlags[i] != 0) result |= OXRT_SCENE_HAS_GEOMETRY_FLAGS;
    if (inputType == OXRT_BUILD_INPUT_SPHERES) result |= OXRT_SCENE_HAS_SPHERES;
    if (inputType == OXRT_BUILD_INPUT_CURVES) result |= OXRT_SCENE_HAS_CURVES;
    if (view.opacityMicromaps) result |= OXRT_SCENE_HAS_MICROMAPS;
    return result;
}

std::size_t Geometry::bytes() const
{
    return recordFlags.bytes() + recordOffsets.bytes() + vertices.bytes() + indices.bytes() + boxes.bytes() +
           (shape ? shape->bytes() : 0) + micromaps.bytes();
}

void Geometry::prepare(const EmbreeLibrary& embree, RTCGeometry geometry, const OxrtGeometry& target) const
{
    embree.rtcSetGeometryUserData(geometry, const_cast<OxrtGeometry*>(&target));
    embree.rtcSetGeometryMask(geometry, ~0u); // Embree's default is 1
    embree.rtcSetGeometryBuildQuality(geometry, quality);
    embree.rtcSetGeometryEnableFilterFunctionFromArguments(geometry, anyHitPossible());
}

RTCGeometry Geometry::makeTriangles(const EmbreeLibrary& embree, RTCDevice device) const
{
    const RTCGeometry geometry = embree.rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    embree.rtcSetGeometryTimeStepCount(geometry, view.keyCount);
    for (std::uint32_t key = 0; key < view.keyCount; ++key)
        embree.rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, key, RTC_FORMAT_FLOAT3, vertices.data(),
                                          3 * sizeof(float) * view.vertexCount * key, 3 * sizeof(float), view.vertexCount);
    embree.rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, indices.data(), 0, 12, view.primitiveCount);
    return geometry;
}

RTCGeometry Geometry::makeBoxes(const EmbreeLibrary& embree, RTCDevice device, OxrtGeometry& target) const
{
    const RTCGeometry geometry = embree.rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    embree.rtcSetGeometryTimeStepCount(geometry, view.keyCount);
    embree.rtcSetGeometryUserPrimitiveCount(geometry, view.primitiveCount);
    embree.rtcSetGeometryBoundsFunction(geometry, boxBounds, &target);
    embree.rtcSetGeometryIntersectFunction(geometry, intersectNothing);
    embree.rtcSetGeometryOccludedFunction(geometry, occludeNothing);
    return geometry;
}

void Geometry::attach(const EmbreeLibrary& embree, RTCDevice device, RTCScene scene, unsigned geomID, OxrtGeometry& target) const
{
    target = view;
    if (view.primitiveCount == 0) return; // the number stays reserved
    const RTCGeometry geometry = shape                                                 ? shape->make(embree, device, target)
                                 : view.primitiveType == OXRT_PRIMITIVE_CUSTOM ? makeBoxes(embree, device, target)
                                                                               : makeTriangles(embree, device);
    prepare(embree, geometry, target);
    embree.rtcCommitGeometry(geometry);
    embree.rtcAttachGeometryByID(scene, geometry, geomID);
    embree.rtcReleaseGeometry(geometry);
}

void Geometry::attachExtra(const EmbreeLibrary& embree, RTCDevice device, RTCScene scene, unsigned geomID, unsigned extraID,
                           const OxrtGeometry& target, OxrtGeometry& extra) const
{
    const RTCGeometry geometry = shape->makeExtra(embree, device, geomID, target, extra);
    prepare(embree, geometry, extra);
    embree.rtcCommitGeometry(geometry);
    embree.rtcAttachGeometryByID(scene, geometry, extraID);
    embree.rtcReleaseGeometry(geometry);
}

void Geometry::refit(const EmbreeLibrary& embree, RTCScene scene, unsigned geomID) const
{
    if (view.primitiveCount == 0) return;
    const RTCGeometry geometry = embree.rtcGetGeometry(scene, geomID);
    embree.rtcSetGeometryEnableFilterFunctionFromArguments(geometry, anyHitPossible());
    if (shape)
        shape->refit(embree, geometry);
    else if (view.primitiveType == OXRT_PRIMITIVE_TRIANGLE) {
        for (std::uint32_t key = 0; key < view.keyCount; ++key) embree.rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, key);
        if (indicesChanged) embree.rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0); // makes Embree build anew
    }
    embree.rtcCommitGeometry(geometry);
}

void Geometry::refitExtra(const EmbreeLibrary& embree, RTCScene scene, unsigned extraID) const
{
    embree.rtcCommitGeometry(embree.rtcGetGeometry(scene, extraID));
}

} // namespace oxrt
