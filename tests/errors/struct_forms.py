import optixc as ox
from optixc import float3


@ox.struct
class Base:
    x: float


@ox.struct
class Derived(Base):  # E[OX202]: cannot inherit
    y: float


@ox.struct
class NoType:
    a = 1  # E[OX202]: a field needs a type
    b: float


@ox.struct
class _Private:
    __x: float  # E[OX202]: gives the field `__x` the name `_Private__x`
    __init__: float


@ox.struct
class Empty:  # E[OX202]: has no fields
    pass


@ox.struct
class Twice:
    a: float
    a: int  # E[OX202]: field `a` is defined twice


@ox.struct
class Order:
    a: float = 1.0
    b: float  # E[OX202]: without a default follows one with a default


@ox.struct
class Kinds:
    a: tuple[float, float]  # E[OX202]: a field cannot be of type
    b: str  # E[OX201]: `str` is no type
    c: ox.Array  # E[OX201]: needs its element type
    d: ox.FixedArray[float]  # E[OX201]: FixedArray needs an element type and a size
    e: ox.FixedArray[float, 0]  # E[OX201]: an integer constant from 1
    f: ox.Array[tuple[float, float]]  # E[OX201]: an array cannot hold
    g: list[float]  # E[OX201]: `list[float]` is no type
    for i in range(3):  # E[OX202]: a struct holds fields only
        pass


@ox.struct
class Broken:
    inner: missing  # E[OX201]: `missing` is no type


@ox.payload
class HoldsBroken:
    broken: Broken


@ox.struct
class Default:
    x: float = True  # E[OX302]: the default of `x` must be float32


@ox.program
def __raygen__a():
    d = Default()
