"""Rays given one by one: what each hits, and where."""

import optixc as ox
from optixc import Array, Traversable, float3, int32


@ox.struct
class Params:
    scene: Traversable
    origins: Array[float3]
    directions: Array[float3]
    primitives: Array[int32]
    instances: Array[int32]
    distances: Array[float]


@ox.payload
class Index:
    i: int32


params = ox.launch_params(Params)


@ox.program
def __raygen__each():
    i = int32(ox.get_launch_index().x)
    index = Index(i)
    ox.trace(params.scene, params.origins[i], params.directions[i], payload=index)


@ox.program
def __closesthit__note(index: Index):
    params.primitives[index.i] = int32(ox.get_primitive_index())
    params.instances[index.i] = int32(ox.get_instance_index())
    params.distances[index.i] = ox.get_ray_tmax()


@ox.program
def __miss__note(index: Index):
    params.primitives[index.i] = -1
