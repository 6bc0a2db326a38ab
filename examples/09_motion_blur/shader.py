"""Paths through a scene that moves while the shutter is open: every path has a time of its own, and all of its rays go at that time.

Closest-hit programs bring back the surface as it is at that time; the ray generation program shades and goes on.
"""

import optixc as ox
from optixc import float2, float3, float4, uint32
from optixc.stdlib.camera import Pinhole, pinhole_direction
from optixc.stdlib.frame import frame_from_normal, to_world
from optixc.stdlib.math import PI, safe_acos
from optixc.stdlib.random import pixel_sample_2d
from optixc.stdlib.sampling import cosine_hemisphere, uniform_cone
from optixc.stdlib.self_intersection import offset_ray_origin

OPEN_MISS = 1
PLAIN = 0
GORES = 1
LAWN = 2
BANDS = 3


@ox.struct
class Params:
    """A launch adds path number `sample` of `samples` to each pixel; the shutter is open for times 0 to `shutter`."""

    image: ox.Array2[float4]
    ray_counts: ox.Array2[uint32]
    scene: ox.Traversable
    camera: Pinhole
    sample: int
    samples: int
    shutter: float
    sun_direction: float3
    sun_color: float3
    sun_cosine: float


@ox.struct
class Paint:
    """Two colours in a pattern: the gores of a ball by object space, a lawn by world space, bands by the number of the triangle."""

    color: float3
    other: float3
    pattern: int
    bands: uint32


@ox.payload
class Surface:
    """The first surface along a ray at the ray's time; the unit normal points towards the origin of the ray."""

    point: float3
    normal: float3
    albedo: float3
    hit: int


@ox.payload
class Opening:
    """1 where a ray to the sun got through."""

    open: float


params = ox.launch_params(Params)


@ox.device
def numbers(pixel: uint32, dimension: uint32) -> float2:
    """Two numbers of this sample for one purpose."""
    return pixel_sample_2d(uint32(params.sample), pixel, dimension)


@ox.device
def sky(direction: float3) -> float3:
    """White near the horizon, blue above."""
    up = ox.max(direction.y, 0.0)
    return ox.lerp(float3(0.86, 0.93, 1.0), float3(0.20, 0.42, 0.86), ox.pow(up, 0.55))


@ox.device
def sunlight(surface: Surface, u: float2, time: float) -> float3:
    """What reaches a surface from the sun's disc."""
    to_sun = to_world(frame_from_normal(params.sun_direction), uniform_cone(u, params.sun_cosine))
    cosine = ox.dot(surface.normal, to_sun)
    if cosine <= 0.0:
        return float3(0.0)
    opening = Opening(0.0)
    ox.trace(
        params.scene,
        offset_ray_origin(surface.point, surface.normal),
        to_sun,
        ray_time=time,
        ray_flags=ox.RayFlags.TERMINATE_ON_FIRST_HIT | ox.RayFlags.DISABLE_CLOSESTHIT,
        miss_sbt_index=OPEN_MISS,
        payload=opening,
    )
    return cosine * opening.open * params.sun_color


@ox.program
def __raygen__paths():
    i, size = ox.get_launch_index(), ox.get_launch_dimensions()
    pixel = i.y * size.x + i.x
    jitter = numbers(pixel, uint32(0))
    screen = float2((float(i.x) + jitter.x) / float(size.x), (float(i.y) + jitter.y) / float(size.y))
    time = params.shutter * numbers(pixel, uint32(1)).x
    origin = params.camera.eye
    direction = pinhole_direction(params.camera, screen)
    throughput = float3(1.0)
    color = float3(0.0)
    rays = 0
    for bounce in range(4):
        surface = Surface(float3(0.0), float3(0.0), float3(0.0), 0)
        rays += 1
        ox.trace(params.scene, origin, direction, ray_time=time, payload=surface)
        if surface.hit == 0:
            color += throughput * sky(direction)
            break
        throughput *= surface.albedo
        rays += 1
        color += throughput * sunlight(surface, numbers(pixel, uint32(2 * bounce + 2)), time)
        scattered = cosine_hemisphere(numbers(pixel, uint32(2 * bounce + 3)))
        direction = to_world(frame_from_normal(surface.normal), scattered)
        origin = offset_ray_origin(surface.point, surface.normal)
    params.image[i.y, i.x] += float4(color, 1.0) / float(params.samples)
    params.ray_counts[i.y, i.x] += uint32(rays)


@ox.device
def painted(paint: Paint, local: float3, world: float3) -> float3:
    """The colour at a point, given in object and in world space."""
    if paint.pattern == GORES:
        longitude = ox.atan2(local.x, local.z) / PI
        pole = safe_acos(abs(local.y) / ox.length(local))
        return paint.color if int(ox.floor(3.0 * longitude)) % 2 == 0 and pole > 0.25 else paint.other
    if paint.pattern == LAWN:
        mown = ox.smoothstep(-0.15, 0.15, ox.sin(2.1 * (world.x + 0.6 * world.z)))
        return ox.lerp(paint.color, paint.other, mown)
    if paint.pattern == BANDS:
        return paint.color if (ox.get_primitive_index() // paint.bands) % 2 == 0 else paint.other
    return paint.color


@ox.device
def bring_back(surface: Surface, paint: Paint, local: float3, local_normal: float3):
    """Fills the payload from a point and a normal in object space; the transforms are those at the ray's time."""
    n = ox.normalize(ox.transform_normal_from_object_to_world_space(local_normal))
    surface.point = ox.transform_point_from_object_to_world_space(local)
    surface.normal = -n if ox.dot(n, ox.get_world_ray_direction()) > 0.0 else n
    surface.albedo = painted(paint, local, surface.point)
    surface.hit = 1


@ox.program
def __closesthit__triangles(surface: Surface, paint: Paint):
    p0, p1, p2 = ox.get_triangle_vertex_data()
    uv = ox.get_triangle_barycentrics()
    bring_back(surface, paint, (1.0 - uv.x - uv.y) * p0 + uv.x * p1 + uv.y * p2, ox.cross(p1 - p0, p2 - p0))


@ox.program
def __closesthit__ball(surface: Surface, paint: Paint):
    sphere = ox.get_sphere_data()
    hit = ox.get_world_ray_origin() + ox.get_ray_tmax() * ox.get_world_ray_direction()
    out = ox.normalize(ox.transform_point_from_world_to_object_space(hit) - sphere.xyz)
    bring_back(surface, paint, sphere.xyz + sphere.w * out, out)


@ox.program
def __miss__open(opening: Opening):
    opening.open = 1.0
