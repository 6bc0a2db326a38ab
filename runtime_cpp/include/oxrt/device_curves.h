/* Spheres, curves and ribbons: their data at the ray's time, of the current hit and by handle. */
#ifndef OXRT_DEVICE_CURVES_H
#define OXRT_DEVICE_CURVES_H

#include <oxrt/device_handles.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* The keys of a structure at a time; static ones have one. */
OXRT_INLINE KeyPlace keyPosition(const OxrtTraversableView& gas, float time) { return gas.keyCount > 1 ? keyPlace(gas, time) : KeyPlace{0, 0.0f}; }
OXRT_INLINE KeyPlace keyPosition(const Ray& ray) { return keyPosition(holderOf(ray), ray.time); }

/* ---- of a primitive ------------------------------------------------------------------------------------------------------------- */

/* A vertex with its radius, between the motion keys. */
OXRT_INLINE float4 radiusVertex(const OxrtGeometry& geometry, uint32_t index, KeyPlace at) {
    const float* v = geometry.vertices + 4 * (geometry.vertexCount * at.key + index);
    if (at.fraction == 0.0f)
        return {v[0], v[1], v[2], v[3]};
    const float* w = v + 4 * geometry.vertexCount;
    const float a = 1.0f - at.fraction;
    const float b = at.fraction;
    return {a * v[0] + b * w[0], a * v[1] + b * w[1], a * v[2] + b * w[2], a * v[3] + b * w[3]};
}

template <int N> struct ControlPoints;
template <> struct ControlPoints<2> {
    using Type = Tuple<float4, float4>;
};
template <> struct ControlPoints<3> {
    using Type = Tuple<float4, float4, float4>;
};
template <> struct ControlPoints<4> {
    using Type = Tuple<float4, float4, float4, float4>;
};
template <int N> OXRT_INLINE typename ControlPoints<N>::Type controlPoints(const OxrtGeometry& geometry, uint32_t primitive, KeyPlace at) {
    const uint32_t first = geometry.indices[primitive];
    const auto point = [&](uint32_t i) { return radiusVertex(geometry, first + i, at); };
    if constexpr (N == 2)
        return makeTuple(point(0), point(1));
    else if constexpr (N == 3)
        return makeTuple(point(0), point(1), point(2));
    else
        return makeTuple(point(0), point(1), point(2), point(3));
}

/* One of the 8 numbers that say how a ribbon's segment lies; see OxrtGeometry::widths. */
OXRT_INLINE float ribbonWidth(const OxrtGeometry& geometry, uint32_t primitive, KeyPlace at, int number) {
    const uint64_t perKey = 8 * uint64_t(geometry.primitiveCount);
    const float* w = geometry.widths + perKey * at.key + 8 * uint64_t(primitive) + number;
    return at.fraction == 0.0f ? w[0] : (1.0f - at.fraction) * w[0] + at.fraction * w[perKey];
}

/* What of a ribbon's normal is in one axis: the axis' derivative, the direction across, and its derivative. */
struct RibbonAxis {
    float slope, across, change;
};
OXRT_INLINE RibbonAxis ribbonAxis(float p0, float p1, float p2, float begin, float end, float beginLean, float endLean, float u) {
    const float a = 1.0f - u;
    const float slope = a * (p1 - p0) + u * (p2 - p1);
    const float way = 0.5f * u * (p1 - p0 + slope);        /* from the beginning of the segment */
    const float left = 0.5f * a * (slope + p2 - p1);       /* to its end */
    const float first = begin + beginLean * way;
    const float second = end + endLean * left;
    return {slope, a * first + u * second, second - first + (a * beginLean - u * endLean) * slope};
}

/* The normal of the ruled surface axis(u) + v radius(u) across(u) / |across(u)|, not normalised: its derivatives' cross product, in which
   the direction across has the length of the blend of its ends, as OptiX gives it. */
OXRT_INLINE float3 ribbonNormal(const OxrtGeometry& geometry, uint32_t primitive, KeyPlace at, const float2& parameters) {
    const float u = parameters.x;
    const uint32_t first = geometry.indices[primitive];
    const float4 p0 = radiusVertex(geometry, first, at);
    const float4 p1 = radiusVertex(geometry, first + 1, at);
    const float4 p2 = radiusVertex(geometry, first + 2, at);
    const auto width = [&](int number) { return ribbonWidth(geometry, primitive, at, number); };
    const RibbonAxis x = ribbonAxis(p0.x, p1.x, p2.x, width(0), width(3), width(6), width(7), u);
    const RibbonAxis y = ribbonAxis(p0.y, p1.y, p2.y, width(1), width(4), width(6), width(7), u);
    const RibbonAxis z = ribbonAxis(p0.z, p1.z, p2.z, width(2), width(5), width(6), width(7), u);
    const float a = 1.0f - u;
    const float radius = 0.5f * (a * a * p0.w + (1.0f + 2.0f * u * a) * p1.w + u * u * p2.w);
    const float squared = x.across * x.across + y.across * y.across + z.across * z.across;
    const float inverse = squared > 0.0f ? 1.0f / __builtin_sqrtf(squared) : 0.0f;
    const float along = (x.across * x.change + y.across * y.change + z.across * z.change) * inverse * inverse;
    const float scale = parameters.y * radius * inverse;
    const float3 tangent(x.slope + scale * (x.change - along * x.across), y.slope + scale * (y.change - along * y.across),
                         z.slope + scale * (z.change - along * z.across));
    return {tangent.y * z.across - tangent.z * y.across, tangent.z * x.across - tangent.x * z.across,
            tangent.x * y.across - tangent.y * x.across};
}

/* ---- of the hit ----------------------------------------------------------------------------------------------------------------- */

OXRT_INLINE float4 getSphereData(const Ray& ray) {
    return ray.geometry->primitiveType == OXRT_PRIMITIVE_SPHERE ? radiusVertex(*ray.geometry, ray.primitive, keyPosition(ray)) : float4{};
}
OXRT_INLINE float3 getRibbonNormal(const Ray& ray, const float2& parameters) {
    return ray.geometry->widths ? ribbonNormal(*ray.geometry, ray.primitive, keyPosition(ray), parameters) : float3{};
}

/* ---- by handle ---------------------------------------------------------------------------------------------------------------------- */

OXRT_INLINE float4 getSphereDataFromHandle(OxrtThread& thread, uint64_t gas, uint32_t primitive, uint32_t sbtGasIndex, float time,
                                           Place place = Place::current()) {
    const NamedPrimitive named = findPrimitive(thread, gas, primitive, sbtGasIndex, OXRT_PRIMITIVE_SPHERE, place);
    return named.geometry ? radiusVertex(*named.geometry, named.primitive, keyPosition(*named.view, time)) : float4{};
}
OXRT_INLINE float3 getRibbonNormalFromHandle(OxrtThread& thread, uint64_t gas, uint32_t primitive, uint32_t sbtGasIndex, float time,
                                             const float2& parameters, Place place = Place::current()) {
    const NamedPrimitive named = findPrimitive(thread, gas, primitive, sbtGasIndex, OXRT_PRIMITIVE_FLAT_QUADRATIC_BSPLINE, place);
    return named.geometry ? ribbonNormal(*named.geometry, named.primitive, keyPosition(*named.view, time), parameters) : float3{};
}

/* The control points of one curve type; zeros where the primitive is of another one. */
#define OXRT_CURVE_GETTER(name, type, count)                                                                                          \
    OXRT_INLINE ControlPoints<count>::Type get##name(const Ray& ray) {                                                                \
        return ray.geometry->primitiveType == OXRT_PRIMITIVE_##type ? controlPoints<count>(*ray.geometry, ray.primitive, keyPosition(ray)) \
                                                                    : ControlPoints<count>::Type{};                                   \
    }                                                                                                                                 \
    OXRT_INLINE ControlPoints<count>::Type get##name##FromHandle(OxrtThread& thread, uint64_t gas, uint32_t primitive,                \
                                                                 uint32_t sbtGasIndex, float time, Place place = Place::current()) {  \
        const NamedPrimitive named = findPrimitive(thread, gas, primitive, sbtGasIndex, OXRT_PRIMITIVE_##type, place);                \
        return named.geometry ? controlPoints<count>(*named.geometry, named.primitive, keyPosition(*named.view, time))                \
                              : ControlPoints<count>::Type{};                                                                         \
    }
OXRT_CURVE_GETTER(LinearCurveVertexData, LINEAR, 2)
OXRT_CURVE_GETTER(QuadraticBSplineVertexData, QUADRATIC_BSPLINE, 3)
OXRT_CURVE_GETTER(QuadraticBSplineRocapsVertexData, QUADRATIC_BSPLINE_ROCAPS, 3)
OXRT_CURVE_GETTER(CubicBSplineVertexData, CUBIC_BSPLINE, 4)
OXRT_CURVE_GETTER(CubicBSplineRocapsVertexData, CUBIC_BSPLINE_ROCAPS, 4)
OXRT_CURVE_GETTER(CatmullRomVertexData, CATMULL_ROM, 4)
OXRT_CURVE_GETTER(CatmullRomRocapsVertexData, CATMULL_ROM_ROCAPS, 4)
OXRT_CURVE_GETTER(CubicBezierVertexData, CUBIC_BEZIER, 4)
OXRT_CURVE_GETTER(CubicBezierRocapsVertexData, CUBIC_BEZIER_ROCAPS, 4)
OXRT_CURVE_GETTER(RibbonVertexData, FLAT_QUADRATIC_BSPLINE, 3)
#undef OXRT_CURVE_GETTER

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
