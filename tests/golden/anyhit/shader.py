"""Cut-outs and attenuation: any-hit programs end in three ways, also out of a helper; ray flags that are not constant."""

import optixc as ox
from optixc import float3, uint32


@ox.struct
class Params:
    light: ox.Array[float3]
    scene: ox.Traversable
    flags: uint32


@ox.struct
class Glass:
    tint: float3
    opacity: float


@ox.payload
class Shadow:
    light: float3
    hits: ox.int32


params = ox.launch_params(Params)


@ox.device
def stop_if_dark(shadow: Shadow):
    if shadow.light.x < 0.01:
        ox.terminate_ray()


@ox.program
def __raygen__lights():
    i = ox.get_launch_index().x
    shadow = Shadow(float3(1.0), 0)
    ox.trace(params.scene, params.light[i], float3(0.0, 1.0, 0.0), ray_flags=params.flags, payload=shadow)
    ox.trace(
        params.scene,
        params.light[i],
        float3(0.0, 0.0, 1.0),
        ray_flags=ox.RayFlags.TERMINATE_ON_FIRST_HIT | ox.RayFlags.DISABLE_CLOSESTHIT,
        sbt_offset=1,
        payload=shadow,
    )
    params.light[i] = shadow.light


@ox.program
def __anyhit__glass(shadow: Shadow, glass: Glass):
    shadow.hits += 1
    uv = ox.get_triangle_barycentrics()
    if uv.x + uv.y < glass.opacity:
        ox.ignore_intersection()
    shadow.light *= glass.tint
    stop_if_dark(shadow)
    if ox.is_front_face_hit():
        ox.ignore_intersection()


@ox.program
def __miss__dark(shadow: Shadow):
    shadow.light = float3(0.0)
