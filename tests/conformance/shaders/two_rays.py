"""Two ray types over materials: what test_sbt_check.py lays out."""

import optixc as ox
from optixc import float3


@ox.struct
class Params:
    out: ox.Array[float]
    scene: ox.Traversable
    x: float


@ox.struct
class Shade:
    value: float


@ox.payload
class Radiance:
    value: float


@ox.payload
class Shadow:
    light: float
    spare: float


params = ox.launch_params(Params)


@ox.program
def __raygen__both():
    i = ox.get_launch_index().x
    ray = Radiance(0.0)
    origin = float3(0.25 + 2.0 * float(i), 0.25, 1.0)
    ox.trace(params.scene, origin, float3(0.0, 0.0, -1.0), sbt_offset=0, sbt_stride=2, miss_sbt_index=0, payload=ray)
    shadow = Shadow(0.0, 0.0)
    ox.trace(params.scene, origin, float3(0.0, 0.0, -1.0), sbt_offset=1, sbt_stride=2, miss_sbt_index=1, payload=shadow)
    params.out[i] = ray.value + shadow.light


@ox.program
def __closesthit__shade(ray: Radiance, shade: Shade):
    ray.value = shade.value


@ox.program
def __closesthit__shadow(ray: Shadow, shade: Shade):
    ray.light = 1000.0 * shade.value


@ox.program
def __intersection__box():
    ox.report_intersection(0.5, 0)


@ox.program
def __miss__radiance(ray: Radiance):
    ray.value = -1.0


@ox.program
def __miss__shadow(ray: Shadow):
    ray.light = -1000.0
