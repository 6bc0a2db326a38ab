import optixc as ox
from optixc import float2, float3, int2, int32, uint8, uint32


@ox.struct
class Pair:
    a: float
    b: int


@ox.device
def stored(
    a: uint8,  # E[OX201]: a parameter cannot be uint8
    b: float,
) -> float:
    return b


@ox.device
def gives_stored(b: float) -> tuple[float, ox.half2]:  # E[OX201]: a result cannot be tuple[float32, half2]
    return b, ox.half2(b)


@ox.program
def __raygen__a():
    i = ox.get_launch_index()
    k = 3
    a = i.x + k  # E[OX303]: `+` does not take uint32 and int32 signed and unsigned do not mix
    b = i.x < k  # E[OX303]: uint32 and int32 cannot be compared
    c = float3(1.0) + float2(1.0)  # E[OX303]: vectors of one size are needed
    d: int = 1.5  # E[OX302]: `d` must be int32, this is a float literal
    e: float3 = 1.0  # E[OX302]: write float3(x) to spread
    f = True + 1  # E[OX303]: a bool is no number
    g = 1.5 & 2  # E[OX303]: expected integers
    h = ~1.5  # E[OX303]: expected an integer
    j = -True  # E[OX303]: expected a number or vector
    if float3(1.0):  # E[OX302]: a condition must be a bool or a number
        pass
    l = k and True  # E[OX303]: `and` takes bools
    m = float3(1.0) < float3(2.0)  # E[OX303]: order scalars
    n = 1.0 if k else float3(1.0)  # E[OX302]: the branches are
    o = Pair(1.0)  # E[OX305]: misses `b`
    p = Pair(1.0, 2, 3)  # E[OX305]: takes 2 arguments, here are 3
    q = Pair(1.0, c=2)  # E[OX305]: no parameter `c`
    r = Pair(1.0, a=2)  # E[OX305]: gets `a` twice
    s = Pair(1.0, 2.5)  # E[OX302]: field `b` must be int32
    t = float3(1.0, 2.0)  # E[OX305]: takes 3 components, here are 2
    u = float3(Pair(1.0, 2))  # E[OX302]: a component must be a number
    v = int2(1.5, 2)  # E[OX302]: a component of int2 must be an integer
    w = ox.sqrt(True)  # E[OX302]: sqrt() takes
    x = ox.cross(1.0, float3(1.0))  # E[OX302]: argument `a` must be float3
    y = ox.dot(1.0, 2.0)  # E[OX302]: e.g. float3
    z = ox.sqrt()  # E[OX305]: misses `x`
    aa: uint8 = 3  # E[OX201]: 8 and 16 bit numbers live in memory only
    bb = Pair(1.0, 2) == Pair(1.0, 2)  # E[OX303]: `==` does not take Pair
    cc = float(float3(1.0))  # E[OX302]: float32() takes a number
    dd = ox.popcount(1.5)  # E[OX302]: an integer or vector of integers
    k = k + 1
    uint32(k).x = 1  # E[OX311]: uint32 has no attribute `x`
    ee = float3(1.0) + Pair(1.0, 2)  # E[OX303]: does not take float3 and Pair
    ff = ox.float3x3(1.0)  # E[OX305]: takes 3 rows or 9 numbers
    gg = float3(x=1.0)  # E[OX305]: takes no keywords
    hh = ox.Array[float](3)  # E[OX402]: an array cannot be made in a shader
    ii = ox.FixedArray[float, 3](1.0)  # E[OX305]: takes 3 items or none
    jj = ox.isnan(float3(1.0))  # E[OX302]: isnan() takes a number
    kk = int32(1.0, 2.0)  # E[OX305]: takes one argument
    mm = stored(3, 1.0)
    ll = ox.float3x3(float3(1.0), float3(1.0), float3(1.0)) * float3(1.0)  # E[OX303]: write `@` for the matrix product
