"""What handles of instances and transforms lead to, asked from a ray generation program."""

import optixc as ox
from optixc import Array, Array2, Traversable, uint32


@ox.struct
class Query:
    handle: Traversable
    is_instance: uint32  # of an IAS: the instance `index` is meant
    index: uint32


@ox.struct
class Answer:
    handle: Traversable
    child: Traversable
    static_child: Traversable
    type: uint32
    id: uint32


@ox.struct
class Params:
    queries: Array[Query]
    answers: Array[Answer]
    matrices: Array2[float]


params = ox.launch_params(Params)


@ox.device
def put(i: uint32, column: int, matrix: ox.float3x4):
    for row in range(3):
        for entry in range(4):
            params.matrices[i, column + 4 * row + entry] = matrix[row][entry]


@ox.program
def __raygen__ask():
    i = ox.get_launch_index().x
    query = params.queries[i]
    handle = query.handle
    if query.is_instance != 0:
        handle = ox.get_instance_traversable_from_ias(query.handle, query.index)
    static_child, transform, inverse = ox.get_static_transform_from_handle(handle)
    params.answers[i] = Answer(handle, ox.get_instance_child_from_handle(handle), static_child,
                               uint32(ox.get_transform_type_from_handle(handle)), ox.get_instance_id_from_handle(handle))
    put(i, 0, ox.get_instance_transform_from_handle(handle))
    put(i, 12, ox.get_instance_inverse_transform_from_handle(handle))
    put(i, 24, transform)
    put(i, 36, inverse)
