import optixc as ox
from optixc import float3, int8, uint32

SIZE = 1 << 40
BAD = 1 // 0  # E[OX314]: divides a constant by zero
VECTOR = float3(1.0, 2.0)  # E[OX305]: takes 3 components
LIMIT: uint32 = -1  # E[OX313]: does not hold -1
SELF = SELF + 1


@ox.program
def __raygen__a():
    a: int = SIZE  # E[OX313]: does not hold 1099511627776
    b = BAD
    c = 1 / 0  # E[OX314]: divides a constant by zero
    d = a / 0  # E[OX314]: divides by the constant zero
    e = a % 0  # E[OX314]: divides by the constant zero
    f = 1 << -1  # E[OX313]: a shift count is negative
    g = a << -1  # E[OX313]: a shift count is never negative
    h = 99999999999999999999999999  # E[OX313]: more than 64 bits
    i = uint32(-1)  # E[OX313]: uint32 does not hold -1
    j = int8(200)  # E[OX313]: int8 does not hold 200
    k = 3000000000  # E[OX313]: does not hold 3000000000
    l = uint32(3) - 4000000000 - 5000000000  # E[OX313]: does not hold 5000000000
    m = a ** -1  # E[OX313]: an integer to a negative power
    n = 10 ** 5000  # E[OX313]: too large
    o = VECTOR
    p = LIMIT
    q = SELF  # E[OX310]: defined in terms of itself
    r = int(1e400)  # E[OX313]: int32 does not hold inf
    s = 2.0 ** 5000.0  # E[OX313]: too large
    t = float3(1.0) / 0.0  # E[OX314]: divides by the constant zero
