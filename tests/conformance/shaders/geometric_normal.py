"""Notes the geometric normal that closest-hit and any-hit programs see, beside what it should be along."""

import optixc as ox
from optixc import float3, float4


@ox.struct
class Params:
    """`found[i]`: the normal at the hit, in any-hit, and the expected one; w of the first is 1 + the primitive type, 0 for a miss."""

    found: ox.Array2[float4]
    origins: ox.Array[float3]
    directions: ox.Array[float3]
    scene: ox.Traversable


@ox.payload
class Normals:
    at_hit: float4
    in_anyhit: float4
    expected: float4


params = ox.launch_params(Params)


@ox.program
def __raygen__shoot():
    i = ox.get_launch_index().x
    normals = Normals(float4(0.0), float4(0.0), float4(0.0))
    ox.trace(params.scene, params.origins[i], params.directions[i], tmin=0.0, tmax=1e16, payload=normals)
    params.found[i, 0] = normals.at_hit
    params.found[i, 1] = normals.in_anyhit
    params.found[i, 2] = normals.expected


@ox.program
def __anyhit__note(normals: Normals):
    normals.in_anyhit = float4(ox.get_geometric_normal(), ox.get_ray_tmax())


@ox.program
def __closesthit__note(normals: Normals):
    kind = ox.get_primitive_type()
    normals.at_hit = float4(ox.get_geometric_normal(), 1.0 + float(kind))
    if kind == ox.PrimitiveType.TRIANGLE:
        a, b, c = ox.get_triangle_vertex_data()
        normals.expected = float4(ox.cross(b - a, c - a), ox.get_ray_tmax())
    elif kind == ox.PrimitiveType.SPHERE:
        point = ox.get_world_ray_origin() + ox.get_ray_tmax() * ox.get_world_ray_direction()
        inside = ox.transform_point_from_world_to_object_space(point)
        normals.expected = float4(inside - ox.get_sphere_data().xyz, ox.get_ray_tmax())
    else:
        normals.expected = float4(float3(0.0), ox.get_ray_tmax())


@ox.program
def __intersection__box():
    """Met where the ray enters the box's bottom, wherever that is."""
    ox.report_intersection(-ox.get_object_ray_origin().z / ox.get_object_ray_direction().z, 0)
