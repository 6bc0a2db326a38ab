"""User exceptions from every kind of program, and traces nested too deep: the programs of the recorded exception probes.

params.trail holds eight words per launch index: 0 ray generation began, 1 it passed its throw, 2 its trace returned, 3 payload word 1
after it, 4 closest hit or miss passed its throw, 5 what the callable returned, 6 closest hit began, 7 any hit (1) or intersection (2)
passed its throw. Only launch index 1 throws.
"""

import optixc as ox
from optixc import Array, Array2, Traversable, float3, uint32

RAYGEN = 1
CLOSESTHIT = 2
MISS = 3
ANYHIT = 4
INTERSECTION = 5
DIRECT = 6
CONTINUATION = 7
DEPTH = 8
EXCEPTION_WORDS = 13


@ox.struct
class Params:
    trail: Array2[uint32]
    exceptions: Array2[uint32]
    exception_count: Array[uint32]
    depth_log: Array2[uint32]
    depth_count: Array[uint32]
    scene: Traversable
    boxes: Traversable
    mode: uint32
    details: uint32
    code: uint32


@ox.struct
class Record:
    id: uint32


@ox.payload
class Words:
    a: uint32
    b: uint32
    c: uint32
    d: uint32


params = ox.launch_params(Params)


@ox.device
def throw_five():
    n = params.details
    if n == 0:
        ox.throw_exception(5)
    elif n == 1:
        ox.throw_exception(5, 101)
    elif n == 2:
        ox.throw_exception(5, 101, 102)
    elif n == 3:
        ox.throw_exception(5, 101, 102, 103)
    elif n == 4:
        ox.throw_exception(5, 101, 102, 103, 104)
    elif n == 5:
        ox.throw_exception(5, 101, 102, 103, 104, 105)
    elif n == 6:
        ox.throw_exception(5, 101, 102, 103, 104, 105, 106)
    elif n == 7:
        ox.throw_exception(5, 101, 102, 103, 104, 105, 106, 107)
    else:
        ox.throw_exception(5, 101, 102, 103, 104, 105, 106, 107, 108)


@ox.device
def throw():
    if params.code == 0:
        ox.throw_exception(0, 101)
    elif params.code == 1:
        ox.throw_exception(1, 101)
    elif params.code == 1073741823:
        ox.throw_exception(1073741823, 101)
    else:
        throw_five()


@ox.device
def put_depth(what: uint32, index: uint32, depth: uint32):
    row = ox.atomic_add(params.depth_count, 0, uint32(1))
    params.depth_log[row, 0] = what
    params.depth_log[row, 1] = index
    params.depth_log[row, 2] = depth


@ox.program
def __direct_callable__throw(x: int) -> int:
    throw()
    return 5


@ox.program
def __continuation_callable__throw(x: int) -> int:
    throw()
    return 5


@ox.program
def __raygen__throw():
    i = ox.get_launch_index().x
    mode = params.mode
    params.trail[i, 0] = 1
    if mode == RAYGEN and i == 1:
        throw()
    params.trail[i, 1] = 1
    if mode == DIRECT and i == 1:
        params.trail[i, 5] = uint32(ox.direct_call(6, 1, result=int))
    if mode == CONTINUATION and i == 1:
        params.trail[i, 5] = uint32(ox.continuation_call(6, 1, result=int))
    words = Words(i, 2, 3, 4)
    x = 50.0 if mode == MISS else 0.25
    scene = params.scene
    if mode == INTERSECTION:
        x = 0.5
        scene = params.boxes
    ox.trace(scene, float3(x, x, 5.0), float3(0.0, 0.0, -1.0), tmin=0.5, tmax=100.0, sbt_offset=8, miss_sbt_index=3, payload=words)
    params.trail[i, 2] = 1
    params.trail[i, 3] = words.b


@ox.program
def __closesthit__throw(words: Words):
    i = ox.get_launch_index().x
    words.b = 77
    params.trail[i, 6] = 1
    if params.mode == CLOSESTHIT and i == 1:
        throw()
    params.trail[i, 4] = 1
    words.b = 78
    if params.mode == DEPTH:
        depth = words.c
        put_depth(70, i, depth)
        inner = Words(i, 2, depth + 1, 4)
        if depth < 3 + params.details:
            ox.trace(params.scene, float3(0.25, 0.25, 5.0), float3(0.0, 0.0, -1.0), tmin=0.5, tmax=100.0, sbt_offset=8,
                     miss_sbt_index=3, payload=inner)
        put_depth(71, i, depth)


@ox.program
def __miss__throw(words: Words):
    i = ox.get_launch_index().x
    words.b = 87
    if params.mode == MISS and i == 1:
        throw()
    params.trail[i, 4] = 1


@ox.program
def __anyhit__throw():
    i = ox.get_launch_index().x
    if params.mode == ANYHIT and i == 1:
        throw()
    params.trail[i, 7] = 1


@ox.program
def __intersection__throw():
    i = ox.get_launch_index().x
    if params.mode == INTERSECTION and i == 1:
        throw()
    params.trail[i, 7] = 2
    ox.report_intersection(4.0, 1, uint32(0), uint32(0))


@ox.program
def __exception__throw(record: Record):
    n = ox.atomic_add(params.exception_count, 0, uint32(1))
    params.exceptions[n, 0] = uint32(ox.get_exception_code())
    params.exceptions[n, 1] = ox.get_launch_index().x
    params.exceptions[n, 2] = ox.get_exception_detail_0()
    params.exceptions[n, 3] = ox.get_exception_detail_1()
    params.exceptions[n, 4] = ox.get_exception_detail_2()
    params.exceptions[n, 5] = ox.get_exception_detail_3()
    params.exceptions[n, 6] = ox.get_exception_detail_4()
    params.exceptions[n, 7] = ox.get_exception_detail_5()
    params.exceptions[n, 8] = ox.get_exception_detail_6()
    params.exceptions[n, 9] = ox.get_exception_detail_7()
    params.exceptions[n, 10] = record.id
    params.exceptions[n, 11] = ox.get_launch_dimensions().x
