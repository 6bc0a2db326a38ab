// What all curves keep of their input: control points with radii, and the first control point of each segment.
#pragma once

#include "array.h"
#include "curve_basis.h"
#include "own_shape.h"
#include "shape.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace oxrt {

// `primitive` of a curve view as a polynomial, between its motion keys.
Cubic segmentAt(const OxrtGeometry& view, std::uint32_t primitive, const KeyPosition& position);
// The bounds at one motion key of the spheres along a segment.
RTCBounds segmentBounds(const OxrtGeometry& view, std::uint32_t primitive, std::uint32_t key);

// A segment as the ray sees it from its point beside the middle of the segment, which is `shift` along the ray: the ray's origin is 0 then.
// Seen from far away the way to the segment is long and what counts of it is short, so the difference is taken in double precision.
struct Beside {
    Cubic segment;
    double shift;
};
Beside besideRay(const Cubic& segment, const LaneRay& ray);

// A flat end of a strand: where the curve begins (end 0) or stops (end 1).
struct CurveEnd {
    std::uint32_t segment;
    std::uint32_t end;
};

class CurvePoints {
public:
    explicit CurvePoints(const OxrtBuildInput& input);

    void copy(const OxrtBuildInput& input);
    void describe(OxrtGeometry& view) const;
    std::size_t bytes() const { return points.bytes() + firsts.bytes(); }

    bool continues(std::uint32_t segment) const; // in the segment before it
    std::vector<CurveEnd> strandEnds() const;

    const std::uint32_t type;
    CurveKind kind;
    const std::uint32_t segmentCount;
    const std::uint64_t pointCount;
    const std::uint32_t keyCount;
    Array<float> points; // x y z radius; pointCount for each key
    Array<std::uint32_t> firsts;
};

// The discs that close the ends of strands; a user geometry of its own that reports hits on the curves.
struct CurveCaps {
    std::vector<CurveEnd> ends;
    const OxrtGeometry* curves = nullptr;
    unsigned curvesID = 0;

    std::uint32_t count() const { return static_cast<std::uint32_t>(ends.size()); }
    // `extra` is the view of the caps: only callbacks see it.
    RTCGeometry make(const EmbreeLibrary& embree, RTCDevice device, unsigned geomID, const OxrtGeometry& view, OxrtGeometry& extra);
};

} // namespace oxrt
