// Flat ends of curves: discs across the axis, met from outside only. Their parameter u is exactly 0 or 1.
#include "curve_points.h"

#include "embree_library.h"

#include <cmath>

namespace oxrt {

namespace {

// The direction of the axis at an end; where control points coincide the slope is zero and the way from nearby stands for it.
Point4 axisAt(const Cubic& segment, float u)
{
    const Point4 slope = segment.slope(u);
    if (dot3(slope, slope) > 0) return slope;
    constexpr float nearby = 1e-2f;
    return u == 0 ? segment.at(nearby) - segment.at(0) : segment.at(1) - segment.at(1 - nearby);
}

void intersectCap(const OxrtGeometry& view, unsigned, unsigned primitive, LaneHits& hits)
{
    const auto& caps = *static_cast<const CurveCaps*>(view.shape);
    const CurveEnd& end = caps.ends[primitive];
    const float u = static_cast<float>(end.end);
    const Beside beside = besideRay(segmentAt(*caps.curves, end.segment, keyPosition(caps.curves->keyCount, hits.ray.time)), hits.ray);
    const Point4 center = beside.segment.at(u);
    const Point4 normal = axisAt(beside.segment, u) * (end.end ? 1.0f : -1.0f);
    const float cosine = dot3(hits.ray.direction, normal);
    if (!(cosine < 0)) return;
    const float t = dot3(center, normal) / cosine;
    const Point4 away = hits.ray.direction * t - center;
    if (!(dot3(away, away) <= center.w * center.w)) return;
    hits.offer({static_cast<float>(beside.shift + static_cast<double>(t)), u, 0, normal, caps.curvesID, end.segment});
}

void capBounds(const RTCBoundsFunctionArguments* arguments)
{
    const auto& caps = *static_cast<const CurveCaps*>(static_cast<const OxrtGeometry*>(arguments->geometryUserPtr)->shape);
    const CurveEnd& end = caps.ends[arguments->primID];
    const Point4 center = segmentAt(*caps.curves, end.segment, {arguments->timeStep, 0}).at(static_cast<float>(end.end));
    const float r = std::fabs(center.w);
    *arguments->bounds_o = {center.x - r, center.y - r, center.z - r, 0, center.x + r, center.y + r, center.z + r, 0};
}

} // namespace

RTCGeometry CurveCaps::make(const EmbreeLibrary& embree, RTCDevice device, unsigned geomID, const OxrtGeometry& view, OxrtGeometry& extra)
{
    curves = &view;
    curvesID = geomID;
    const RTCGeometry geometry = embree.rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    extra = view;
    extra.shape = this;
    extra.boxes = nullptr;
    setOwnShape(embree, geometry, extra, ownShapeOf<intersectCap>, capBounds, count(), view.keyCount);
    return geometry;
}

} // namespace oxrt
