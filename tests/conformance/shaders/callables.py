"""Callables from every kind of program: the programs of the recorded callables probe.

A row of params.log is: what, record, primitive or record after the calls, four payload words, eight results. The recorded callable takes a
struct and a pointer to a caller's local; here a callable's struct parameter is its record, so the values come one by one and the side
effects go to memory of the launch.
"""

import optixc as ox
from optixc import Array, Array2, Traversable, float3, float4, uint32

LOG_WORDS = 15
LOG_NUMBERS = 9


@ox.struct
class Params:
    log: Array2[uint32]
    log_numbers: Array2[float]
    log_count: Array[uint32]
    side: Array[uint32]
    scene: Traversable
    boxes: Traversable


@ox.struct
class Record:
    id: uint32
    k: float


@ox.payload
class Words:
    a: uint32
    b: uint32
    c: uint32
    d: uint32


params = ox.launch_params(Params)


@ox.device
def new_row(what: uint32) -> uint32:
    n = params.log_count[0]
    params.log_count[0] = n + 1
    params.log[n, 0] = what
    return n


@ox.device
def put_words(what: uint32, words: Words):
    n = new_row(what)
    params.log[n, 3] = words.a
    params.log[n, 4] = words.b
    params.log[n, 5] = words.c
    params.log[n, 6] = words.d


@ox.device
def shoot(scene: Traversable, x: float, y: float, offset: uint32, miss: uint32, words: Words):
    ox.trace(scene, float3(x, y, 5.0), float3(0.0, 0.0, -1.0), tmin=0.5, tmax=100.0, sbt_offset=offset, miss_sbt_index=miss, payload=words)


@ox.program
def __direct_callable__add(a: int, b: int, record: Record) -> int:
    return a * 10 + b + int(record.id) * 1000


@ox.program
def __direct_callable__vector(x: float4, i: int, s: float, record: Record) -> float4:
    params.side[0] = 4242
    params.side[1] = uint32(i + int(record.id))
    return x * s + float4(record.k)


@ox.program
def __direct_callable__nested(n: int, record: Record) -> int:
    if n <= 0:
        return int(record.id)
    return 10 * ox.direct_call(2, n - 1, result=int) + int(record.id)


@ox.program
def __direct_callable__traverse(x: int) -> int:
    words = Words(1, 2, 3, 4)
    ox.traverse(params.scene, float3(0.25, 0.25, 5.0), float3(0.0, 0.0, -1.0), tmin=0.5, tmax=100.0, payload=words)
    if ox.hit_object_is_hit():
        return 1000 + int(ox.hit_object_get_primitive_index()) + x
    return -1


@ox.program
def __continuation_callable__trace(depth: int) -> int:
    words = Words(uint32(depth), 0, 0, 0)
    x = 0.25 if depth & 1 != 0 else 50.0
    shoot(params.scene, x, 0.25, 0, 0, words)
    below = 0
    if depth > 0:
        below = ox.continuation_call(4, depth - 1, result=int)
    return int(words.b) + below * 1000


@ox.program
def __direct_callable__both(x: float, record: Record) -> float:
    return x + record.k


@ox.program
def __continuation_callable__both(x: float, record: Record) -> float:
    return x * record.k


@ox.device
def call_all(what: uint32, before: uint32) -> uint32:
    n = new_row(what)
    params.log[n, 1] = before
    params.log[n, 7] = uint32(ox.direct_call(0, 3, 4, result=int))
    params.side[0] = 0
    y = ox.direct_call(1, float4(1.0, 2.0, 3.0, 4.0), 7, 2.0, result=float4)
    params.log_numbers[n, 0] = y.x
    params.log_numbers[n, 1] = y.y
    params.log_numbers[n, 2] = y.z
    params.log_numbers[n, 3] = y.w
    params.log[n, 8] = params.side[1]
    params.log[n, 9] = params.side[0]
    params.log[n, 10] = uint32(ox.direct_call(2, 3, result=int))
    return n


@ox.program
def __raygen__call(record: Record):
    n = call_all(20, record.id)
    params.log[n, 2] = record.id
    n = new_row(21)
    params.log[n, 7] = uint32(ox.direct_call(3, 5, result=int))
    params.log[n, 8] = uint32(ox.continuation_call(4, 3, result=int))
    params.log_numbers[n, 0] = ox.direct_call(5, 10.0, result=float)
    params.log_numbers[n, 1] = ox.continuation_call(5, 10.0, result=float)
    params.log[n, 1] = record.id
    words = Words(1, 2, 3, 4)
    shoot(params.scene, 0.25, 0.25, 6, 2, words)
    put_words(22, words)
    shoot(params.scene, 50.0, 0.25, 6, 2, words)
    put_words(23, words)
    shoot(params.boxes, 0.5, 0.5, 7, 2, words)


@ox.program
def __closesthit__call(words: Words, record: Record):
    n = call_all(30, record.id)
    params.log[n, 2] = record.id
    n = new_row(31)
    params.log[n, 1] = record.id
    params.log[n, 7] = uint32(ox.continuation_call(4, 1, result=int))
    params.log[n, 2] = ox.get_primitive_index()
    params.log_numbers[n, 8] = ox.get_ray_tmax()
    words.d = 555


@ox.program
def __miss__call(words: Words, record: Record):
    n = call_all(40, record.id)
    params.log[n, 2] = record.id
    n = new_row(41)
    params.log[n, 1] = record.id
    params.log[n, 7] = uint32(ox.continuation_call(4, 1, result=int))
    words.d = 556


@ox.program
def __anyhit__call(record: Record):
    n = call_all(50, record.id)
    params.log[n, 2] = record.id


@ox.program
def __intersection__call(record: Record):
    n = call_all(60, record.id)
    params.log[n, 2] = record.id
    ox.report_intersection(4.0, 1, uint32(0), uint32(0))


@ox.program
def __closesthit__simple(words: Words):
    words.b = 7


@ox.program
def __miss__simple(words: Words):
    words.b = 9
