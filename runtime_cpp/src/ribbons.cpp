// Ribbons: a line of half-width r(u) swept along a quadratic B-spline, met from both sides. The direction across is blended between unit
// vectors at the borders of segments: across the tangent and the caller's normal, or where there are no normals as the strand turns. The
// point of the axis in front of the ray along that direction is a root of a polynomial in u, of degree 5 at most.
#include "curve_points.h"

#include "embree_library.h"
#include "polynomial.h"
#include "ribbon_turn.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace oxrt {

namespace {

constexpr float inPlane = 1e-6f; // the ray meets the ribbon edge on

Point4 pointOf(const float* xyz)
{
    return {xyz[0], xyz[1], xyz[2], 0};
}

void storePoint(float* xyz, const Point4& p)
{
    xyz[0] = p.x;
    xyz[1] = p.y;
    xyz[2] = p.z;
}

// The part of `a` across the unit vector `direction`.
Point4 rejected(const Point4& a, const Point4& direction)
{
    return a - direction * dot3(a, direction);
}

// The direction across along one segment. Each border adds to its own direction a part of the way along the axis, so that the surface
// turns into that of the segment before it without a crease.
struct Across {
    Point4 begin, end;
    float beginLean, endLean;

    // As a polynomial in u above the axis, which is of degree 2.
    Cubic above(const Cubic& axis) const
    {
        return {begin, end - begin + axis.b * (beginLean + endLean) + axis.c * endLean,
                (axis.c - axis.b) * beginLean - axis.b * endLean, axis.c * (-beginLean - endLean)};
    }
};

constexpr std::size_t widthFloats = 8; // of one segment and key, in the order of Across

Across readAcross(const float* width)
{
    return {pointOf(width), pointOf(width + 3), width[6], width[7]};
}

Across acrossAt(const OxrtGeometry& view, std::uint32_t primitive, const KeyPosition& position)
{
    const std::size_t perKey = widthFloats * view.primitiveCount;
    const float* key = view.widths + perKey * position.key + widthFloats * primitive;
    if (position.fraction == 0) return readAcross(key);
    float between[widthFloats];
    for (std::size_t i = 0; i < widthFloats; ++i) between[i] = key[i] * (1 - position.fraction) + key[perKey + i] * position.fraction;
    return readAcross(between);
}

// Where axis and direction across lie in one plane with the ray, whose origin is 0: cross(axis, across) . direction = 0.
Polynomial planeCondition(const Cubic& axis, const Cubic& across, const Point4& direction)
{
    const Point4 from[3] = {axis.a, axis.b, axis.c};
    const Point4 wide[4] = {across.a, across.b, across.c, across.d};
    Polynomial condition;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 4; ++j) condition.terms[i + j] += static_cast<double>(dot3(cross3(from[i], wide[j]), direction));
    return condition;
}

void intersectRibbon(const OxrtGeometry& view, unsigned geometry, unsigned primitive, LaneHits& hits)
{
    const KeyPosition position = keyPosition(view.keyCount, hits.ray.time);
    const Beside beside = besideRay(segmentAt(view, primitive, position), hits.ray);
    const Cubic& axis = beside.segment;
    const Cubic across = acrossAt(view, primitive, position).above(axis);
    const Point4& direction = hits.ray.direction;
    double roots[Polynomial::mostRoots];
    const int count = rootsIn01(planeCondition(axis, across, direction), roots);
    const float lengthSquared = dot3(direction, direction);
    LaneHit found[Polynomial::mostRoots];
    int foundCount = 0;
    for (int i = 0; i < count; ++i) {
        const float u = static_cast<float>(roots[i]);
        const Point4 center = axis.at(u);
        const Point4 wide = normalize3(across.at(u));
        const Point4 away = center * -1.0f;
        // The nearest points of two lines: the ray, and the one across the ribbon.
        const float between = dot3(wide, direction);
        const float sine = lengthSquared - between * between;
        if (!(sine > inPlane * lengthSquared)) continue;
        const float side = (dot3(away, wide) * lengthSquared - dot3(away, direction) * between) / sine;
        const float v = side / center.w;
        if (!(std::fabs(v) <= 1)) continue;
        const float beyond = (dot3(away, wide) * between - dot3(away, direction)) / sine;
        const float t = static_cast<float>(beside.shift + static_cast<double>(beyond));
        const Point4 normal = cross3(axis.slope(u), wide);
        const float cosine = dot3(normal, direction);
        if (!(cosine * cosine > inPlane * inPlane * dot3(normal, normal) * lengthSquared)) continue;
        int place = foundCount++;
        for (; place > 0 && found[place - 1].t > t; --place) found[place] = found[place - 1];
        found[place] = {t, u, v, normal, geometry, primitive};
    }
    for (int i = 0; i < foundCount; ++i)
        if (!hits.offer(found[i])) return;
}

void ribbonBounds(const RTCBoundsFunctionArguments* arguments)
{
    const auto& view = *static_cast<const OxrtGeometry*>(arguments->geometryUserPtr);
    *arguments->bounds_o = kept(view, arguments->primID, segmentBounds(view, arguments->primID, arguments->timeStep));
}

class Ribbons final : public Shape {
public:
    explicit Ribbons(const OxrtBuildInput& input) : curves(input), widths(widthFloats * curves.segmentCount * curves.keyCount)
    {
        computeWidths(input);
    }
    std::unique_ptr<Shape> clone() const override { return std::make_unique<Ribbons>(*this); }
    void copy(const OxrtBuildInput& input) override
    {
        curves.copy(input);
        computeWidths(input);
    }
    void describe(OxrtGeometry& view) const override
    {
        curves.describe(view);
        view.widths = widths.data();
    }
    RTCGeometry make(const EmbreeLibrary& embree, RTCDevice device, OxrtGeometry& view) override
    {
        const RTCGeometry geometry = embree.rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
        setOwnShape(embree, geometry, view, ownShapeOf<intersectRibbon>, ribbonBounds, curves.segmentCount, curves.keyCount);
        return geometry;
    }
    void refit(const EmbreeLibrary&, RTCGeometry) const override {}
    bool isOwn() const override { return true; }
    std::size_t bytes() const override { return curves.bytes() + widths.bytes(); }

    RTCBounds boundsAt(const OxrtGeometry& view, std::uint32_t primitive, std::uint32_t key) const override
    {
        return segmentBounds(view, primitive, key);
    }

private:
    void computeWidths(const OxrtBuildInput& input)
    {
        for (std::uint32_t key = 0; key < curves.keyCount; ++key) {
            if (input.normals) {
                alongNormals(input.normals[key], key);
                alignSides(input.normals[key], key);
            } else {
                alongStrands(key);
            }
            leanAcross(key);
        }
    }

    void alongNormals(const float* normals, std::uint32_t key)
    {
        for (std::uint32_t i = 0; i < curves.segmentCount; ++i)
            for (std::uint32_t end = 0; end < 2; ++end) storePoint(widthOf(key, i) + 3 * end, acrossNormal(normals, key, i, end));
    }

    void alongStrands(std::uint32_t key)
    {
        for (std::uint32_t first = 0, behind = 0; first < curves.segmentCount; first = behind) {
            for (behind = first + 1; behind < curves.segmentCount && curves.continues(behind);) ++behind;
            const std::vector<Point4> across = acrossStrand(pointsOf(key, first), behind - first);
            for (std::uint32_t i = first; i < behind; ++i)
                for (std::uint32_t end = 0; end < 2; ++end) storePoint(widthOf(key, i) + 3 * end, across[i - first + end]);
        }
    }

    float* widthOf(std::uint32_t key, std::uint32_t segment)
    {
        return widths.data() + widthFloats * (std::size_t(curves.segmentCount) * key + segment);
    }

    const Point4* pointsOf(std::uint32_t key, std::uint32_t segment) const
    {
        return reinterpret_cast<const Point4*>(curves.points.data()) + curves.pointCount * key + curves.firsts[segment];
    }

    Point4 acrossNormal(const float* normals, std::uint32_t key, std::uint32_t segment, std::uint32_t end) const
    {
        const Point4* p = pointsOf(key, segment) + end;
        const Point4 tangent = p[1] - p[0];
        const Point4 across = normalize3(cross3(pointOf(normals + 3 * (curves.firsts[segment] + end)), tangent));
        return dot3(across, across) > 0 ? across : anyAcross(tangent);
    }

    // The sides must not swap along a strand, where the caller's normals do not swap; a border at right angles to the one before it counts
    // as swapped, as OptiX has it.
    void alignSides(const float* normals, std::uint32_t key)
    {
        float sign = 1;
        Point4 before;
        for (std::uint32_t i = 0; i < curves.segmentCount; ++i) {
            float* width = widthOf(key, i);
            if (!curves.continues(i)) {
                sign = 1;
                before = pointOf(width);
            }
            const Point4 own[2] = {before, pointOf(width + 3)}; // the border that two segments share is the first one's
            storePoint(width, own[0] * sign);
            const float* up = normals + 3 * curves.firsts[i];
            if (!(dot3(pointOf(up), pointOf(up + 3)) > 0))
                sign = 1;
            else if (!(dot3(own[0], own[1]) > 0))
                sign = -sign;
            storePoint(width + 3, own[1] * sign);
            before = own[1];
        }
    }

    // Where the ribbon turns about its axis, the surface normals at a border would not be those of the segment before: the direction across
    // gets the same derivative on both sides. (The rule follows hits on ribbons of a real OptiX.)
    void leanAcross(std::uint32_t key)
    {
        Point4 before;
        for (std::uint32_t i = 0; i < curves.segmentCount; ++i) {
            float* width = widthOf(key, i);
            Across across = readAcross(width);
            across.beginLean = across.endLean = 0;
            const Cubic axis = cubicOf(Basis::QuadraticBSpline, pointsOf(key, i));
            if (curves.continues(i)) leanAfter(before, axis, across);
            width[6] = across.beginLean;
            width[7] = across.endLean;
            const Cubic above = across.above(axis);
            before = rejected(above.slope(1), across.end);
        }
    }

    // `before`: the derivative of the direction across where the segment before ends.
    static void leanAfter(const Point4& before, const Cubic& axis, Across& across)
    {
        const Point4 tangent = axis.slope(0);
        const Point4 missing = before - rejected(across.end - across.begin, across.begin);
        const Point4 side = cross3(tangent, across.begin);
        constexpr float noTurn = 1e-5f;
        if (std::fabs(dot3(before, side)) + std::fabs(dot3(before - missing, side)) < noTurn * std::sqrt(dot3(side, side))) return;
        // missing = endLean * slope in the middle + beginLean * tangent, across `begin`
        const Point4 middle = rejected(axis.slope(0.5f), across.begin);
        const Point4 first = rejected(tangent, across.begin);
        const Point4 area = cross3(middle, first);
        const float squared = dot3(area, area);
        constexpr float parallel = 1e-4f;
        if (!(squared > parallel * parallel * dot3(middle, middle) * dot3(first, first))) return;
        across.endLean = dot3(cross3(missing, first), area) / squared;
        across.beginLean = dot3(cross3(middle, missing), area) / squared;
    }

    CurvePoints curves;
    Array<float> widths;
};

} // namespace

std::unique_ptr<Shape> makeRibbons(const OxrtBuildInput& input)
{
    return std::make_unique<Ribbons>(input);
}

} // namespace oxrt
