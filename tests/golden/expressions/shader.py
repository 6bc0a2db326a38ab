"""Every operator and conversion, with the parentheses that each needs."""

import optixc as ox
from optixc import float2, float3, float3x4, float4, int32, int64, uint2, uint32, uint64


@ox.struct
class Params:
    f: ox.Array[ox.float32]
    d: ox.Array[ox.float64]
    i: ox.Array[int32]
    u: ox.Array[uint32]
    bytes: ox.Array2[ox.uchar4]
    m: float3x4
    flag: bool
    wide: int64
    huge: uint64


params = ox.launch_params(Params)


@ox.program
def __raygen__main():
    a, b = params.i[0], params.i[1]
    x, y = params.u[0], params.u[1]
    s, t = params.f[0], params.f[1]
    params.i[2] = a - (b - 1) - (a + b) * -a
    params.i[3] = a // b + a % b + a // 4 + (a << 3) + (a >> b)
    params.i[4] = a & b | a ^ ~b
    params.i[5] = int32(s) + int32(x) + int32(a < b) + (-2147483647 - 1)
    params.u[2] = x // 16 + x % 10 + (x >> 4) + (x << y)
    params.u[3] = uint32(s) | uint32(a)
    params.f[2] = a / b + s / t - s % t + s**2.0 + float(x)
    params.f[3] = s if (a < b <= 5 and not params.flag) or x == y else -t
    params.f[4] = min(s, 1.0) + max(s, max(t, 0.25)) + abs(-s) + 0.1 + 1e-30 + 3.0
    params.d[0] = ox.float64(s) * 0.1 + params.d[1]
    params.i[6] = int32(params.wide >> 2) + int32(params.huge % 1000)
    v = float3(s, t, 1.0)
    w = float4(v.zyx, 0.5)
    q = params.m @ w
    c = float3x4(w, w.wzyx, float4(0.0))
    params.f[5] = q.x + c[1].y + ox.dot(v, v.yzx) + w[2]
    n = uint2(x, y) * 2 + 1
    params.u[4] = n.x if n == uint2(1, 2) else n.y
    colour = params.bytes[0, a]
    params.f[6] = float(colour.x) / 255.0 + float(ox.popcount(x)) + ox.uint_as_float(x)
    ratio = float2(float(colour.y), ox.sqrt(s)) / 2.0
    params.f[7] = ratio.x * ratio.y
