"""Direct and continuation callables: two signatures, record data, and a callable that calls another."""

import optixc as ox
from optixc import float2, float3, uint32


@ox.struct
class Params:
    colors: ox.Array[float3]
    material: uint32


@ox.struct
class Stripes:
    width: float
    other: uint32


params = ox.launch_params(Params)


@ox.program
def __raygen__materials():
    i = ox.get_launch_index().x
    uv = float2(float(i), 0.5)
    color = ox.direct_call(params.material, uv, result=float3)
    params.colors[i] = color + ox.continuation_call(0, color, result=float3)


@ox.program
def __direct_callable__plain(uv: float2) -> float3:
    return float3(uv.x, uv.y, 0.0)


@ox.program
def __direct_callable__stripes(uv: float2, stripes: Stripes) -> float3:
    if ox.fract(uv.x / stripes.width) < 0.5:
        return float3(1.0)
    return ox.direct_call(stripes.other, uv, result=float3)


@ox.program
def __continuation_callable__glow(color: float3) -> float3:
    return 0.1 * color
