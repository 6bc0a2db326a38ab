"""What handles of transforms and structures lead to, asked from a ray generation program: keys, options, addresses, corners."""

import optixc as ox
from optixc import Array, Array2, Traversable, float3, uint32, uint64


@ox.struct
class Query:
    handle: Traversable
    index: uint32  # a key of a transform, an instance, a primitive
    gas_index: uint32


@ox.struct
class Params:
    queries: Array[Query]
    children: Array[Traversable]
    addresses: Array[uint64]
    options: Array2[float]
    numbers: Array2[float]


params = ox.launch_params(Params)


@ox.device
def put_options(i: uint32, count: uint32, flags: uint32, begin: float, end: float):
    params.options[i, 0] = float(count)
    params.options[i, 1] = float(flags)
    params.options[i, 2] = begin
    params.options[i, 3] = end


@ox.program
def __raygen__matrix_key():
    i = ox.get_launch_index().x
    child, count, flags, begin, end, key = ox.get_matrix_motion_transform_from_handle(params.queries[i].handle, params.queries[i].index)
    params.children[i] = child
    put_options(i, count, flags, begin, end)
    for row in range(3):
        for column in range(4):
            params.numbers[i, 4 * row + column] = key[row][column]


@ox.program
def __raygen__srt_key():
    i = ox.get_launch_index().x
    child, count, flags, begin, end, key = ox.get_srt_motion_transform_from_handle(params.queries[i].handle, params.queries[i].index)
    params.children[i] = child
    put_options(i, count, flags, begin, end)
    for row in range(4):
        for column in range(4):
            params.numbers[i, 4 * row + column] = key[row][column]


@ox.program
def __raygen__address():
    i = ox.get_launch_index().x
    params.addresses[i] = ox.get_gas_pointer_from_handle(params.queries[i].handle)


@ox.program
def __raygen__instance():
    i = ox.get_launch_index().x
    params.children[i] = ox.get_instance_traversable_from_ias(params.queries[i].handle, params.queries[i].index)


@ox.device
def put_corner(i: uint32, first: int, corner: float3):
    params.numbers[i, first] = corner.x
    params.numbers[i, first + 1] = corner.y
    params.numbers[i, first + 2] = corner.z


@ox.program
def __raygen__corners():
    i = ox.get_launch_index().x
    query = params.queries[i]
    a, b, c = ox.get_triangle_vertex_data_from_handle(query.handle, query.index, query.gas_index, 0.0)
    put_corner(i, 0, a)
    put_corner(i, 3, b)
    put_corner(i, 6, c)


@ox.program
def __raygen__sphere():
    i = ox.get_launch_index().x
    query = params.queries[i]
    sphere = ox.get_sphere_data_from_handle(query.handle, query.index, query.gas_index, 0.0)
    put_corner(i, 0, float3(sphere.x, sphere.y, sphere.z))
    params.numbers[i, 3] = sphere.w
