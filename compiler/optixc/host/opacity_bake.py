"""Opacity micromaps from a picture: every texel that a micro-triangle's points may read decides, so a known state is never wrong."""

from __future__ import annotations

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
)

# Texels: interpolated coordinates are rounded, and so is the sum of the weights of a filter.
_COORDINATE_ROUNDING = 1.0 / 256.0
_ALPHA_ROUNDING = 1e-6
_AT_ONCE = 1 << 20
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
    micro-triangle is opaque or transparent only if every texel that its points may read says so; else it is unknown, and the program
    decides as before. Triangles of one state need no micromap; equal micromaps are kept once.
    """
    picture = _picture(alpha)
    corners = _corners(uvs, indices)
    if not isinstance(level, int) or not 0 <= level <= MAX_LEVEL:
        raise InvalidValueError(f"level must be 0 to {MAX_LEVEL}, not {level!r}")
    if filter not in ("linear", "nearest") or wrap not in ("repeat", "clamp"):
        raise InvalidValueError(f'filter is "linear" or "nearest" and wrap "repeat" or "clamp", not {filter!r} and {wrap!r}')
    sampler = _Sampler(picture, cutoff, filter == "linear", wrap == "repeat")
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
    array = np.asarray(alpha)
    if array.ndim != 2 or 0 in array.shape or array.dtype.kind not in "uf":
        raise InvalidValueError(f"alpha takes a picture of one channel, uint8 or float of shape (height, width), not {array.shape}")
    return array.astype(np.float64) / (255.0 if array.dtype == np.uint8 else 1.0)


def _corners(uvs: Any, indices: Any) -> Floats:
    points = np.asarray(uvs, np.float64)
    if points.ndim != 2 or points.shape[1] != 2:
        raise InvalidValueError(f"uvs takes an array of shape (n, 2), not {points.shape}")
    if indices is None:
        return points[: len(points) // 3 * 3].reshape(-1, 3, 2)
    triangles = np.asarray(indices)
    if triangles.ndim != 2 or triangles.shape[1] != 3 or (triangles.size and not 0 <= triangles.min() <= triangles.max() < len(points)):
        raise InvalidValueError(f"indices takes rows of three vertices below {len(points)}")
    return np.asarray(points[triangles], np.float64)


class _Sampler:
    """Counts of texels above and below the cut-off in rectangles of the picture, by summed areas."""

    def __init__(self, picture: Floats, cutoff: float, is_linear: bool, repeats: bool) -> None:
        self._height, self._width = picture.shape
        self._is_linear, self._repeats = is_linear, repeats
        self._picture, self._cutoff = picture, cutoff
        tiles = np.tile(picture, (2, 2)) if repeats else picture
        self._opaque = _summed(tiles >= cutoff + _ALPHA_ROUNDING)
        self._transparent = _summed(tiles < cutoff - _ALPHA_ROUNDING)

    def states(self, corners: Floats, parts: Floats) -> NDArray[np.uint8]:
        """The state of every micro-triangle (their corners in `parts`) of every triangle."""
        size = np.array([self._width, self._height], np.float64)
        a, b, c = corners[:, None, 0], corners[:, None, 1], corners[:, None, 2]
        texels = [(a + part[None, :, :1] * (b - a) + part[None, :, 1:] * (c - a)) * size for part in parts]
        low = np.minimum(np.minimum(texels[0], texels[1]), texels[2]) - _COORDINATE_ROUNDING
        high = np.maximum(np.maximum(texels[0], texels[1]), texels[2]) + _COORDINATE_ROUNDING
        shift = 0.5 if self._is_linear else 0.0
        first = np.floor(low - shift).astype(np.int64)
        last = np.floor(high - shift).astype(np.int64) + (1 if self._is_linear else 0)
        x0, x1 = self._range(first[..., 0], last[..., 0], self._width)
        y0, y1 = self._range(first[..., 1], last[..., 1], self._height)
        area = (x1 - x0) * (y1 - y0)
        states = np.where(self._middle_is_opaque(texels), UNKNOWN_OPAQUE, UNKNOWN_TRANSPARENT).astype(np.uint8)
        states[_count(self._opaque, x0, x1, y0, y1) == area] = OPAQUE
        states[_count(self._transparent, x0, x1, y0, y1) == area] = TRANSPARENT
        return states

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


def _summed(mask: NDArray[np.bool_]) -> Counts:
    sums = np.zeros((mask.shape[0] + 1, mask.shape[1] + 1), np.int64)
    sums[1:, 1:] = mask.cumsum(axis=0, dtype=np.int64).cumsum(axis=1)
    return sums


def _count(sums: Counts, x0: Counts, x1: Counts, y0: Counts, y1: Counts) -> Counts:
    return np.asarray(sums[y1, x1] - sums[y0, x1] - sums[y1, x0] + sums[y0, x0])
