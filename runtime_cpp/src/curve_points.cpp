// See curve_points.h.
#include "curve_points.h"

#include "error.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace oxrt {

namespace {

constexpr std::uint32_t endcapsOn = 1;

void checkRadii(const OxrtBuildInput& input, unsigned number, bool isNegativeSkipped)
{
    for (std::uint32_t key = 0; key < std::max(1u, input.numKeys); ++key)
        for (std::uint64_t i = 0; i < input.numVertices; ++i) {
            const float radius = input.radii[key][i];
            if (std::isnan(radius) || (radius < 0 && !isNegativeSkipped))
                fail(OXRT_ERROR_INVALID_VALUE, "input %u: radii[%u][%llu] is %g; radii of curves are numbers from 0", number, key,
                     static_cast<unsigned long long>(i), static_cast<double>(radius));
        }
}

// An upper bound, near the largest value, of a + b u + c u^2 + d u^3 for u in [0, 1].
float largestIn01(const float (&terms)[4])
{
    const auto at = [&terms](double u) { return terms[0] + u * (terms[1] + u * (terms[2] + u * double(terms[3]))); };
    double largest = std::max(at(0), at(1));
    // the derivative b + 2 c u + 3 d u^2; of its two roots each is found without the difference of two near numbers
    const double b = terms[1];
    const double c = terms[2];
    const double d = 3 * double(terms[3]);
    const double discriminant = c * c - b * d;
    // most curves only rise or only fall: then so do the derivative's Bezier coefficients
    const bool rises = b >= 0 && b + c >= 0 && b + 2 * c + d >= 0;
    const bool falls = b <= 0 && b + c <= 0 && b + 2 * c + d <= 0;
    if (!rises && !falls && discriminant > 0) {
        const double q = -(c + std::copysign(std::sqrt(discriminant), c));
        for (const double u : {q / d, b / q})
            if (u > 0 && u < 1) largest = std::max(largest, at(u));
    }
    // the terms are rounded, and the points on the surface will be
    const double size = std::fabs(terms[0]) + std::fabs(terms[1]) + std::fabs(terms[2]) + std::fabs(terms[3]);
    return static_cast<float>(largest + 4 * double(std::numeric_limits<float>::epsilon()) * size);
}

} // namespace

void checkCurves(const OxrtBuildInput& input, unsigned number)
{
    CurveKind kind;
    if (!findCurveKind(input.curveType, kind))
        fail(OXRT_ERROR_INVALID_VALUE, "input %u: curveType 0x%x is no curve; give a PrimitiveType of curves", number, input.curveType);
    if (input.numSbtRecords != 1) fail(OXRT_ERROR_INVALID_VALUE, "input %u: curves have one SBT record, not %u", number, input.numSbtRecords);
    if (input.endcapFlags > endcapsOn)
        fail(OXRT_ERROR_INVALID_VALUE, "input %u: endcapFlags is 0x%x; give CurveEndcapFlags.DEFAULT or ON", number, input.endcapFlags);
    if (input.normals && !kind.isRibbon)
        fail(OXRT_ERROR_INVALID_VALUE, "input %u: normals are for ribbons (FLAT_QUADRATIC_BSPLINE), not for curve type 0x%x", number,
             input.curveType);
    if (input.numPrimitives == 0) return;
    checkKeys(input.vertices, input, number, "vertices");
    checkKeys(input.radii, input, number, "radii");
    if (input.normals) checkKeys(input.normals, input, number, "normals");
    if (!input.indices)
        fail(OXRT_ERROR_INVALID_VALUE, "input %u: indices is NULL; curves need the first control point of each segment", number);
    for (std::uint64_t i = 0; i < input.numPrimitives; ++i)
        if (input.indices[i] + std::uint64_t(kind.controlPoints) > input.numVertices)
            fail(OXRT_ERROR_INVALID_VALUE, "input %u: segment %llu begins at vertex %u and has %u control points, but there are %llu vertices",
                 number, static_cast<unsigned long long>(i), input.indices[i], kind.controlPoints,
                 static_cast<unsigned long long>(input.numVertices));
    checkRadii(input, number, kind.isRounded);
}

CurvePoints::CurvePoints(const OxrtBuildInput& input)
    : type(input.curveType), kind(), segmentCount(static_cast<std::uint32_t>(input.numPrimitives)),
      pointCount(input.numPrimitives == 0 ? 0 : input.numVertices), keyCount(std::max(1u, input.numKeys)), points(4 * pointCount * keyCount),
      firsts(segmentCount)
{
    findCurveKind(type, kind);
    copy(input);
}

void CurvePoints::copy(const OxrtBuildInput& input)
{
    for (std::uint32_t key = 0; key < keyCount; ++key)
        for (std::uint64_t i = 0; i < pointCount; ++i) {
            float* point = points.data() + 4 * (pointCount * key + i);
            const float* const vertex = input.vertices[key] + 3 * i;
            for (int axis = 0; axis < 3; ++axis) point[axis] = vertex[axis];
            point[3] = input.radii[key][i];
        }
    std::copy_n(input.indices, segmentCount, firsts.data());
}

void CurvePoints::describe(OxrtGeometry& view) const
{
    view.primitiveType = type;
    view.vertices = points.data();
    view.vertexCount = pointCount;
    view.indices = firsts.data();
}

bool CurvePoints::continues(std::uint32_t segment) const
{
    return segment > 0 && firsts[segment] == firsts[segment - 1] + kind.step;
}

std::vector<CurveEnd> CurvePoints::strandEnds() const
{
    std::vector<CurveEnd> ends;
    for (std::uint32_t i = 0; i < segmentCount; ++i) {
        if (!continues(i)) ends.push_back({i, 0});
        if (i + 1 == segmentCount || !continues(i + 1)) ends.push_back({i, 1});
    }
    return ends;
}

Cubic segmentAt(const OxrtGeometry& view, std::uint32_t primitive, const KeyPosition& position)
{
    CurveKind kind;
    findCurveKind(view.primitiveType, kind);
    const auto* points = reinterpret_cast<const Point4*>(view.vertices) + view.vertexCount * position.key + view.indices[primitive];
    if (position.fraction == 0) return cubicOf(kind.basis, points);
    Point4 between[4];
    const Point4* next = points + view.vertexCount;
    for (unsigned i = 0; i < kind.controlPoints; ++i) between[i] = points[i] * (1 - position.fraction) + next[i] * position.fraction;
    return cubicOf(kind.basis, between);
}

Beside besideRay(const Cubic& segment, const LaneRay& ray)
{
    const Point4 middle = segment.at(0.5f);
    const double direction[3] = {ray.direction.x, ray.direction.y, ray.direction.z};
    const double origin[3] = {ray.origin.x, ray.origin.y, ray.origin.z};
    const double away[3] = {middle.x - origin[0], middle.y - origin[1], middle.z - origin[2]};
    double along = 0;
    double lengthSquared = 0;
    for (int axis = 0; axis < 3; ++axis) {
        along += away[axis] * direction[axis];
        lengthSquared += direction[axis] * direction[axis];
    }
    const double shift = along / lengthSquared;
    const auto moved = [&](float a, int axis) { return static_cast<float>(a - (origin[axis] + shift * direction[axis])); };
    Cubic near = segment;
    near.a = {moved(segment.a.x, 0), moved(segment.a.y, 1), moved(segment.a.z, 2), segment.a.w};
    return {near, shift};
}

RTCBounds segmentBounds(const OxrtGeometry& view, std::uint32_t primitive, std::uint32_t key)
{
    const Cubic segment = segmentAt(view, primitive, {key, 0});
    const float radii[4] = {segment.a.w, segment.b.w, segment.c.w, segment.d.w};
    RTCBounds bounds = {};
    float* const low[3] = {&bounds.lower_x, &bounds.lower_y, &bounds.lower_z};
    float* const high[3] = {&bounds.upper_x, &bounds.upper_y, &bounds.upper_z};
    for (int axis = 0; axis < 3; ++axis) {
        const auto at = [axis](const Point4& p) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; };
        const float terms[4] = {at(segment.a), at(segment.b), at(segment.c), at(segment.d)};
        float above[4];
        float below[4];
        for (int i = 0; i < 4; ++i) {
            above[i] = terms[i] + radii[i];
            below[i] = radii[i] - terms[i];
        }
        *high[axis] = largestIn01(above);
        *low[axis] = -largestIn01(below);
    }
    return bounds;
}

} // namespace oxrt
