"""Points and tangents of curve segments from their control points, as `get_..._vertex_data` gives them: the radius is in w.

A tangent is the derivative by the curve's parameter in [0, 1]; it has no unit length. The normal of a round curve at a point of its
surface is perpendicular to the tangent, away from the axis.
"""

import optixc as ox
from optixc import float3, float4


@ox.device
def cubic_bspline_point(p: tuple[float4, float4, float4, float4], u: float) -> float4:
    """Axis and radius of a uniform cubic B-spline."""
    s = 1.0 - u
    weights = float4(s * s * s, 4.0 - 6.0 * u * u + 3.0 * u * u * u, 4.0 - 6.0 * s * s + 3.0 * s * s * s, u * u * u) / 6.0
    return weights.x * p[0] + weights.y * p[1] + weights.z * p[2] + weights.w * p[3]


@ox.device
def cubic_bspline_tangent(p: tuple[float4, float4, float4, float4], u: float) -> float3:
    """Its derivative."""
    s = 1.0 - u
    derivative = s * s * (p[1] - p[0]) + (1.0 + 2.0 * u * s) * (p[2] - p[1]) + u * u * (p[3] - p[2])
    return 0.5 * derivative.xyz


@ox.device
def catmull_rom_point(p: tuple[float4, float4, float4, float4], u: float) -> float4:
    """Axis and radius of a Catmull-Rom segment, from the second to the third point."""
    bend = 2.0 * p[0] - 5.0 * p[1] + 4.0 * p[2] - p[3]
    turn = 3.0 * (p[1] - p[2]) + p[3] - p[0]
    return p[1] + 0.5 * u * (p[2] - p[0] + u * (bend + u * turn))


@ox.device
def catmull_rom_tangent(p: tuple[float4, float4, float4, float4], u: float) -> float3:
    """Its derivative."""
    bend = 2.0 * p[0] - 5.0 * p[1] + 4.0 * p[2] - p[3]
    turn = 3.0 * (p[1] - p[2]) + p[3] - p[0]
    derivative = 0.5 * (p[2] - p[0] + u * (2.0 * bend + 3.0 * u * turn))
    return derivative.xyz


@ox.device
def linear_tangent(p: tuple[float4, float4]) -> float3:
    """The direction of a straight segment."""
    difference = p[1] - p[0]
    return difference.xyz


@ox.device
def normal_across(point: float3, axis: float3, tangent: float3) -> float3:
    """The unit normal of a round curve at `point` of its surface, perpendicular to the tangent: the widening of the curve is left out."""
    away = point - axis
    along = ox.dot(away, tangent) / ox.dot(tangent, tangent)
    return ox.normalize(away - along * tangent)
