"""Programs that nest as deep as a launch parameter says: traces, direct callables, continuation callables."""

import optixc as ox
from optixc import float3, uint32


@ox.struct
class Params:
    scene: ox.Traversable
    out: ox.Array[uint32]
    codes: ox.Array[ox.int32]
    depth: ox.Array[uint32]


@ox.payload
class Level:
    left: uint32
    reached: uint32


params = ox.launch_params(Params)


@ox.device
def shoot(level: Level):
    ox.trace(params.scene, float3(0.25, 0.25, 1.0), float3(0.0, 0.0, -1.0), payload=level)


@ox.program
def __raygen__traces():
    i = ox.get_launch_index().x
    level = Level(params.depth[i], 0)
    if level.left > 0:
        shoot(level)
    params.out[i] = level.reached


@ox.program
def __raygen__traverses():
    i = ox.get_launch_index().x
    level = Level(uint32(1), 0)
    if params.depth[i] > 0:
        ox.traverse(params.scene, float3(0.25, 0.25, 1.0), float3(0.0, 0.0, -1.0), payload=level)
        ox.invoke(payload=level)
    params.out[i] = level.reached


@ox.program
def __closesthit__again(level: Level):
    inner = Level(level.left - 1, 0)
    if inner.left > 0:
        shoot(inner)
    level.reached = inner.reached + 1


@ox.program
def __raygen__direct():
    i = ox.get_launch_index().x
    params.out[i] = ox.direct_call(0, params.depth[i], result=uint32)


@ox.program
def __direct_callable__down(n: uint32) -> uint32:
    if n == 0:
        return uint32(0)
    below = ox.direct_call(0, n - 1, result=uint32)
    return below + (below & 1) + 1  # used twice, so that no compiler makes a loop of it


@ox.program
def __raygen__continuation():
    i = ox.get_launch_index().x
    params.out[i] = ox.continuation_call(0, params.depth[i], result=uint32)


@ox.program
def __continuation_callable__down(n: uint32) -> uint32:
    if n == 0:
        return uint32(0)
    below = ox.continuation_call(0, n - 1, result=uint32)
    return below + (below & 1) + 1


@ox.program
def __exception__note():
    params.codes[ox.get_launch_index().x] = ox.get_exception_code()
