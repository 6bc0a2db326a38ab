"""Random numbers and directions: the same as in the hand-written kernels, number for number."""

import optixc as ox
from optixc import float2, float3


@ox.struct
class Random:
    """A PCG stream of 32 bits."""

    state: ox.uint32


@ox.device
def pcg_hash(value: ox.uint32) -> ox.uint32:
    """O'Neill's PCG RXS-M-XS, one step from `value`."""
    state = value * 747796405 + 2891336453
    word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737
    return (word >> 22) ^ word


@ox.device
def random_float(random: Random) -> float:
    """The next number in [0, 1)."""
    word = pcg_hash(random.state)
    random.state = random.state * 747796405 + 2891336453
    return float(word >> 8) * 5.9604644775390625e-08


@ox.device
def random_float2(random: Random) -> float2:
    """The next two numbers in [0, 1)."""
    first = random_float(random)
    second = random_float(random)
    return float2(first, second)


@ox.device
def tangents(n: float3) -> tuple[float3, float3]:
    """Two unit vectors that are perpendicular to the unit vector `n` and to each other (Duff et al. 2017)."""
    sign = 1.0 if n.z >= 0.0 else -1.0
    a = -1.0 / (sign + n.z)
    b = n.x * n.y * a
    return float3(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), float3(b, sign + n.y * n.y * a, -n.y)


@ox.device
def cosine_hemisphere(u: float2) -> float3:
    """A direction about +z with density cos(theta) / pi (Malley's method)."""
    radius = ox.sqrt(u.x)
    phi = 6.283185307 * u.y
    return float3(radius * ox.cos(phi), radius * ox.sin(phi), ox.sqrt(1.0 - u.x))


@ox.device
def cosine_about(n: float3, u: float2) -> float3:
    """`cosine_hemisphere` about the unit vector `n`."""
    s, t = tangents(n)
    local = cosine_hemisphere(u)
    return local.x * s + local.y * t + local.z * n


@ox.device
def facing(n: float3, direction: float3) -> float3:
    """`n` turned against `direction`."""
    return -n if ox.dot(n, direction) > 0.0 else n
