"""Programs of area H: who am I, and what does my record say."""

import optixc as ox
from optixc import Array, Traversable, float3, uint32


@ox.struct
class Params:
    indices: Array[uint32]
    dimensions: Array[uint32]
    scene: Traversable
    value: uint32


@ox.struct
class Data:
    a: uint32
    b: float
    c: float3


@ox.payload
class Result:
    a: uint32
    b: float
    c: float3


params = ox.launch_params(Params)


@ox.program
def __raygen__index(data: Data):
    i, n = ox.get_launch_index(), ox.get_launch_dimensions()
    linear = i.x + n.x * (i.y + n.y * i.z)
    params.indices[linear] = linear + data.a + params.value
    params.dimensions[3 * linear] = n.x
    params.dimensions[3 * linear + 1] = n.y
    params.dimensions[3 * linear + 2] = n.z


@ox.program
def __raygen__trace():
    i = ox.get_launch_index().x
    result = Result(0, 0.0, float3(0.0))
    ox.trace(params.scene, float3(0.25, 0.25, 5.0), float3(0.0, 0.0, -1.0), payload=result)
    params.indices[i] = result.a + uint32(result.b) + uint32(result.c.x + result.c.y + result.c.z)


@ox.program
def __closesthit__data(result: Result, data: Data):
    result.a = data.a
    result.b = data.b
    result.c = data.c


@ox.program
def __closesthit__get_sbt_data(result: Result):
    data = ox.get_sbt_data(Data)
    result.a = data.a
    result.b = data.b
    result.c = data.c


@ox.program
def __miss__nothing(result: Result):
    result.a = 1000000
