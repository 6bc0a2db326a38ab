"""Traces that nest, two payload classes, and a helper that traces. The depth is counted because it may pass the limit of 3."""

import optixc as ox
from optixc import float3

OPTIONS = {"max_trace_depth": 3}
SHADOW = ox.RayFlags.TERMINATE_ON_FIRST_HIT | ox.RayFlags.DISABLE_CLOSESTHIT | ox.RayFlags.DISABLE_ANYHIT


@ox.struct
class Params:
    image: ox.Array[float3]
    scene: ox.Traversable
    light: float3


@ox.struct
class Mirror:
    tint: float3


@ox.payload
class Radiance:
    color: float3
    depth: ox.int32


@ox.payload
class Light:
    visible: bool


params = ox.launch_params(Params)


@ox.device
def lit(point: float3) -> float:
    light = Light(False)
    ox.trace(params.scene, point, params.light - point, tmin=1e-3, tmax=1.0, ray_flags=SHADOW, miss_sbt_index=1, payload=light)
    return 1.0 if light.visible else 0.0


@ox.program
def __raygen__image():
    i = ox.get_launch_index()
    ray = Radiance(float3(0.0), 0)
    ox.trace(params.scene, float3(float(i.x), 0.0, 0.0), float3(0.0, 0.0, 1.0), payload=ray)
    params.image[i.x] = ray.color


@ox.program
def __closesthit__matte(ray: Radiance):
    point = ox.get_world_ray_origin() + ox.get_ray_tmax() * ox.get_world_ray_direction()
    ray.color = float3(lit(point))


@ox.program
def __closesthit__mirror(ray: Radiance, mirror: Mirror):
    point = ox.get_world_ray_origin() + ox.get_ray_tmax() * ox.get_world_ray_direction()
    deeper = Radiance(float3(0.0), ray.depth + 1)
    ox.trace(params.scene, point, -ox.get_world_ray_direction(), tmin=1e-3, payload=deeper)
    ray.color = mirror.tint * deeper.color


@ox.program
def __miss__black(ray: Radiance):
    ray.color = float3(0.0)


@ox.program
def __miss__visible(light: Light):
    light.visible = True
