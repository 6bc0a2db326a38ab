"""Shades any triangle mesh: smooth normals, base colours per vertex, one sun with shadows, light from the sky."""

import optixc as ox
from optixc import float2, float3, float4, uint3
from optixc.stdlib.random import sobol_owen_2d
from optixc.stdlib.self_intersection import offset_ray_origin

RADIANCE_MISS = 0
SHADOW_MISS = 1


@ox.struct
class Params:
    """A launch adds number `sample` of `samples` rays through each pixel; the sun's direction points towards it."""

    image: ox.Array2[float4]
    scene: ox.Traversable
    eye: float3
    u: float3
    v: float3
    w: float3
    sun_direction: float3
    sun_color: float3
    sample: int
    samples: int


@ox.struct
class Mesh:
    """Vertex data in object space, indexed like the triangles of the acceleration structure."""

    indices: ox.Array[uint3]
    normals: ox.Array[float3]
    colors: ox.Array[float3]


@ox.payload
class Radiance:
    color: float3


@ox.payload
class Shadow:
    """1 where nothing stands between the point and the sun."""

    visible: float


params = ox.launch_params(Params)


@ox.device
def sky(direction: float3) -> float3:
    """A pale horizon below a blue zenith; the ground is grey-brown."""
    up = direction.y
    if up < 0.0:
        return ox.lerp(float3(0.80, 0.82, 0.84), float3(0.30, 0.27, 0.25), ox.min(1.0, -3.0 * up))
    return ox.lerp(float3(0.80, 0.82, 0.84), float3(0.25, 0.45, 0.80), ox.sqrt(up))


@ox.device
def sun_visibility(point: float3) -> float:
    """1 or 0: an occlusion ray needs no closest-hit program, so the first hit ends it."""
    shadow = Shadow(0.0)
    ox.trace(
        params.scene,
        point,
        params.sun_direction,
        ray_flags=ox.RayFlags.TERMINATE_ON_FIRST_HIT | ox.RayFlags.DISABLE_CLOSESTHIT,
        miss_sbt_index=SHADOW_MISS,
        payload=shadow,
    )
    return shadow.visible


@ox.program
def __raygen__pinhole():
    i, size = ox.get_launch_index(), ox.get_launch_dimensions()
    jitter = sobol_owen_2d(ox.uint32(params.sample), i.y * size.x + i.x)
    x = 2.0 * (float(i.x) + jitter.x) / float(size.x) - 1.0
    y = 1.0 - 2.0 * (float(i.y) + jitter.y) / float(size.y)
    ray = Radiance(float3(0.0))
    ox.trace(params.scene, params.eye, ox.normalize(x * params.u + y * params.v + params.w), payload=ray)
    params.image[i.y, i.x] += float4(ray.color, 1.0) / float(params.samples)


@ox.device
def interpolate(a: float3, b: float3, c: float3, uv: float2) -> float3:
    """The value at barycentric coordinates `uv`, which weigh the second and third corner."""
    return (1.0 - uv.x - uv.y) * a + uv.x * b + uv.y * c


@ox.program
def __closesthit__mesh(ray: Radiance, mesh: Mesh):
    # Geometric normal, turned towards the viewer
    p0, p1, p2 = ox.get_triangle_vertex_data()
    direction = ox.get_world_ray_direction()
    geometric = ox.normalize(ox.transform_normal_from_object_to_world_space(ox.cross(p1 - p0, p2 - p0)))
    if ox.dot(geometric, direction) > 0.0:
        geometric = -geometric

    # Smooth normal and colour from the mesh's arrays
    triangle = mesh.indices[ox.get_primitive_index()]
    uv = ox.get_triangle_barycentrics()
    smooth = interpolate(mesh.normals[triangle.x], mesh.normals[triangle.y], mesh.normals[triangle.z], uv)
    n = ox.normalize(ox.transform_normal_from_object_to_world_space(smooth))
    if ox.dot(n, geometric) < 0.0:
        n = -n
    albedo = interpolate(mesh.colors[triangle.x], mesh.colors[triangle.y], mesh.colors[triangle.z], uv)

    # Sun with shadow; the sky's light as a hemisphere
    point = ox.transform_point_from_object_to_world_space(interpolate(p0, p1, p2, uv))
    light = ox.lerp(float3(0.10, 0.09, 0.08), float3(0.26, 0.30, 0.36), 0.5 + 0.5 * n.y)
    cosine = ox.dot(n, params.sun_direction)
    if cosine > 0.0 and ox.dot(geometric, params.sun_direction) > 0.0:
        light += cosine * sun_visibility(offset_ray_origin(point, geometric)) * params.sun_color
    ray.color = albedo * light


@ox.program
def __miss__sky(ray: Radiance):
    ray.color = sky(ox.get_world_ray_direction())


@ox.program
def __miss__sun(shadow: Shadow):
    shadow.visible = 1.0
