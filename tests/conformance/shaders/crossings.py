"""Counts the crossings of lines with everything in their way: the any-hit program counts and drops each hit."""

import optixc as ox
from optixc import float3, uint32


@ox.struct
class Params:
    """Line i begins at `origins[i]`, runs along the unit vector `directions[i]` and is `length` long."""

    origins: ox.Array[float3]
    directions: ox.Array[float3]
    counts: ox.Array[uint32]
    scene: ox.Traversable
    length: float


@ox.payload
class Count:
    value: uint32


params = ox.launch_params(Params)


@ox.program
def __raygen__lines():
    i = ox.get_launch_index().x
    count = Count(uint32(0))
    ox.trace(params.scene, params.origins[i], params.directions[i], tmax=params.length, payload=count)
    params.counts[i] = count.value


@ox.program
def __anyhit__count(count: Count):
    count.value += uint32(1)
    ox.ignore_intersection()
