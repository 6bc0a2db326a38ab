"""A landscape of instances in the sun: colours that differ from tree to tree by the instance's id, a lake that mirrors, haze far away."""

import optixc as ox
from optixc import float2, float3, float4, uint32
from optixc.stdlib.camera import Pinhole, pinhole_direction
from optixc.stdlib.frame import frame_from_normal, to_world
from optixc.stdlib.fresnel import fresnel_dielectric
from optixc.stdlib.random import hash_uint, pixel_sample_2d, unit_float
from optixc.stdlib.sampling import cosine_hemisphere, uniform_cone
from optixc.stdlib.self_intersection import offset_ray_origin

OPEN_MISS = 1
NOTHING = 0
SOLID = 1
WATER = 2


@ox.struct
class Params:
    """A launch adds path number `sample` of `samples` to each pixel; `haze` is how much of the light each unit of length scatters."""

    image: ox.Array2[float4]
    ray_counts: ox.Array2[uint32]
    scene: ox.Traversable
    camera: Pinhole
    sample: int
    samples: int
    sun_direction: float3
    sun_color: float3
    haze: float


@ox.struct
class Material:
    """A colour, another that instances take a part of, and whether this is water; `slope_color` replaces them where it is steep."""

    color: float3
    other: float3
    slope_color: float3
    is_water: int
    is_ground: int


@ox.payload
class Surface:
    """The first surface along a ray; the unit normal points towards its origin."""

    point: float3
    normal: float3
    albedo: float3
    distance: float
    kind: int


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
    """Warm near the sun, pale near the horizon, blue above."""
    up = ox.max(direction.y, 0.0)
    blue = ox.lerp(float3(0.72, 0.80, 0.90), float3(0.17, 0.35, 0.72), ox.pow(up, 0.5))
    glow = ox.pow(ox.max(ox.dot(direction, params.sun_direction), 0.0), 6.0)
    return blue + glow * float3(0.55, 0.36, 0.16)


@ox.device
def sunlight(surface: Surface, u: float2) -> float3:
    """What reaches a surface from the sun's disc."""
    to_sun = to_world(frame_from_normal(params.sun_direction), uniform_cone(u, 0.99996))
    cosine = ox.dot(surface.normal, to_sun)
    if cosine <= 0.0:
        return float3(0.0)
    opening = Opening(0.0)
    ox.trace(
        params.scene,
        offset_ray_origin(surface.point, surface.normal),
        to_sun,
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
    origin = params.camera.eye
    direction = pinhole_direction(params.camera, screen)
    throughput = float3(1.0)
    color = float3(0.0)
    rays = 0
    for bounce in range(3):
        surface = Surface(float3(0.0), float3(0.0), float3(0.0), 0.0, NOTHING)
        rays += 1
        ox.trace(params.scene, origin, direction, payload=surface)
        if surface.kind == NOTHING:
            color += throughput * sky(direction)
            break

        # What the air between adds and takes
        clear = ox.exp(-params.haze * surface.distance)
        color += (1.0 - clear) * throughput * sky(float3(direction.x, 0.02, direction.z))
        throughput *= clear
        u = numbers(pixel, uint32(2 * bounce + 1))
        if surface.kind == WATER:
            # Small waves; light from below is a dark green
            slope = 0.012 * (u - float2(0.5))
            n = ox.normalize(float3(slope.x, 1.0, slope.y))
            reflected = fresnel_dielectric(ox.min(abs(ox.dot(n, direction)), 1.0), 1.33)
            color += (1.0 - reflected) * throughput * surface.albedo
            throughput *= reflected
            direction = ox.normalize(ox.reflect(direction, n))
            direction.y = ox.max(direction.y, 1e-3)
        else:
            rays += 1
            throughput *= surface.albedo
            color += throughput * sunlight(surface, u)
            scattered = cosine_hemisphere(numbers(pixel, uint32(2 * bounce + 2)))
            direction = to_world(frame_from_normal(surface.normal), scattered)
        origin = offset_ray_origin(surface.point, surface.normal)
    params.image[i.y, i.x] += float4(color, 1.0) / float(params.samples)
    params.ray_counts[i.y, i.x] += uint32(rays)


@ox.program
def __closesthit__surface(surface: Surface, material: Material):
    p0, p1, p2 = ox.get_triangle_vertex_data()
    uv = ox.get_triangle_barycentrics()
    n = ox.normalize(ox.transform_normal_from_object_to_world_space(ox.cross(p1 - p0, p2 - p0)))
    surface.normal = -n if ox.dot(n, ox.get_world_ray_direction()) > 0.0 else n
    surface.point = ox.transform_point_from_object_to_world_space((1.0 - uv.x - uv.y) * p0 + uv.x * p1 + uv.y * p2)
    surface.distance = ox.get_ray_tmax()
    surface.kind = WATER if material.is_water != 0 else SOLID
    word = hash_uint(ox.get_instance_id())
    color = ox.lerp(material.color, material.other, unit_float(word))
    surface.albedo = color * (0.75 + 0.5 * unit_float(hash_uint(word)))
    if material.is_ground != 0:
        surface.albedo = ox.lerp(material.slope_color, material.color, ox.smoothstep(0.75, 0.92, abs(n.y)))


@ox.program
def __miss__open(opening: Opening):
    opening.open = 1.0
