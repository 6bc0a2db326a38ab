"""A first picture: one ray per pixel, one closest-hit program, one miss program."""

import optixc as ox
from optixc import float3, float4


@ox.struct
class Params:
    image: ox.Array2[float4]
    scene: ox.Traversable
    eye: float3
    u: float3
    v: float3
    w: float3


@ox.struct
class Material:
    albedo: float3


@ox.payload
class Radiance:
    color: float3


params = ox.launch_params(Params)


@ox.program
def __raygen__pinhole():
    i, size = ox.get_launch_index(), ox.get_launch_dimensions()
    x = 2.0 * (float(i.x) + 0.5) / float(size.x) - 1.0
    y = 1.0 - 2.0 * (float(i.y) + 0.5) / float(size.y)
    ray = Radiance(float3(0.0))
    direction = ox.normalize(x * params.u + y * params.v + params.w)
    ox.trace(params.scene, params.eye, direction, tmin=0.0, tmax=1e16, payload=ray)
    params.image[i.y, i.x] = float4(ray.color, 1.0)


@ox.program
def __closesthit__matte(ray: Radiance, material: Material):
    """Brighter where the surface faces the ray."""
    p0, p1, p2 = ox.get_triangle_vertex_data()
    n = ox.transform_normal_from_object_to_world_space(ox.cross(p1 - p0, p2 - p0))
    ray.color = material.albedo * abs(ox.dot(ox.normalize(n), ox.get_world_ray_direction()))


@ox.program
def __miss__sky(ray: Radiance):
    ray.color = float3(0.5, 0.7, 1.0)
