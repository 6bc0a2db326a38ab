"""A trace cut in two: traverse, a look at the hit object, invoke."""

import optixc as ox
from optixc import float3


@ox.struct
class Params:
    seen: ox.Array[float3]
    scene: ox.Traversable


@ox.payload
class Radiance:
    color: float3


params = ox.launch_params(Params)


@ox.device
def is_near() -> bool:
    return ox.hit_object_is_hit() and ox.hit_object_get_ray_tmax() < 1.0


@ox.program
def __raygen__main():
    i = ox.get_launch_index().x
    ray = Radiance(float3(0.0))
    ox.traverse(params.scene, float3(0.0), float3(0.0, 0.0, 1.0), payload=ray)
    if is_near():
        ox.invoke(payload=ray)
    ox.trace(params.scene, float3(0.0), float3(0.0, 1.0, 0.0), payload=ray)
    params.seen[i] = ray.color


@ox.program
def __closesthit__white(ray: Radiance):
    ray.color = float3(1.0)
