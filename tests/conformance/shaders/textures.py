"""Texture look-ups: one per launch index, at coordinates of the host's choice."""

import optixc as ox
from optixc import float2, float4


@ox.struct
class Params:
    places: ox.Array[float2]
    colors: ox.Array[float4]
    texture: ox.Texture


@ox.struct
class Surface:
    texture: ox.Texture


params = ox.launch_params(Params)


@ox.program
def __raygen__look():
    i = ox.get_launch_index().x
    place = params.places[i]
    params.colors[i] = ox.tex2d(params.texture, place.x, place.y)


@ox.program
def __raygen__odd_ones():
    i = ox.get_launch_index().x
    color = float4(-1.0)
    if i % 2 == 1:
        place = params.places[i]
        color = ox.tex2d(params.texture, place.x, place.y)
    params.colors[i] = color


@ox.program
def __raygen__record(surface: Surface):
    i = ox.get_launch_index().x
    place = params.places[i]
    params.colors[i] = ox.tex2d(surface.texture, place.x, place.y)
