"""Opacity micromaps from a picture: bounds of what its points may read decide about a micro-triangle, so a known state is never wrong."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optixc.enums_scene import OpacityMicromapFormat
from optixc.errors import InvalidValueError
from optixc.host.micromap_curve import micromap_index_to_base_barycentrics
from optixc.host.opacity import (
    MAX_LEVEL,
    OPAQUE,
    TRANSPARENT,
    UNKNOWN_OPAQUE,
    UNKNOWN_TRANSPARENT,
    BuildInputOpacityMicromap,
    OpacityMicromap,
    take_numbers,
)
from optixc.host.whole_numbers import take_whole

# Texels: interpolated coordinates are rounded, and so is the sum of the weights of a filter.
_COORDINATE_ROUNDING = 1.0 / 256.0
# Of a coordinate: what interpolation in float32 may be off by, which counts far outside of the picture.
_RELATIVE_ROUNDING = 2.0**-21
# From here on float32 coordinates have no fraction.
_FARTHEST = 2.0**24
_ALPHA_ROUNDING = 1e-6
_AT_ONCE = 1 << 20
_PICTURES = 4
_FINEST = 3  # levels by which a micro-triangle is split to bound what a filter gives on it
Floats = NDArray[np.float64]
Counts = NDArray[np.int64]


@dataclass(frozen=True)
class BakedOpacity:
    """What was baked: the micromaps that differ from each other, an index for each triangle, and what share of the area is known."""

    maps: tuple[OpacityMicromap, ...]
    indices: NDArray[np.int32]
    known: float

    def build(self, context: Any) -> BuildInputOpacityMicromap:
        """The build input's part, with the micromaps in an array of the context."""
        return BuildInputOpacityMicromap(context.opacity_micromap_array_build(list(self.maps)) if self.maps else None, self.indices)


def bake_opacity_micromap(
    alpha: Any,
    uvs: Any,
    indices: Any = None,
    *,
    level: int = 6,
    cutoff: float = 0.5,
    filter: str = "linear",
    wrap: str = "repeat",
) -> BakedOpacity:
    """Micromaps for an any-hit program that ignores hits where the alpha read from the picture is below `cutoff`.

    `alpha` is (height, width), uint8 (0 to 255 are 0 to 1) or float; `uvs` float (n, 2) by vertex, `indices` (m, 3) or None for vertices in
    threes. `filter` ("linear", "nearest") and `wrap` ("repeat", "clamp") are those of the texture that the program reads. A
    micro-triangle is opaque or transparent only if all values that its points may read say so; else it is unknown, and the program
    decides as before. Triangles of one state need no micromap; equal micromaps are kept once.
    """
    picture = _picture(alpha)
    corners = _corners(uvs, indices)
    take_whole(level, 0, MAX_LEVEL, "level")
    if filter not in ("linear", "nearest") or wrap not in ("repeat", "clamp"):
        raise InvalidValueError(f'filter is "linear" or "nearest" and wrap "repeat" or "clamp", not {filter!r} and {wrap!r}')
    if not isinstance(cutoff, int | float) or math.isnan(cutoff):
        raise InvalidValueError(f"cutoff takes a number, not {cutoff!r}")
    farthest = float(np.abs(corners).max(initial=0.0)) * max(picture.shape)
    rounding = max(_COORDINATE_ROUNDING, _RELATIVE_ROUNDING * farthest)
    sampler = _Sampler(picture, cutoff, filter == "linear", wrap == "repeat", rounding)
    parts = np.stack(micromap_index_to_base_barycentrics(np.arange(4**level), level)).astype(np.float64)
    # Foliage repeats its texture coordinates: equal triangles are looked at once
    unlike, of_triangle, uses = np.unique(corners.reshape(-1, 6), axis=0, return_inverse=True, return_counts=True)
    step = max(1, _AT_ONCE // 4**level)
    maps: dict[bytes, int] = {}
    chosen = np.zeros(len(unlike), np.int32)
    known = 0
    for first in range(0, len(unlike), step):
        states = sampler.states(unlike[first : first + step].reshape(-1, 3, 2), parts)
        known += int(np.count_nonzero(states <= OPAQUE, axis=1) @ uses[first : first + step])
        for number, row in enumerate(states):
            if (row == row[0]).all():
                chosen[first + number] = -1 - int(row[0])
            else:
                chosen[first + number] = maps.setdefault(row.tobytes(), len(maps))
    made = tuple(OpacityMicromap(np.frombuffer(key, np.uint8), level, OpacityMicromapFormat.FORMAT_4_STATE) for key in maps)
    return BakedOpacity(made, chosen[of_triangle.ravel()], known / max(1, len(corners) * 4**level))


def _picture(alpha: Any) -> Floats:
    array = take_numbers(alpha, "alpha")
    if array.ndim != 2 or 0 in array.shape or array.dtype.kind not in "uf":
        what = f"{array.dtype} {array.shape}"
        raise InvalidValueError(f"alpha takes a picture of one channel, uint8 or float of shape (height, width), not {what}")
    return array.astype(np.float64) / (255.0 if array.dtype == np.uint8 else 1.0)


def _corners(uvs: Any, indices: Any) -> Floats:
    given = take_numbers(uvs, "uvs")
    if given.ndim != 2 or given.shape[1] != 2 or given.dtype.kind not in "iuf":
        raise InvalidValueError(f"uvs takes numbers of shape (n, 2), not {given.dtype} {given.shape}")
    points = given.astype(np.float64)
    wrong = np.flatnonzero(~(np.abs(points) <= _FARTHEST).all(axis=1))
    if len(wrong):
        what = f"uvs[{wrong[0]}] is {points[wrong[0]].tolist()}"
        raise InvalidValueError(f"{what}; coordinates are finite and at most {_FARTHEST:.0f} in size")
    if indices is None:
        return points[: len(points) // 3 * 3].reshape(-1, 3, 2)
    triangles = take_numbers(indices, "indices")
    is_table = triangles.dtype.kind in "iu" and triangles.ndim == 2 and triangles.shape[1] == 3
    if not is_table or (triangles.size and not 0 <= triangles.min() <= triangles.max() < len(points)):
        raise InvalidValueError(f"indices takes rows of three vertices below {len(points)}")
    return np.asarray(points[triangles], np.float64)


class _Sampler:
    """Counts of texels above and below the cut-off in rectangles of the picture, by summed areas."""

    def __init__(self, picture: Floats, cutoff: float, is_linear: bool, repeats: bool, rounding: float) -> None:
        self._rounding = rounding
        self._height, self._width = picture.shape
        self._is_linear, self._repeats = is_linear, repeats
        self._picture, self._cutoff = picture, cutoff
        tiles = np.tile(picture, (2, 2)) if repeats else picture
        self._opaque = _summed(tiles >= cutoff + _ALPHA_ROUNDING)
        self._transparent = _summed(tiles < cutoff - _ALPHA_ROUNDING)

    def states(self, corners: Floats, parts: Floats) -> NDArray[np.uint8]:
        """The state of every micro-triangle (their corners in `parts`) of every triangle."""
        size = np.array([self._width, self._height], np.float64)
        texels = _split(corners * size, parts)
        low = np.minimum(np.minimum(texels[0], texels[1]), texels[2]) - self._rounding
        high = np.maximum(np.maximum(texels[0], texels[1]), texels[2]) + self._rounding
        shift = 0.5 if self._is_linear else 0.0
        first = np.floor(low - shift).astype(np.int64)
        last = np.floor(high - shift).astype(np.int64) + (1 if self._is_linear else 0)
        x0, x1 = self._range(first[..., 0], last[..., 0], self._width)
        y0, y1 = self._range(first[..., 1], last[..., 1], self._height)
        area = (x1 - x0) * (y1 - y0)
        states = np.where(self._middle_is_opaque(texels), UNKNOWN_OPAQUE, UNKNOWN_TRANSPARENT).astype(np.uint8)
        states[_count(self._opaque, x0, x1, y0, y1) == area] = OPAQUE
        states[_count(self._transparent, x0, x1, y0, y1) == area] = TRANSPARENT
        # What is many pictures high would take for ever, and is hardly of one state
        unknown = np.nonzero((states > OPAQUE) & (high[..., 1] - low[..., 1] <= _PICTURES * self._height))
        states[unknown] = self._state_by_rows(np.stack([one[unknown] for one in texels], axis=1), states[unknown])
        if self._is_linear:
            unknown = np.nonzero(states > OPAQUE)
            states[unknown] = self._state_by_parts(np.stack([one[unknown] for one in texels], axis=1), states[unknown])
        return states

    def _state_by_rows(self, points: Floats, states: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """States of micro-triangles (n, 3, 2) that their rectangles do not tell: row by row, only the texels beside the triangle count."""
        shift = 0.5 if self._is_linear else 0.0
        more = 1 if self._is_linear else 0
        first = np.floor(points[:, :, 1].min(axis=1) - self._rounding - shift).astype(np.int64)
        last = np.floor(points[:, :, 1].max(axis=1) + self._rounding - shift).astype(np.int64)
        is_opaque, is_transparent = np.ones(len(points), bool), np.ones(len(points), bool)
        for step in range(int((last - first).max(initial=-1)) + 1):
            row = np.minimum(first + step, last)
            left, right = _extent(points, row + shift - self._rounding, row + 1 + shift + self._rounding)
            begin = np.floor(left - self._rounding - shift).astype(np.int64)
            end = np.floor(right + self._rounding - shift).astype(np.int64)
            x0, x1 = self._range(begin, end + more, self._width)
            y0, y1 = self._range(row, row + more, self._height)
            area = (x1 - x0) * (y1 - y0)
            is_opaque &= _count(self._opaque, x0, x1, y0, y1) == area
            is_transparent &= _count(self._transparent, x0, x1, y0, y1) == area
        return np.where(is_opaque, OPAQUE, np.where(is_transparent, TRANSPARENT, states)).astype(np.uint8)

    def _state_by_parts(self, points: Floats, states: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """States of micro-triangles (n, 3, 2) that texels do not tell: by bounds of the filtered values in rectangles of about a texel."""
        size = (points.max(axis=1) - points.min(axis=1)).max(axis=1, initial=1.0)
        level = np.minimum(np.ceil(np.log2(size)), _FINEST).astype(np.int64)
        made = states.copy()
        for finer in range(_FINEST + 1):
            parts = np.stack(micromap_index_to_base_barycentrics(np.arange(4**finer), finer)).astype(np.float64)
            chosen = np.flatnonzero(level == finer)
            step = max(1, _AT_ONCE // 4**finer)
            for first in range(0, len(chosen), step):
                numbers = chosen[first : first + step]
                least, most = self._filtered_bounds(_split(points[numbers], parts))
                known = np.where(most < self._cutoff - _ALPHA_ROUNDING, TRANSPARENT, states[numbers])
                made[numbers] = np.where(least >= self._cutoff + _ALPHA_ROUNDING, OPAQUE, known)
        return made

    def _filtered_bounds(self, corners: list[Floats]) -> tuple[Floats, Floats]:
        """The least and the greatest filtered alpha on rows of small triangles, corner by corner (n, m, 2). Between four texel centres it
        is bilinear, so on a rectangle its extremes lie at the corners."""
        low = np.minimum(np.minimum(corners[0], corners[1]), corners[2]) - self._rounding - 0.5
        high = np.maximum(np.maximum(corners[0], corners[1]), corners[2]) + self._rounding - 0.5
        first, last = np.floor(low).astype(np.int64), np.floor(high).astype(np.int64)
        least, most = np.full(low.shape[:2], np.inf), np.full(low.shape[:2], -np.inf)
        for offset in ((0, 0), (1, 0), (0, 1), (1, 1)):
            cell = first + np.array(offset)
            begin, end = np.clip(low - cell, 0.0, 1.0), np.clip(high - cell, 0.0, 1.0)
            values = []
            for x, y in ((begin, begin), (begin, end), (end, begin), (end, end)):
                upper = self._alpha(cell, 0, 0) * (1.0 - x[..., 0]) + self._alpha(cell, 1, 0) * x[..., 0]
                lower = self._alpha(cell, 0, 1) * (1.0 - x[..., 0]) + self._alpha(cell, 1, 1) * x[..., 0]
                values.append(upper * (1.0 - y[..., 1]) + lower * y[..., 1])
            reached = (cell <= last).all(axis=-1)
            least = np.where(reached, np.minimum(least, np.min(values, axis=0)), least)
            most = np.where(reached, np.maximum(most, np.max(values, axis=0)), most)
        is_wide = (last - first > 1).any(axis=-1)
        return np.where(is_wide, -np.inf, least).min(axis=1), np.where(is_wide, np.inf, most).max(axis=1)

    def _alpha(self, cell: Counts, right: int, down: int) -> Floats:
        """Alpha of the texel beside a cell's first one."""
        x, y = cell[..., 0] + right, cell[..., 1] + down
        if self._repeats:
            return self._picture[np.mod(y, self._height), np.mod(x, self._width)]
        return self._picture[np.clip(y, 0, self._height - 1), np.clip(x, 0, self._width - 1)]

    def _range(self, first: Counts, last: Counts, size: int) -> tuple[Counts, Counts]:
        """Texels first to last as begin and end of a range in the summed areas."""
        if not self._repeats:
            return np.clip(first, 0, size - 1), np.clip(last, 0, size - 1) + 1
        count = np.minimum(last - first + 1, size)
        begin = np.mod(first, size)
        return begin, begin + count

    def _middle_is_opaque(self, texels: list[Floats]) -> NDArray[np.bool_]:
        middle = np.floor((texels[0] + texels[1] + texels[2]) / 3.0).astype(np.int64)
        x, y = middle[..., 0], middle[..., 1]
        if self._repeats:
            x, y = np.mod(x, self._width), np.mod(y, self._height)
        else:
            x, y = np.clip(x, 0, self._width - 1), np.clip(y, 0, self._height - 1)
        return np.asarray(self._picture[y, x] >= self._cutoff)


def _split(corners: Floats, parts: Floats) -> list[Floats]:
    """The three corners (n, m, 2) of every micro-triangle, given by barycentrics (3, m, 2), of triangles (n, 3, 2)."""
    a, b, c = corners[:, None, 0], corners[:, None, 1], corners[:, None, 2]
    return [a + part[None, :, :1] * (b - a) + part[None, :, 1:] * (c - a) for part in parts]


def _extent(points: Floats, bottom: Floats, top: Floats) -> tuple[Floats, Floats]:
    """The least and the greatest x of triangles (n, 3, 2) where y is between `bottom` and `top`, from their clipped edges."""
    left, right = np.full(len(points), np.inf), np.full(len(points), -np.inf)
    for a, b in ((points[:, 0], points[:, 1]), (points[:, 1], points[:, 2]), (points[:, 2], points[:, 0])):
        rise = b[:, 1] - a[:, 1]
        is_level = rise == 0.0
        slope = np.where(is_level, 1.0, rise)
        at_bottom, at_top = (bottom - a[:, 1]) / slope, (top - a[:, 1]) / slope
        inside = (a[:, 1] >= bottom) & (a[:, 1] <= top)
        begin = np.where(is_level, np.where(inside, 0.0, 2.0), np.clip(np.minimum(at_bottom, at_top), 0.0, None))
        end = np.where(is_level, np.where(inside, 1.0, -1.0), np.clip(np.maximum(at_bottom, at_top), None, 1.0))
        for t in (begin, end):
            x = a[:, 0] + t * (b[:, 0] - a[:, 0])
            left = np.where(begin <= end, np.minimum(left, x), left)
            right = np.where(begin <= end, np.maximum(right, x), right)
    is_outside = left > right  # by rounding only: the whole width is safe
    return np.where(is_outside, points[:, :, 0].min(axis=1), left), np.where(is_outside, points[:, :, 0].max(axis=1), right)


def _summed(mask: NDArray[np.bool_]) -> Counts:
    sums = np.zeros((mask.shape[0] + 1, mask.shape[1] + 1), np.int64)
    sums[1:, 1:] = mask.cumsum(axis=0, dtype=np.int64).cumsum(axis=1)
    return sums


def _count(sums: Counts, x0: Counts, x1: Counts, y0: Counts, y1: Counts) -> Counts:
    return np.asarray(sums[y1, x1] - sums[y0, x1] - sums[y1, x0] + sums[y0, x0])
