"""Whitted's ray tracer over custom primitives: spheres of glass, metal and paint above a checkered floor, one point light.

Shadow rays are a second ray type: glass attenuates them in an any-hit program, everything else ends them.
"""

from camera import Camera, camera_direction, pixel_of

import optixc as ox
from optixc import float3, float4

RAY_TYPES = 2
DEPTH = 6
FAINTEST = 0.02


@ox.struct
class Params:
    image: ox.Array2[float4]
    scene: ox.Traversable
    camera: Camera
    spheres: ox.Array[float4]
    floor_size: float
    light: float3
    sky: float3
    offset: float


@ox.struct
class Material:
    color: float3


@ox.payload
class Radiance:
    color: float3
    importance: float
    depth: int


@ox.payload
class Shadow:
    attenuation: float


@ox.attributes
class Surface:
    n: float3


params = ox.launch_params(Params)


@ox.program
def __raygen__whitted():
    index = ox.get_launch_index()
    direction = camera_direction(params.camera, pixel_of(params.camera, index))
    params.image[index.y, index.x] = float4(radiance(params.camera.eye, direction, 1.0, 0), 1.0)


@ox.device
def radiance(origin: float3, direction: float3, importance: float, depth: int) -> float3:
    """What comes along a ray."""
    ray = Radiance(float3(0.0), importance, depth)
    ox.trace(
        params.scene,
        origin,
        direction,
        tmin=0.0,
        tmax=1e16,
        ray_flags=ox.RayFlags.DISABLE_ANYHIT,
        sbt_stride=RAY_TYPES,
        payload=ray,
    )
    return ray.color


@ox.device
def direct_light(point: float3, n: float3) -> float:
    """The light at `point`: cosine times the share that glass lets through."""
    to_light = params.light - point
    distance = ox.length(to_light)
    wi = to_light * (1.0 / distance)
    cosine = ox.dot(n, wi)
    if cosine <= 0.0:
        return 0.0
    shadow = Shadow(1.0)
    ox.trace(
        params.scene,
        point + params.offset * n,
        wi,
        tmin=0.0,
        tmax=distance,
        ray_flags=ox.RayFlags.TERMINATE_ON_FIRST_HIT | ox.RayFlags.DISABLE_CLOSESTHIT,
        sbt_offset=1,
        sbt_stride=RAY_TYPES,
        miss_sbt_index=1,
        payload=shadow,
    )
    return cosine * shadow.attenuation


@ox.device
def hit_point() -> float3:
    return ox.get_world_ray_origin() + ox.get_ray_tmax() * ox.get_world_ray_direction()


@ox.program
def __intersection__sphere():
    sphere = params.spheres[ox.get_primitive_index()]
    origin = ox.get_object_ray_origin() - sphere.xyz
    direction = ox.get_object_ray_direction()
    b = ox.dot(origin, direction)
    # the part of `origin` that is perpendicular to the ray keeps its precision far from the sphere
    perpendicular = origin - b * direction
    discriminant = sphere.w * sphere.w - ox.dot(perpendicular, perpendicular)
    if discriminant > 0.0:
        root = ox.sqrt(discriminant)
        t = -b - root
        if t < ox.get_ray_tmin():
            t = -b + root
        ox.report_intersection(t, 0, Surface((origin + t * direction) * (1.0 / sphere.w)))


@ox.program
def __intersection__floor():
    origin = ox.get_object_ray_origin()
    direction = ox.get_object_ray_direction()
    t = -origin.y / direction.y
    x = origin.x + t * direction.x
    z = origin.z + t * direction.z
    if abs(x) < params.floor_size and abs(z) < params.floor_size:
        ox.report_intersection(t, 0, Surface(float3(0.0, 1.0, 0.0)))


@ox.program
def __closesthit__paint(ray: Radiance, surface: Surface, material: Material):
    light = direct_light(hit_point(), surface.n)
    ray.color = material.color * (0.2 + 0.8 * light)


@ox.program
def __closesthit__checker(ray: Radiance, surface: Surface, material: Material):
    point = hit_point()
    odd = (int(ox.floor(point.x)) + int(ox.floor(point.z))) & 1
    shade = 0.35 if odd == 1 else 1.0
    light = direct_light(point, surface.n)
    ray.color = material.color * (shade * (0.2 + 0.8 * light))


@ox.program
def __closesthit__metal(ray: Radiance, surface: Surface, material: Material):
    point = hit_point()
    direction = ox.get_world_ray_direction()
    n = surface.n
    color = material.color * (0.1 + 0.2 * direct_light(point, n))
    importance = 0.7 * ray.importance
    if ray.depth < DEPTH and importance > FAINTEST:
        color += 0.7 * material.color * radiance(point + params.offset * n, ox.reflect(direction, n), importance, ray.depth + 1)
    ray.color = color


@ox.program
def __closesthit__glass(ray: Radiance, surface: Surface, material: Material):
    point = hit_point()
    direction = ox.get_world_ray_direction()
    outward = surface.n
    cosine = -ox.dot(outward, direction)
    entering = cosine > 0.0
    n = outward if entering else -outward
    cosine = abs(cosine)
    eta = 1.0 / 1.5 if entering else 1.5
    # Snell, then Schlick's form of Fresnel's reflectance
    k = 1.0 - eta * eta * (1.0 - cosine * cosine)
    reflectance = 1.0
    color = float3(0.0)
    if k > 0.0:
        cosine_t = ox.sqrt(k)
        m = 1.0 - (cosine if entering else cosine_t)
        reflectance = 0.04 + 0.96 * (m * m * (m * m) * m)
        importance = (1.0 - reflectance) * ray.importance
        if ray.depth < DEPTH and importance > FAINTEST:
            refracted = eta * direction + (eta * cosine - cosine_t) * n
            passed = radiance(point - params.offset * n, refracted, importance, ray.depth + 1)
            color += (1.0 - reflectance) * material.color * passed
    importance = reflectance * ray.importance
    if ray.depth < DEPTH and importance > FAINTEST:
        color += reflectance * radiance(point + params.offset * n, direction + 2.0 * cosine * n, importance, ray.depth + 1)
    ray.color = color


@ox.program
def __anyhit__glass_shadow(shadow: Shadow):
    shadow.attenuation *= 0.8
    ox.ignore_intersection()


@ox.program
def __anyhit__opaque_shadow(shadow: Shadow):
    shadow.attenuation = 0.0
    ox.terminate_ray()


@ox.program
def __miss__sky(ray: Radiance):
    t = 0.5 * ox.get_world_ray_direction().y + 0.5
    ray.color = (1.0 - t) * float3(1.0) + t * params.sky


@ox.program
def __miss__lit(shadow: Shadow):
    pass
