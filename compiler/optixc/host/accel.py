"""Acceleration structures: built from build inputs, named by 64-bit handles."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

import numpy as np

from optixc.enums_scene import AccelPropertyType, BuildFlags
from optixc.errors import InvalidValueError
from optixc.host import library
from optixc.host.context import Context
from optixc.host.inputs import BuildInput, MotionOptions, pack_inputs, take_handle
from optixc.host.owned import Owned
from optixc.host.sbt_reach import Parts, below, parts_of
from optixc.host.whole_numbers import WORD_LIMIT, take_member, take_whole


class TraversableHandle(int):
    """A traversable's 64-bit handle. It keeps its accel alive, so that parameters and records that hold it do."""

    of = "Traversable"
    accel: Any

    def __new__(cls, value: int, accel: Any = None) -> TraversableHandle:
        made = super().__new__(cls, value)
        made.accel = accel
        return made

    def __reduce__(self) -> tuple[Any, ...]:
        return int, (int(self),)


def moves_by_transform(traversable: Any) -> bool:
    """Whether motion transforms lie in the graph below a traversable, as far as Python knows it: plain numbers tell nothing."""
    known = traversable.accel if isinstance(traversable, TraversableHandle) else traversable
    return bool(getattr(known, "moves_by_transform", False))


class Accel(Owned):
    """A GAS or IAS. It lives as long as something refers to it (this object, a handle, a parent), or until `destroy()`."""

    def __init__(self, context: Context, inputs: Sequence[BuildInput], build_flags: int, motion_options: MotionOptions | None) -> None:
        self._accel: Any = None
        self._context = context
        build_flags = take_whole(build_flags, 0, WORD_LIMIT - 1, "build_flags combines BuildFlags: it")
        if motion_options is not None and not isinstance(motion_options, MotionOptions):
            raise InvalidValueError(f"motion_options takes a MotionOptions, not {type(motion_options).__name__}")
        self._build_flags = build_flags
        self._motion = motion_options
        self._inputs: tuple[BuildInput, ...] = tuple(inputs) if isinstance(inputs, Sequence) else ()
        options = library.ffi().new("OxrtAccelBuildOptions*")
        options.buildFlags = build_flags
        if motion_options is not None:
            motion_options.fill(options.motion)
        packed = pack_inputs(inputs)
        made = library.ffi().new("OxrtAccel*")
        library.check(library.lib().oxrtAccelBuild(context.handle, options, packed.array, packed.count, made))
        self._accel = made[0]
        self._children = tuple(child for one in self._inputs for child in one.children())
        self._moves: bool | None = None
        self.parts = parts_of(self._inputs)
        self._inputs = ()
        self._handle = int(self._info().handle)

    @property
    def handle(self) -> TraversableHandle:
        """The 64-bit handle: slot and generation, never a pointer; stale after `destroy()`."""
        return TraversableHandle(self._handle, self)

    @property
    def aabb(self) -> np.ndarray[Any, Any]:
        """World bounds, float32 (2, 3): minimum and maximum; minimum above maximum if nothing can be hit."""
        return np.array(list(self._info().aabb), np.float32).reshape(2, 3)

    @property
    def memory_usage(self) -> int:
        """Bytes held by Embree and the runtime for this structure."""
        return int(self._info().memoryUsage)

    @property
    def primitive_count(self) -> int:
        """Primitives of a GAS, instances of an IAS."""
        return int(self._info().primitiveCount)

    @property
    def has_native_instances(self) -> bool:
        """Whether Embree walks through this IAS by itself: one level over static structures. Other graphs are walked through by kernels."""
        return bool(self._info().hasNativeInstances)

    @property
    def moves_by_transform(self) -> bool:
        """Whether motion transforms lie below this structure; looked for once, since there may be a million instances."""
        if self._moves is None:
            different = {id(child): child for child in self._children}.values()
            self._moves = any(moves_by_transform(child) for child in different)
        return self._moves

    @property
    def is_native(self) -> bool:
        """Whether Embree walks through this structure without the kernels: geometry, or an IAS with `has_native_instances`."""
        info = self._info() if self._accel is not None and self._context.is_alive else None
        return info is not None and bool(info.isGas or info.hasNativeInstances)

    def emit_property(self, property_type: AccelPropertyType | int) -> Any:
        """OptiX's optixAccelEmitProperty: COMPACTED_SIZE is a number of bytes and needs ALLOW_COMPACTION.

        AABBS are the world bounds at each motion key, float32 (keys, 2, 3), minimum above maximum where nothing can be hit.
        """
        ffi, emit = library.ffi(), library.lib().oxrtAccelEmitProperty
        kind = take_member(property_type, AccelPropertyType, "emit_property")
        if kind == AccelPropertyType.COMPACTED_SIZE:
            size = ffi.new("uint64_t*")
            library.check(emit(self._live(), kind, size, 8))
            return int(size[0])
        keys = 1 if self._motion is None else max(1, int(self._motion.num_keys))
        boxes = np.empty((keys, 2, 3), np.float32)
        library.check(emit(self._live(), kind, ffi.cast("float*", boxes.ctypes.data), boxes.nbytes))
        return boxes

    def update(self, inputs: Sequence[BuildInput]) -> Accel:
        """Refits to the same inputs with other coordinates; needs ALLOW_UPDATE. The handle stays."""
        if not self._build_flags & BuildFlags.ALLOW_UPDATE:
            raise InvalidValueError("update() needs an accel that was built with BuildFlags.ALLOW_UPDATE")
        packed = pack_inputs(inputs)
        library.check(library.lib().oxrtAccelUpdate(self._live(), packed.array, packed.count))
        self._children = tuple(child for one in inputs for child in one.children())
        self._moves = None
        self.parts = parts_of(inputs)
        return self

    def compact(self) -> Accel:
        """Another accel that is hit like this one, which may be destroyed then; needs ALLOW_COMPACTION, as in OptiX.

        Embree's builds are compact already: what cannot be updated shares its memory, the rest is built again.
        """
        made = library.ffi().new("OxrtAccel*")
        library.check(library.lib().oxrtAccelCompact(self._live(), made))
        return self._copied(made[0], self._children, self.parts)

    def relocate(self, children: Sequence[Any] | None = None) -> Accel:
        """Another accel that is hit like this one; of an IAS with other children where they are given, one for each instance."""
        ffi = library.ffi()
        if children is not None and (not isinstance(children, Sequence | np.ndarray) or getattr(children, "ndim", 1) != 1):
            raise InvalidValueError(f"relocate takes a list of children, not {type(children).__name__}")
        children = None if children is None or len(children) == 0 else children
        handles = ffi.NULL if children is None else ffi.new("uint64_t[]", [take_handle(child, "relocate") for child in children])
        made = ffi.new("OxrtAccel*")
        library.check(library.lib().oxrtAccelRelocate(self._live(), handles, 0 if children is None else len(children), made))
        if children is None:
            return self._copied(made[0], self._children, self.parts)
        return self._copied(made[0], tuple(children), below(self.parts, children))

    def _copied(self, accel: Any, children: tuple[Any, ...], parts: Parts) -> Accel:
        """A Python object for a copy that the runtime made."""
        made: Accel = object.__new__(Accel)
        made._accel, made._context, made._build_flags, made._motion = accel, self._context, self._build_flags, self._motion
        made._inputs, made._children, made.parts = (), children, parts
        made._moves = None
        made._handle = int(made._info().handle)
        return made

    def destroy(self) -> None:
        """Makes the handle stale; memory goes when no IAS and no launch uses it. Nothing happens the second time."""
        accel, self._accel = self._accel, None
        if accel is not None and self._context.is_alive:
            library.check(library.lib().oxrtAccelDestroy(accel))

    def _live(self) -> Any:
        if self._accel is None:
            raise InvalidValueError("this accel was destroyed")
        # Raises for a destroyed context and in a forked child.
        _ = self._context.handle
        return self._accel

    def _info(self) -> Any:
        info = library.ffi().new("OxrtAccelInfo*")
        library.check(library.lib().oxrtAccelGetInfo(self._live(), info))
        return info

    def __del__(self) -> None:
        if getattr(self, "_accel", None) is not None and not sys.is_finalizing():
            self.destroy()

    def __repr__(self) -> str:
        return f"<Accel {self._handle:#x}{'' if self._accel is not None else ' destroyed'}>"
