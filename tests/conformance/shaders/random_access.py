"""Corners of triangles and motion of their structure by handle, from a ray generation program."""

import optixc as ox
from optixc import Array, Array2, Traversable, uint32


@ox.struct
class Query:
    gas: Traversable
    primitive: uint32
    gas_index: uint32
    time: float


@ox.struct
class Params:
    queries: Array[Query]
    corners: Array2[float]
    motion: Array2[float]


params = ox.launch_params(Params)


@ox.program
def __raygen__corners():
    i = ox.get_launch_index().x
    query = params.queries[i]
    a, b, c = ox.get_triangle_vertex_data_from_handle(query.gas, query.primitive, query.gas_index, query.time)
    params.corners[i, 0] = a.x
    params.corners[i, 1] = a.y
    params.corners[i, 2] = a.z
    params.corners[i, 3] = b.x
    params.corners[i, 4] = b.y
    params.corners[i, 5] = b.z
    params.corners[i, 6] = c.x
    params.corners[i, 7] = c.y
    params.corners[i, 8] = c.z
    params.motion[i, 0] = ox.get_gas_motion_time_begin(query.gas)
    params.motion[i, 1] = ox.get_gas_motion_time_end(query.gas)
    params.motion[i, 2] = float(ox.get_gas_motion_step_count(query.gas))
