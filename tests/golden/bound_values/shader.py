"""A bound value removes the shadow ray, its programs' class, and the helper that traced it."""

import optixc as ox
from optixc import float3

OPTIONS = {"bound_values": {"shadows": False, "samples": 4}}


@ox.struct
class Params:
    image: ox.Array[float3]
    scene: ox.Traversable
    shadows: bool
    samples: ox.int32


@ox.payload
class Radiance:
    color: float3


@ox.payload
class Shadow:
    light: float


params = ox.launch_params(Params)


@ox.device
def light_at(point: float3) -> float:
    shadow = Shadow(0.0)
    ox.trace(params.scene, point, float3(0.0, 1.0, 0.0), payload=shadow)
    return shadow.light


@ox.program
def __raygen__image():
    i = ox.get_launch_index().x
    color = float3(0.0)
    for _ in range(params.samples):
        ray = Radiance(float3(0.0))
        ox.trace(params.scene, float3(0.0), float3(0.0, 0.0, 1.0), payload=ray)
        color += ray.color
    if params.shadows and params.samples > 2:
        color *= light_at(float3(0.0))
    params.image[i] = color / float(params.samples)


@ox.program
def __miss__white(ray: Radiance):
    ray.color = float3(1.0)
