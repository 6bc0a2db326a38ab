"""The event recorder's programs for curves of every basis and ribbons."""

from recorder import (
    EVENT_ANYHIT,
    EVENT_CLOSESTHIT,
    NORMAL,
    VERTEX_WORDS,
    VERTICES,
    Record,
    U,
    V,
    Words,
    decide,
    new_event,
    params,
    put3,
    put_hit,
    put_object_ray,
    put_primitive,
    put_ray,
)

import optixc as ox
from optixc import float4, uint32

QUADRATIC = 0x2501
CUBIC = 0x2502
LINEAR = 0x2503
CATMULL_ROM = 0x2504
RIBBON = 0x2505
BEZIER = 0x2507
QUADRATIC_ROCAPS = 0x2508
CUBIC_ROCAPS = 0x2509
CATMULL_ROM_ROCAPS = 0x250a
BEZIER_ROCAPS = 0x250b


@ox.device
def put4(ray: uint32, event: uint32, point: uint32, value: float4):
    column = VERTICES + 4 * point
    params.numbers[ray, event, column] = value.x
    params.numbers[ray, event, column + 1] = value.y
    params.numbers[ray, event, column + 2] = value.z
    params.numbers[ray, event, column + 3] = value.w
    params.words[ray, event, VERTEX_WORDS] = 4 * point + 4


@ox.device
def put_three(ray: uint32, event: uint32, a: float4, b: float4, c: float4):
    put4(ray, event, 0, a)
    put4(ray, event, 1, b)
    put4(ray, event, 2, c)


@ox.device
def put_four(ray: uint32, event: uint32, a: float4, b: float4, c: float4, d: float4):
    put_three(ray, event, a, b, c)
    put4(ray, event, 3, d)


@ox.device
def put_curve(ray: uint32, event: uint32):
    kind = uint32(ox.get_primitive_type())
    if kind == RIBBON:
        parameters = ox.get_ribbon_parameters()
        params.numbers[ray, event, U] = parameters.x
        params.numbers[ray, event, V] = parameters.y
        a, b, c = ox.get_ribbon_vertex_data()
        put_three(ray, event, a, b, c)
        put3(ray, event, NORMAL, ox.get_ribbon_normal(parameters))
        return
    params.numbers[ray, event, U] = ox.get_curve_parameter()
    if kind == LINEAR:
        p, q = ox.get_linear_curve_vertex_data()
        put4(ray, event, 0, p)
        put4(ray, event, 1, q)
    elif kind == QUADRATIC:
        a, b, c = ox.get_quadratic_bspline_vertex_data()
        put_three(ray, event, a, b, c)
    elif kind == QUADRATIC_ROCAPS:
        a, b, c = ox.get_quadratic_bspline_rocaps_vertex_data()
        put_three(ray, event, a, b, c)
    elif kind == CUBIC:
        a, b, c, d = ox.get_cubic_bspline_vertex_data()
        put_four(ray, event, a, b, c, d)
    elif kind == CUBIC_ROCAPS:
        a, b, c, d = ox.get_cubic_bspline_rocaps_vertex_data()
        put_four(ray, event, a, b, c, d)
    elif kind == CATMULL_ROM:
        a, b, c, d = ox.get_catmull_rom_vertex_data()
        put_four(ray, event, a, b, c, d)
    elif kind == CATMULL_ROM_ROCAPS:
        a, b, c, d = ox.get_catmull_rom_rocaps_vertex_data()
        put_four(ray, event, a, b, c, d)
    elif kind == BEZIER:
        a, b, c, d = ox.get_cubic_bezier_vertex_data()
        put_four(ray, event, a, b, c, d)
    else:
        a, b, c, d = ox.get_cubic_bezier_rocaps_vertex_data()
        put_four(ray, event, a, b, c, d)


@ox.program
def __closesthit__curve(words: Words, record: Record):
    ray = words.word0
    event = new_event(ray, EVENT_CLOSESTHIT)
    put_ray(ray, event, record.id, words)
    put_primitive(ray, event)
    put_hit(ray, event)
    put_curve(ray, event)
    words.word3 = 7000 + ox.get_primitive_index()


@ox.program
def __anyhit__curve(words: Words, record: Record):
    ray = words.word0
    event = new_event(ray, EVENT_ANYHIT)
    put_ray(ray, event, record.id, words)
    put_primitive(ray, event)
    put_hit(ray, event)
    put_curve(ray, event)
    put_object_ray(ray, event)
    words.word1 = words.word1 + 1
    words.word2 = 1000 + ox.get_primitive_index()
    decide(record, words.word1, ox.get_primitive_index(), ox.get_hit_kind())
