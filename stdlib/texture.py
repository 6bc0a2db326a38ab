"""Patterns and look-ups: checkers, images in arrays, coordinates on a sphere. Textures proper are read with `ox.tex2d`."""

import optixc as ox
from optixc import float2, float3, float4
from optixc.stdlib.math import INV_PI, safe_acos


@ox.device
def checker(place: float2) -> bool:
    """Whether the unit square that holds `place` is one of the light ones."""
    return (int(ox.floor(place.x)) + int(ox.floor(place.y))) % 2 == 0


@ox.device
def line_pattern(place: float2, width: float) -> bool:
    """Whether `place` is on a line of the integer grid, of this full width."""
    half = 0.5 * width
    x = ox.fract(place.x + half)
    y = ox.fract(place.y + half)
    return x < width or y < width


@ox.device
def wrap_texel(i: int, size: int) -> int:
    """A texel number repeated over and over."""
    return i % size


@ox.device
def bilinear(image: ox.Array2[float4], place: float2) -> float4:
    """An image that repeats, with texel centres at half numbers; (0, 0) is the upper left corner of the first texel."""
    height, width = int(image.shape[0]), int(image.shape[1])
    x = place.x * float(width) - 0.5
    y = place.y * float(height) - 0.5
    left, top = int(ox.floor(x)), int(ox.floor(y))
    tx = x - ox.floor(x)
    ty = y - ox.floor(y)
    x0, x1 = wrap_texel(left, width), wrap_texel(left + 1, width)
    y0, y1 = wrap_texel(top, height), wrap_texel(top + 1, height)
    upper = ox.lerp(image[y0, x0], image[y0, x1], float4(tx))
    lower = ox.lerp(image[y1, x0], image[y1, x1], float4(tx))
    return ox.lerp(upper, lower, float4(ty))


@ox.device
def sphere_coordinates(n: float3) -> float2:
    """Longitude and latitude of a unit vector as texture coordinates; y is up, v grows downwards."""
    return float2(0.5 + 0.5 * INV_PI * ox.atan2(n.x, n.z), INV_PI * safe_acos(n.y))


@ox.device
def triplanar_weights(n: float3, sharpness: float) -> float3:
    """How much of the projections along x, y and z a surface with this normal takes; they sum to 1."""
    w = float3(ox.pow(abs(n.x), sharpness), ox.pow(abs(n.y), sharpness), ox.pow(abs(n.z), sharpness))
    return w / (w.x + w.y + w.z)
