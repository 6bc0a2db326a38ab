"""Callables with values, structs and record data; what a call passes decides which struct is the record's."""

import optixc as ox
from optixc import float3, uint32


@ox.struct
class Params:
    out: ox.Array[float]
    records: ox.Array[uint32]
    x: float


@ox.struct
class Surface:
    normal: float3
    depth: float


@ox.struct
class Factor:
    k: float


params = ox.launch_params(Params)


@ox.program
def __raygen__call():
    i = ox.get_launch_index().x
    params.out[i] = ox.direct_call(params.records[i], params.x, result=float)


@ox.program
def __raygen__structs():
    i = ox.get_launch_index().x
    surface = Surface(float3(1.0, 2.0, 3.0), float(i))
    moved = ox.direct_call(params.records[i] + 3, surface, params.x, result=Surface)
    params.out[i] = ox.direct_call(params.records[i], surface, result=float) + moved.depth


@ox.program
def __raygen__both():
    i = ox.get_launch_index().x
    params.out[i] = 100.0 * ox.direct_call(params.records[i], params.x, result=float)
    params.out[i] += ox.continuation_call(params.records[i], params.x, result=float)


@ox.program
def __direct_callable__plus(x: float, factor: Factor) -> float:
    return x + factor.k


@ox.program
def __direct_callable__times(x: float, factor: Factor) -> float:
    return x * factor.k


@ox.program
def __continuation_callable__minus(x: float, factor: Factor) -> float:
    return x - factor.k


@ox.program
def __direct_callable__argument_only(surface: Surface) -> float:
    return surface.normal.y + surface.depth


@ox.program
def __direct_callable__argument_and_record(surface: Surface, factor: Factor) -> float:
    return surface.normal.z * factor.k


@ox.program
def __direct_callable__argument_and_asked(surface: Surface) -> float:
    return surface.normal.x + ox.get_sbt_data(Factor).k


@ox.program
def __direct_callable__move(surface: Surface, by: float) -> Surface:
    moved = ox.copy(surface)
    moved.depth += by
    return moved
