"""Leaves as quads with a filtered alpha texture: primary rays and a shadow ray each; `counting` lets any-hit programs count their runs."""

from camera import Camera, camera_direction, pixel_of
from sampling import facing

import optixc as ox
from optixc import float2, float3, float4, uint3, uint64


@ox.struct
class Params:
    image: ox.Array2[float4]
    scene: ox.Traversable
    camera: Camera
    sun: float3
    offset: float
    runs: ox.Array[uint64]
    counting: bool


@ox.struct
class Leaves:
    triangles: ox.Array[uint3]
    uvs: ox.Array[float2]
    picture: ox.Texture


@ox.payload
class Color:
    value: float3


@ox.payload
class Visibility:
    value: float


params = ox.launch_params(Params)


@ox.program
def __raygen__micromaps():
    index = ox.get_launch_index()
    direction = camera_direction(params.camera, pixel_of(params.camera, index))
    color = Color(float3(0.0))
    ox.trace(params.scene, params.camera.eye, direction, tmax=1e16, payload=color)
    params.image[index.y, index.x] = float4(color.value, 1.0)


@ox.device
def texel(leaves: Leaves) -> float4:
    """The filtered picture at the hit."""
    corners = leaves.triangles[ox.get_primitive_index()]
    weights = ox.get_triangle_barycentrics()
    place = (1.0 - weights.x - weights.y) * leaves.uvs[corners.x] + weights.x * leaves.uvs[corners.y] + weights.y * leaves.uvs[corners.z]
    return ox.tex2d(leaves.picture, place.x, place.y)


@ox.program
def __closesthit__leaf(color: Color, leaves: Leaves):
    direction = ox.get_world_ray_direction()
    p0, p1, p2 = ox.get_triangle_vertex_data()
    n = facing(ox.normalize(ox.cross(p1 - p0, p2 - p0)), direction)
    cosine = ox.dot(n, params.sun)
    visibility = Visibility(0.0)
    if cosine > 0.0:
        ox.trace(
            params.scene,
            ox.get_world_ray_origin() + ox.get_ray_tmax() * direction + params.offset * n,
            params.sun,
            tmax=1e16,
            ray_flags=ox.RayFlags.TERMINATE_ON_FIRST_HIT | ox.RayFlags.DISABLE_CLOSESTHIT,
            miss_sbt_index=1,
            payload=visibility,
        )
    color.value = texel(leaves).xyz * (0.3 + 0.7 * cosine * visibility.value)


@ox.program
def __anyhit__alpha(leaves: Leaves):
    if params.counting:
        ox.atomic_add(params.runs, 0, uint64(1))
    if texel(leaves).w < 0.5:
        ox.ignore_intersection()


@ox.program
def __miss__sky(color: Color):
    color.value = float3(0.5, 0.7, 1.0)


@ox.program
def __miss__visible(visibility: Visibility):
    visibility.value = 1.0
