"""Build inputs: arrays of the caller, checked for type, shape and order, as the runtime reads them.

Arrays are copied by the build; they may change or go afterwards. A list of arrays in place of one array gives motion keys, as does one
array with an axis more in front.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from optixc.enums import AABB_BUFFER_BYTE_ALIGNMENT
from optixc.enums_scene import GeometryFlags, InstanceFlags, MotionFlags
from optixc.errors import InvalidValueError
from optixc.host import library
from optixc.host.opacity import pack_micromaps
from optixc.host.vertex_formats import to_float3
from optixc.host.whole_numbers import WORD_LIMIT, take_whole

Keys = Any
_KEY_LIMIT = 1 << 16
_FLAGS_WANTED = "combines GeometryFlags, one word or one for each record"
_ALL_MOTION_FLAGS = int(MotionFlags.START_VANISH | MotionFlags.END_VANISH)
_IDENTITY = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)


@dataclass(frozen=True)
class MotionOptions:
    """OptiX's OptixMotionOptions: keys spread evenly from `time_begin` to `time_end`."""

    num_keys: int = 1
    time_begin: float = 0.0
    time_end: float = 1.0
    flags: MotionFlags | int = MotionFlags.NONE

    def fill(self, target: Any) -> None:
        """Writes the options into an OxrtMotionOptions."""
        target.numKeys = take_whole(self.num_keys, 0, _KEY_LIMIT - 1, "MotionOptions.num_keys")
        target.flags = take_whole(self.flags, 0, _ALL_MOTION_FLAGS, "MotionOptions.flags combines MotionFlags: it")
        try:
            times = float(self.time_begin), float(self.time_end)
        except (TypeError, ValueError, OverflowError) as error:
            times_given = f"{self.time_begin!r:.40} and {self.time_end!r:.40}"
            raise InvalidValueError(f"the times of MotionOptions are numbers, not {times_given}") from error
        target.timeBegin, target.timeEnd = times


@dataclass(eq=False)
class Instance:
    """One instance: a traversable (accel, handle or transform) under a 3x4 object-to-world transform. A build reads its members, which may
    change for the next one."""

    traversable: Any
    transform: Any = None
    instance_id: int = 0
    sbt_offset: int = 0
    visibility_mask: int = 255
    flags: InstanceFlags | int = InstanceFlags.NONE


def take_array(value: Any, dtype: Any, shape: tuple[int | str, ...], where: str) -> np.ndarray[Any, Any]:
    """`value` as a C-contiguous array of `dtype` and `shape` (names stand for any size), else a clear error.

    Rows may lie apart, as with OptiX's strides: an array of padded rows, or members of structs. They are copied together then.
    """
    wanted = f"{where} takes a {np.dtype(dtype).name} array of shape ({', '.join(map(str, shape))}{',' if len(shape) == 1 else ''})"
    if not isinstance(value, np.ndarray):
        raise InvalidValueError(
            f"{wanted}, not {type(value).__name__}; make one with numpy.ascontiguousarray(..., numpy.{np.dtype(dtype).name})"
        )
    if value.dtype != dtype:
        raise InvalidValueError(f"{wanted}, not {value.dtype}; convert with array.astype(numpy.{np.dtype(dtype).name})")
    fits = value.ndim == len(shape) and all(isinstance(want, str) or want == got for want, got in zip(shape, value.shape, strict=True))
    if not fits:
        raise InvalidValueError(f"{wanted}, not of shape {value.shape}")
    if value.flags.c_contiguous and value.flags.aligned:
        return value
    row_bytes = value.itemsize * int(np.prod(value.shape[1:]))
    if not value.flags.c_contiguous and (value.strides[0] < row_bytes or not value[0].flags.c_contiguous):
        raise InvalidValueError(
            f"{wanted}, its rows one after the other and without gaps inside; the strides of this one are {value.strides}, use "
            "numpy.ascontiguousarray(array)"
        )
    return value.copy()


def take_index_array(value: Any, shape: tuple[int | str, ...], where: str) -> np.ndarray[Any, Any]:
    """Indices as uint32; int32, uint16 and uint8 are taken as well, negative ones refused."""
    if isinstance(value, np.ndarray) and value.dtype == np.int32:
        array = take_array(value, np.int32, shape, where)
        if array.size and int(array.min()) < 0:
            raise InvalidValueError(f"{where} holds the negative index {int(array.min())}")
        return array.view(np.uint32)
    if isinstance(value, np.ndarray) and value.dtype in (np.uint8, np.uint16):
        return take_array(value, value.dtype, shape, where).astype(np.uint32)
    return take_array(value, np.uint32, shape, where)


@dataclass
class CInputs:
    """An array of OxrtBuildInput with everything it points to."""

    array: Any
    count: int
    kept: list[Any] = field(default_factory=list)


def pack_inputs(inputs: Sequence[BuildInput]) -> CInputs:
    """Checks all inputs and lays them out for the runtime."""
    if isinstance(inputs, BuildInput) or not isinstance(inputs, Sequence):
        raise InvalidValueError(f"accel_build takes a list of build inputs, not {type(inputs).__name__}")
    if not inputs:
        raise InvalidValueError("an acceleration structure needs at least one build input; the list is empty")
    packed = CInputs(library.ffi().new("OxrtBuildInput[]", len(inputs)), len(inputs))
    for number, one in enumerate(inputs):
        if not isinstance(one, BuildInput):
            raise InvalidValueError(f"build input {number} is a {type(one).__name__}, not a BuildInput")
        if type(one) is not type(inputs[0]):
            kinds = f"input {number} is a {type(one).__name__} but input 0 a {type(inputs[0]).__name__}"
            raise InvalidValueError(f"{kinds}; make one accel per type and instance them")
        one.fill(packed.array[number], packed.kept)
    return packed


class BuildInput:
    """What all build inputs share."""

    def fill(self, target: Any, kept: list[Any]) -> None:
        """Writes this input into an OxrtBuildInput; what it points to goes to `kept`."""
        raise NotImplementedError

    def children(self) -> tuple[Any, ...]:
        """Traversables that this input refers to."""
        return ()


def pointer_to(array: np.ndarray[Any, Any], c_type: str, kept: list[Any]) -> Any:
    """A C pointer to the array, which goes to `kept`; NULL for an empty one."""
    kept.append(array)
    ffi = library.ffi()
    return ffi.cast(c_type, array.ctypes.data) if array.size else ffi.NULL


def take_keys(value: Keys, shape: tuple[int | str, ...], where: str) -> list[np.ndarray[Any, Any]]:
    """The arrays of the motion keys, all of one shape; one array is one key, one with an axis more holds all keys."""
    is_stack = isinstance(value, np.ndarray) and value.ndim == len(shape) + 1
    arrays = list(value) if is_stack or isinstance(value, list | tuple) else [value]
    if not arrays:
        raise InvalidValueError(f"{where} is an empty list; motion needs one array per key")
    if not any(isinstance(array, np.ndarray) for array in arrays):
        given = f"a list of {type(arrays[0]).__name__}" if isinstance(value, list | tuple) else type(value).__name__
        wanted = f"a float32 array of shape ({', '.join(map(str, shape))}{',' if len(shape) == 1 else ''}), or a list of such arrays"
        remedy = "make one with numpy.ascontiguousarray(..., numpy.float32)"
        raise InvalidValueError(f"{where} takes {wanted}, one for each motion key, not {given}; {remedy}")
    taken = [take_array(array, np.float32, shape, where if len(arrays) == 1 else f"{where}[{key}]") for key, array in enumerate(arrays)]
    if any(array.shape != taken[0].shape for array in taken):
        raise InvalidValueError(f"the motion keys of {where} must have one shape, not {', '.join(str(array.shape) for array in taken)}")
    return taken


def fill_keys(arrays: list[np.ndarray[Any, Any]], kept: list[Any]) -> Any:
    """A C array of pointers to the keys."""
    pointers = library.ffi().new("float*[]", [pointer_to(array, "float*", kept) for array in arrays])
    kept.append(pointers)
    return pointers


@dataclass(kw_only=True)
class Records:
    """SBT members shared by the geometry inputs: one flag word for all records or one each, and the record of each primitive."""

    flags: Any = GeometryFlags.NONE
    num_sbt_records: int = 1
    sbt_index_offsets: Any = None
    primitive_index_offset: int = 0

    def fill_records(self, target: Any, primitives: int, kept: list[Any], where: str) -> None:
        count = take_whole(self.num_sbt_records, 1, 1 << 24, f"{where}: num_sbt_records")
        try:
            given = np.atleast_1d(np.asarray(self.flags))
            words = given.astype(np.uint32)
        except (TypeError, ValueError, OverflowError) as error:
            raise InvalidValueError(f"{where}: flags {_FLAGS_WANTED}, not {self.flags!r:.60}") from error
        if given.dtype.kind not in "iu" or not np.array_equal(given, words):
            raise InvalidValueError(f"{where}: flags {_FLAGS_WANTED}, not {self.flags!r:.60}")
        if words.ndim != 1 or words.size not in (1, count):
            raise InvalidValueError(f"{where}: flags is one word or one for each of the {count} records, not {words.size} words")
        words = np.ascontiguousarray(np.broadcast_to(words, count))
        last = WORD_LIMIT - 1 - primitives  # with the number of primitives it must stay below 2**32
        offset = take_whole(self.primitive_index_offset, 0, last, f"{where}: primitive_index_offset")
        target.numSbtRecords = count
        target.flags = pointer_to(words, "uint32_t*", kept)
        target.primitiveIndexOffset = offset
        if self.sbt_index_offsets is not None:
            offsets = take_index_array(_as_words(self.sbt_index_offsets), ("n",), f"{where}.sbt_index_offsets")
            if offsets.size != primitives:
                raise InvalidValueError(f"{where}: {offsets.size} sbt_index_offsets for {primitives} primitives")
            # an offset past the last record means the last record, as in OptiX: the runtime clamps
            target.sbtIndexOffsets = pointer_to(offsets, "uint32_t*", kept)


@dataclass
class BuildInputTriangles(Records, BuildInput):
    """Triangles: float32 vertices (n, 3), uint32 indices (m, 3) or None for vertices in threes; `pre_transform` 3x4 is baked in.

    Vertices may also be float16 or int16 (as signed normalised numbers) and (n, 2), which means z = 0; `vertex_format` then is what the
    numpy type says, and may be given to be sure of it. Indices may be of 1, 2 or 4 bytes. `opacity_micromap` is a
    BuildInputOpacityMicromap. One or two vertices left over by the threes are not used.
    """

    vertices: Keys
    indices: Any = None
    pre_transform: Any = field(default=None, kw_only=True)
    opacity_micromap: Any = field(default=None, kw_only=True)
    vertex_format: Any = field(default=None, kw_only=True)

    def fill(self, target: Any, kept: list[Any]) -> None:
        keys = take_keys(
            to_float3(self.vertices, self.vertex_format, "BuildInputTriangles.vertices"), ("n", 3), "BuildInputTriangles.vertices"
        )
        target.type = library.lib().OXRT_BUILD_INPUT_TRIANGLES
        target.numKeys = len(keys)
        target.vertices = fill_keys(keys, kept)
        target.numVertices = len(keys[0])
        if self.indices is None:
            primitives = len(keys[0]) // 3
        else:
            indices = take_index_array(self.indices, ("m", 3), "BuildInputTriangles.indices")
            if indices.size and int(indices.max()) >= len(keys[0]):
                raise InvalidValueError(f"BuildInputTriangles.indices holds {int(indices.max())}, though there are {len(keys[0])} vertices")
            target.indices = pointer_to(indices, "uint32_t*", kept)
            primitives = len(indices)
        target.numPrimitives = primitives
        if self.pre_transform is not None:
            target.preTransform = pointer_to(take_transform(self.pre_transform, "pre_transform"), "float*", kept)
        if self.opacity_micromap is not None:
            target.opacityMicromap = pack_micromaps(self.opacity_micromap, primitives, kept)
        self.fill_records(target, primitives, kept, "BuildInputTriangles")


@dataclass
class BuildInputCustomPrimitives(Records, BuildInput):
    """Custom primitives by their boxes: float32 (n, 6), min x y z then max x y z; rows that lie apart do so by multiples of 8 bytes."""

    aabbs: Keys

    def fill(self, target: Any, kept: list[Any]) -> None:
        keys = take_keys(self.aabbs, ("n", 6), "BuildInputCustomPrimitives.aabbs")
        for array in self.aabbs if isinstance(self.aabbs, list | tuple) else [self.aabbs]:
            if len(array) > 1 and array.strides[0] % AABB_BUFFER_BYTE_ALIGNMENT:
                raise InvalidValueError(
                    f"BuildInputCustomPrimitives.aabbs: a stride of {array.strides[0]} bytes is no multiple of {AABB_BUFFER_BYTE_ALIGNMENT}"
                )
        target.type = library.lib().OXRT_BUILD_INPUT_CUSTOM_PRIMITIVES
        target.numKeys = len(keys)
        target.aabbs = fill_keys(keys, kept)
        target.numPrimitives = len(keys[0])
        self.fill_records(target, len(keys[0]), kept, "BuildInputCustomPrimitives")


@dataclass
class BuildInputInstances(BuildInput):
    """Instances: a list of `Instance`, or a list of traversables with arrays of their members for many at once.

    The members are an array of n or one value for all; `transforms` is (n, 3, 4), best float32. A uint64 array of handles is the
    quickest list.
    """

    instances: Sequence[Any] | np.ndarray
    transforms: Any = field(default=None, kw_only=True)
    instance_ids: Any = field(default=None, kw_only=True)
    sbt_offsets: Any = field(default=None, kw_only=True)
    visibility_masks: Any = field(default=None, kw_only=True)
    flags: Any = field(default=None, kw_only=True)

    _DTYPE = np.dtype(
        [
            ("transform", np.float32, (12,)),
            ("instance_id", np.uint32),
            ("sbt_offset", np.uint32),
            ("visibility_mask", np.uint32),
            ("flags", np.uint32),
            ("traversable", np.uint64),
        ]
    )

    def children(self) -> tuple[Any, ...]:
        if isinstance(self.instances, np.ndarray) and self.instances.dtype.kind in "iu":
            return ()  # numbers keep nothing alive; the runtime does
        # Most scenes have many instances of few children
        different = {id(one): one for one in self.instances}.values()
        return tuple(one.traversable if isinstance(one, Instance) else one for one in different)

    def fill(self, target: Any, kept: list[Any]) -> None:
        if not isinstance(self.instances, Sequence | np.ndarray) or getattr(self.instances, "ndim", 1) != 1:
            raise InvalidValueError(f"BuildInputInstances takes a list of instances or traversables, not {type(self.instances).__name__}")
        table = np.zeros(len(self.instances), self._DTYPE)
        if len(self.instances) and isinstance(self.instances[0], Instance):
            self._fill_from_objects(table)
        else:
            self._fill_from_arrays(table)
        target.type = library.lib().OXRT_BUILD_INPUT_INSTANCES
        target.numSbtRecords = 1
        target.numKeys = 1
        target.numPrimitives = len(table)
        target.instances = pointer_to(table, "OxrtInstance*", kept)

    def _fill_from_objects(self, table: np.ndarray[Any, Any]) -> None:
        if any(value is not None for value in (self.transforms, self.instance_ids, self.sbt_offsets, self.visibility_masks, self.flags)):
            raise InvalidValueError("members given as arrays go with a list of traversables, not with Instance objects")
        for row, one in zip(table, self.instances, strict=True):
            if not isinstance(one, Instance):
                raise InvalidValueError(f"the list mixes Instance objects with {type(one).__name__}")
            members = (one.instance_id, one.sbt_offset, one.visibility_mask, one.flags)
            if any(not isinstance(member, int | np.integer) or not 0 <= member < 1 << 32 for member in members):
                raise InvalidValueError(f"members of an instance are whole numbers of 32 bits, not {one!r}")
            for name, member in zip(_MEMBERS, members, strict=True):
                _check_member(name, int(member))
            row["transform"] = _IDENTITY if one.transform is None else take_transform(one.transform, "Instance.transform").ravel()
            row["instance_id"], row["sbt_offset"], row["visibility_mask"], row["flags"] = members
            row["traversable"] = take_handle(one.traversable, "Instance.traversable")

    def _fill_from_arrays(self, table: np.ndarray[Any, Any]) -> None:
        count = len(table)
        table["traversable"] = take_handles(self.instances)
        if self.transforms is None:
            table["transform"] = _IDENTITY
        else:
            table["transform"] = _take_transforms(self.transforms, count)
        members = (
            ("instance_id", self.instance_ids, 0),
            ("sbt_offset", self.sbt_offsets, 0),
            ("visibility_mask", self.visibility_masks, 255),
            ("flags", self.flags, 0),
        )
        for name, given, default in members:
            try:
                values = np.atleast_1d(np.asarray(default if given is None else given))
            except ValueError:
                values = np.zeros(0)
            fits = values.dtype.kind in "iu" and values.ndim == 1 and values.size in (1, count)
            if not fits or (values.size and not 0 <= int(values.min()) <= int(values.max()) < WORD_LIMIT):
                raise InvalidValueError(f"{name} of instances is one whole number or {count} of them, not {given!r:.60}")
            if given is not None and values.size:
                _check_member(name, int(values.max()))
            table[name] = values.astype(np.uint32)


_MEMBERS = {"instance_id": 1 << 28, "sbt_offset": 1 << 28, "visibility_mask": 256, "flags": WORD_LIMIT}


def _check_member(name: str, value: int) -> None:
    if value >= _MEMBERS[name]:
        raise InvalidValueError(f"{name} {value} of an instance is not below {_MEMBERS[name]}")


def take_handle(value: Any, where: str) -> int:
    """The 64-bit handle of an accel, a transform or a handle itself."""
    handle = getattr(value, "handle", value)
    if isinstance(handle, bool) or not isinstance(handle, int | np.integer) or not 0 <= handle < 1 << 64:
        raise InvalidValueError(f"{where} takes an accel or a traversable handle, not {type(value).__name__}")
    return int(handle)


def take_handles(values: Sequence[Any] | np.ndarray) -> np.ndarray[Any, Any]:
    """The handles of many traversables as uint64; each object is looked at once, however often it stands in the list."""
    if isinstance(values, np.ndarray) and values.dtype.kind in "iu" and values.ndim == 1:
        if values.size and int(values.min()) < 0:
            raise InvalidValueError(f"instance {int(values.argmin())} takes an accel or a traversable handle, not {int(values.min())}")
        return values.astype(np.uint64)
    objects = list(values)  # alive while their ids are compared
    known: dict[int, int] = {}
    for number, one in enumerate(objects):
        if id(one) not in known:
            known[id(one)] = take_handle(one, f"instance {number}")
    return np.fromiter(map(known.__getitem__, map(id, objects)), np.uint64, len(objects))


def _take_transforms(value: Any, count: int) -> np.ndarray[Any, Any]:
    """Matrices of shape (count, 3, 4) as float32 rows of 12, from anything that numpy makes them of."""
    try:
        array = np.asarray(value, np.float32)
    except (TypeError, ValueError) as error:
        raise InvalidValueError(f"BuildInputInstances.transforms takes an array of shape (n, 3, 4), not {type(value).__name__}") from error
    if array.ndim < 1 or array.shape[1:] not in ((3, 4), (12,)):
        raise InvalidValueError(f"BuildInputInstances.transforms takes an array of shape (n, 3, 4), not {array.shape}")
    if len(array) != count:
        raise InvalidValueError(f"{len(array)} transforms for {count} instances")
    return array.reshape(count, 12)


def _as_words(value: Any) -> Any:
    """A list of whole numbers, or an array of a wider type whose numbers are of 32 bits, as uint32; anything else as it is."""
    is_list = isinstance(value, list | tuple) and all(isinstance(one, int | np.integer) for one in value)
    numbers = np.array(value) if is_list and value else value
    if isinstance(numbers, np.ndarray) and numbers.dtype in (np.int64, np.uint64) and numbers.size:
        return numbers.astype(np.uint32) if numbers.min() >= 0 and numbers.max() < WORD_LIMIT else numbers
    return numbers


def take_transform(value: Any, where: str) -> np.ndarray[Any, Any]:
    """A 3x4 matrix as float32, from anything that numpy makes one of."""
    try:
        with np.errstate(all="ignore"):
            array = np.require(value, np.float32, ("A", "C"))
    except (TypeError, ValueError) as error:
        raise InvalidValueError(f"{where} takes a 3x4 matrix, not {type(value).__name__}") from error
    if array.shape not in ((3, 4), (12,)):
        raise InvalidValueError(f"{where} takes a 3x4 matrix, not shape {array.shape}")
    return array
