"""A diffuse path tracer with next event estimation towards one rectangular light, and the same with heavy shading.

Depth 8, Russian roulette from the fourth bounce on. `__closesthit__matte` is the light form; `__closesthit__principled` evaluates
20 octaves of noise (colour, roughness and a bumped normal) and the principled BRDF twice at every hit.
"""

from camera import Camera, camera_direction, pixel_of
from noise import octaves
from principled import Principled, principled
from sampling import Random, cosine_about, facing, pcg_hash, random_float, random_float2

import optixc as ox
from optixc import float3, float4

DEPTH = 8
ROULETTE_FROM = 3


@ox.struct
class Light:
    """A parallelogram that emits `radiance` to the side of its unit normal `n`."""

    corner: float3
    edge_u: float3
    edge_v: float3
    n: float3
    radiance: float3
    area: float


@ox.struct
class Params:
    image: ox.Array2[float4]
    scene: ox.Traversable
    camera: Camera
    light: Light
    sky: float3
    width: ox.uint32
    offset: float
    noise_scale: float


@ox.struct
class Matte:
    albedo: float3


@ox.payload
class Path:
    """In: `random`, `bounce`. Out: radiance found at the hit, and where and with what weight the path goes on, unless it ended."""

    radiance: float3
    weight: float3
    origin: float3
    direction: float3
    random: ox.uint32
    bounce: int
    ended: bool


@ox.payload
class Visibility:
    value: float


params = ox.launch_params(Params)


@ox.program
def __raygen__path():
    index = ox.get_launch_index()
    pixel = pixel_of(params.camera, index)
    color = float3(0.0)
    throughput = float3(1.0)
    path = Path(
        radiance=float3(0.0),
        weight=float3(0.0),
        origin=params.camera.eye,
        direction=camera_direction(params.camera, pixel),
        random=pcg_hash(pixel.y * params.width + pixel.x),
        bounce=0,
        ended=False,
    )
    for bounce in range(DEPTH):
        path.bounce = bounce
        ox.trace(
            params.scene, path.origin, path.direction, tmin=0.0, tmax=1e16, ray_flags=ox.RayFlags.DISABLE_ANYHIT, payload=path
        )
        color += throughput * path.radiance
        if path.ended:
            break
        throughput *= path.weight
        if bounce >= ROULETTE_FROM:
            survival = ox.min(ox.max(throughput.x, ox.max(throughput.y, throughput.z)), 0.95)
            random = Random(path.random)
            if random_float(random) >= survival:
                break
            path.random = random.state
            throughput *= 1.0 / survival
    params.image[index.y, index.x] = float4(color, 1.0)


@ox.device
def direct_light(origin: float3, n: float3, target: float3) -> tuple[float3, float3]:
    """The direction to `target` on the light, and the light's radiance over density, times the cosine at `n`; zero in shadow."""
    to_light = target - origin
    distance2 = ox.dot(to_light, to_light)
    distance = ox.sqrt(distance2)
    wi = to_light * (1.0 / distance)
    cosine = ox.dot(n, wi)
    cosine_light = -ox.dot(params.light.n, wi)
    incoming = float3(0.0)
    if cosine > 0.0 and cosine_light > 0.0:
        visibility = Visibility(0.0)
        ox.trace(
            params.scene,
            origin,
            wi,
            tmin=0.0,
            tmax=0.999 * distance,
            ray_flags=ox.RayFlags.TERMINATE_ON_FIRST_HIT | ox.RayFlags.DISABLE_CLOSESTHIT | ox.RayFlags.DISABLE_ANYHIT,
            miss_sbt_index=1,
            payload=visibility,
        )
        incoming = (visibility.value * cosine * cosine_light * params.light.area / distance2) * params.light.radiance
    return wi, incoming


@ox.device
def light_point(random: Random) -> float3:
    u = random_float2(random)
    return params.light.corner + u.x * params.light.edge_u + u.y * params.light.edge_v


@ox.device
def geometric_normal(direction: float3) -> float3:
    """The unit normal of the triangle that was hit, on the side of the ray."""
    return facing(ox.normalize(ox.get_geometric_normal()), direction)


@ox.program
def __closesthit__matte(path: Path, material: Matte):
    direction = ox.get_world_ray_direction()
    n = geometric_normal(direction)
    origin = ox.get_world_ray_origin() + ox.get_ray_tmax() * direction + params.offset * n
    random = Random(path.random)
    _, incoming = direct_light(origin, n, light_point(random))
    path.radiance = 0.318309886 * material.albedo * incoming
    path.weight = material.albedo
    path.origin = origin
    path.direction = cosine_about(n, random_float2(random))
    path.random = random.state


@ox.program
def __closesthit__principled(path: Path, material: Principled):
    direction = ox.get_world_ray_direction()
    n = geometric_normal(direction)
    point = ox.get_world_ray_origin() + ox.get_ray_tmax() * direction
    origin = point + params.offset * n
    # 20 octaves of noise: 4 + 4 for the surface, 3 x 4 for the slopes of the bumps
    q = params.noise_scale * point
    color = material.color * (0.7 + 0.3 * octaves(q, 4))
    roughness = ox.clamp(material.roughness + 0.2 * octaves(q + float3(17.0), 4), 0.05, 1.0)
    slopes = float3(octaves(q + float3(31.0), 4), octaves(q + float3(47.0), 4), octaves(q + float3(61.0), 4))
    bumped = ox.normalize(n + 0.2 * slopes)
    random = Random(path.random)
    wo = -direction
    wi, incoming = direct_light(origin, bumped, light_point(random))
    path.radiance = principled(material, color, roughness, bumped, wo, wi) * incoming
    path.direction = cosine_about(n, random_float2(random))
    # density cos(n, w) / pi, the estimator's cosine is that of the bumped normal
    cosine = ox.dot(n, path.direction)
    if cosine <= 0.0:
        path.ended = True
    else:
        value = principled(material, color, roughness, bumped, wo, path.direction)
        path.weight = (3.141592654 * ox.max(ox.dot(bumped, path.direction), 0.0) / cosine) * value
    path.origin = origin
    path.random = random.state


@ox.program
def __closesthit__light(path: Path):
    faces = ox.dot(params.light.n, ox.get_world_ray_direction()) < 0.0
    path.radiance = params.light.radiance if path.bounce == 0 and faces else float3(0.0)
    path.ended = True


@ox.program
def __miss__sky(path: Path):
    path.radiance = params.sky
    path.ended = True


@ox.program
def __miss__visible(visibility: Visibility):
    visibility.value = 1.0
