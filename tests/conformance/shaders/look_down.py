"""Every launch index looks down onto one of some scenes, whose handles stand in an array that changes."""

import optixc as ox
from optixc import Array, Traversable, float3, uint32


@ox.struct
class Params:
    scenes: Array[Traversable]
    seen: Array[uint32]


@ox.payload
class Seen:
    hits: uint32


params = ox.launch_params(Params)


@ox.program
def __raygen__look():
    i = ox.get_launch_index().x
    seen = Seen(0)
    ox.trace(params.scenes[i & 7], float3(0.25, 0.25, 5.0), float3(0.0, 0.0, -1.0), payload=seen)
    params.seen[i] = seen.hits


@ox.program
def __closesthit__seen(seen: Seen):
    seen.hits = seen.hits + 1
