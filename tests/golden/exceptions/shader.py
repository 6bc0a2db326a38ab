"""Exceptions that users throw: out of a ray generation program, a closest-hit program and a helper."""

import optixc as ox
from optixc import float3

OPTIONS = {"exception_flags": 4}


@ox.struct
class Params:
    codes: ox.Array[ox.int32]
    scene: ox.Traversable


@ox.payload
class Distance:
    t: float


params = ox.launch_params(Params)


@ox.device
def check(t: float) -> float:
    if t < 0.0:
        ox.throw_exception(7, 1, 2)
    return ox.sqrt(t)


@ox.program
def __raygen__throwing():
    i = ox.get_launch_index().x
    if i == 13:
        ox.throw_exception(13)
    found = Distance(0.0)
    ox.trace(params.scene, float3(0.0), float3(0.0, 0.0, 1.0), payload=found)
    params.codes[i] = ox.int32(check(found.t))


@ox.program
def __closesthit__throwing(found: Distance):
    found.t = ox.get_ray_tmax()
    if ox.get_primitive_index() == 5:
        ox.throw_exception(5)


@ox.program
def __exception__note():
    params.codes[ox.get_launch_index().x] = -ox.get_exception_code()
