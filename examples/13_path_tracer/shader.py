"""A path tracer: next event estimation with multiple importance sampling, a principled material, progressive accumulation, tone mapping.

`traverse` finds the hit, `invoke` shades it. In between, the hit object tells whether the path ends here: paths that left the scene, met
the lamp or lost at Russian roulette are never shaded. Shadow rays only traverse, so they need no records.
"""

from enum import IntEnum

import optixc as ox
from optixc import float2, float3, float4, uint32
from optixc.stdlib.camera import ThinLens, thin_lens_ray
from optixc.stdlib.environment import EnvironmentMap, environment_pdf, environment_radiance, environment_sample
from optixc.stdlib.frame import frame_from_normal, to_local, to_world
from optixc.stdlib.light import RectangleLight, rectangle_light, rectangle_light_pdf
from optixc.stdlib.math import max_component, power_heuristic
from optixc.stdlib.principled import Principled, principled_eval, principled_pdf, principled_sample
from optixc.stdlib.random import hash_uint, sobol_owen_2d
from optixc.stdlib.self_intersection import offset_ray_origin
from optixc.stdlib.tone_mapping import expose, filmic

LAMP_INSTANCE = 1
ROULETTE_FROM = 3


class Draw(IntEnum):
    """What random points are for; each bounce has points of its own for each."""

    PIXEL = 0
    LENS = 1
    LAMP = 2
    SKY = 3
    LOBE = 4
    CHOICE = 5
    COUNT = 6


@ox.struct
class Params:
    """A launch of the path tracer adds sample number `sample` of each pixel to `sums`; `develop` writes their mean to `image`.

    Light of a path over several surfaces is at most `max_indirect`: what is brighter would be a speckle.
    """

    sums: ox.Array2[float4]
    image: ox.Array2[float4]
    ray_counts: ox.Array2[uint32]
    scene: ox.Traversable
    camera: ThinLens
    lamp: RectangleLight
    sky: EnvironmentMap
    sample: int
    max_bounces: int
    max_indirect: float
    exposure: float


@ox.struct
class Part:
    """A mesh of one material."""

    indices: ox.Array2[uint32]
    normals: ox.Array[float3]
    material: Principled


@ox.payload
class Shading:
    """What closest-hit programs tell of a surface: written there, read by the path."""

    point: float3 = ox.payload_word(caller="r", ch="w")
    geometric_normal: float3 = ox.payload_word(caller="r", ch="w")
    normal: float3 = ox.payload_word(caller="r", ch="w")
    base_color: float3 = ox.payload_word(caller="r", ch="w")
    metallic: float = ox.payload_word(caller="r", ch="w")
    roughness: float = ox.payload_word(caller="r", ch="w")
    specular: float = ox.payload_word(caller="r", ch="w")
    coat: float = ox.payload_word(caller="r", ch="w")
    coat_roughness: float = ox.payload_word(caller="r", ch="w")


params = ox.launch_params(Params)


@ox.device
def draw(pixel: uint32, bounce: int, purpose: Draw) -> float2:
    """A point of the unit square for this sample."""
    return sobol_owen_2d(uint32(params.sample), hash_uint(pixel + hash_uint(uint32(bounce * Draw.COUNT + purpose))))


@ox.device
def is_clear(origin: float3, direction: float3, distance: float) -> bool:
    """Whether nothing stands in the way. Nothing is invoked: the hit object tells."""
    ox.traverse(params.scene, origin, direction, tmax=distance, ray_flags=ox.RayFlags.TERMINATE_ON_FIRST_HIT)
    return not ox.hit_object_is_hit()


@ox.device
def direct_light(material: Principled, wo: float3, surface: Shading, pixel: uint32, bounce: int) -> float3:
    """One point of the lamp and one direction of the sky, each weighted against finding it by the material's own directions."""
    frame = frame_from_normal(surface.normal)
    result = float3(0.0)

    lamp = rectangle_light(params.lamp, surface.point, draw(pixel, bounce, Draw.LAMP))
    wi = to_local(frame, lamp.to_light)
    if lamp.pdf > 0.0 and wi.z > 0.0 and ox.dot(lamp.to_light, surface.geometric_normal) > 0.0:
        weight = power_heuristic(lamp.pdf, principled_pdf(material, wo, wi)) * wi.z / lamp.pdf
        origin = offset_ray_origin(surface.point, surface.geometric_normal)
        if is_clear(origin, lamp.to_light, 0.999 * lamp.distance):
            result += principled_eval(material, wo, wi) * lamp.radiance * weight

    sky = environment_sample(params.sky, draw(pixel, bounce, Draw.SKY))
    wi = to_local(frame, sky.to_light)
    if sky.pdf > 0.0 and wi.z > 0.0 and ox.dot(sky.to_light, surface.geometric_normal) > 0.0:
        weight = power_heuristic(sky.pdf, principled_pdf(material, wo, wi)) * wi.z / sky.pdf
        origin = offset_ray_origin(surface.point, surface.geometric_normal)
        if is_clear(origin, sky.to_light, 1e16):
            result += principled_eval(material, wo, wi) * sky.radiance * weight
    return result


@ox.device
def light_here(origin: float3, direction: float3, lobe_pdf: float) -> tuple[float3, bool]:
    """What the outgoing hit object shines, and whether the path ends there; `lobe_pdf` is the density of the material's direction, or 0
    for a camera ray."""
    if ox.hit_object_is_miss():
        weight = 1.0 if lobe_pdf <= 0.0 else power_heuristic(lobe_pdf, environment_pdf(params.sky, direction))
        return environment_radiance(params.sky, direction) * weight, True
    if ox.hit_object_get_instance_id() != LAMP_INSTANCE:
        return float3(0.0), False
    lamp_pdf = rectangle_light_pdf(params.lamp, origin, direction)
    if lamp_pdf <= 0.0:
        return float3(0.0), True
    return params.lamp.radiance * (1.0 if lobe_pdf <= 0.0 else power_heuristic(lobe_pdf, lamp_pdf)), True


@ox.program
def __raygen__path():
    i, size = ox.get_launch_index(), ox.get_launch_dimensions()
    pixel = hash_uint(i.y * size.x + i.x)
    jitter = draw(pixel, 0, Draw.PIXEL)
    screen = float2((float(i.x) + jitter.x) / float(size.x), (float(i.y) + jitter.y) / float(size.y))
    origin, direction = thin_lens_ray(params.camera, screen, draw(pixel, 0, Draw.LENS))
    direct, indirect = float3(0.0), float3(0.0)
    throughput = float3(1.0)
    lobe_pdf = 0.0
    rays = 0
    for bounce in range(params.max_bounces + 1):
        ox.traverse(params.scene, origin, direction)
        rays += 1
        light, ends = light_here(origin, direction, lobe_pdf)
        found = throughput * light

        # Paths that end here are not shaded
        if not ends and bounce >= ROULETTE_FROM:
            survival = ox.min(0.95, max_component(throughput))
            ends = draw(pixel, bounce, Draw.CHOICE).y >= survival
            throughput /= survival
        if ends or bounce == params.max_bounces:
            direct, indirect = collected(direct, indirect, found, bounce)
            break
        ox.reorder()
        surface = Shading(origin, direction, direction, float3(0.0), 0.0, 0.0, 0.0, 0.0, 0.0)
        ox.invoke(payload=surface)

        # Light from here, then the next direction
        material = Principled(
            surface.base_color, surface.metallic, surface.roughness, surface.specular, 0.0, surface.coat, surface.coat_roughness
        )
        frame = frame_from_normal(surface.normal)
        wo = to_local(frame, -direction)
        found += throughput * direct_light(material, wo, surface, pixel, bounce)
        rays += 2
        direct, indirect = collected(direct, indirect, found, bounce)
        lobe = draw(pixel, bounce, Draw.LOBE)
        sample = principled_sample(material, wo, float3(lobe.x, lobe.y, draw(pixel, bounce, Draw.CHOICE).x))
        direction = to_world(frame, sample.wi)
        throughput *= sample.weight
        if max_component(throughput) <= 0.0 or ox.dot(direction, surface.geometric_normal) <= 0.0:
            break
        origin = offset_ray_origin(surface.point, surface.geometric_normal)
        lobe_pdf = sample.pdf
    indirect *= ox.min(1.0, params.max_indirect / ox.max(max_component(indirect), 1e-6))
    params.sums[i.y, i.x] += float4(direct + indirect, 1.0)
    params.ray_counts[i.y, i.x] += uint32(rays)


@ox.device
def collected(direct: float3, indirect: float3, found: float3, bounce: int) -> tuple[float3, float3]:
    """Adds light to what comes over at most one surface, or to the rest."""
    return (direct + found, indirect) if bounce < 2 else (direct, indirect + found)


@ox.program
def __closesthit__part(surface: Shading, part: Part):
    triangle = ox.get_primitive_index()
    uv = ox.get_triangle_barycentrics()
    p0, p1, p2 = ox.get_triangle_vertex_data()
    d = ox.get_world_ray_direction()
    n = ox.normalize(ox.transform_normal_from_object_to_world_space(ox.cross(p1 - p0, p2 - p0)))
    n = -n if ox.dot(n, d) > 0.0 else n
    n0 = part.normals[part.indices[triangle, 0]]
    n1 = part.normals[part.indices[triangle, 1]]
    n2 = part.normals[part.indices[triangle, 2]]
    smooth = ox.normalize(ox.transform_normal_from_object_to_world_space((1.0 - uv.x - uv.y) * n0 + uv.x * n1 + uv.y * n2))
    smooth = -smooth if ox.dot(smooth, n) < 0.0 else smooth

    # A smooth normal that faces away would be black: it is turned until it is seen
    facing = ox.dot(smooth, d)
    if facing > -0.01:
        smooth = ox.normalize(smooth - (facing + 0.01) * d)
    surface.point = ox.transform_point_from_object_to_world_space((1.0 - uv.x - uv.y) * p0 + uv.x * p1 + uv.y * p2)
    surface.geometric_normal = n
    surface.normal = smooth
    surface.base_color = part.material.base_color
    surface.metallic = part.material.metallic
    surface.roughness = part.material.roughness
    surface.specular = part.material.specular
    surface.coat = part.material.coat
    surface.coat_roughness = part.material.coat_roughness


@ox.program
def __raygen__develop():
    """From sums of light to a picture in [0, 1], still linear."""
    i = ox.get_launch_index()
    total = params.sums[i.y, i.x]
    color = total.xyz / ox.max(total.w, 1.0)
    params.image[i.y, i.x] = float4(filmic(expose(color, params.exposure)), 1.0)
