"""Given rays against one kind of primitive: distance, parameters and normal of each hit."""

import optixc as ox
from optixc import float2, float3, float4


@ox.struct
class Params:
    origins: ox.Array[float3]
    directions: ox.Array[float3]
    hits: ox.Array[float4]
    normals: ox.Array[float4]
    scene: ox.Traversable


@ox.payload
class Found:
    hit: float4
    normal: float3


params = ox.launch_params(Params)


@ox.program
def __raygen__accuracy():
    i = ox.get_launch_index().x
    found = Found(float4(0.0), float3(0.0))
    ox.trace(params.scene, params.origins[i], params.directions[i], tmax=1e30, ray_flags=ox.RayFlags.DISABLE_ANYHIT, payload=found)
    params.hits[i] = found.hit
    params.normals[i] = float4(found.normal, 0.0)


@ox.device
def note(found: Found, parameters: float2):
    found.hit = float4(1.0, ox.get_ray_tmax(), parameters.x, parameters.y)
    found.normal = ox.get_geometric_normal()


@ox.program
def __closesthit__triangles(found: Found):
    note(found, ox.get_triangle_barycentrics())


@ox.program
def __closesthit__spheres(found: Found):
    note(found, float2(0.0))


@ox.program
def __closesthit__curves(found: Found):
    note(found, float2(ox.get_curve_parameter(), 0.0))


@ox.program
def __closesthit__ribbons(found: Found):
    note(found, ox.get_ribbon_parameters())


@ox.program
def __miss__nothing(found: Found):
    found.hit.x = 0.0
