// Round curves by Embree's own: linear ones with spherical ends, the others as swept circles that are open at the ends, or closed by discs.
// Quadratic B-splines have no Embree type: each segment becomes a Bezier curve of the same shape.
#include "curve_points.h"
#include "filter_lanes.h"

#include <cmath>
#include <cstdint>

namespace oxrt {

namespace {

// Where caps are on, u is 0 or 1 on them and nowhere else; the nearest values that a real OptiX gives beside them.
constexpr float afterStart = 1e-7f;
constexpr float beforeEnd = 0.99999988f;

void keepOffEnds(const RTCFilterFunctionNArguments* arguments)
{
    enum { U = 3 };
    float* const u = static_cast<float*>(arguments->hit) + U * arguments->N;
    eachValidLane(*arguments, [&](unsigned lane) {
        arguments->valid[lane] = isEntered(*arguments, lane) ? -1 : 0;
        u[lane] = std::fmin(std::fmax(u[lane], afterStart), beforeEnd);
    });
}

class Curves final : public Shape {
public:
    explicit Curves(const OxrtBuildInput& input)
        : curves(input), isElevated(curves.kind.basis == Basis::QuadraticBSpline),
          hasEndcaps(input.endcapFlags != 0 && curves.kind.basis != Basis::Linear)
    {
        if (hasEndcaps) caps.ends = curves.strandEnds();
        if (curves.kind.basis == Basis::Linear) markNeighbours();
        if (isElevated) {
            elevated = Array<float>(16 * std::size_t(curves.segmentCount) * curves.keyCount);
            elevatedFirsts = Array<std::uint32_t>(curves.segmentCount);
            for (std::uint32_t i = 0; i < curves.segmentCount; ++i) elevatedFirsts[i] = 4 * i;
            elevate();
        }
    }

    std::unique_ptr<Shape> clone() const override { return std::make_unique<Curves>(*this); }

    void copy(const OxrtBuildInput& input) override
    {
        curves.copy(input);
        if (isElevated) elevate();
    }

    void describe(OxrtGeometry& view) const override
    {
        curves.describe(view);
        view.hasEndcaps = hasEndcaps;
    }

    RTCGeometry make(const EmbreeLibrary& embree, RTCDevice device, OxrtGeometry&) override
    {
        const RTCGeometry geometry = embree.rtcNewGeometry(device, embreeType());
        const Array<float>& points = isElevated ? elevated : curves.points;
        const std::size_t count = isElevated ? 4 * std::size_t(curves.segmentCount) : curves.pointCount;
        const Array<std::uint32_t>& firsts = isElevated ? elevatedFirsts : curves.firsts;
        embree.rtcSetGeometryTimeStepCount(geometry, curves.keyCount);
        for (std::uint32_t key = 0; key < curves.keyCount; ++key)
            embree.rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, key, RTC_FORMAT_FLOAT4, points.data(),
                                              sizeof(Point4) * count * key, sizeof(Point4), count);
        embree.rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, firsts.data(), 0, sizeof(std::uint32_t),
                                          curves.segmentCount);
        if (curves.kind.basis == Basis::Linear)
            embree.rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_FLAGS, 0, RTC_FORMAT_UCHAR, neighbours.data(), 0, 1,
                                              curves.segmentCount);
        setFilter(embree, geometry, hasEndcaps ? keepOffEnds : dropBackFaces);
        return geometry;
    }

    void refit(const EmbreeLibrary& embree, RTCGeometry geometry) const override
    {
        for (std::uint32_t key = 0; key < curves.keyCount; ++key) embree.rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, key);
    }

    std::size_t bytes() const override
    {
        return curves.bytes() + elevated.bytes() + elevatedFirsts.bytes() + neighbours.bytes() + caps.ends.size() * sizeof(CurveEnd);
    }

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
    RTCGeometryType embreeType() const
    {
        switch (curves.kind.basis) {
        case Basis::Linear: return RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE;
        case Basis::CubicBSpline: return RTC_GEOMETRY_TYPE_ROUND_BSPLINE_CURVE;
        case Basis::CatmullRom: return RTC_GEOMETRY_TYPE_ROUND_CATMULL_ROM_CURVE;
        case Basis::QuadraticBSpline:
        case Basis::Bezier: break;
        }
        return RTC_GEOMETRY_TYPE_ROUND_BEZIER_CURVE;
    }

    // Joints inside of a strand are covered once.
    void markNeighbours()
    {
        neighbours = Array<std::uint8_t>(curves.segmentCount);
        for (std::uint32_t i = 1; i < curves.segmentCount; ++i)
            if (curves.continues(i)) {
                neighbours[i - 1] |= RTC_CURVE_FLAG_NEIGHBOR_RIGHT;
                neighbours[i] |= RTC_CURVE_FLAG_NEIGHBOR_LEFT;
            }
    }

    void elevate()
    {
        for (std::uint32_t key = 0; key < curves.keyCount; ++key) {
            const auto* points = reinterpret_cast<const Point4*>(curves.points.data()) + curves.pointCount * key;
            auto* target = reinterpret_cast<Bezier*>(elevated.data()) + std::size_t(curves.segmentCount) * key;
            for (std::uint32_t i = 0; i < curves.segmentCount; ++i)
                target[i] = bezierOf(cubicOf(Basis::QuadraticBSpline, points + curves.firsts[i]));
        }
    }

    CurvePoints curves;
    const bool isElevated;
    const bool hasEndcaps;
    CurveCaps caps;
    Array<float> elevated;
    Array<std::uint32_t> elevatedFirsts;
    Array<std::uint8_t> neighbours;
};

} // namespace

std::unique_ptr<Shape> makeCurves(const OxrtBuildInput& input)
{
    return std::make_unique<Curves>(input);
}

} // namespace oxrt
