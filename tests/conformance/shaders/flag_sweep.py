"""One ray for each place and combination of ray flags; what happened to it in one word."""

import optixc as ox
from optixc import Array, Array2, float3, uint32

# bits of a result
CALLS = 1
CLOSESTHIT = 256
MISSED = 512
SECOND = 1024  # the closest hit is on primitive 1
KIND = 65536


@ox.struct
class Place:
    x: float
    y: float
    height: float  # the ray comes from there, towards z = -0.5


@ox.struct
class Params:
    places: Array[Place]
    flags: Array[uint32]
    out: Array2[uint32]
    scene: ox.Traversable


@ox.struct
class Record:
    ignores: uint32


@ox.payload
class Story:
    word: uint32


params = ox.launch_params(Params)


@ox.program
def __raygen__sweep():
    i = ox.get_launch_index()
    place = params.places[i.x]
    story = Story(0)
    direction = float3(0.0, 0.0, -0.5 - place.height)
    ox.trace(params.scene, float3(place.x, place.y, place.height), direction, ray_flags=params.flags[i.y], payload=story)
    params.out[i.y, i.x] = story.word


@ox.program
def __miss__note(story: Story):
    story.word = story.word + MISSED


@ox.program
def __closesthit__note(story: Story):
    story.word = story.word + CLOSESTHIT + SECOND * ox.get_primitive_index() + KIND * ox.get_hit_kind()


@ox.program
def __anyhit__count(story: Story, record: Record):
    story.word = story.word + CALLS
    if record.ignores != 0:
        ox.ignore_intersection()


@ox.program
def __intersection__plane():
    plane = -float(ox.get_primitive_index())
    ox.report_intersection((plane - ox.get_object_ray_origin().z) / ox.get_object_ray_direction().z, 7)
