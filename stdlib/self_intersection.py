"""Ray origins that do not hit the surface that they start from."""

import optixc as ox
from optixc import float3

ORIGIN = 0.03125
FLOAT_SCALE = 1.52587890625e-05
INT_SCALE = 256.0


@ox.device
def offset_coordinate(p: float, n: float) -> float:
    """One coordinate of `offset_ray_origin`: a fixed number of units in the last place, or a fixed distance near zero."""
    if abs(p) < ORIGIN:
        return p + FLOAT_SCALE * n
    steps = int(INT_SCALE * n)
    return ox.int_as_float(ox.float_as_int(p) + (-steps if p < 0.0 else steps))


@ox.device
def offset_ray_origin(p: float3, n: float3) -> float3:
    """A point on a triangle moved off it along the unit geometric normal, which points to the side of the new ray. Scales with the
    coordinates, so it needs no scene-dependent epsilon. C. Wächter, N. Binder, "A Fast and Robust Method for Avoiding
    Self-Intersection", Ray Tracing Gems, 2019."""
    return float3(offset_coordinate(p.x, n.x), offset_coordinate(p.y, n.y), offset_coordinate(p.z, n.z))
