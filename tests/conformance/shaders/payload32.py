"""Thirty-two payload words, copied in and out through nested traces: the payload probes of the recorded set.

Rows of params.rows: word 0 is the tag (1 ray generation after its trace, 2 closest hit at its begin, 3 the inner caller's words after its
trace, 4 the closest hit's own words after it, 5 any hit, 6 miss), word 1 the depth, then the 32 payload words.
"""

import optixc as ox
from optixc import Array, Array2, FixedArray, Traversable, float3, uint32

WORDS = 32
Block = FixedArray[uint32, 32]


@ox.struct
class Params:
    scene: Traversable
    rows: Array2[uint32]
    count: Array[uint32]
    depth: uint32
    ray_flags: uint32
    mode: uint32


@ox.payload
class Words:
    w: Block


params = ox.launch_params(Params)


@ox.device
def put(tag: uint32, depth: uint32, words: Words):
    row = params.count[0]
    params.count[0] = row + 1
    params.rows[row, 0] = tag
    params.rows[row, 1] = depth
    for i in range(WORDS):
        params.rows[row, 2 + i] = words.w[i]


@ox.program
def __raygen__words():
    words = Words(Block())
    for i in range(WORDS):
        words.w[i] = uint32(1000 + i)
    words.w[0] = 0
    x = 50.0 if params.mode == 1 else 0.25
    ox.trace(params.scene, float3(x, 0.25, 5.0), float3(0.0, 0.0, -1.0), tmin=0.5, tmax=100.0, ray_flags=params.ray_flags, payload=words)
    put(1, 0, words)


@ox.program
def __closesthit__words(words: Words):
    depth = words.w[0]
    put(2, depth, words)
    if depth + 1 < params.depth:
        inner = Words(Block())
        for i in range(WORDS):
            inner.w[i] = words.w[i] + 10000
        inner.w[0] = depth + 1
        ox.trace(params.scene, float3(0.25, 0.25, 5.0), float3(0.0, 0.0, -1.0), tmin=0.5, tmax=100.0, ray_flags=params.ray_flags,
                 payload=inner)
        put(3, depth, inner)
        put(4, depth, words)
    for i in range(0, WORDS, 2):
        words.w[i] = 500000 + 100 * depth + uint32(i)


@ox.program
def __anyhit__words(words: Words):
    put(5, words.w[0], words)
    words.w[31] = words.w[31] + 1
    words.w[30] = 30
    if params.mode == 2:
        ox.ignore_intersection()


@ox.program
def __miss__words(words: Words):
    put(6, words.w[0], words)
    words.w[5] = 55555
