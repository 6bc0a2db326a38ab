"""Primary rays against curves or spheres: the distance, and which primitive it was."""

from camera import Camera, camera_direction, pixel_of

import optixc as ox
from optixc import float3, float4, uint32


@ox.struct
class Params:
    image: ox.Array2[float4]
    scene: ox.Traversable
    camera: Camera


@ox.payload
class Found:
    value: float3


params = ox.launch_params(Params)


@ox.program
def __raygen__shapes():
    index = ox.get_launch_index()
    direction = camera_direction(params.camera, pixel_of(params.camera, index))
    found = Found(float3(0.0))
    ox.trace(params.scene, params.camera.eye, direction, tmin=0.0, tmax=1e16, ray_flags=ox.RayFlags.DISABLE_ANYHIT, payload=found)
    params.image[index.y, index.x] = float4(found.value, 1.0)


@ox.program
def __closesthit__shape(found: Found):
    number = ox.get_primitive_index()
    found.value = float3(ox.get_ray_tmax(), float(number & uint32(255)), float((number >> 8) & uint32(255)))


@ox.program
def __miss__nothing(found: Found):
    found.value = float3(0.0)
