import optixc as ox
from optixc import float3


@ox.struct
class Params:
    scene: ox.Traversable


@ox.struct
class Data:
    x: float


@ox.payload
class Ray:
    x: float


params = ox.launch_params(Params)


@ox.device
def shoot():
    ray = Ray(1.0)
    ox.trace(params.scene, float3(0.0), float3(1.0), payload=ray)  # E[OX304]: trace() is not allowed in `__optix_enabled__far`, which is not inlined `__optix_enabled__` functions may do what direct callables do


@ox.device
def __optix_enabled__far():
    shoot()


@ox.device
def __optix_enabled__data() -> float:
    return ox.get_sbt_data(Data).x  # E[OX304]: get_sbt_data() is not allowed in `__optix_enabled__data`, which is not inlined `__optix_enabled__` functions may do


@ox.device
def __optix_enabled__index() -> int:
    return int(ox.get_launch_index().x)


@ox.program
def __raygen__r():
    __optix_enabled__far()
    shoot()
    print(__optix_enabled__data(), __optix_enabled__index())


@ox.program
def __exception__e():
    print(__optix_enabled__index())  # E[OX304]: an exception program cannot call `__optix_enabled__index`, which is not inlined call a helper without the prefix
