"""Reads and writes arrays of parameters, of structs inside, of arrays of structs and of records; asks others for their shape only."""

import optixc as ox
from optixc import Array, Array2, FixedArray, Traversable


@ox.struct
class Material:
    texels: Array[float]
    scale: float


@ox.struct
class Inner:
    weights: Array[float]
    unused: Array[float]


@ox.struct
class Params:
    out: Array[float]
    source: Array2[float]
    inner: Inner
    materials: Array[Material]
    pair: FixedArray[Material, 2]
    optional: Array[float]
    scene: Traversable


@ox.struct
class Data:
    table: Array[float]
    unused: Array[float]


@ox.payload
class Ray:
    value: float


params = ox.launch_params(Params)


@ox.program
def __raygen__read(data: Data):
    i = ox.get_launch_index().x
    total = params.source[0, i] * params.inner.weights[i] + params.materials[1].texels[i] + params.pair[1].texels[i] + data.table[i]
    for j in range(params.optional.shape[0]):
        total += params.optional[j]
    params.out[i] = total


@ox.program
def __raygen__trace():
    ray = Ray(7.0)
    ox.trace(params.scene, ox.float3(0.2, 0.2, 1.0), ox.float3(0.0, 0.0, -1.0), payload=ray)
    params.out[ox.get_launch_index().x] = ray.value


@ox.program
def __miss__missed(ray: Ray):
    ray.value = -1.0


@ox.program
def __closesthit__hit(ray: Ray, data: Data):
    ray.value = data.table[0]
