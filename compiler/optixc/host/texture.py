"""Textures: pixels that shaders read with `tex2d`, filtered and wrapped."""


from __future__ import annotations

import sys
from typing import Any

import numpy as np
import numpy.typing as npt

from optixc.errors import InvalidValueError
from optixc.host import library
from optixc.host.owned import Owned

_FORMATS = {"float32": 0, "uint8": 1}
_FILTERS = {"nearest": 0, "linear": 1}
_WRAPS = {"repeat": 0, "clamp": 1, "mirror": 2, "border": 3}


class TextureHandle(int):
    """A texture's 64-bit handle. It keeps its texture alive, so that parameters and records that hold it do."""

    of = "Texture"
    texture: Any

    def __new__(cls, value: int, texture: Any = None) -> TextureHandle:
        made = super().__new__(cls, value)
        made.texture = texture
        return made

    def __reduce__(self) -> tuple[Any, ...]:
        return int, (int(self),)


class Texture2D(Owned):
    """A picture that the programs of every context can read.

    `array` is (height, width) or (height, width, 1 to 4), float32 or uint8 (read as 0 to 1), and is copied; its first row is v = 0, its
    first column u = 0, and texel centres lie at (i + 0.5) / size. `filter` is "linear" or "nearest"; `wrap` is "repeat", "clamp",
    "mirror" or "border" (zero outside), or a pair of them for u and v; `srgb` decodes the colours of uint8 texels, before filtering.
    Missing channels read as 0, a missing alpha as 1.
    """

    def __init__(
        self, array: npt.NDArray[Any], *, filter: str = "linear", wrap: str | tuple[str, str] = "repeat", srgb: bool = False
    ) -> None:
        self._handle: int | None = None
        self._generation = library.process_generation()
        texels = _checked(array)
        wraps = wrap if isinstance(wrap, tuple) and len(wrap) == 2 else (wrap, wrap)
        self.height, self.width, self.channels = (int(size) for size in texels.shape)
        options = library.ffi().new("OxrtTextureOptions*")
        options.texels = library.ffi().from_buffer(texels)
        options.width, options.height, options.channels = self.width, self.height, self.channels
        options.format = _FORMATS[texels.dtype.name]
        options.filter = _chosen("filter", filter, _FILTERS)
        options.wrapU, options.wrapV = (_chosen("wrap", one, _WRAPS) for one in wraps)
        if not isinstance(srgb, bool):
            raise InvalidValueError(f"Texture2D: srgb takes a bool, not {srgb!r}")
        options.srgb = srgb
        made = library.ffi().new("uint64_t*")
        library.check(library.lib().oxrtTextureCreate(library.ffi().NULL, options, made))
        self._handle = int(made[0])

    @property
    def handle(self) -> TextureHandle:
        """The 64-bit handle: slot and generation, never a pointer; a stale one reads as zero."""
        if self._handle is None:
            raise InvalidValueError("this texture was destroyed")
        return TextureHandle(self._handle, self)

    def destroy(self) -> None:
        """Makes the handle stale; memory goes when no launch reads it. Nothing happens the second time."""
        handle, self._handle = self._handle, None
        if handle is not None and self._generation == library.process_generation():
            library.check(library.lib().oxrtTextureDestroy(library.ffi().NULL, handle))

    def __del__(self) -> None:
        if getattr(self, "_handle", None) is not None and not sys.is_finalizing():
            self.destroy()

    def __repr__(self) -> str:
        return f"<Texture2D {self.width} x {self.height} x {self.channels}{'' if self._handle is not None else ' destroyed'}>"


def _checked(array: Any) -> npt.NDArray[Any]:
    """The texels with three axes, in C order."""
    if not isinstance(array, np.ndarray) or array.dtype.name not in _FORMATS:
        got = f"an array of {array.dtype}" if isinstance(array, np.ndarray) else type(array).__name__
        raise InvalidValueError(f"Texture2D takes a numpy array of float32 or uint8, not {got}")
    texels = array[:, :, np.newaxis] if array.ndim == 2 else array
    if texels.ndim != 3 or not 1 <= texels.shape[2] <= 4:
        raise InvalidValueError(f"Texture2D takes an array of shape (height, width) or (height, width, 1 to 4), not {array.shape}")
    return np.ascontiguousarray(texels)


def _chosen(what: str, value: Any, known: dict[str, int]) -> int:
    if not isinstance(value, str) or value not in known:
        raise InvalidValueError(f"Texture2D: {what} takes one of {', '.join(known)}, not {value!r}")
    return known[value]
