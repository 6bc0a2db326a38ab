"""A continuation callable that traces, and a closest-hit program that calls it again: as deep as the payload says."""

import optixc as ox
from optixc import float3, uint32


@ox.struct
class Params:
    scene: ox.Traversable
    out: ox.Array[uint32]
    codes: ox.Array[ox.int32]
    depth: ox.Array[uint32]


@ox.struct
class Weight:
    value: uint32


@ox.payload
class Level:
    left: uint32
    sum: uint32


params = ox.launch_params(Params)


@ox.program
def __continuation_callable__shoot(left: uint32, weight: Weight) -> uint32:
    level = Level(left, 0)
    ox.trace(params.scene, float3(0.25, 0.25, 1.0), float3(0.0, 0.0, -1.0), payload=level)
    return level.sum + weight.value


@ox.program
def __closesthit__again(level: Level):
    level.sum = 1
    if level.left > 1:
        level.sum += ox.continuation_call(level.left % 2, level.left - 1, result=uint32)


@ox.program
def __raygen__mutual():
    i = ox.get_launch_index().x
    params.out[i] = ox.continuation_call(params.depth[i] % 2, params.depth[i], result=uint32)


@ox.program
def __exception__note():
    params.codes[ox.get_launch_index().x] = ox.get_exception_code()
