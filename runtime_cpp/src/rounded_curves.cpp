// Curves swept by spheres (OptiX's rocaps). A ray enters the union of the spheres at the smallest of their entry distances; on the tube that
// is a minimum of the distance over the curve's parameter, so the roots of its derivative are looked for. Ends are open, or closed by discs.
#include "curve_points.h"

#include "embree_library.h"

#include <cmath>
#include <cstdint>

namespace oxrt {

namespace {

constexpr int leaves = 16; // parts of a segment within which the distance has at most one minimum
constexpr int rootSteps = 24;
constexpr int mostHits = 4;

// A segment in the space of a ray: x and y across it, z along it in units of length.
struct AlongRay {
    Cubic curve;
    Point4 axes[3]; // x, y, z
    double shift;   // from the ray's origin to z = 0, in units of its direction
    float length;   // of the direction

    // The ray's squared distance from the axis beyond the radius, negative outside of the sphere at u; and half its derivative.
    float depth(const Point4& p) const { return p.w * p.w - p.x * p.x - p.y * p.y; }
    float halfDepthSlope(const Point4& p, const Point4& s) const { return p.w * s.w - p.x * s.x - p.y * s.y; }
    // Has the sign of the derivative of the entry distance.
    float slope(float u) const
    {
        const Point4 p = curve.at(u);
        const Point4 s = curve.slope(u);
        const float d = depth(p);
        return (d > 0 ? s.z * std::sqrt(d) : 0.0f) - halfDepthSlope(p, s);
    }
};

AlongRay alongRay(const Cubic& segment, const LaneRay& ray)
{
    const Beside beside = besideRay(segment, ray);
    const float length = std::sqrt(dot3(ray.direction, ray.direction));
    const Point4 z = ray.direction * (1 / length);
    const Point4 helper = std::fabs(z.x) < 0.5f ? Point4{1, 0, 0, 0} : Point4{0, 1, 0, 0};
    const Point4 x = normalize3(cross3(helper, z));
    const Point4 y = cross3(z, x);
    const auto turned = [&](const Point4& p) { return Point4{dot3(p, x), dot3(p, y), dot3(p, z), p.w}; };
    const Cubic& near = beside.segment;
    return {{turned(near.a), turned(near.b), turned(near.c), turned(near.d)}, {x, y, z}, beside.shift, length};
}

// Whether the ray may come within the radius of the part of the curve with these Bezier points.
bool mayMeet(const Bezier& part)
{
    float lowX = part.p[0].x, highX = lowX, lowY = part.p[0].y, highY = lowY, radius = 0;
    for (const Point4& p : part.p) {
        lowX = std::min(lowX, p.x);
        highX = std::max(highX, p.x);
        lowY = std::min(lowY, p.y);
        highY = std::max(highY, p.y);
        radius = std::max(radius, std::fabs(p.w));
    }
    return lowX <= radius && highX >= -radius && lowY <= radius && highY >= -radius;
}

// Bezier points of the part of a cubic from `begin` on, `width` long.
Bezier partOf(const Cubic& c, float begin, float width)
{
    const Cubic part = {c.at(begin), c.slope(begin) * width, (c.c + c.d * (3 * begin)) * (width * width), c.d * (width * width * width)};
    return bezierOf(part);
}

// The parameter in [low, high] where the slope goes from negative to positive, by regula falsi with bisection. Of the last interval it is
// the end where the ray is inside of the sphere: along a slowly growing tube the minimum lies where it has hardly entered.
float minimumIn(const AlongRay& along, float low, float high, float slopeLow, float slopeHigh)
{
    for (int step = 0; step < rootSteps && high - low > 1e-7f; ++step) {
        const float guess = (low * slopeHigh - high * slopeLow) / (slopeHigh - slopeLow);
        const bool isInside = step % 3 != 2 && guess > low && guess < high;
        const float middle = isInside ? guess : 0.5f * (low + high);
        const float slope = along.slope(middle);
        if (slope == 0) return middle;
        if (slope < 0) {
            low = middle;
            slopeLow = slope;
        } else {
            high = middle;
            slopeHigh = slope;
        }
    }
    return high;
}

struct Entry {
    float t, u;
    Point4 normal;
};

// Where the ray enters the spheres along the segment, nearest first.
int findEntries(const AlongRay& along, Entry (&entries)[mostHits])
{
    int count = 0;
    constexpr float width = 1.0f / leaves;
    for (int group = 0; group < leaves; group += 4) {
        if (!mayMeet(partOf(along.curve, static_cast<float>(group) * width, 4 * width))) continue;
        for (int leaf = group; leaf < group + 4; ++leaf) {
            const float low = static_cast<float>(leaf) * width;
            if (count == mostHits || !mayMeet(partOf(along.curve, low, width))) continue;
            const float slopeLow = along.slope(low);
            const float slopeHigh = along.slope(low + width);
            // The beginning belongs to the segment before, as in OptiX.
            if (!(slopeLow < 0 && slopeHigh >= 0)) continue;
            const float u = slopeHigh == 0 ? low + width : minimumIn(along, low, low + width, slopeLow, slopeHigh);
            const Point4 p = along.curve.at(u);
            const float depth = along.depth(p);
            if (!(depth >= 0) || !(p.w > 0)) continue;
            const float half = std::sqrt(depth);
            const float t = static_cast<float>(along.shift + static_cast<double>((p.z - half) / along.length));
            const Entry entry = {t, u, (along.axes[0] * p.x + along.axes[1] * p.y + along.axes[2] * half) * -1.0f};
            int place = count++;
            for (; place > 0 && entries[place - 1].t > entry.t; --place) entries[place] = entries[place - 1];
            entries[place] = entry;
        }
    }
    return count;
}

void intersectSegment(const OxrtGeometry& view, unsigned geometry, unsigned primitive, LaneHits& hits)
{
    const auto* points = reinterpret_cast<const Point4*>(view.vertices) + view.indices[primitive];
    CurveKind kind;
    findCurveKind(view.primitiveType, kind);
    for (unsigned i = 0; i < kind.controlPoints; ++i)
        if (points[i].w < 0) return;
    const Cubic segment = segmentAt(view, primitive, keyPosition(view.keyCount, hits.ray.time));
    const AlongRay along = alongRay(segment, hits.ray);
    Entry entries[mostHits];
    const int count = findEntries(along, entries);
    for (int i = 0; i < count; ++i) {
        if (!hits.offer({entries[i].t, entries[i].u, 0, entries[i].normal, geometry, primitive})) return;
    }
}

void segmentBoundsOf(const RTCBoundsFunctionArguments* arguments)
{
    const auto& view = *static_cast<const OxrtGeometry*>(arguments->geometryUserPtr);
    *arguments->bounds_o = kept(view, arguments->primID, segmentBounds(view, arguments->primID, arguments->timeStep));
}

class RoundedCurves final : public Shape {
public:
    explicit RoundedCurves(const OxrtBuildInput& input) : curves(input)
    {
        if (input.endcapFlags != 0) caps.ends = curves.strandEnds();
    }
    std::unique_ptr<Shape> clone() const override { return std::make_unique<RoundedCurves>(*this); }
    void copy(const OxrtBuildInput& input) override { curves.copy(input); }
    void describe(OxrtGeometry& view) const override
    {
        curves.describe(view);
        view.hasEndcaps = caps.count() != 0;
    }
    RTCGeometry make(const EmbreeLibrary& embree, RTCDevice device, OxrtGeometry& view) override
    {
        const RTCGeometry geometry = embree.rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
        setOwnShape(embree, geometry, view, ownShapeOf<intersectSegment>, segmentBoundsOf, curves.segmentCount, curves.keyCount);
        return geometry;
    }
    void refit(const EmbreeLibrary&, RTCGeometry) const override {}
    bool isOwn() const override { return true; }
    std::size_t bytes() const override { return curves.bytes() + caps.ends.size() * sizeof(CurveEnd); }
    RTCBounds boundsAt(const OxrtGeometry& view, std::uint32_t primitive, std::uint32_t key) const override
    {
        return segmentBounds(view, primitive, key);
    }
    std::uint32_t extraCount() const override { return caps.count(); }
    RTCGeometry makeExtra(const EmbreeLibrary& embree, RTCDevice device, unsigned geomID, const OxrtGeometry& view,
                          OxrtGeometry& extra) override
    {
        return caps.make(embree, device, geomID, view, extra);
    }

private:
    CurvePoints curves;
    CurveCaps caps;
};

} // namespace

std::unique_ptr<Shape> makeRoundedCurves(const OxrtBuildInput& input)
{
    return std::make_unique<RoundedCurves>(input);
}

} // namespace oxrt
