"""One triangle, coloured by its barycentric coordinates, in front of a plain background."""

import optixc as ox
from optixc import float3, float4


@ox.struct
class Params:
    """Launch parameters; `u`, `v` and `w` span the image plane: its half width, half height and distance from the eye."""

    image: ox.Array2[float4]
    scene: ox.Traversable
    eye: float3
    u: float3
    v: float3
    w: float3


@ox.struct
class Background:
    """The data of the miss program's SBT record."""

    color: float3


@ox.payload
class Radiance:
    """What a ray carries and brings back."""

    color: float3


params = ox.launch_params(Params)


@ox.program
def __raygen__pinhole():
    """One ray through the centre of each pixel."""
    i, size = ox.get_launch_index(), ox.get_launch_dimensions()
    x = 2.0 * (float(i.x) + 0.5) / float(size.x) - 1.0
    y = 1.0 - 2.0 * (float(i.y) + 0.5) / float(size.y)
    ray = Radiance(float3(0.0))
    ox.trace(params.scene, params.eye, ox.normalize(x * params.u + y * params.v + params.w), tmin=0.0, tmax=1e16, payload=ray)
    params.image[i.y, i.x] = float4(ray.color, 1.0)


@ox.program
def __closesthit__barycentrics(ray: Radiance):
    """Each corner has a colour of its own: red, green, blue."""
    uv = ox.get_triangle_barycentrics()
    ray.color = float3(1.0 - uv.x - uv.y, uv.x, uv.y)


@ox.program
def __miss__background(ray: Radiance, background: Background):
    ray.color = background.color
