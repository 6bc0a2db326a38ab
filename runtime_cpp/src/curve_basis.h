// Segments of curves as cubic polynomials, radius in the fourth component; and what is known of each curve type.
#pragma once

#include "oxrt/oxrt.h"
#include "oxrt/pipeline.h"

#include <cmath>
#include <cstdint>

namespace oxrt {

struct Point4 {
    float x = 0, y = 0, z = 0, w = 0;
    Point4 operator+(const Point4& b) const { return {x + b.x, y + b.y, z + b.z, w + b.w}; }
    Point4 operator-(const Point4& b) const { return {x - b.x, y - b.y, z - b.z, w - b.w}; }
    Point4 operator*(float s) const { return {x * s, y * s, z * s, w * s}; }
};

inline float dot3(const Point4& a, const Point4& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Point4 cross3(const Point4& a, const Point4& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x, 0};
}
inline Point4 normalize3(const Point4& a)
{
    const float length = std::sqrt(dot3(a, a));
    return length > 0 ? Point4{a.x / length, a.y / length, a.z / length, 0} : Point4{};
}

// a + b u + c u^2 + d u^3
struct Cubic {
    Point4 a, b, c, d;
    Point4 at(float u) const { return a + (b + (c + d * u) * u) * u; }
    Point4 slope(float u) const { return b + (c * 2.0f + d * (3.0f * u)) * u; }
};

enum class Basis { Linear, QuadraticBSpline, CubicBSpline, CatmullRom, Bezier };

struct CurveKind {
    Basis basis = Basis::Linear;
    unsigned controlPoints = 2; // of a segment
    unsigned step = 1;          // from the first control point of a segment to that of the next one of its strand
    bool isRounded = false;     // swept spheres: OptiX's rocaps
    bool isRibbon = false;
};

// False for a type that is no curve.
inline bool findCurveKind(std::uint32_t type, CurveKind& kind)
{
    switch (type) {
    case OXRT_PRIMITIVE_LINEAR: kind = {Basis::Linear, 2, 1, false, false}; return true;
    case OXRT_PRIMITIVE_QUADRATIC_BSPLINE: kind = {Basis::QuadraticBSpline, 3, 1, false, false}; return true;
    case OXRT_PRIMITIVE_CUBIC_BSPLINE: kind = {Basis::CubicBSpline, 4, 1, false, false}; return true;
    case OXRT_PRIMITIVE_CATMULL_ROM: kind = {Basis::CatmullRom, 4, 1, false, false}; return true;
    case OXRT_PRIMITIVE_CUBIC_BEZIER: kind = {Basis::Bezier, 4, 3, false, false}; return true;
    case OXRT_PRIMITIVE_QUADRATIC_BSPLINE_ROCAPS: kind = {Basis::QuadraticBSpline, 3, 1, true, false}; return true;
    case OXRT_PRIMITIVE_CUBIC_BSPLINE_ROCAPS: kind = {Basis::CubicBSpline, 4, 1, true, false}; return true;
    case OXRT_PRIMITIVE_CATMULL_ROM_ROCAPS: kind = {Basis::CatmullRom, 4, 1, true, false}; return true;
    case OXRT_PRIMITIVE_CUBIC_BEZIER_ROCAPS: kind = {Basis::Bezier, 4, 3, true, false}; return true;
    case OXRT_PRIMITIVE_FLAT_QUADRATIC_BSPLINE: kind = {Basis::QuadraticBSpline, 3, 1, false, true}; return true;
    default: return false;
    }
}

// Of the segment that begins at the control point `p`.
inline Cubic cubicOf(Basis basis, const Point4* p)
{
    switch (basis) {
    case Basis::Linear: return {p[0], p[1] - p[0], {}, {}};
    case Basis::QuadraticBSpline: return {(p[0] + p[1]) * 0.5f, p[1] - p[0], (p[0] - p[1] * 2.0f + p[2]) * 0.5f, {}};
    case Basis::CubicBSpline:
        return {(p[0] + p[1] * 4.0f + p[2]) * (1.0f / 6), (p[2] - p[0]) * 0.5f, (p[0] - p[1] * 2.0f + p[2]) * 0.5f,
                (p[3] - p[0] + (p[1] - p[2]) * 3.0f) * (1.0f / 6)};
    case Basis::CatmullRom:
        return {p[1], (p[2] - p[0]) * 0.5f, p[0] - p[1] * 2.5f + p[2] * 2.0f - p[3] * 0.5f, (p[3] - p[0] + (p[1] - p[2]) * 3.0f) * 0.5f};
    case Basis::Bezier: break;
    }
    return {p[0], (p[1] - p[0]) * 3.0f, (p[0] - p[1] * 2.0f + p[2]) * 3.0f, p[3] - p[0] + (p[1] - p[2]) * 3.0f};
}

// Bezier control points of a cubic: they bound it.
struct Bezier {
    Point4 p[4];
};
inline Bezier bezierOf(const Cubic& c)
{
    return {{c.a, c.a + c.b * (1.0f / 3), c.a + c.b * (2.0f / 3) + c.c * (1.0f / 3), c.a + c.b + c.c + c.d}};
}

} // namespace oxrt
