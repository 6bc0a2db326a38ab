"""Two payload types with words that only some programs read or write: the programs of the recorded payload-type probes."""

import optixc as ox
from optixc import Array, Traversable, float3, uint32


@ox.struct
class Params:
    scene: Traversable
    seen: Array[uint32]
    mode: uint32


@ox.payload
class Narrow:
    told: uint32 = ox.payload_word(caller="w", ch="r")
    answer: uint32 = ox.payload_word(caller="r", ch="w", ms="w")
    counted: uint32 = ox.payload_word(caller="rw", ah="rw", ch="r", ms="r")


@ox.payload
class Open:
    word: uint32


params = ox.launch_params(Params)


@ox.program
def __raygen__types():
    origin = float3(0.25, 0.25, 5.0)
    if params.mode != 0:
        origin = float3(50.0, 0.25, 5.0)
    down = float3(0.0, 0.0, -1.0)
    narrow = Narrow(11, 22, 33)
    ox.trace(params.scene, origin, down, tmin=0.5, tmax=100.0, payload=narrow)
    params.seen[1] = narrow.answer
    params.seen[2] = narrow.counted
    wide = Open(44)
    ox.trace(params.scene, origin, down, tmin=0.5, tmax=100.0, sbt_offset=1, miss_sbt_index=1, payload=wide)
    params.seen[3] = wide.word


@ox.program
def __closesthit__narrow(ray: Narrow):
    params.seen[4] = ray.told
    params.seen[5] = ray.counted
    ray.answer = 1111


@ox.program
def __miss__narrow(ray: Narrow):
    params.seen[5] = ray.counted
    ray.answer = 2222


@ox.program
def __anyhit__narrow(ray: Narrow):
    params.seen[6] = ray.counted
    ray.counted = ray.counted + 1


@ox.program
def __closesthit__open(ray: Open):
    params.seen[7] = ray.word
    ray.word = 3333


@ox.program
def __miss__open(ray: Open):
    params.seen[7] = ray.word
    ray.word = 4444


@ox.program
def __anyhit__open(ray: Open):
    ray.word = ray.word + 1
