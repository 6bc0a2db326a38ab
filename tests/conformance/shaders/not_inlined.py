"""Helpers that stay functions of their own: pure, with state of the launch, with a struct, called by each other and by all programs."""

import optixc as ox
from optixc import Array, float3, uint32


@ox.struct
class Params:
    scene: ox.Traversable
    out: Array[float]
    hits: Array[uint32]


@ox.struct
class Sum:
    total: float
    count: int


@ox.payload
class Ray:
    value: float


params = ox.launch_params(Params)


@ox.device
def __optix_enabled__square(x: float) -> float:
    return x * x


@ox.device
def __optix_enabled__add(sum: Sum, x: float):
    sum.total += __optix_enabled__square(x)
    sum.count += 1


@ox.device
def __optix_enabled__column() -> float:
    return float(ox.get_launch_index().x)


@ox.device
def __optix_enabled__blocked(x: float) -> bool:
    """Direct callables may traverse."""
    ray = Ray(0.0)
    ox.traverse(params.scene, float3(x, 0.2, 1.0), float3(0.0, 0.0, -1.0), payload=ray)
    found = ox.hit_object_is_hit()
    if found:
        ox.atomic_add(params.hits, 0, uint32(1))
    return found


@ox.program
def __raygen__r():
    i = ox.get_launch_index().x
    sum = Sum(0.0, 0)
    for step in range(int(i) % 5):
        __optix_enabled__add(sum, float(step))
    ray = Ray(1.0)
    ox.trace(params.scene, float3(0.05 * __optix_enabled__column(), 0.2, 1.0), float3(0.0, 0.0, -1.0), payload=ray)
    blocked = __optix_enabled__blocked(0.05 * float(i))
    params.out[i] = sum.total + 100.0 * float(sum.count) + 1000.0 * ray.value + (0.5 if blocked else 0.0)


@ox.program
def __closesthit__c(ray: Ray):
    ray.value = __optix_enabled__square(2.0) + __optix_enabled__column()


@ox.program
def __miss__m(ray: Ray):
    sum = Sum(0.0, 0)
    __optix_enabled__add(sum, 3.0)
    ray.value = sum.total
