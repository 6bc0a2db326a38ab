"""The pinhole camera of every benchmark, and which pixel a launch index is."""

import optixc as ox
from optixc import float2, float3, uint2, uint3


@ox.struct
class Camera:
    """`u`, `v`, `w` span the image plane; `pixel` is 2 over the size of the whole image; `skip` rows are left out after every 16."""

    eye: float3
    u: float3
    v: float3
    w: float3
    pixel: float2
    skip: ox.uint32


@ox.device
def pixel_of(camera: Camera, index: uint3) -> uint2:
    """The pixel of the whole image: a launch may cover strips of 16 rows, which keeps the coherence of neighbouring rays."""
    return uint2(index.x, index.y + (index.y // 16) * camera.skip)


@ox.device
def camera_direction(camera: Camera, pixel: uint2) -> float3:
    """The unit direction through the centre of `pixel`."""
    x = camera.pixel.x * (float(pixel.x) + 0.5) - 1.0
    y = 1.0 - camera.pixel.y * (float(pixel.y) + 0.5)
    return ox.normalize(x * camera.u + y * camera.v + camera.w)
