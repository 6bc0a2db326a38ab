"""The event recorder's programs for spheres."""

from recorder import (
    EVENT_ANYHIT,
    EVENT_CLOSESTHIT,
    VERTEX_WORDS,
    VERTICES,
    Record,
    Words,
    decide,
    new_event,
    params,
    put_hit,
    put_object_ray,
    put_primitive,
    put_ray,
)

import optixc as ox
from optixc import uint32


@ox.device
def put_sphere(ray: uint32, event: uint32):
    sphere = ox.get_sphere_data()
    params.numbers[ray, event, VERTICES] = sphere.x
    params.numbers[ray, event, VERTICES + 1] = sphere.y
    params.numbers[ray, event, VERTICES + 2] = sphere.z
    params.numbers[ray, event, VERTICES + 3] = sphere.w
    params.words[ray, event, VERTEX_WORDS] = 4


@ox.program
def __closesthit__sphere(words: Words, record: Record):
    ray = words.word0
    event = new_event(ray, EVENT_CLOSESTHIT)
    put_ray(ray, event, record.id, words)
    put_primitive(ray, event)
    put_hit(ray, event)
    put_sphere(ray, event)
    words.word3 = 7000 + ox.get_primitive_index()


@ox.program
def __anyhit__sphere(words: Words, record: Record):
    ray = words.word0
    event = new_event(ray, EVENT_ANYHIT)
    put_ray(ray, event, record.id, words)
    put_primitive(ray, event)
    put_hit(ray, event)
    put_sphere(ray, event)
    put_object_ray(ray, event)
    words.word1 = words.word1 + 1
    words.word2 = 1000 + ox.get_primitive_index()
    decide(record, words.word1, ox.get_primitive_index(), ox.get_hit_kind())
