"""Control points of curves and ribbons and the normals of ribbons by handle, from a ray generation program."""

import optixc as ox
from optixc import Array, Array2, Traversable, uint32


@ox.struct
class Query:
    gas: Traversable
    primitive: uint32
    u: float
    v: float
    is_ribbon: uint32


@ox.struct
class Params:
    queries: Array[Query]
    points: Array2[float]
    normals: Array2[float]


params = ox.launch_params(Params)


@ox.program
def __raygen__points():
    i = ox.get_launch_index().x
    query = params.queries[i]
    a, b, c, d = ox.get_cubic_bspline_vertex_data_from_handle(query.gas, query.primitive, 0, 0.0)
    if query.is_ribbon != 0:
        a, b, c = ox.get_ribbon_vertex_data_from_handle(query.gas, query.primitive, 0, 0.0)
        n = ox.get_ribbon_normal_from_handle(query.gas, query.primitive, 0, 0.0, ox.float2(query.u, query.v))
        params.normals[i, 0] = n.x
        params.normals[i, 1] = n.y
        params.normals[i, 2] = n.z
    params.points[i, 0] = a.x
    params.points[i, 1] = a.y
    params.points[i, 2] = a.z
    params.points[i, 3] = a.w
    params.points[i, 4] = b.x
    params.points[i, 5] = b.y
    params.points[i, 6] = b.z
    params.points[i, 7] = b.w
    params.points[i, 8] = c.x
    params.points[i, 9] = c.y
    params.points[i, 10] = c.z
    params.points[i, 11] = c.w
    params.points[i, 12] = d.x
    params.points[i, 13] = d.y
    params.points[i, 14] = d.z
    params.points[i, 15] = d.w
