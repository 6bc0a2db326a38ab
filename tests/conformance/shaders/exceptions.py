"""Closest-hit programs that throw or recurse, and an exception program that writes down what it saw."""

import optixc as ox
from optixc import float3, uint32

THROW = 1
RECURSE = 100


@ox.struct
class Params:
    out: ox.Array[uint32]
    codes: ox.Array[ox.int32]
    details: ox.Array2[uint32]
    modes: ox.Array[uint32]
    scene: ox.Traversable


@ox.struct
class Number:
    value: uint32


@ox.payload
class Left:
    levels: uint32


params = ox.launch_params(Params)


@ox.device
def shoot(left: Left):
    ox.trace(params.scene, float3(0.25, 0.25, 1.0), float3(0.0, 0.0, -1.0), payload=left)


@ox.program
def __raygen__r():
    i = ox.get_launch_index().x
    mode = params.modes[i]
    left = Left(mode - RECURSE if mode >= RECURSE else uint32(1))
    shoot(left)
    params.out[i] += 100


@ox.program
def __closesthit__c(left: Left):
    i = ox.get_launch_index().x
    if left.levels > 1:
        inner = Left(left.levels - 1)
        shoot(inner)
        return
    params.out[i] += 1
    if params.modes[i] == THROW:
        ox.throw_exception(42, 100, 101, 102, 103, 104, 105, 106, 107)
    params.out[i] += 10


@ox.program
def __exception__e(number: Number):
    i = ox.get_launch_index().x
    params.out[i] += number.value
    params.codes[i] = ox.get_exception_code()
    params.details[i, 0] = ox.get_exception_detail_0()
    params.details[i, 1] = ox.get_exception_detail_1()
    params.details[i, 2] = ox.get_exception_detail_2()
    params.details[i, 3] = ox.get_exception_detail_3()
    params.details[i, 4] = ox.get_exception_detail_4()
    params.details[i, 5] = ox.get_exception_detail_5()
    params.details[i, 6] = ox.get_exception_detail_6()
    params.details[i, 7] = ox.get_exception_detail_7()
