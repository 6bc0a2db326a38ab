"""Lights: what a point receives, and how to draw a point of a light that has an extent.

`to_light` is the unit direction from the shaded point. Shadows are the caller's.
"""

import optixc as ox
from optixc import float2, float3
from optixc.stdlib.sampling import uniform_triangle, visible_sphere, visible_sphere_pdf


@ox.struct
class LightSample:
    """A direction towards a light: `radiance` arrives from there, `pdf` is per steradian, or 0 for a light without extent, whose
    `radiance` is an irradiance."""

    to_light: float3
    distance: float
    radiance: float3
    pdf: float


@ox.struct
class PointLight:
    """Intensity is power per steradian."""

    position: float3
    intensity: float3


@ox.struct
class SpotLight:
    """A point light within a cone: full inside `cos_inner`, nothing outside `cos_outer`."""

    position: float3
    axis: float3
    intensity: float3
    cos_inner: float
    cos_outer: float


@ox.struct
class RectangleLight:
    """Emits on the side of cross(edge_u, edge_v); the edges are full lengths."""

    corner: float3
    edge_u: float3
    edge_v: float3
    radiance: float3


@ox.struct
class SphereLight:
    """Emits outwards from its surface."""

    center: float3
    radius: float
    radiance: float3


@ox.device
def point_light(light: PointLight, point: float3) -> LightSample:
    """PBRT 4ed. 12.1."""
    away = light.position - point
    distance = ox.length(away)
    return LightSample(away / distance, distance, light.intensity / (distance * distance), 0.0)


@ox.device
def spot_light(light: SpotLight, point: float3) -> LightSample:
    """With a smooth edge. PBRT 4ed. 12.1.1."""
    away = light.position - point
    distance = ox.length(away)
    to_light = away / distance
    edge = ox.smoothstep(light.cos_outer, light.cos_inner, -ox.dot(to_light, light.axis))
    return LightSample(to_light, distance, light.intensity * (edge / (distance * distance)), 0.0)


@ox.device
def area_to_solid_angle(pdf: float, distance: float, cosine: float) -> float:
    """A density per area as one per steradian, seen from a distance at an angle; 0 from behind or edge-on. PBRT 4ed. 4.2.3."""
    return pdf * distance * distance / cosine if cosine > 0.0 else 0.0


@ox.device
def rectangle_light(light: RectangleLight, point: float3, u: float2) -> LightSample:
    """A point of the rectangle, uniform by area."""
    away = light.corner + u.x * light.edge_u + u.y * light.edge_v - point
    distance = ox.length(away)
    to_light = away / distance
    across = ox.cross(light.edge_u, light.edge_v)
    area = ox.length(across)
    pdf = area_to_solid_angle(1.0 / area, distance, -ox.dot(to_light, across) / area)
    return LightSample(to_light, distance, light.radiance if pdf > 0.0 else float3(0.0), pdf)


@ox.device
def rectangle_light_pdf(light: RectangleLight, point: float3, to_light: float3) -> float:
    """Density of `rectangle_light` for a direction, 0 where it misses the light or comes from behind."""
    across = ox.cross(light.edge_u, light.edge_v)
    area = ox.length(across)
    facing = -ox.dot(to_light, across) / area
    if facing <= 0.0:
        return 0.0
    away = light.corner - point
    distance = ox.dot(away, across) / ox.dot(to_light, across)
    if distance <= 0.0:
        return 0.0
    inside = distance * to_light - away
    a = ox.dot(ox.cross(inside, light.edge_v), across) / (area * area)
    b = ox.dot(ox.cross(light.edge_u, inside), across) / (area * area)
    if a < 0.0 or a > 1.0 or b < 0.0 or b > 1.0:
        return 0.0
    return area_to_solid_angle(1.0 / area, distance, facing)


@ox.device
def sphere_light(light: SphereLight, point: float3, u: float2) -> LightSample:
    """A direction into the cone that the sphere fills, from a point outside of it. PBRT 4ed. 6.2.4."""
    to_light = visible_sphere(light.center, light.radius, point, u)
    away = light.center - point
    along = ox.dot(away, to_light)
    aside = away - along * to_light
    half_chord = ox.sqrt(ox.max(light.radius * light.radius - ox.dot(aside, aside), 0.0))
    return LightSample(to_light, along - half_chord, light.radiance, visible_sphere_pdf(light.center, light.radius, point))


@ox.device
def triangle_light(p0: float3, p1: float3, p2: float3, radiance: float3, point: float3, u: float2) -> LightSample:
    """A point of a triangle that emits on its front (counter-clockwise) side, uniform by area."""
    uv = uniform_triangle(u)
    away = (1.0 - uv.x - uv.y) * p0 + uv.x * p1 + uv.y * p2 - point
    distance = ox.length(away)
    to_light = away / distance
    across = ox.cross(p1 - p0, p2 - p0)
    twice_area = ox.length(across)
    pdf = area_to_solid_angle(2.0 / twice_area, distance, -ox.dot(to_light, across) / twice_area)
    return LightSample(to_light, distance, radiance if pdf > 0.0 else float3(0.0), pdf)
