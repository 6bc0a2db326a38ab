"""Custom primitives: reports with attributes as a struct and as words, from a program and from a helper."""

import optixc as ox
from optixc import float3, float_as_uint


@ox.struct
class Params:
    depth: ox.Array[ox.float32]
    scene: ox.Traversable


@ox.struct
class Sphere:
    center: float3
    radius: float


@ox.attributes
class SpherePoint:
    normal: float3


@ox.payload
class Distance:
    t: float
    back: bool


params = ox.launch_params(Params)


@ox.device
def report_root(t: float, center: float3) -> bool:
    n = ox.normalize(ox.get_object_ray_origin() + t * ox.get_object_ray_direction() - center)
    return ox.report_intersection(t, 1, SpherePoint(n))


@ox.program
def __raygen__depth():
    i = ox.get_launch_index()
    found = Distance(-1.0, False)
    ox.trace(params.scene, float3(float(i.x), float(i.y), -10.0), float3(0.0, 0.0, 1.0), payload=found)
    params.depth[i.x] = -found.t if found.back else found.t


@ox.program
def __intersection__sphere(sphere: Sphere):
    o = ox.get_object_ray_origin() - sphere.center
    d = ox.get_object_ray_direction()
    a, b = ox.dot(d, d), ox.dot(o, d)
    discriminant = b * b - a * (ox.dot(o, o) - sphere.radius * sphere.radius)
    if discriminant >= 0.0:
        root = ox.sqrt(discriminant)
        if not report_root((-b - root) / a, sphere.center):
            ox.report_intersection((-b + root) / a, 2, float_as_uint(root), 7)


@ox.program
def __closesthit__sphere(found: Distance, point: SpherePoint):
    found.t = ox.get_ray_tmax()
    found.back = ox.get_hit_kind() == 2 or point.normal.z > 0.0
