"""Primary rays, coloured by the interpolated vertex normal."""

from camera import Camera, camera_direction, pixel_of

import optixc as ox
from optixc import float3, float4, uint3


@ox.struct
class Params:
    image: ox.Array2[float4]
    scene: ox.Traversable
    camera: Camera


@ox.struct
class Mesh:
    """Record data: vertex indices and normals."""

    triangles: ox.Array[uint3]
    normals: ox.Array[float3]


@ox.payload
class Color:
    value: float3


params = ox.launch_params(Params)


@ox.program
def __raygen__primary():
    index = ox.get_launch_index()
    direction = camera_direction(params.camera, pixel_of(params.camera, index))
    color = Color(float3(0.0))
    ox.trace(params.scene, params.camera.eye, direction, tmin=0.0, tmax=1e16, ray_flags=ox.RayFlags.DISABLE_ANYHIT, payload=color)
    params.image[index.y, index.x] = float4(color.value, 1.0)


@ox.program
def __closesthit__normal(color: Color, mesh: Mesh):
    corners = mesh.triangles[ox.get_primitive_index()]
    weights = ox.get_triangle_barycentrics()
    n0 = mesh.normals[corners.x]
    n1 = mesh.normals[corners.y]
    n2 = mesh.normals[corners.z]
    n = ox.normalize((1.0 - weights.x - weights.y) * n0 + weights.x * n1 + weights.y * n2)
    color.value = 0.5 * n + float3(0.5)


@ox.program
def __miss__black(color: Color):
    color.value = float3(0.0)
