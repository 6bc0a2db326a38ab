"""Hit objects: traverse, make, invoke, and what every getter says in between. The programs of the recorded hit-object probes.

params.states holds one row for each look at the outgoing hit object, params.log one for each program call and payload.
"""

import optixc as ox
from optixc import Array, Array2, Traversable, float3, uint32

CLOSESTHIT = 1
MISS = 2
AFTER_TRAVERSE = 3
AFTER_INVOKE = 4
ANYHIT = 5
STATE_WORDS = 15
STATE_NUMBERS = 32
LOG_WORDS = 15
LOG_NUMBERS = 10


@ox.struct
class Handle:
    value: Traversable


@ox.struct
class Params:
    states: Array2[uint32]
    state_numbers: Array2[float]
    state_gas: Array[Handle]
    state_count: Array[uint32]
    log: Array2[uint32]
    log_numbers: Array2[float]
    log_count: Array[uint32]
    scene: Traversable
    boxes: Traversable
    mode: uint32


@ox.struct
class Record:
    id: uint32
    mode: uint32


@ox.payload
class Words:
    a: uint32
    b: uint32
    c: uint32
    d: uint32


params = ox.launch_params(Params)


@ox.device
def put3(row: uint32, column: uint32, value: float3):
    params.state_numbers[row, column] = value.x
    params.state_numbers[row, column + 1] = value.y
    params.state_numbers[row, column + 2] = value.z


@ox.device
def dump(tag: uint32):
    n = params.state_count[0]
    params.state_count[0] = n + 1
    params.states[n, 0] = tag
    params.states[n, 1] = uint32(ox.hit_object_is_hit())
    params.states[n, 2] = uint32(ox.hit_object_is_miss())
    params.states[n, 3] = uint32(ox.hit_object_is_nop())
    params.states[n, 4] = ox.hit_object_get_instance_id()
    params.states[n, 5] = ox.hit_object_get_instance_index()
    params.states[n, 6] = ox.hit_object_get_primitive_index()
    params.states[n, 7] = ox.hit_object_get_transform_list_size()
    params.states[n, 8] = ox.hit_object_get_sbt_gas_index()
    params.states[n, 9] = ox.hit_object_get_hit_kind()
    params.states[n, 10] = ox.hit_object_get_ray_flags()
    params.states[n, 11] = ox.hit_object_get_sbt_record_index()
    params.states[n, 12] = 0xffffffff
    if not ox.hit_object_is_nop():
        params.states[n, 12] = ox.hit_object_get_sbt_data(Record).id
    params.states[n, 13] = ox.hit_object_get_attribute_0()
    params.states[n, 14] = ox.hit_object_get_attribute_1()
    put3(n, 0, ox.hit_object_get_world_ray_origin())
    put3(n, 3, ox.hit_object_get_world_ray_direction())
    params.state_numbers[n, 6] = ox.hit_object_get_ray_tmin()
    params.state_numbers[n, 7] = ox.hit_object_get_ray_tmax()
    params.state_numbers[n, 8] = ox.hit_object_get_ray_time()
    if ox.hit_object_is_hit():
        params.state_gas[n] = Handle(ox.hit_object_get_gas_traversable_handle())
        to_world = ox.hit_object_get_object_to_world_transform_matrix()
        for row in range(3):
            for column in range(4):
                params.state_numbers[n, 11 + 4 * row + column] = to_world[row][column]
        if ox.hit_object_get_hit_kind() >= 254:
            barycentrics = ox.hit_object_get_triangle_barycentrics()
            params.state_numbers[n, 9] = barycentrics.x
            params.state_numbers[n, 10] = barycentrics.y
            p, q, r = ox.hit_object_get_triangle_vertex_data()
            put3(n, 23, p)
            put3(n, 26, q)
            put3(n, 29, r)


@ox.device
def log(what: uint32, record: uint32, primitive: uint32, words: Words) -> uint32:
    n = params.log_count[0]
    params.log_count[0] = n + 1
    params.log[n, 0] = what
    params.log[n, 1] = record
    params.log[n, 2] = primitive
    params.log[n, 3] = words.a
    params.log[n, 4] = words.b
    params.log[n, 5] = words.c
    params.log[n, 6] = words.d
    return n


@ox.device
def put_ray(n: uint32):
    params.log_numbers[n, 0] = ox.get_ray_tmin()
    params.log_numbers[n, 1] = ox.get_ray_tmax()
    params.log_numbers[n, 2] = ox.get_ray_time()
    origin, direction = ox.get_world_ray_origin(), ox.get_world_ray_direction()
    params.log_numbers[n, 3] = origin.x
    params.log_numbers[n, 4] = origin.y
    params.log_numbers[n, 5] = origin.z
    params.log_numbers[n, 6] = direction.x
    params.log_numbers[n, 7] = direction.y
    params.log_numbers[n, 8] = direction.z


@ox.device
def look(scene: Traversable, origin: float3, flags: uint32, offset: uint32, miss: uint32, words: Words):
    ox.traverse(scene, origin, float3(0.0, 0.0, -1.0), tmin=0.5, tmax=100.0, ray_time=0.25, ray_flags=flags, sbt_offset=offset,
                miss_sbt_index=miss, payload=words)


@ox.program
def __raygen__hit_objects():
    at, beside, down = float3(0.25, 0.25, 5.0), float3(50.0, 50.0, 5.0), float3(0.0, 0.0, -1.0)
    words = Words(1, 2, 3, 4)
    mode = params.mode
    if mode == 0:
        dump(0)
        ox.invoke(payload=words)
        dump(1)
        log(100, 0, 0, words)
    elif mode == 1:
        look(params.scene, at, 0, 0, 0, words)
        dump(10)
        log(110, 0, 0, words)
        ox.invoke(payload=words)
        dump(11)
        log(111, 0, 0, words)
        ox.invoke(payload=words)
        dump(12)
        log(112, 0, 0, words)
    elif mode == 2:
        look(params.scene, beside, 0, 0, 1, words)
        dump(20)
        log(120, 0, 0, words)
        ox.invoke(payload=words)
        dump(21)
        log(121, 0, 0, words)
    elif mode == 3:
        look(params.scene, at, 0, 0, 0, words)
        dump(30)
        ox.trace(params.scene, beside, down, tmin=0.5, tmax=100.0, ray_time=0.25, miss_sbt_index=1, payload=words)
        dump(31)
        ox.trace(params.scene, at, down, tmin=0.5, tmax=100.0, ray_time=0.25, miss_sbt_index=1, payload=words)
        dump(32)
    elif mode == 4:
        ox.make_miss_hit_object(1, at, down, 0.125, 77.0, 0.25, 8)
        dump(40)
        words.a = 11
        ox.invoke(payload=words)
        dump(41)
        log(141, 0, 0, words)
    elif mode == 5:
        look(params.scene, at, 0, 0, 0, words)
        ox.make_nop_hit_object()
        dump(50)
        ox.invoke(payload=words)
        dump(51)
        log(151, 0, 0, words)
    elif mode == 6:
        look(params.scene, at, 0, 0, 0, words)
        ox.hit_object_set_sbt_record_index(3)
        dump(60)
        ox.invoke(payload=words)
        dump(61)
    elif mode == 7:
        look(params.scene, at, 0, 0, 0, words)
        data = ox.hit_object_get_traverse_data()
        transforms = ox.FixedArray[Traversable, 4]()
        count = ox.hit_object_get_transform_list_size()
        for i in range(count):
            transforms[i] = ox.hit_object_get_transform_list_handle(i)
        dump(70)
        ox.make_nop_hit_object()
        dump(71)
        ox.make_hit_object(params.scene, at, down, 0.5, 0.25, 0, data, transforms, count)
        dump(72)
        ox.invoke(payload=words)
        dump(73)
        ox.make_hit_object(params.scene, float3(7.0, 8.0, 9.0), float3(0.0, 1.0, 0.0), 0.0625, 0.75, 4, data, transforms, count)
        dump(74)
        ox.invoke(payload=words)
    elif mode == 8:
        look(params.scene, at, 8, 0, 0, words)
        dump(80)
        ox.invoke(payload=words)
        dump(81)
        log(181, 0, 0, words)
    elif mode == 9:
        look(params.scene, at, 0, 1, 0, words)
        dump(90)
        ox.reorder()
        dump(91)
        ox.reorder(3, 2)
        dump(92)
        ox.invoke(payload=words)
        dump(93)
    elif mode == 10:
        ox.make_miss_hit_object(0, at, down, 0.0, 10.0, 0.0, 0)
        ox.hit_object_set_sbt_record_index(1)
        dump(100)
        ox.invoke(payload=words)
    elif mode == 11:
        look(params.scene, at, 0, 4, 0, words)
        dump(110)
        log(1110, 0, 0, words)
        again = Words(21, 22, 23, 24)
        ox.invoke(payload=again)
        log(1111, 0, 0, again)
    elif mode == 12:
        look(params.scene, at, 4, 2, 0, words)
        dump(120)
        log(1120, 0, 0, words)
        ox.invoke(payload=words)
    elif mode == 13:
        look(Traversable(0), at, 0, 0, 1, words)
        dump(130)
        ox.invoke(payload=words)
        dump(131)
    elif mode == 14:
        look(params.boxes, float3(0.5, 0.5, 5.0), 0, 5, 0, words)
        dump(140)
        ox.invoke(payload=words)


@ox.program
def __miss__hit_objects(words: Words, record: Record):
    n = log(MISS, record.id, 0, words)
    put_ray(n)
    params.log[n, 7] = ox.get_ray_flags()
    words.b = 900 + record.id


@ox.program
def __closesthit__hit_objects(words: Words, record: Record):
    n = log(CLOSESTHIT, record.id, ox.get_primitive_index(), words)
    put_ray(n)
    params.log[n, 7] = ox.get_ray_flags()
    params.log[n, 8] = ox.get_instance_id()
    params.log[n, 9] = ox.get_hit_kind()
    params.log[n, 10] = ox.get_sbt_gas_index()
    words.b = 700 + record.id
    if record.mode == 4:
        dump(1000)
        inner = Words(31, 32, 33, 34)
        ox.traverse(params.scene, float3(2.25, 0.25, 3.0), float3(0.0, 0.0, -1.0), tmin=0.1, tmax=50.0, ray_time=0.25, payload=inner)
        dump(1001)
        n = log(AFTER_TRAVERSE, record.id, ox.get_primitive_index(), words)
        put_origin(n)
        params.log_numbers[n, 0] = ox.get_ray_tmin()
        params.log[n, 5] = 0
        params.log[n, 6] = 0
        params.log[n, 8] = ox.get_instance_id()
        ox.invoke(payload=inner)
        dump(1002)
        n = log(AFTER_INVOKE, record.id, ox.get_primitive_index(), words)
        put_origin(n)
        params.log[n, 5] = inner.a
        params.log[n, 6] = inner.b


@ox.device
def put_origin(n: uint32):
    params.log_numbers[n, 1] = ox.get_ray_tmax()
    origin = ox.get_world_ray_origin()
    params.log_numbers[n, 3] = origin.x
    params.log_numbers[n, 4] = origin.y
    params.log_numbers[n, 5] = origin.z


@ox.program
def __anyhit__hit_objects(words: Words, record: Record):
    n = log(ANYHIT, record.id, ox.get_primitive_index(), words)
    params.log[n, 3] = 0
    params.log[n, 4] = 0
    params.log[n, 5] = 0
    params.log[n, 6] = 0
    params.log_numbers[n, 1] = ox.get_ray_tmax()
    words.c = words.c + 100
    if record.mode == 2:
        ox.ignore_intersection()


@ox.program
def __intersection__hit_objects():
    ox.report_intersection(4.25, 9, uint32(111), uint32(222))
