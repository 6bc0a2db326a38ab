"""Payload programs of area F: words that are kept, counted, written before the end of a program, and nested."""

import optixc as ox
from optixc import Array, Array2, Traversable, float3, uint32

COUNT = 0
TERMINATE = 1
WRITE_AFTER_IGNORE = 2


@ox.struct
class Params:
    scene: Traversable
    out: Array2[uint32]
    mode: Array[uint32]
    ray_flags: uint32
    scratch: Array2[uint32]


@ox.payload
class Eight:
    w0: uint32
    w1: uint32
    w2: uint32
    w3: uint32
    w4: uint32
    w5: uint32
    w6: uint32
    w7: uint32


params = ox.launch_params(Params)


@ox.device
def start(words: Eight):
    ox.trace(params.scene, float3(0.25, 0.25, 5.0), float3(0.0, 0.0, -1.0), tmax=100.0, ray_flags=params.ray_flags, payload=words)


@ox.device
def put(row: uint32, words: Eight):
    params.out[row, 0] = words.w0
    params.out[row, 1] = words.w1
    params.out[row, 2] = words.w2
    params.out[row, 3] = words.w3
    params.out[row, 4] = words.w4
    params.out[row, 5] = words.w5
    params.out[row, 6] = words.w6
    params.out[row, 7] = words.w7


@ox.program
def __raygen__eight():
    index = ox.get_launch_index().x
    words = Eight(10, 11, 12, 13, 14, 15, 16, 17)
    start(words)
    words.w7 += params.scratch[index, 3]
    put(index, words)


@ox.program
def __raygen__tuple():
    index = ox.get_launch_index().x
    a, b, c = ox.trace(params.scene, float3(0.25, 0.25, 5.0), float3(0.0, 0.0, -1.0), tmax=100.0,
                       payload=(uint32(1), uint32(2), uint32(3)))
    params.out[index, 0] = a
    params.out[index, 1] = b
    params.out[index, 2] = c


@ox.program
def __closesthit__third(words: Eight):
    words.w3 = 33


@ox.program
def __closesthit__by_number():
    ox.set_payload_3(ox.get_payload_0() + 100)


@ox.program
def __closesthit__three():
    ox.set_payload_2(ox.get_payload_0() + ox.get_payload_1())


@ox.program
def __closesthit__copy_first(words: Eight):
    words.w1 = words.w0


@ox.program
def __closesthit__nested(words: Eight):
    inner = Eight(words.w0 + 1, 1, 2, 3, 4, 5, 6, 7)
    if words.w0 < 12:
        start(inner)
    words.w2 = words.w2 + inner.w0 + 100 * words.w0


@ox.program
def __closesthit__scratch(words: Eight):
    row = ox.get_launch_index().x
    params.scratch[row, 3] = params.scratch[row, 0] + params.scratch[row, 1] + params.scratch[row, 2]
    words.w7 = 0


@ox.program
def __closesthit__undefined():
    ox.set_payload_5(ox.undefined_value())


@ox.program
def __anyhit__by_mode(words: Eight):
    mode = params.mode[0]
    if mode == COUNT:
        words.w0 = words.w0 + 1
        ox.ignore_intersection()
    elif mode == TERMINATE:
        words.w0 = 77
        ox.terminate_ray()
        words.w0 = 78
    else:
        ox.ignore_intersection()
        words.w0 = 99


@ox.program
def __miss__copy_first(words: Eight):
    words.w1 = words.w0
