"""The shading of well-known sample programs, in small: each ray generation program is one sample."""

import math

import optixc as ox
from optixc import float3


@ox.struct
class Params:
    image: ox.Array2[float3]
    scene: ox.Traversable
    depth: int
    time: float
    origins: ox.Array[float3]
    distances: ox.Array[float]


@ox.struct
class Surface:
    """Albedo and emission of a surface; `shader` is the record of its callable."""

    albedo: float3
    emission: float3
    shader: ox.uint32


@ox.payload
class Ray:
    color: float3
    throughput: float3
    origin: float3
    direction: float3
    alive: int


@ox.payload
class Shadow:
    """How much of a light arrives: nothing, until the ray misses everything."""

    light: float


@ox.attributes
class SphereHit:
    normal: float3


params = ox.launch_params(Params)

LIGHT = float3(0.0, 0.0, 3.0)
SHADOW_RAY = ox.RayFlags.TERMINATE_ON_FIRST_HIT | ox.RayFlags.DISABLE_CLOSESTHIT


@ox.device
def pixel_origin() -> float3:
    """Parallel rays over the square from -1 to 1, from z = 2 downwards."""
    i, size = ox.get_launch_index(), ox.get_launch_dimensions()
    x = 2.0 * (float(i.x) + 0.5) / float(size.x) - 1.0
    y = 2.0 * (float(i.y) + 0.5) / float(size.y) - 1.0
    return float3(x, y, 2.0)


@ox.device
def store(color: float3):
    i = ox.get_launch_index()
    params.image[i.y, i.x] = color


@ox.device
def visibility(origin: float3, direction: float3, distance: float) -> float:
    """1 if nothing stands within the distance, else 0; rays of type 1."""
    shadow = Shadow(0.0)
    ox.trace(params.scene, origin, direction, tmin=1e-3, tmax=distance, ray_flags=SHADOW_RAY, miss_sbt_index=1, payload=shadow)
    return shadow.light


@ox.device
def new_ray() -> Ray:
    return Ray(float3(0.0), float3(1.0), float3(0.0), float3(0.0), 0)


@ox.program
def __raygen__hello():
    """One colour everywhere."""
    store(float3(0.462, 0.725, 0.0))


@ox.program
def __raygen__orthographic():
    """One ray per pixel; what it brings back is the pixel."""
    ray = new_ray()
    ox.trace(params.scene, pixel_origin(), float3(0.0, 0.0, -1.0), ray_time=params.time, payload=ray)
    store(ray.color)


@ox.program
def __raygen__path():
    """Path tracing by a loop: each hit scatters, leaves emission and goes on with its albedo."""
    ray = new_ray()
    ray.origin = pixel_origin() * float3(0.5, 0.5, 0.0)
    ray.direction = float3(0.0, 0.0, -1.0)
    ray.alive = 1
    light = float3(0.0)
    for _bounce in range(params.depth):
        throughput = ray.throughput
        ray.color = float3(0.0)
        ox.trace(params.scene, ray.origin, ray.direction, tmin=1e-4, payload=ray)
        light += throughput * ray.color
        if ray.alive == 0:
            break
    store(light)


@ox.program
def __raygen__queries():
    """Closest distances for a list of rays, without shading: the ray's tmax comes back, -1 for a miss."""
    i = ox.get_launch_index()
    ray = new_ray()
    ox.trace(params.scene, params.origins[i.x], float3(0.0, 0.0, -1.0), payload=ray)
    params.distances[i.x] = params.origins[i.x].z - ray.origin.z if ray.alive == 1 else -1.0


@ox.program
def __raygen__volume():
    """Absorption between entry and exit of each ray: Beer and Lambert's law over the chord."""
    ray = new_ray()
    origin = pixel_origin()
    ox.trace(params.scene, origin, float3(0.0, 0.0, -1.0), payload=ray)
    if ray.alive == 0:
        store(float3(1.0))
        return
    entry = ray.origin.z
    ox.trace(params.scene, float3(origin.x, origin.y, -2.0), float3(0.0, 0.0, 1.0), payload=ray)
    store(float3(ox.exp(-2.0 * (entry - ray.origin.z))))


@ox.program
def __raygen__ambient():
    """The part of a fan of rays that meets nothing. A pipeline that binds `depth` knows their number when it is compiled."""
    origin = pixel_origin() * float3(1.0, 1.0, 0.0)
    free = 0.0
    for ray in range(params.depth):
        angle = (float(ray) + 0.5) * math.pi / float(params.depth)
        free += visibility(origin, float3(ox.cos(angle), 0.0, ox.sin(angle)), 1e16)
    store(float3(free / float(params.depth)))


@ox.program
def __miss__background(ray: Ray):
    ray.color = float3(0.1, 0.2, 0.3)
    ray.alive = 0


@ox.program
def __miss__dark(ray: Ray):
    ray.alive = 0


@ox.program
def __miss__lit(shadow: Shadow):
    shadow.light = 1.0


@ox.program
def __closesthit__checker(ray: Ray, surface: Surface):
    """A floor of unit squares in two colours under one light; the ambient part stays in its shadow."""
    p = ox.get_world_ray_origin() + ox.get_ray_tmax() * ox.get_world_ray_direction()
    square = int(ox.floor(2.0 * p.x)) + int(ox.floor(2.0 * p.y))
    colour = surface.albedo if square % 2 == 0 else surface.emission
    to_light = LIGHT - p
    distance = ox.length(to_light)
    diffuse = to_light.z / distance * visibility(p, to_light / distance, distance)
    ray.color = colour * (0.25 + 0.75 * diffuse)


@ox.program
def __closesthit__mirror(ray: Ray, surface: Surface):
    """What the reflected ray brings, tinted."""
    d = ox.get_world_ray_direction()
    p = ox.get_world_ray_origin() + ox.get_ray_tmax() * d
    reflected = new_ray()
    ox.trace(params.scene, p, ox.reflect(d, float3(0.0, 0.0, 1.0)), tmin=1e-3, payload=reflected)
    ray.color = surface.albedo * reflected.color


@ox.program
def __closesthit__strand(ray: Ray, surface: Surface):
    """Hair from the colour of its root to that of its tip, along all segments of the strand."""
    along = (float(ox.get_primitive_index()) + ox.get_curve_parameter()) / float(surface.shader)
    ray.color = ox.lerp(surface.albedo, surface.emission, along)


@ox.program
def __closesthit__barycentrics(ray: Ray):
    uv = ox.get_triangle_barycentrics()
    ray.color = float3(uv.x, uv.y, 1.0)


@ox.program
def __anyhit__cutout():
    """A checkerboard in barycentric coordinates lets every other square through."""
    uv = ox.get_triangle_barycentrics()
    if (int(uv.x * 8.0) + int(uv.y * 8.0)) & 1 == 1:
        ox.ignore_intersection()


@ox.program
def __intersection__sphere():
    """The unit sphere around the origin in object space."""
    o, d = ox.get_object_ray_origin(), ox.get_object_ray_direction()
    a, b, c = ox.dot(d, d), ox.dot(o, d), ox.dot(o, o) - 1.0
    root = b * b - a * c
    if root <= 0.0:
        return
    t = (-b - ox.sqrt(root)) / a
    if ox.get_ray_tmin() <= t <= ox.get_ray_tmax():
        ox.report_intersection(t, 0, SphereHit(o + t * d))


@ox.program
def __closesthit__normal(ray: Ray, hit: SphereHit):
    """Normals as colours."""
    ray.color = 0.5 * (hit.normal + 1.0)
    ray.origin = ox.get_world_ray_origin() + ox.get_ray_tmax() * ox.get_world_ray_direction()
    ray.alive = 1


@ox.program
def __direct_callable__normal_shading(n: float3, albedo: float3) -> float3:
    return 0.5 * (n + 1.0) * albedo


@ox.program
def __direct_callable__phong(n: float3, albedo: float3) -> float3:
    return albedo * ox.max(0.0, n.z) + 0.25 * ox.pow(ox.max(0.0, n.z), 16.0)


@ox.program
def __closesthit__callable(ray: Ray, surface: Surface, hit: SphereHit):
    """The record's callable shades."""
    ray.color = ox.direct_call(surface.shader, ox.normalize(hit.normal), surface.albedo, result=float3)


@ox.program
def __closesthit__glow(ray: Ray, surface: Surface):
    """A wall that glows and reflects straight back: light is the geometric series of its albedo."""
    ray.color = surface.emission
    ray.throughput *= surface.albedo
    ray.origin = ox.get_world_ray_origin() + ox.get_ray_tmax() * ox.get_world_ray_direction()
    ray.direction = -ox.get_world_ray_direction()
    ray.alive = 1
