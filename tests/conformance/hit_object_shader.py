"""The shader of the hit-object tests: the same getters, written once, ask the ray in flight and the outgoing hit object.

`dump_incoming` and `dump_outgoing` are made from one text, so that they cannot differ by a slip.
"""

from __future__ import annotations

from pathlib import Path

NUMBERS = 84
"""Words that a dump writes."""

_HEAD = '''
import optixc as ox
from optixc import Array, Array2, FixedArray, Traversable, TraverseData, float2, float3, float4, uint32


@ox.struct
class Saved:
    data: TraverseData
    transforms: FixedArray[Traversable, 8]
    count: uint32


@ox.struct
class Params:
    scenes: Array[Traversable]
    origins: Array[float3]
    directions: Array[float3]
    incoming: Array2[uint32]
    outgoing: Array2[uint32]
    payloads: Array2[uint32]
    saved: Array[Saved]
    mode: uint32


@ox.struct
class Record:
    number: uint32


@ox.payload
class Words:
    record: uint32
    calls: uint32
    t: float


params = ox.launch_params(Params)


@ox.device
def put(out: Array2[uint32], column: int, value: uint32):
    out[ox.get_launch_index().x, column] = value


@ox.device
def put3(out: Array2[uint32], column: int, value: float3):
    put(out, column, ox.float_as_uint(value.x))
    put(out, column + 1, ox.float_as_uint(value.y))
    put(out, column + 2, ox.float_as_uint(value.z))


@ox.device
def put4(out: Array2[uint32], column: int, value: float4):
    put3(out, column, value.xyz)
    put(out, column + 3, ox.float_as_uint(value.w))
'''

_DUMP = '''

@ox.device
def dump_WHO(out: Array2[uint32]):
    put(out, 0, ox.get_primitive_index())
    put(out, 1, ox.get_sbt_gas_index())
    put(out, 2, ox.get_instance_id())
    put(out, 3, ox.get_instance_index())
    put(out, 4, ox.get_hit_kind())
    put(out, 5, ox.get_transform_list_size())
    put(out, 6, ox.get_ray_flags())
    put(out, 7, ox.get_cluster_id())
    put(out, 8, ox.float_as_uint(ox.get_ray_tmin()))
    put(out, 9, ox.float_as_uint(ox.get_ray_tmax()))
    put(out, 10, ox.float_as_uint(ox.get_ray_time()))
    put3(out, 11, ox.get_world_ray_origin())
    put3(out, 14, ox.get_world_ray_direction())
    put(out, 17, ox.get_attribute_0())
    put(out, 18, ox.get_attribute_1())
    put(out, 19, ox.get_attribute_2())
    put(out, 20, ox.get_attribute_3())
    put(out, 21, ox.get_attribute_7())
    to_world = ox.get_object_to_world_transform_matrix()
    to_object = ox.get_world_to_object_transform_matrix()
    for row in range(3):
        put4(out, 22 + 4 * row, to_world[row])
        put4(out, 34 + 4 * row, to_object[row])
    put3(out, 46, ox.transform_point_from_world_to_object_space(float3(1.0, 2.0, 3.0)))
    put3(out, 49, ox.transform_normal_from_object_to_world_space(float3(1.0, 2.0, 3.0)))
    put3(out, 52, ox.transform_vector_from_object_to_world_space(float3(1.0, 2.0, 3.0)))
    kind = ox.get_hit_kind()
    if kind >= 254:
        barycentrics = ox.get_triangle_barycentrics()
        put(out, 55, ox.float_as_uint(barycentrics.x))
        put(out, 56, ox.float_as_uint(barycentrics.y))
        a, b, c = ox.get_triangle_vertex_data()
        put3(out, 57, a)
        put3(out, 60, b)
        put3(out, 63, c)
    elif kind == 138:
        put4(out, 57, ox.get_sphere_data())
    elif kind == 130:
        put(out, 55, ox.float_as_uint(ox.get_curve_parameter()))
        p, q, r, s = ox.get_cubic_bspline_vertex_data()
        put4(out, 57, p)
        put4(out, 61, q)
        put4(out, 65, r)
        put4(out, 69, s)
    elif kind == 136:
        along = ox.get_ribbon_parameters()
        put(out, 55, ox.float_as_uint(along.x))
        put(out, 56, ox.float_as_uint(along.y))
        put3(out, 57, ox.get_ribbon_normal(along))
    for i in range(ox.get_transform_list_size()):
        put(out, 76 + int(i), ox.get_transform_type_from_handle(ox.get_transform_list_handle(i)))
'''

_PROGRAMS = '''

@ox.device
def dump_if_hit():
    put(params.outgoing, 75, uint32(ox.hit_object_is_hit()) + 2 * uint32(ox.hit_object_is_miss()) + 4 * uint32(ox.hit_object_is_nop()))
    if ox.hit_object_is_hit():
        dump_outgoing(params.outgoing)


@ox.device
def look(scene: int, flags: uint32, words: Words):
    i = ox.get_launch_index().x
    ox.traverse(params.scenes[scene], params.origins[i], params.directions[i], tmin=0.01, tmax=50.0, ray_time=0.4, ray_flags=flags,
                miss_sbt_index=uint32(scene), payload=words)


@ox.device
def finish(words: Words):
    i = ox.get_launch_index().x
    params.payloads[i, 0] = words.record
    params.payloads[i, 1] = words.calls
    params.payloads[i, 2] = ox.float_as_uint(words.t)


@ox.program
def __raygen__traced():
    i = ox.get_launch_index().x
    words = Words(99, 0, -1.0)
    scene = int(i % 2)
    ox.trace(params.scenes[scene], params.origins[i], params.directions[i], tmin=0.01, tmax=50.0, ray_time=0.4, ray_flags=0,
             miss_sbt_index=uint32(scene), payload=words)
    finish(words)


@ox.program
def __raygen__cut_in_two():
    words = Words(99, 0, -1.0)
    i = ox.get_launch_index().x
    if i % 2 == 0:
        look(0, 0, words)
    else:
        look(1, 0, words)
    ox.reorder(i % 7, 3)
    dump_if_hit()
    if params.mode == 1:
        # the hit goes through memory and is made again
        count = ox.hit_object_get_transform_list_size()
        saved = Saved(ox.hit_object_get_traverse_data(), FixedArray[Traversable, 8](), count)
        for k in range(count):
            saved.transforms[k] = ox.hit_object_get_transform_list_handle(k)
        params.saved[i] = saved
        was_hit = ox.hit_object_is_hit()
        ox.make_nop_hit_object()
        if was_hit:
            ox.make_hit_object(params.scenes[i % 2], params.origins[i], params.directions[i], 0.01, 0.4, 0, saved.data, saved.transforms,
                               saved.count)
        else:
            ox.make_miss_hit_object(i % 2, params.origins[i], params.directions[i], 0.01, 50.0, 0.4, 0)
        dump_if_hit()
    elif params.mode == 2 and ox.hit_object_is_hit():
        # the hit is told by numbers
        count = ox.hit_object_get_transform_list_size()
        transforms = FixedArray[Traversable, 8]()
        for k in range(count):
            transforms[k] = ox.hit_object_get_transform_list_handle(k)
        t, index, gas = ox.hit_object_get_ray_tmax(), ox.hit_object_get_instance_index(), ox.hit_object_get_sbt_gas_index()
        primitive, kind = ox.hit_object_get_primitive_index(), ox.hit_object_get_hit_kind()
        a0, a1, a2 = ox.hit_object_get_attribute_0(), ox.hit_object_get_attribute_1(), ox.hit_object_get_attribute_2()
        a3, a7 = ox.hit_object_get_attribute_3(), ox.hit_object_get_attribute_7()
        record = ox.hit_object_get_sbt_record_index()
        ox.make_nop_hit_object()
        if i % 3 == 0:
            ox.make_hit_object_with_record(params.scenes[i % 2], params.origins[i], params.directions[i], 0.01, t, 0.4, record, index,
                                           transforms, count, gas, primitive, kind, a0, a1, a2, a3, 0, 0, 0, a7)
        elif i % 2 == 0:
            ox.make_hit_object(params.scenes[0], params.origins[i], params.directions[i], 0.01, t, 0.4, 0, 1, index, gas, primitive, kind,
                               a0, a1, a2, a3, 0, 0, 0, a7)
        else:
            ox.make_hit_object(params.scenes[1], params.origins[i], params.directions[i], 0.01, t, 0.4, 0, 1, index, transforms, count,
                               gas, primitive, kind, a0, a1, a2, a3, 0, 0, 0, a7)
        dump_if_hit()
    params.outgoing[i, 74] = ox.hit_object_get_sbt_data(Record).number
    ox.invoke(payload=words)
    params.outgoing[i, 73] = uint32(ox.hit_object_is_nop())
    finish(words)


@ox.program
def __raygen__made_later():
    i = ox.get_launch_index().x
    words = Words(99, 0, -1.0)
    ox.make_hit_object(params.scenes[i % 2], params.origins[i], params.directions[i], 0.01, 0.4, 0, params.saved[i].data,
                       params.saved[i].transforms, params.saved[i].count)
    dump_if_hit()
    ox.invoke(payload=words)
    finish(words)


@ox.program
def __raygen__different():
    i = ox.get_launch_index().x
    words = Words(99, 0, -1.0)
    dump_if_hit()
    if i % 6 == 1:
        look(0, 8, words)
    elif i % 6 == 2:
        look(1, 4, words)
    elif i % 6 == 3:
        ox.make_miss_hit_object(1, float3(1.0, 2.0, 3.0), float3(0.0, 0.0, 1.0), 0.125, 7.0, 0.25, i)
    elif i % 6 == 4:
        look(0, 0, words)
        ox.hit_object_set_sbt_record_index(2)
    elif i % 6 == 5:
        look(1, 0, words)
        other = Words(0, 0, 0.0)
        ox.trace(params.scenes[0], params.origins[i], params.directions[i], payload=other)
    put3(params.outgoing, 64, ox.hit_object_get_world_ray_origin())
    params.outgoing[i, 67] = ox.float_as_uint(ox.hit_object_get_ray_tmax())
    params.outgoing[i, 68] = ox.hit_object_get_ray_flags()
    params.outgoing[i, 69] = ox.hit_object_get_sbt_record_index()
    params.outgoing[i, 70] = ox.hit_object_get_sbt_data(Record).number
    params.outgoing[i, 71] = ox.hit_object_get_instance_id()
    params.outgoing[i, 72] = ox.hit_object_get_transform_list_size()
    params.outgoing[i, 75] = (uint32(ox.hit_object_is_hit()) + 2 * uint32(ox.hit_object_is_miss()) + 4 * uint32(ox.hit_object_is_nop()))
    ox.invoke(payload=words)
    finish(words)


@ox.program
def __closesthit__hit(words: Words, record: Record):
    words.record = record.number
    words.calls = words.calls + 1
    words.t = ox.get_ray_tmax()
    dump_incoming(params.incoming)


@ox.program
def __miss__sky(words: Words, record: Record):
    words.record = record.number
    words.t = ox.get_ray_tmax()


@ox.program
def __anyhit__odd(words: Words):
    words.calls = words.calls + 16
    if ox.get_primitive_index() % 3 == 2:
        ox.ignore_intersection()


@ox.program
def __intersection__ball():
    d, o = ox.get_object_ray_direction(), ox.get_object_ray_origin()
    t = -ox.dot(o, d) / ox.dot(d, d)
    near = o + t * d
    if ox.dot(near, near) < 0.5:
        ox.report_intersection(t, 17, ox.float_as_uint(near.x), uint32(5), uint32(6), uint32(7), uint32(8), uint32(9), uint32(10),
                               uint32(11))
'''

_WITH_BOTH = ("get_launch_index", "get_transform_type_from_handle")


def _outgoing(text: str) -> str:
    made = text.replace("ox.get_", "ox.hit_object_get_").replace("ox.transform_", "ox.hit_object_transform_")
    for name in _WITH_BOTH:
        made = made.replace(f"ox.hit_object_{name}", f"ox.{name}")
    return made


def write(folder: Path) -> Path:
    """Writes the shader file."""
    path = folder / "hit_object_shader_text.py"
    dumps = _DUMP.replace("WHO", "incoming") + _outgoing(_DUMP).replace("WHO", "outgoing")
    path.write_text(f'"""Made by the hit-object tests."""\n{_HEAD}{dumps}{_PROGRAMS}', encoding="utf-8")
    return path
