"""Warps of the unit square and their densities: disk, hemisphere, sphere, cone, triangle, a sphere seen from outside.

A density is per unit of area (disk, triangle) or per steradian (everything else).
"""

import optixc as ox
from optixc import float2, float3
from optixc.stdlib.frame import frame_from_normal, to_world
from optixc.stdlib.math import INV_PI, PI, safe_sqrt


@ox.device
def uniform_disk(u: float2) -> float2:
    """Concentric map onto the unit disk: keeps strata compact. P. Shirley, K. Chiu, 1997; PBRT 4ed. A.5.1."""
    x = 2.0 * u.x - 1.0
    y = 2.0 * u.y - 1.0
    if x == 0.0 and y == 0.0:
        return float2(0.0)
    if abs(x) > abs(y):
        radius = x
        angle = 0.25 * PI * (y / x)
    else:
        radius = y
        angle = 0.5 * PI - 0.25 * PI * (x / y)
    return float2(radius * ox.cos(angle), radius * ox.sin(angle))


@ox.device
def uniform_disk_pdf() -> float:
    """Density of `uniform_disk` inside the disk."""
    return INV_PI


@ox.device
def cosine_hemisphere(u: float2) -> float3:
    """A direction around z with density cos(theta) / pi. Malley's method; PBRT 4ed. A.5.3."""
    d = uniform_disk(u)
    return float3(d.x, d.y, safe_sqrt(1.0 - d.x * d.x - d.y * d.y))


@ox.device
def cosine_hemisphere_pdf(w: float3) -> float:
    """Density of `cosine_hemisphere`."""
    return ox.max(w.z, 0.0) * INV_PI


@ox.device
def uniform_hemisphere(u: float2) -> float3:
    """A direction around z, all alike. PBRT 4ed. A.5.2."""
    sine = safe_sqrt(1.0 - u.x * u.x)
    angle = 2.0 * PI * u.y
    return float3(sine * ox.cos(angle), sine * ox.sin(angle), u.x)


@ox.device
def uniform_hemisphere_pdf(w: float3) -> float:
    """Density of `uniform_hemisphere`."""
    return 0.5 * INV_PI if w.z >= 0.0 else 0.0


@ox.device
def uniform_sphere(u: float2) -> float3:
    """A direction, all alike. PBRT 4ed. A.5.2."""
    z = 1.0 - 2.0 * u.x
    sine = safe_sqrt(1.0 - z * z)
    angle = 2.0 * PI * u.y
    return float3(sine * ox.cos(angle), sine * ox.sin(angle), z)


@ox.device
def uniform_sphere_pdf() -> float:
    """Density of `uniform_sphere`."""
    return 0.25 * INV_PI


@ox.device
def uniform_cone(u: float2, cos_theta_max: float) -> float3:
    """A direction at most theta_max from z, all alike. PBRT 4ed. A.5.4."""
    z = (1.0 - u.x) + u.x * cos_theta_max
    sine = safe_sqrt(1.0 - z * z)
    angle = 2.0 * PI * u.y
    return float3(sine * ox.cos(angle), sine * ox.sin(angle), z)


@ox.device
def uniform_cone_pdf(cos_theta_max: float) -> float:
    """Density of `uniform_cone` inside the cone."""
    return 0.5 * INV_PI / (1.0 - cos_theta_max)


@ox.device
def uniform_triangle(u: float2) -> float2:
    """Barycentric weights of the second and third corner. E. Heitz, "A Low-Distortion Map Between Triangle and Square", 2019."""
    if u.y > u.x:
        return float2(0.5 * u.x, u.y - 0.5 * u.x)
    return float2(u.x - 0.5 * u.y, 0.5 * u.y)


@ox.device
def uniform_triangle_pdf(p0: float3, p1: float3, p2: float3) -> float:
    """Density of `uniform_triangle` per area of this triangle; 0 for a triangle without area."""
    twice_area = ox.length(ox.cross(p1 - p0, p2 - p0))
    return 2.0 / twice_area if twice_area > 0.0 else 0.0


@ox.device
def cone_of_sphere(center: float3, radius: float, point: float3) -> float:
    """1 - cos(theta_max) of the cone that a sphere fills as seen from a point outside, exact also for far away spheres."""
    away = center - point
    sine_squared = radius * radius / ox.dot(away, away)
    return sine_squared / (1.0 + safe_sqrt(1.0 - sine_squared))


@ox.device
def visible_sphere(center: float3, radius: float, point: float3, u: float2) -> float3:
    """A direction from a point outside towards a sphere, all alike. PBRT 4ed. 6.2.4."""
    one_minus_cosine = u.x * cone_of_sphere(center, radius, point)
    sine = safe_sqrt(one_minus_cosine * (2.0 - one_minus_cosine))
    angle = 2.0 * PI * u.y
    local = float3(sine * ox.cos(angle), sine * ox.sin(angle), 1.0 - one_minus_cosine)
    return to_world(frame_from_normal(ox.normalize(center - point)), local)


@ox.device
def visible_sphere_pdf(center: float3, radius: float, point: float3) -> float:
    """Density of `visible_sphere` inside the cone."""
    return 0.5 * INV_PI / cone_of_sphere(center, radius, point)
