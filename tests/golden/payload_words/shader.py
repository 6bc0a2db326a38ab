"""Payload registers: fields that are no single word, access by number, programs of another class with the same words."""

import optixc as ox
from optixc import float2, uint32, uint64


@ox.struct
class Params:
    out: ox.Array[uint32]
    scene: ox.Traversable


@ox.payload
class Mixed:
    hit: bool
    where: uint64
    uv: float2
    kind: ox.uint8


@ox.payload
class Alike:
    was_hit: bool
    address: uint64
    place: float2
    tag: ox.uint8


params = ox.launch_params(Params)


@ox.program
def __raygen__main():
    mixed = Mixed(False, 1, float2(0.0), 3)
    ox.trace(params.scene, ox.float3(0.0), ox.float3(0.0, 0.0, 1.0), payload=mixed)
    params.out[0] = uint32(mixed.where >> 32) if mixed.hit else uint32(mixed.kind)
    first, second = ox.trace(params.scene, ox.float3(0.0), ox.float3(0.0, 0.0, 1.0), payload=(params.out[1], 0.5))
    params.out[2] = first + uint32(second)


@ox.program
def __closesthit__mixed(mixed: Mixed):
    mixed.hit = True
    mixed.where += 4294967296
    mixed.uv = ox.get_triangle_barycentrics()


@ox.program
def __closesthit__alike(alike: Alike):
    alike.was_hit = not alike.was_hit
    alike.tag = 7


@ox.program
def __miss__words():
    ox.set_payload_1(ox.get_payload_0() + 1)


@ox.program
def __miss__nothing():
    pass
