"""Transforms as traversables of their own: static, or moving by matrix or SRT keys."""


from __future__ import annotations

import sys
from typing import Any

import numpy as np

from optixc.errors import InvalidValueError
from optixc.host import library
from optixc.host.accel import TraversableHandle, moves_by_transform
from optixc.host.context import Context
from optixc.host.inputs import MotionOptions, take_handle, take_transform
from optixc.host.owned import Owned

_SRT_FLOATS = 16


class Transform(Owned):
    """A static, matrix-motion or SRT-motion transform above a child, which it keeps alive; made by the methods of the context."""

    def __init__(self, context: Context, kind: str, child: Any, keys: np.ndarray[Any, Any], motion_options: MotionOptions | None) -> None:
        self._transform: Any = None
        self._context = context
        self._child = child
        self._kind = kind
        ffi, lib = library.ffi(), library.lib()
        options = ffi.new("OxrtTransformOptions*")
        options.type = getattr(lib, f"OXRT_TRANSFORM_{kind}")
        options.child = take_handle(child, "the child of a transform")
        options.keys = ffi.cast("float*", keys.ctypes.data)
        if motion_options is not None:
            motion_options.fill(options.motion)
        made = ffi.new("OxrtTransform*")
        library.check(lib.oxrtTransformCreate(context.handle, options, made))
        self._transform = made[0]
        handle = ffi.new("OxrtTraversableHandle*")
        library.check(lib.oxrtTransformGetHandle(self._transform, handle))
        self._handle = int(handle[0])

    @property
    def handle(self) -> TraversableHandle:
        """The 64-bit handle; stale after `destroy()`."""
        return TraversableHandle(self._handle, self)

    @property
    def moves_by_transform(self) -> bool:
        """Whether this is a motion transform or one lies below."""
        return self._kind != "STATIC" or moves_by_transform(self._child)

    def destroy(self) -> None:
        """Makes the handle stale; memory goes when no parent and no launch uses it. Nothing happens the second time."""
        transform, self._transform = self._transform, None
        if transform is not None and self._context.is_alive:
            library.check(library.lib().oxrtTransformDestroy(transform))

    def __del__(self) -> None:
        if getattr(self, "_transform", None) is not None and not sys.is_finalizing():
            self.destroy()

    def __repr__(self) -> str:
        return f"<Transform {self._handle:#x}{'' if self._transform is not None else ' destroyed'}>"


def static_transform(context: Context, child: Any, transform: Any) -> Transform:
    """`child` under a 3x4 matrix."""
    return Transform(context, "STATIC", child, take_transform(transform, "static_transform"), None)


def matrix_motion_transform(context: Context, child: Any, keys: Any, motion_options: MotionOptions | None) -> Transform:
    """`child` under matrices that are blended by element; `keys` has the shape (num_keys, 3, 4)."""
    matrices = _keys(keys, (3, 4), 12, "matrix_motion_transform")
    return Transform(context, "MATRIX_MOTION", child, matrices, _options(motion_options, len(matrices), "matrix_motion_transform"))


def srt_motion_transform(context: Context, child: Any, keys: Any, motion_options: MotionOptions | None) -> Transform:
    """`child` under scale, rotation and translation blended by component; `keys` has the shape (num_keys, 16), members in OptiX's order:
    sx a b pvx sy c pvy sz pvz qx qy qz qw tx ty tz."""
    rows = _keys(keys, (_SRT_FLOATS,), _SRT_FLOATS, "srt_motion_transform")
    return Transform(context, "SRT_MOTION", child, rows, _options(motion_options, len(rows), "srt_motion_transform"))


def _keys(keys: Any, shape: tuple[int, ...], floats: int, where: str) -> np.ndarray[Any, Any]:
    try:
        with np.errstate(all="ignore"):
            array = np.require(keys, np.float32, ("A", "C"))
    except (TypeError, ValueError) as error:
        raise InvalidValueError(f"{where} takes an array of keys, not {type(keys).__name__}") from error
    if array.ndim < 1 or array.shape[1:] not in (shape, (floats,)):
        raise InvalidValueError(f"{where} takes keys of shape (num_keys, {', '.join(map(str, shape))}), not {array.shape}")
    return array.reshape(-1, floats)


def _options(motion_options: MotionOptions | None, count: int, where: str) -> MotionOptions:
    """The options, by default the keys spread over 0 to 1."""
    if motion_options is None:
        return MotionOptions(count)
    if not isinstance(motion_options, MotionOptions):
        raise InvalidValueError(f"{where}: motion_options takes a MotionOptions, not {type(motion_options).__name__}")
    if motion_options.num_keys != count:
        raise InvalidValueError(f"{where}: motion_options.num_keys is {motion_options.num_keys}, but there are {count} keys")
    return motion_options
