import optixc as ox
from optixc import float3, float4


@ox.payload
class Huge:  # E[OX207]: 36 words of 32 bits, at most 32
    a: ox.FixedArray[float4, 9]


@ox.attributes
class Wide:  # E[OX207]: 9 words of 32 bits, at most 8
    a: float4
    b: float4
    c: float


@ox.payload
class Pointing:
    a: ox.Array[float]  # E[OX202]: a payload cannot hold an array


@ox.payload
class Semantics:
    a: float = ox.payload_word(caller="x")  # E[OX202]: payload_word() takes
    b: float = ox.payload_word(ch="r", ms="r")  # E[OX202]: must be written by somebody
    c: float = ox.payload_word(caller="r", ch="w")


@ox.struct
class Plain:
    a: float = ox.payload_word(caller="r", ch="w")  # E[OX202]: belongs into an `@ox.payload` class


@ox.program
def __raygen__a():
    pass
