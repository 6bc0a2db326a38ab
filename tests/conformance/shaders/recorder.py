"""The event recorder: every program call of a ray writes what its getters return into an event of that ray.

The protocol is that of the recorded OptiX programs: payload word 0 is the ray's index, word 1 counts any-hit calls (+1) and
intersection calls (+0x10000), word 2 is 1000 + the primitive of the last any-hit call, word 3 is 7000 + primitive after a closest hit and
9000 + record after a miss. Events of ray r stand in rows [r, n]; a field's column is a constant below. Curves, spheres and motion have
their own files, because a pipeline holds only what its scenes need.
"""

import optixc as ox
from optixc import Array, Array3, FixedArray, Traversable, float3, uint32

EVENT_INTERSECTION = 1
EVENT_REPORT = 2
EVENT_ANYHIT = 3
EVENT_CLOSESTHIT = 4
EVENT_MISS = 5

# columns of Params.words
TYPE = 0
RECORD = 1
PRIMITIVE = 2
INSTANCE_INDEX = 3
INSTANCE_ID = 4
GAS_INDEX = 5
HIT_KIND = 6
PRIMITIVE_TYPE = 7
FRONT = 8
BACK = 9
RAY_FLAGS = 10
MASK = 11
PAYLOAD = 12
TRANSFORM_COUNT = 16
TRANSFORM_TYPES = 17
ATTRIBUTES = 25
RETURNED = 33
REPORTED_KIND = 34
VERTEX_WORDS = 35
MOTION_STEPS = 36
WORD_COUNT = 37

# columns of Params.numbers
TMIN = 0
TMAX = 1
TIME = 2
WORLD_ORIGIN = 3
WORLD_DIRECTION = 6
OBJECT_ORIGIN = 9
OBJECT_DIRECTION = 12
OBJECT_TO_WORLD = 15
WORLD_TO_OBJECT = 27
U = 39
V = 40
VERTICES = 41
NORMAL = 57
REPORTED_T = 60
TMAX_BEFORE = 61
TMAX_AFTER = 62
MOTION_BEGIN = 63
MOTION_END = 64
NUMBER_COUNT = 65

# columns of Params.handles
GAS_HANDLE = 0
TRANSFORM_HANDLES = 1
HANDLE_COUNT = 9


@ox.struct
class Ray:
    origin: float3
    tmin: float
    direction: float3
    tmax: float
    time: float
    mask: uint32
    flags: uint32
    sbt_offset: uint32
    sbt_stride: uint32
    miss_index: uint32
    word1: uint32
    word2: uint32
    word3: uint32
    handle: Traversable


@ox.struct
class Outcome:
    event_count: uint32
    returned: uint32
    word0: uint32
    word1: uint32
    word2: uint32
    word3: uint32


@ox.struct
class Handle:
    value: Traversable


@ox.struct
class Params:
    rays: Array[Ray]
    outcomes: Array[Outcome]
    counts: Array[uint32]
    words: Array3[uint32]
    numbers: Array3[float]
    handles: Array3[Handle]


@ox.struct
class Report:
    t: float
    t_per_primitive: float
    kind: uint32
    attributes: FixedArray[uint32, 8]


@ox.struct
class Record:
    id: uint32
    anyhit_mode: uint32
    anyhit_argument: uint32
    report_count: uint32
    report0: Report
    report1: Report
    report2: Report
    report3: Report


@ox.payload
class Words:
    word0: uint32
    word1: uint32
    word2: uint32
    word3: uint32


params = ox.launch_params(Params)


@ox.device
def new_event(ray: uint32, kind: uint32) -> uint32:
    count = params.counts[ray]
    params.counts[ray] = count + 1
    last = uint32(params.words.shape[1]) - 1
    event = min(count, last)
    params.words[ray, event, TYPE] = kind
    return event


@ox.device
def put3(ray: uint32, event: uint32, column: uint32, value: float3):
    params.numbers[ray, event, column] = value.x
    params.numbers[ray, event, column + 1] = value.y
    params.numbers[ray, event, column + 2] = value.z


@ox.device
def put_ray(ray: uint32, event: uint32, record: uint32, words: Words):
    params.words[ray, event, RECORD] = record
    params.words[ray, event, RAY_FLAGS] = ox.get_ray_flags()
    params.words[ray, event, MASK] = ox.get_ray_visibility_mask()
    params.words[ray, event, PAYLOAD] = words.word0
    params.words[ray, event, PAYLOAD + 1] = words.word1
    params.words[ray, event, PAYLOAD + 2] = words.word2
    params.words[ray, event, PAYLOAD + 3] = words.word3
    params.numbers[ray, event, TMIN] = ox.get_ray_tmin()
    params.numbers[ray, event, TMAX] = ox.get_ray_tmax()
    params.numbers[ray, event, TIME] = ox.get_ray_time()
    put3(ray, event, WORLD_ORIGIN, ox.get_world_ray_origin())
    put3(ray, event, WORLD_DIRECTION, ox.get_world_ray_direction())


@ox.device
def put_primitive(ray: uint32, event: uint32):
    params.words[ray, event, PRIMITIVE] = ox.get_primitive_index()
    params.words[ray, event, INSTANCE_INDEX] = ox.get_instance_index()
    params.words[ray, event, INSTANCE_ID] = ox.get_instance_id()
    params.words[ray, event, GAS_INDEX] = ox.get_sbt_gas_index()
    count = ox.get_transform_list_size()
    params.words[ray, event, TRANSFORM_COUNT] = count
    for i in range(min(count, uint32(8))):
        handle = ox.get_transform_list_handle(i)
        params.handles[ray, event, TRANSFORM_HANDLES + i] = Handle(handle)
        params.words[ray, event, TRANSFORM_TYPES + i] = uint32(ox.get_transform_type_from_handle(handle))
    gas = ox.get_gas_traversable_handle()
    params.handles[ray, event, GAS_HANDLE] = Handle(gas)
    params.numbers[ray, event, MOTION_BEGIN] = ox.get_gas_motion_time_begin(gas)
    params.numbers[ray, event, MOTION_END] = ox.get_gas_motion_time_end(gas)
    params.words[ray, event, MOTION_STEPS] = ox.get_gas_motion_step_count(gas)
    to_world = ox.get_object_to_world_transform_matrix()
    to_object = ox.get_world_to_object_transform_matrix()
    for row in range(3):
        for column in range(4):
            params.numbers[ray, event, OBJECT_TO_WORLD + 4 * row + column] = to_world[row][column]
            params.numbers[ray, event, WORLD_TO_OBJECT + 4 * row + column] = to_object[row][column]


@ox.device
def put_object_ray(ray: uint32, event: uint32):
    put3(ray, event, OBJECT_ORIGIN, ox.get_object_ray_origin())
    put3(ray, event, OBJECT_DIRECTION, ox.get_object_ray_direction())


@ox.device
def put_hit(ray: uint32, event: uint32):
    params.words[ray, event, HIT_KIND] = ox.get_hit_kind()
    params.words[ray, event, PRIMITIVE_TYPE] = uint32(ox.get_primitive_type())
    params.words[ray, event, FRONT] = uint32(ox.is_front_face_hit())
    params.words[ray, event, BACK] = uint32(ox.is_back_face_hit())
    params.words[ray, event, ATTRIBUTES] = ox.get_attribute_0()
    params.words[ray, event, ATTRIBUTES + 1] = ox.get_attribute_1()
    params.words[ray, event, ATTRIBUTES + 2] = ox.get_attribute_2()
    params.words[ray, event, ATTRIBUTES + 3] = ox.get_attribute_3()
    params.words[ray, event, ATTRIBUTES + 4] = ox.get_attribute_4()
    params.words[ray, event, ATTRIBUTES + 5] = ox.get_attribute_5()
    params.words[ray, event, ATTRIBUTES + 6] = ox.get_attribute_6()
    params.words[ray, event, ATTRIBUTES + 7] = ox.get_attribute_7()
    params.words[ray, event, VERTEX_WORDS] = 0


@ox.device
def put_triangle(ray: uint32, event: uint32):
    barycentrics = ox.get_triangle_barycentrics()
    params.numbers[ray, event, U] = barycentrics.x
    params.numbers[ray, event, V] = barycentrics.y
    a, b, c = ox.get_triangle_vertex_data()
    put3(ray, event, VERTICES, a)
    put3(ray, event, VERTICES + 3, b)
    put3(ray, event, VERTICES + 6, c)
    params.words[ray, event, VERTEX_WORDS] = 9


@ox.device
def decide(record: Record, count: uint32, primitive: uint32, kind: uint32):
    calls = count & 0xffff
    if record.anyhit_mode == 1:
        ox.ignore_intersection()
    elif record.anyhit_mode == 2:
        ox.terminate_ray()
    elif record.anyhit_mode == 3:
        if primitive & 1 != 0:
            ox.ignore_intersection()
    elif record.anyhit_mode == 4:
        if calls == record.anyhit_argument:
            ox.terminate_ray()
    elif record.anyhit_mode == 5:
        if calls <= record.anyhit_argument:
            ox.ignore_intersection()
    elif record.anyhit_mode == 6:
        if calls < record.anyhit_argument:
            ox.ignore_intersection()
        elif calls == record.anyhit_argument:
            ox.terminate_ray()
    elif record.anyhit_mode == 7 and kind & 1 != 0:
        ox.ignore_intersection()


@ox.device
def report(ray: uint32, words: Words, record: Record, given: Report, primitive: uint32):
    t = given.t + given.t_per_primitive * float(primitive)
    before = ox.get_ray_tmax()
    accepted = ox.report_intersection(
        t, given.kind, given.attributes[0] + 100 * primitive, given.attributes[1], given.attributes[2], given.attributes[3],
        given.attributes[4], given.attributes[5], given.attributes[6], given.attributes[7])
    event = new_event(ray, EVENT_REPORT)
    params.words[ray, event, RECORD] = record.id
    params.words[ray, event, PRIMITIVE] = primitive
    params.words[ray, event, REPORTED_KIND] = given.kind
    params.words[ray, event, RETURNED] = uint32(accepted)
    params.words[ray, event, PAYLOAD + 1] = words.word1
    params.numbers[ray, event, REPORTED_T] = t
    params.numbers[ray, event, TMAX_BEFORE] = before
    params.numbers[ray, event, TMAX_AFTER] = ox.get_ray_tmax()


@ox.program
def __raygen__main():
    index = ox.get_launch_index().x
    ray = params.rays[index]
    words = Words(index, ray.word1, ray.word2, ray.word3)
    ox.trace(ray.handle, ray.origin, ray.direction, tmin=ray.tmin, tmax=ray.tmax, ray_time=ray.time, visibility_mask=ray.mask,
             ray_flags=ray.flags, sbt_offset=ray.sbt_offset, sbt_stride=ray.sbt_stride, miss_sbt_index=ray.miss_index, payload=words)
    params.outcomes[index] = Outcome(params.counts[index], 1, words.word0, words.word1, words.word2, words.word3)


@ox.program
def __miss__log(words: Words, record: Record):
    ray = words.word0
    event = new_event(ray, EVENT_MISS)
    put_ray(ray, event, record.id, words)
    words.word3 = 9000 + record.id


@ox.program
def __closesthit__triangle(words: Words, record: Record):
    ray = words.word0
    event = new_event(ray, EVENT_CLOSESTHIT)
    put_ray(ray, event, record.id, words)
    put_primitive(ray, event)
    put_hit(ray, event)
    put_triangle(ray, event)
    words.word3 = 7000 + ox.get_primitive_index()


@ox.program
def __anyhit__triangle(words: Words, record: Record):
    ray = words.word0
    event = new_event(ray, EVENT_ANYHIT)
    put_ray(ray, event, record.id, words)
    put_primitive(ray, event)
    put_hit(ray, event)
    put_triangle(ray, event)
    put_object_ray(ray, event)
    words.word1 = words.word1 + 1
    words.word2 = 1000 + ox.get_primitive_index()
    decide(record, words.word1, ox.get_primitive_index(), ox.get_hit_kind())


@ox.program
def __closesthit__custom(words: Words, record: Record):
    ray = words.word0
    event = new_event(ray, EVENT_CLOSESTHIT)
    put_ray(ray, event, record.id, words)
    put_primitive(ray, event)
    put_hit(ray, event)
    words.word3 = 7000 + ox.get_primitive_index()


@ox.program
def __anyhit__custom(words: Words, record: Record):
    ray = words.word0
    event = new_event(ray, EVENT_ANYHIT)
    put_ray(ray, event, record.id, words)
    put_primitive(ray, event)
    put_hit(ray, event)
    put_object_ray(ray, event)
    words.word1 = words.word1 + 1
    words.word2 = 1000 + ox.get_primitive_index()
    decide(record, words.word1, ox.get_primitive_index(), ox.get_hit_kind())


@ox.program
def __intersection__custom(words: Words, record: Record):
    ray = words.word0
    event = new_event(ray, EVENT_INTERSECTION)
    put_ray(ray, event, record.id, words)
    put_primitive(ray, event)
    put_object_ray(ray, event)
    words.word1 = words.word1 + 0x10000
    primitive = ox.get_primitive_index()
    if record.report_count > 0:
        report(ray, words, record, record.report0, primitive)
    if record.report_count > 1:
        report(ray, words, record, record.report1, primitive)
    if record.report_count > 2:
        report(ray, words, record, record.report2, primitive)
    if record.report_count > 3:
        report(ray, words, record, record.report3, primitive)
