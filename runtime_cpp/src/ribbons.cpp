// Ribbons: a line of half-width r(u) swept along a quadratic B-spline, met from both sides. The direction across is blended between unit
// vectors at the borders of segments: across the tangent and the caller's normal, or where there are no normals across the plane in which
// the curve bends. The point of the axis in front of the ray along that direction is a root of a cubic in u.
#include "curve_points.h"

#include "embree_library.h"

#include <array>
#include <cmath>

namespace oxrt {

namespace {

constexpr int rootSteps = 40;
constexpr float inPlane = 1e-6f; // the ray meets the ribbon edge on

Point4 pointOf(const float* xyz)
{
    return {xyz[0], xyz[1], xyz[2], 0};
}

// A direction across `tangent` where nothing else says one.
Point4 anyAcross(const Point4& tangent)
{
    const Point4 across = cross3(tangent, {0, 0, 1, 0});
    return normalize3(dot3(across, across) > 1e-12f * dot3(tangent, tangent) ? across : cross3(tangent, {1, 0, 0, 0}));
}

// Across the plane in which three control points lie; zero if they lie on a line.
Point4 acrossBend(const Point4* p)
{
    const Point4 a = p[1] - p[0];
    const Point4 b = p[2] - p[1];
    const Point4 across = cross3(b, a);
    constexpr float straight = 1e-5f;
    return dot3(across, across) > straight * straight * dot3(a, a) * dot3(b, b) ? normalize3(across) : Point4{};
}

// A polynomial of degree 3 from its values' terms.
struct Polynomial {
    std::array<double, 4> terms;
    double at(double u) const { return terms[0] + (terms[1] + (terms[2] + terms[3] * u) * u) * u; }
};

// The roots of `f` in [0, 1], ascending: it is monotone between the roots of its derivative.
int rootsIn01(const Polynomial& f, double (&roots)[3])
{
    const double a = 3 * f.terms[3], b = f.terms[2], c = f.terms[1];
    double borders[4] = {0, 1, 1, 1};
    int count = 1;
    const double discriminant = b * b - a * c;
    if (discriminant > 0) {
        const double q = -(b + (b < 0 ? -std::sqrt(discriminant) : std::sqrt(discriminant)));
        double extremes[2] = {a != 0 ? q / a : -1, q != 0 ? c / q : -1};
        if (extremes[0] > extremes[1]) std::swap(extremes[0], extremes[1]);
        for (const double u : extremes)
            if (u > 0 && u < 1) borders[count++] = u;
    }
    borders[count] = 1;
    int found = 0;
    for (int i = 0; i < count; ++i) {
        double low = borders[i], high = borders[i + 1];
        const double atLow = f.at(low), atHigh = f.at(high);
        if (atLow == 0 && (found == 0 || roots[found - 1] != low)) roots[found++] = low;
        if (!((atLow < 0 && atHigh > 0) || (atLow > 0 && atHigh < 0))) {
            if (atHigh == 0 && i + 1 == count && found < 3) roots[found++] = high;
            continue;
        }
        for (int step = 0; step < rootSteps; ++step) {
            const double middle = 0.5 * (low + high);
            ((f.at(middle) < 0) == (atLow < 0) ? low : high) = middle;
        }
        roots[found++] = 0.5 * (low + high);
    }
    return found;
}

struct Across {
    Point4 begin, end;
    Point4 at(float u) const { return begin * (1 - u) + end * u; }
};

Across acrossAt(const OxrtGeometry& view, std::uint32_t primitive, const KeyPosition& position)
{
    const std::size_t perKey = 6 * std::size_t(view.primitiveCount);
    const float* key = view.widths + perKey * position.key + 6 * std::size_t(primitive);
    const Across first = {pointOf(key), pointOf(key + 3)};
    if (position.fraction == 0) return first;
    const Across second = {pointOf(key + perKey), pointOf(key + perKey + 3)};
    return {first.begin * (1 - position.fraction) + second.begin * position.fraction,
            first.end * (1 - position.fraction) + second.end * position.fraction};
}

// Where axis and direction across lie in one plane with the ray: cross(axis - origin, across) . direction = 0.
Polynomial planeCondition(const Cubic& axis, const Across& across, const LaneRay& ray)
{
    const Point4 slope = across.end - across.begin;
    const Point4 start = axis.a - ray.origin;
    const auto term = [&](const Point4& p, const Point4& q) { return static_cast<double>(dot3(cross3(p, q), ray.direction)); };
    return {{term(start, across.begin), term(start, slope) + term(axis.b, across.begin), term(axis.b, slope) + term(axis.c, across.begin),
             term(axis.c, slope)}};
}

void intersectRibbon(const OxrtGeometry& view, unsigned geometry, unsigned primitive, LaneHits& hits)
{
    const KeyPosition position = keyPosition(view.keyCount, hits.ray.time);
    const Cubic axis = segmentAt(view, primitive, position);
    const Across across = acrossAt(view, primitive, position);
    double roots[3];
    const int count = rootsIn01(planeCondition(axis, across, hits.ray), roots);
    const Point4& direction = hits.ray.direction;
    const float lengthSquared = dot3(direction, direction);
    LaneHit found[3];
    int foundCount = 0;
    for (int i = 0; i < count; ++i) {
        const float u = static_cast<float>(roots[i]);
        const Point4 center = axis.at(u);
        const Point4 wide = normalize3(across.at(u));
        const Point4 away = hits.ray.origin - center;
        // The nearest points of two lines: the ray, and the one across the ribbon.
        const float between = dot3(wide, direction);
        const float sine = lengthSquared - between * between;
        if (!(sine > inPlane * lengthSquared)) continue;
        const float side = (dot3(away, wide) * lengthSquared - dot3(away, direction) * between) / sine;
        const float v = side / center.w;
        if (!(std::fabs(v) <= 1)) continue;
        const float t = (dot3(away, wide) * between - dot3(away, direction)) / sine;
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
    *arguments->bounds_o = segmentBounds(view, arguments->primID, arguments->timeStep);
}

class Ribbons final : public Shape {
public:
    explicit Ribbons(const OxrtBuildInput& input) : curves(input), widths(6 * std::size_t(curves.segmentCount) * curves.keyCount)
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
    std::size_t bytes() const override { return curves.bytes() + widths.bytes(); }

    RTCBounds boundsAt(const OxrtGeometry& view, std::uint32_t primitive, std::uint32_t key) const override
    {
        return segmentBounds(view, primitive, key);
    }

private:
    void computeWidths(const OxrtBuildInput& input)
    {
        for (std::uint32_t key = 0; key < curves.keyCount; ++key)
            for (std::uint32_t i = 0; i < curves.segmentCount; ++i)
                for (std::uint32_t end = 0; end < 2; ++end) {
                    const Point4 across = input.normals ? acrossNormal(input.normals[key], key, i, end) : acrossCurve(key, i, end);
                    float* target = widths.data() + 6 * (std::size_t(curves.segmentCount) * key + i) + 3 * end;
                    target[0] = across.x;
                    target[1] = across.y;
                    target[2] = across.z;
                }
        for (std::uint32_t key = 0; key < curves.keyCount; ++key) alignSides(key);
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

    // The mean of the bends on both sides of the border.
    Point4 acrossCurve(std::uint32_t key, std::uint32_t segment, std::uint32_t end) const
    {
        const Point4* own = pointsOf(key, segment);
        Point4 mean = acrossBend(own);
        const bool hasNeighbour = end == 0 ? curves.continues(segment) : segment + 1 < curves.segmentCount && curves.continues(segment + 1);
        if (hasNeighbour) {
            const Point4 other = acrossBend(end == 0 ? own - 1 : own + 1);
            mean = dot3(mean, other) < 0 ? mean - other : mean + other;
        }
        return dot3(mean, mean) > 0 ? normalize3(mean) : anyAcross(own[end + 1] - own[end]);
    }

    // The sides must not swap along a strand: each direction is turned to the one before it.
    void alignSides(std::uint32_t key)
    {
        float* width = widths.data() + 6 * std::size_t(curves.segmentCount) * key;
        for (std::uint32_t i = 0; i < curves.segmentCount; ++i)
            for (std::uint32_t end = 0; end < 2; ++end) {
                if (end == 0 && !curves.continues(i)) continue;
                float* own = width + 6 * i + 3 * end;
                const float* before = own - 3;
                if (dot3(pointOf(own), pointOf(before)) < 0)
                    for (int axis = 0; axis < 3; ++axis) own[axis] = -own[axis];
            }
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
