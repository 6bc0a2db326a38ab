"""A mode that is a launch parameter, read in three ways: directly, through a local, inside a struct."""

import optixc as ox
from optixc import float3


@ox.struct
class Light:
    color: float3
    enabled: bool


@ox.struct
class Params:
    out: ox.Array[float]
    k: ox.int32
    light: Light


params = ox.launch_params(Params)


@ox.device
def only_three() -> float:
    return ox.sin(params.light.color.y) + 1000.0


@ox.device
def only_other() -> float:
    return ox.cos(params.light.color.y) + 2000.0


@ox.program
def __raygen__branch():
    i = ox.get_launch_index().x
    k = params.k
    value = 0.0
    value = only_three() if k == 3 else only_other()
    if params.light.enabled:
        value += params.light.color.x
    params.out[i] = value
