"""The same rays by trace and by traverse and invoke, and what hit objects and hit programs say of the same hit."""

import optixc as ox
from optixc import float3, uint32

WORDS = 10
NUMBERS = 46


@ox.struct
class Handle:
    value: ox.Traversable


@ox.struct
class Params:
    scene: ox.Traversable
    origins: ox.Array[float3]
    directions: ox.Array[float3]
    words: ox.Array3[uint32]
    numbers: ox.Array3[float]
    handles: ox.Array3[Handle]
    hint: uint32


@ox.payload
class Seen:
    t: float
    primitive: uint32
    instance: uint32
    anyhits: uint32
    u: float
    v: float


params = ox.launch_params(Params)


@ox.device
def keep(i: uint32, seen: Seen):
    params.words[0, i, 0] = seen.primitive
    params.words[0, i, 1] = seen.instance
    params.words[0, i, 2] = seen.anyhits
    params.numbers[0, i, 0] = seen.t
    params.numbers[0, i, 1] = seen.u
    params.numbers[0, i, 2] = seen.v


@ox.program
def __raygen__trace():
    i = ox.get_launch_index().x
    seen = Seen(0.0, 0, 0, 0, 0.0, 0.0)
    ox.trace(params.scene, params.origins[i], params.directions[i], tmax=50.0, payload=seen)
    keep(i, seen)


@ox.device
def look(i: uint32, seen: Seen):
    ox.traverse(params.scene, params.origins[i], params.directions[i], tmax=50.0, payload=seen)


@ox.program
def __raygen__traverse():
    i = ox.get_launch_index().x
    seen = Seen(0.0, 0, 0, 0, 0.0, 0.0)
    look(i, seen)
    ox.reorder(params.hint & i, 4)
    ox.invoke(payload=seen)
    keep(i, seen)


@ox.program
def __raygen__distance():
    i = ox.get_launch_index().x
    seen = Seen(0.0, 0, 0, 0, 0.0, 0.0)
    look(i, seen)
    params.words[0, i, 0] = uint32(ox.hit_object_is_hit())
    params.numbers[0, i, 0] = ox.hit_object_get_ray_tmax()


@ox.device
def put3(row: uint32, i: uint32, column: uint32, value: float3):
    params.numbers[row, i, column] = value.x
    params.numbers[row, i, column + 1] = value.y
    params.numbers[row, i, column + 2] = value.z


@ox.program
def __raygen__both():
    i = ox.get_launch_index().x
    seen = Seen(0.0, 0, 0, 0, 0.0, 0.0)
    look(i, seen)
    if ox.hit_object_is_hit():
        params.words[0, i, 0] = ox.hit_object_get_primitive_index()
        params.words[0, i, 1] = ox.hit_object_get_instance_index()
        params.words[0, i, 2] = ox.hit_object_get_instance_id()
        params.words[0, i, 3] = ox.hit_object_get_hit_kind()
        params.words[0, i, 4] = ox.hit_object_get_sbt_gas_index()
        params.words[0, i, 5] = ox.hit_object_get_attribute_0()
        params.words[0, i, 6] = ox.hit_object_get_attribute_1()
        params.words[0, i, 7] = ox.hit_object_get_ray_flags()
        count = ox.hit_object_get_transform_list_size()
        params.words[0, i, 8] = count
        params.numbers[0, i, 0] = ox.hit_object_get_ray_tmax()
        params.numbers[0, i, 1] = ox.hit_object_get_ray_tmin()
        uv = ox.hit_object_get_triangle_barycentrics()
        params.numbers[0, i, 2] = uv.x
        params.numbers[0, i, 3] = uv.y
        put3(0, i, 4, ox.hit_object_get_world_ray_origin())
        put3(0, i, 7, ox.hit_object_get_world_ray_direction())
        a, b, c = ox.hit_object_get_triangle_vertex_data()
        put3(0, i, 10, a)
        put3(0, i, 13, b)
        put3(0, i, 16, c)
        to_world = ox.hit_object_get_object_to_world_transform_matrix()
        to_object = ox.hit_object_get_world_to_object_transform_matrix()
        for row in range(3):
            for column in range(4):
                params.numbers[0, i, 19 + 4 * row + column] = to_world[row][column]
                params.numbers[0, i, 31 + 4 * row + column] = to_object[row][column]
        put3(0, i, 43, ox.hit_object_transform_point_from_object_to_world_space(float3(1.0, 2.0, 3.0)))
        for k in range(min(count, uint32(4))):
            params.handles[0, i, k] = Handle(ox.hit_object_get_transform_list_handle(k))
        params.handles[0, i, 4] = Handle(ox.hit_object_get_gas_traversable_handle())
    ox.invoke(payload=seen)


@ox.program
def __closesthit__tell():
    i = ox.get_launch_index().x
    params.words[1, i, 0] = ox.get_primitive_index()
    params.words[1, i, 1] = ox.get_instance_index()
    params.words[1, i, 2] = ox.get_instance_id()
    params.words[1, i, 3] = ox.get_hit_kind()
    params.words[1, i, 4] = ox.get_sbt_gas_index()
    params.words[1, i, 5] = ox.get_attribute_0()
    params.words[1, i, 6] = ox.get_attribute_1()
    params.words[1, i, 7] = ox.get_ray_flags()
    count = ox.get_transform_list_size()
    params.words[1, i, 8] = count
    params.numbers[1, i, 0] = ox.get_ray_tmax()
    params.numbers[1, i, 1] = ox.get_ray_tmin()
    uv = ox.get_triangle_barycentrics()
    params.numbers[1, i, 2] = uv.x
    params.numbers[1, i, 3] = uv.y
    put3(1, i, 4, ox.get_world_ray_origin())
    put3(1, i, 7, ox.get_world_ray_direction())
    a, b, c = ox.get_triangle_vertex_data()
    put3(1, i, 10, a)
    put3(1, i, 13, b)
    put3(1, i, 16, c)
    to_world = ox.get_object_to_world_transform_matrix()
    to_object = ox.get_world_to_object_transform_matrix()
    for row in range(3):
        for column in range(4):
            params.numbers[1, i, 19 + 4 * row + column] = to_world[row][column]
            params.numbers[1, i, 31 + 4 * row + column] = to_object[row][column]
    put3(1, i, 43, ox.transform_point_from_object_to_world_space(float3(1.0, 2.0, 3.0)))
    for k in range(min(count, uint32(4))):
        params.handles[1, i, k] = Handle(ox.get_transform_list_handle(k))
    params.handles[1, i, 4] = Handle(ox.get_gas_traversable_handle())


@ox.program
def __closesthit__see(seen: Seen):
    seen.t = ox.get_ray_tmax()
    seen.primitive = ox.get_primitive_index()
    seen.instance = ox.get_instance_index()
    uv = ox.get_triangle_barycentrics()
    seen.u = uv.x
    seen.v = uv.y


@ox.program
def __anyhit__odd(seen: Seen):
    if ox.get_primitive_index() % 3 == 1:
        seen.anyhits += 1
        ox.ignore_intersection()


@ox.program
def __miss__none(seen: Seen):
    seen.t = -ox.get_ray_tmax()
