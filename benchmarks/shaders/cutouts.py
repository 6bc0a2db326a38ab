"""Leaves as quads with an alpha texture: an any-hit program lets rays through where the leaf is not, for primary and for shadow rays."""

from camera import Camera, camera_direction, pixel_of
from sampling import facing

import optixc as ox
from optixc import float2, float3, float4, uint3


@ox.struct
class Params:
    image: ox.Array2[float4]
    scene: ox.Traversable
    camera: Camera
    sun: float3
    sky: float3
    offset: float


@ox.struct
class Leaves:
    """Record data: texture coordinates per vertex and the texture."""

    triangles: ox.Array[uint3]
    uvs: ox.Array[float2]
    texels: ox.Array2[ox.uchar4]


@ox.payload
class Color:
    value: float3


@ox.payload
class Visibility:
    value: float


params = ox.launch_params(Params)


@ox.program
def __raygen__cutouts():
    index = ox.get_launch_index()
    direction = camera_direction(params.camera, pixel_of(params.camera, index))
    color = Color(float3(0.0))
    ox.trace(params.scene, params.camera.eye, direction, tmin=0.0, tmax=1e16, sbt_stride=2, payload=color)
    params.image[index.y, index.x] = float4(color.value, 1.0)


@ox.device
def texel(leaves: Leaves) -> ox.uint4:
    """The nearest texel at the hit."""
    corners = leaves.triangles[ox.get_primitive_index()]
    weights = ox.get_triangle_barycentrics()
    uv0 = leaves.uvs[corners.x]
    uv1 = leaves.uvs[corners.y]
    uv2 = leaves.uvs[corners.z]
    uv = (1.0 - weights.x - weights.y) * uv0 + weights.x * uv1 + weights.y * uv2
    height, width = leaves.texels.shape
    column = ox.clamp(int(uv.x * float(width)), 0, width - 1)
    row = ox.clamp(int(uv.y * float(height)), 0, height - 1)
    return leaves.texels[row, column]


@ox.program
def __closesthit__leaf(color: Color, leaves: Leaves):
    rgba = texel(leaves)
    albedo = float3(float(rgba.x), float(rgba.y), float(rgba.z)) * (1.0 / 255.0)
    direction = ox.get_world_ray_direction()
    n = facing(ox.normalize(ox.get_geometric_normal()), direction)
    cosine = ox.dot(n, params.sun)
    visibility = Visibility(0.0)
    if cosine > 0.0:
        ox.trace(
            params.scene,
            ox.get_world_ray_origin() + ox.get_ray_tmax() * direction + params.offset * n,
            params.sun,
            tmin=0.0,
            tmax=1e16,
            ray_flags=ox.RayFlags.TERMINATE_ON_FIRST_HIT | ox.RayFlags.DISABLE_CLOSESTHIT,
            sbt_offset=1,
            sbt_stride=2,
            miss_sbt_index=1,
            payload=visibility,
        )
    color.value = albedo * (0.3 + 0.7 * cosine * visibility.value)


@ox.program
def __anyhit__alpha(leaves: Leaves):
    if texel(leaves).w < 128:
        ox.ignore_intersection()


@ox.program
def __miss__sky(color: Color):
    color.value = params.sky


@ox.program
def __miss__visible(visibility: Visibility):
    visibility.value = 1.0
