"""The order of a micromap's micro-triangles: from index to corners and back, for numbers and numpy arrays alike.

The curve is that of OptiX's micromap header: index 0 touches vertex 0, the last one vertex 2, children of index i are 4 i to 4 i + 3.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from optixc.errors import InvalidValueError

Indices = NDArray[np.int64]
Points = NDArray[np.float32]
_MAX_LEVEL = 12


def _parity_above(x: Indices) -> Indices:
    """Bit i of the result: the parity of the bits i and above."""
    for shift in (1, 2, 4, 8):
        x = x ^ (x >> shift)
    return x


def _even_bits(x: Indices) -> Indices:
    result = np.zeros_like(x)
    for bit in range(_MAX_LEVEL):
        result |= ((x >> (2 * bit)) & 1) << bit
    return result


def _spread_bits(x: Indices) -> Indices:
    result = np.zeros_like(x)
    for bit in range(_MAX_LEVEL):
        result |= ((x >> bit) & 1) << (2 * bit)
    return result


def _check_level(level: int) -> None:
    if not isinstance(level, int) or not 0 <= level <= _MAX_LEVEL:
        raise InvalidValueError(f"a subdivision level is 0 to {_MAX_LEVEL}, not {level!r}")


def micromap_index_to_base_barycentrics(index: Any, subdivision_level: int) -> tuple[Points, Points, Points]:
    """The barycentrics (u, v) in the base triangle of a micro-triangle's three corners, float32 (..., 2) each."""
    _check_level(subdivision_level)
    number = np.asarray(index, np.int64)
    if number.size and not 0 <= int(number.min()) <= int(number.max()) < 4**subdivision_level:
        raise InvalidValueError(f"level {subdivision_level} has micro-triangles 0 to {4**subdivision_level - 1}, not {index!r:.60}")
    low = (1 << subdivision_level) - 1
    b0, b1 = _even_bits(number), _even_bits(number >> 1)
    fx, fy = _parity_above(b0), _parity_above(b0 & ~b1)
    t = fy ^ b1
    u = ((fx & ~t) | (b0 & ~t) | (~b0 & ~fx & t)) & low
    v = (fy ^ b0) & low
    w = ((~fx & ~t) | (b0 & ~t) | (~b0 & fx & t)) & low
    # the micro-triangle stands on its head where u + v + w is even
    flip = (u ^ v ^ w ^ 1) & 1 if subdivision_level else np.zeros_like(u)
    order = _order_flip(number)
    scale = np.float32(1.0 / (1 << subdivision_level))
    if subdivision_level == 0:
        order = np.zeros_like(u)

    def corner(a: Indices, b: Indices) -> Points:
        return np.stack([a, b], axis=-1).astype(np.float32) * scale

    return corner(u + order, v + flip), corner(u + 1 - order, v + flip), corner(u + flip, v + 1 - flip)


def _order_flip(number: Indices) -> Indices:
    """Which of the two corners of the horizontal side comes first: its parity over groups of three pairs of bits."""
    pattern = 0x8888888888888888 ^ 0xF000F000F000F000 ^ 0xFFFF000000000000
    table = np.array([(pattern >> i) & 1 for i in range(64)], np.int64)
    result = np.zeros_like(number)
    for shift in range(0, 2 * _MAX_LEVEL, 6):
        result ^= table[(number >> shift) & 63]
    return result


def barycentrics_to_micromap_index(u: Any, v: Any, subdivision_level: int) -> Indices:
    """The micro-triangle that holds a point: the inverse of `micromap_index_to_base_barycentrics`, as the runtime looks it up."""
    _check_level(subdivision_level)
    last = (1 << subdivision_level) - 1
    scaled = [np.maximum(np.asarray(x, np.float32) * np.float32(last + 1), np.float32(0)) for x in (u, v)]
    iu, iv = (np.minimum(x.astype(np.int64), last) for x in scaled)
    over = np.maximum(iu + iv - last, 0)
    larger = iu > iv
    iu, iv = np.where(larger, iu - over, iu), np.where(larger, iv, iv - over)
    rest = (scaled[0] - iu) + (scaled[1] - iv)
    iw = ~(iu + iv) & last
    iw = np.where((rest > 1) & (iu + iv < last), (iw - 1) & last, iw)
    b0 = ~(iu ^ iw) & last
    t = (iu ^ iv) & b0
    b1 = (((_parity_above(t) ^ iu) & ~b0) | t) & last
    return _spread_bits(b0) | _spread_bits(b1) << 1


def base_barycentrics_to_micro_barycentrics(base: Any, micro0: Any, micro1: Any, micro2: Any) -> Points:
    """A point's barycentrics in a micro-triangle, from those in the base triangle and the micro-triangle's corners there."""
    point, corner = np.asarray(base, np.float32), np.asarray(micro0, np.float32)
    a, b, p = np.asarray(micro1, np.float32) - corner, np.asarray(micro2, np.float32) - corner, point - corner
    determinant = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return np.stack(
        [(p[..., 0] * b[..., 1] - p[..., 1] * b[..., 0]) / determinant, (a[..., 0] * p[..., 1] - a[..., 1] * p[..., 0]) / determinant],
        axis=-1,
    )
