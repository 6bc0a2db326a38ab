"""Gradient noise in three dimensions (Perlin 2002, with a hash in place of his table) and sums of octaves of it."""

import optixc as ox
from optixc import float3


@ox.device
def lattice_hash(x: ox.uint32, y: ox.uint32, z: ox.uint32) -> ox.uint32:
    """Well mixed bits for a point of the integer lattice."""
    h = (x * 73856093) ^ (y * 19349663) ^ (z * 83492791)
    h = (h ^ (h >> 15)) * 2246822519
    return h ^ (h >> 13)


@ox.device
def gradient(h: ox.uint32, x: float, y: float, z: float) -> float:
    """The dot product of (x, y, z) with one of Perlin's twelve gradients, chosen by the low four bits of `h`."""
    h = h & 15
    u = x if h < 8 else y
    v = y if h < 4 else (x if h == 12 or h == 14 else z)
    return (u if (h & 1) == 0 else -u) + (v if (h & 2) == 0 else -v)


@ox.device
def fade(t: float) -> float:
    """Perlin's quintic."""
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0)


@ox.device
def mix(a: float, b: float, t: float) -> float:
    return a + t * (b - a)


@ox.device
def noise(p: float3) -> float:
    """Gradient noise, about in [-1, 1]."""
    cell = ox.floor(p)
    x, y, z = p.x - cell.x, p.y - cell.y, p.z - cell.z
    i = ox.uint32(int(cell.x))
    j = ox.uint32(int(cell.y))
    k = ox.uint32(int(cell.z))
    u, v, w = fade(x), fade(y), fade(z)
    front = mix(
        mix(gradient(lattice_hash(i, j, k), x, y, z), gradient(lattice_hash(i + 1, j, k), x - 1.0, y, z), u),
        mix(gradient(lattice_hash(i, j + 1, k), x, y - 1.0, z), gradient(lattice_hash(i + 1, j + 1, k), x - 1.0, y - 1.0, z), u),
        v,
    )
    z1 = z - 1.0
    back = mix(
        mix(gradient(lattice_hash(i, j, k + 1), x, y, z1), gradient(lattice_hash(i + 1, j, k + 1), x - 1.0, y, z1), u),
        mix(gradient(lattice_hash(i, j + 1, k + 1), x, y - 1.0, z1), gradient(lattice_hash(i + 1, j + 1, k + 1), x - 1.0, y - 1.0, z1), u),
        v,
    )
    return mix(front, back, w)


@ox.device
def octaves(p: float3, count: int) -> float:
    """`count` octaves of noise, each at twice the frequency and half the height of the one before."""
    total = 0.0
    height = 0.5
    for _ in range(count):
        total += height * noise(p)
        p = 2.0 * p
        height *= 0.5
    return total
