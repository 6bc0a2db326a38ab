"""Rays from a camera, and rays from everywhere to everywhere, that only ask how far the scene is."""

import optixc as ox
from optixc import Array2, Traversable, float3, uint32


@ox.struct
class Params:
    image: Array2[float]
    scene: Traversable
    eye: float3
    reach: float
    time: float


@ox.payload
class Distance:
    t: float


params = ox.launch_params(Params)


@ox.device
def mixed(x: uint32) -> uint32:
    word = ((x >> ((x >> uint32(28)) + uint32(4))) ^ x) * uint32(277803737)
    return (word >> uint32(22)) ^ word


@ox.program
def __raygen__coherent():
    i, size = ox.get_launch_index(), ox.get_launch_dimensions()
    x = 2.0 * (float(i.x) + 0.5) / float(size.x) - 1.0
    y = 1.0 - 2.0 * (float(i.y) + 0.5) / float(size.y)
    ray = Distance(0.0)
    ox.trace(params.scene, params.eye, ox.normalize(float3(x, y, -2.0)), ray_time=params.time, payload=ray)
    params.image[i.y, i.x] = ray.t


@ox.program
def __raygen__incoherent():
    i, size = ox.get_launch_index(), ox.get_launch_dimensions()
    a = mixed((i.y * size.x + i.x) * uint32(747796405) + uint32(2891336453))
    b = mixed(a * uint32(747796405) + uint32(2891336453))
    angle = 6.2831853 * float(a & uint32(0xFFFF)) / 65536.0
    z = 2.0 * float(a >> uint32(16)) / 65536.0 - 1.0
    radius = ox.sqrt(max(0.0, 1.0 - z * z))
    direction = float3(radius * ox.cos(angle), radius * ox.sin(angle), z)
    origin = float3(float(b & uint32(1023)), float((b >> uint32(10)) & uint32(1023)), float((b >> uint32(20)) & uint32(1023)))
    ray = Distance(0.0)
    ox.trace(params.scene, params.reach * (origin / 512.0 - 1.0), direction, ray_time=params.time, payload=ray)
    params.image[i.y, i.x] = ray.t


@ox.program
def __closesthit__distance(ray: Distance):
    ray.t = ox.get_ray_tmax()


@ox.program
def __miss__nothing(ray: Distance):
    ray.t = -1.0


@ox.program
def __intersection__nothing():
    """Every box along the ray is looked at."""
