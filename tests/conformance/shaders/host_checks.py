"""Small programs for the checks of the host surface: one ray along z per index, an endless loop, a record of any struct."""

import optixc as ox
from optixc import float3


@ox.struct
class Params:
    hits: ox.Array[ox.float32]
    scene: ox.Traversable
    scale: float


@ox.struct
class Other:
    hits: ox.Array[ox.float32]
    scale: float


@ox.struct
class Paint:
    value: float


@ox.payload
class Result:
    value: float


params = ox.launch_params(Params)


@ox.program
def __raygen__rays():
    i = ox.get_launch_index().x
    ray = Result(0.0)
    ox.trace(params.scene, float3(0.25, 0.25, -1.0), float3(0.0, 0.0, 1.0), payload=ray)
    params.hits[i] = ray.value * params.scale


@ox.program
def __raygen__endless():
    x = 0.0
    while params.scale > 0.0:
        x = x + 1.0
    params.hits[0] = x


@ox.program
def __raygen__empty():
    pass


@ox.program
def __closesthit__paint(ray: Result, paint: Paint):
    ray.value = paint.value


@ox.program
def __miss__nothing(ray: Result):
    ray.value = -1.0
