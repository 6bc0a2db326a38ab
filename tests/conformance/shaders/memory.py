"""Memory that a launch index writes and reads again in a program below its trace; a counter that all of them share."""

import optixc as ox
from optixc import float3, uint32


@ox.struct
class Params:
    scene: ox.Traversable
    scratch: ox.Array[uint32]
    out: ox.Array[uint32]


params = ox.launch_params(Params)


@ox.program
def __raygen__write_and_trace():
    i = ox.get_launch_index().x
    params.scratch[i] = 7 * i + 1
    ox.trace(params.scene, float3(0.25, 0.25, 1.0), float3(0.0, 0.0, -1.0))
    params.out[i] = params.scratch[i]


@ox.program
def __closesthit__read():
    i = ox.get_launch_index().x
    params.scratch[i] = params.scratch[i] * 3


@ox.program
def __raygen__count():
    ox.atomic_add(params.scratch, 0, uint32(1))
