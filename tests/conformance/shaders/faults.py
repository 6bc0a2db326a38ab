"""One wrong thing for each kind of fault; every launch index reads what it does from the parameters."""

import optixc as ox
from optixc import float3, uint32

FINE = 0
READ = 1
WRITE = 2
ATOMIC = 3
DIRECT = 4
CONTINUATION = 5
ASSERT = 6
TRAVERSE = 7
NESTED = 8
THROW = 9
READ_IN_HELPER = 10


@ox.struct
class Ray:
    origin: float3
    direction: float3
    tmin: float
    tmax: float
    sbt_offset: uint32
    miss_index: uint32
    mode: uint32
    index: uint32
    scene: ox.Traversable


@ox.struct
class Params:
    rays: ox.Array[Ray]
    out: ox.Array[uint32]
    numbers: ox.Array2[uint32]
    codes: ox.Array[ox.int32]


@ox.payload
class Word:
    value: uint32


@ox.payload
class Pair:
    a: uint32
    b: uint32


@ox.payload
class Number:
    x: float


params = ox.launch_params(Params)


@ox.device
def shoot(ray: Ray, word: Word):
    ox.trace(ray.scene, ray.origin, ray.direction, tmin=ray.tmin, tmax=ray.tmax, sbt_offset=ray.sbt_offset,
             miss_sbt_index=ray.miss_index, payload=word)


@ox.device
def read(index: uint32) -> uint32:
    return params.numbers[0, index]


@ox.program
def __raygen__faults():
    i = ox.get_launch_index().x
    ray = params.rays[i]
    word = Word(1)
    shoot(ray, word)
    if ray.mode == READ:
        word.value += params.numbers[0, ray.index]
    elif ray.mode == WRITE:
        params.numbers[ray.index, 0] = 5
    elif ray.mode == ATOMIC:
        ox.atomic_add(params.numbers, (0, ray.index), uint32(1))
    elif ray.mode == DIRECT:
        word.value += ox.direct_call(ray.index, 1, result=uint32)
    elif ray.mode == CONTINUATION:
        word.value += ox.continuation_call(ray.index, 1, result=uint32)
    elif ray.mode == ASSERT:
        assert ray.index < 100, "indices are small"
    elif ray.mode == TRAVERSE:
        ox.traverse(ray.scene, ray.origin, ray.direction, tmin=-1.0)
    elif ray.mode == THROW:
        ox.throw_exception(77)
    elif ray.mode == READ_IN_HELPER:
        word.value += read(ray.index)
    params.out[i] = word.value


@ox.program
def __raygen__pair():
    i = ox.get_launch_index().x
    pair = Pair(1, 2)
    ox.trace(params.rays[i].scene, params.rays[i].origin, params.rays[i].direction, payload=pair)
    params.out[i] = pair.a + ox.direct_call(4, 1.0, result=uint32)


@ox.program
def __closesthit__word(word: Word):
    i = ox.get_launch_index().x
    word.value += 10
    ray = params.rays[i]
    if ray.mode == NESTED:
        shoot(ray, word)


@ox.program
def __closesthit__pair(pair: Pair):
    pair.a += 10


@ox.program
def __closesthit__number(number: Number):
    number.x += 10.0


@ox.program
def __anyhit__pair(pair: Pair):
    pair.a += 10


@ox.program
def __intersection__pair(pair: Pair):
    pair.a += 10


@ox.program
def __miss__word(word: Word):
    word.value += 100


@ox.program
def __miss__pair(pair: Pair):
    pair.a += 100


@ox.program
def __direct_callable__one(n: int) -> uint32:
    return uint32(n) + 1000


@ox.program
def __direct_callable__float(x: float) -> uint32:
    return uint32(x) + 1000


@ox.program
def __continuation_callable__one(n: int) -> uint32:
    return uint32(n) + 1000


@ox.program
def __exception__note():
    i = ox.get_launch_index().x
    params.codes[i] = ox.get_exception_code()
