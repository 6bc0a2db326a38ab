"""Programs of the optional tests: recursion without device functions, a word that only miss programs read, a hit of an earlier launch."""

import optixc as ox
from optixc import FixedArray, Traversable, float3, uint32


@ox.struct
class Params:
    scene: ox.Traversable
    out: ox.Array[uint32]
    saved: ox.Array[ox.TraverseData]


@ox.payload
class Ray:
    kept: uint32 = ox.payload_word(caller="rw", ms="r")
    seen: uint32 = ox.payload_word(caller="rw", ms="w", ch="w")


params = ox.launch_params(Params)


@ox.device
def fibonacci(n: int) -> int:
    if n < 2:
        return n
    return fibonacci(n - 1) + fibonacci(n - 2)


@ox.device
def origin(index: uint32) -> float3:
    return float3(0.1 * float(index), 0.1, 1.0)


@ox.program
def __raygen__recursive():
    index = ox.get_launch_index().x
    params.out[index] = uint32(fibonacci(int(index)))


@ox.program
def __raygen__kept():
    index = ox.get_launch_index().x
    ray = Ray(1000 + index, 0)
    ox.traverse(params.scene, origin(index), float3(0.0, 0.0, -1.0), payload=ray)
    between = ray.kept
    ray.kept += 1
    ox.invoke(ray)
    params.out[index] = ray.seen + 10000 * (between - 1000)


@ox.program
def __raygen__save():
    index = ox.get_launch_index().x
    ray = Ray(0, 0)
    ox.traverse(params.scene, origin(index), float3(0.0, 0.0, -1.0), payload=ray)
    if ox.hit_object_is_hit():
        params.saved[index] = ox.hit_object_get_traverse_data()
        params.out[index] = 1


@ox.program
def __raygen__restore():
    index = ox.get_launch_index().x
    ray = Ray(0, 0)
    if params.out[index] == 1:
        transforms = FixedArray[Traversable, 1]()
        ox.make_hit_object(
            params.scene, origin(index), float3(0.0, 0.0, -1.0), 0.0, 0.0, uint32(0), params.saved[index], transforms, 0
        )
        ox.invoke(ray)
    params.out[index] = ray.seen


@ox.program
def __miss__tells(ray: Ray):
    ray.seen = ray.kept


@ox.program
def __closesthit__tells(ray: Ray):
    uv = ox.get_triangle_barycentrics()
    ray.seen = uint32(ox.round(100.0 * uv.x)) + 1000 * ox.get_primitive_index()
