"""Opacity micromaps: arrays of them, and which one each triangle of a build input has.

A micromap splits a triangle into 4 ** level micro-triangles and says of each whether it is transparent, opaque or unknown; any-hit programs
run on unknown ones only. Their order is that of `micromap_index_to_base_barycentrics`.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from optixc.enums_scene import OpacityMicromapArrayIndexingMode, OpacityMicromapFlags, OpacityMicromapFormat
from optixc.errors import InvalidValueError
from optixc.host import library
from optixc.host.owned import Owned
from optixc.host.whole_numbers import WORD_LIMIT, take_member, take_whole

MAX_LEVEL = 12
TRANSPARENT, OPAQUE, UNKNOWN_TRANSPARENT, UNKNOWN_OPAQUE = range(4)
Words = np.ndarray[Any, Any]
_FORMATS = (OpacityMicromapFormat.FORMAT_2_STATE, OpacityMicromapFormat.FORMAT_4_STATE)
_FLAGS = (OpacityMicromapFlags.NONE, OpacityMicromapFlags.PREFER_FAST_TRACE, OpacityMicromapFlags.PREFER_FAST_BUILD)

DESC_DTYPE = np.dtype([("byte_offset", np.uint32), ("subdivision_level", np.uint16), ("format", np.uint16)])
COUNT_DTYPE = np.dtype([("count", np.uint32), ("subdivision_level", np.uint32), ("format", np.uint32)])


@dataclass(frozen=True)
class OpacityMicromap:
    """One micromap by its states: uint8 (4 ** level,) of 0 transparent, 1 opaque, 2 unknown-transparent, 3 unknown-opaque."""

    states: Words
    level: int
    format: OpacityMicromapFormat = OpacityMicromapFormat.FORMAT_4_STATE

    def packed(self) -> Words:
        """The states as OptiX lays them out: 1 or 2 bits each, the first in the lowest bits."""
        bits = take_member(self.format, _FORMATS, "OpacityMicromap.format")
        take_whole(self.level, 0, MAX_LEVEL, "OpacityMicromap.level")
        states = take_numbers(self.states, "OpacityMicromap.states")
        if states.shape != (4**self.level,) or states.dtype.kind not in "iu":
            raise InvalidValueError(
                f"OpacityMicromap.states takes {4**self.level} whole numbers for level {self.level}, not {states.shape}"
            )
        if states.size and not 0 <= int(states.min()) <= int(states.max()) < 1 << bits:
            wrong = int(states.min()) if int(states.min()) < 0 else int(states.max())
            raise InvalidValueError(f"states of a {1 << bits}-state micromap are 0 to {(1 << bits) - 1}, not {wrong}")
        per_byte = 8 // bits
        padded = np.zeros(-(-states.size // per_byte) * per_byte, np.uint8)
        padded[: states.size] = states
        shifts = np.arange(per_byte, dtype=np.uint8) * np.uint8(bits)
        return np.asarray(np.bitwise_or.reduce(padded.reshape(-1, per_byte) << shifts, axis=1).astype(np.uint8))


class OpacityMicromapArray(Owned):
    """Micromaps in the runtime's memory; accels that use them keep them alive."""

    def __init__(self, context: Any, data: Words, descs: Words, histogram: Words, flags: int) -> None:
        self._array: Any = None
        self._context = context
        self.count = len(descs)
        self.size_in_bytes = data.size
        self.usage = histogram
        ffi = library.ffi()
        options = ffi.new("OxrtOpacityMicromapArrayOptions*")
        options.flags = flags
        options.numDescs, options.dataSize, options.numHistogramEntries = len(descs), data.size, len(histogram)
        for name, array, c_type in (
            ("data", data, "uint8_t*"),
            ("descs", descs, "OxrtOpacityMicromapDesc*"),
            ("histogram", histogram, "OxrtOpacityMicromapCount*"),
        ):
            setattr(options, name, ffi.cast(c_type, array.ctypes.data) if array.size else ffi.NULL)
        made = ffi.new("OxrtOpacityMicromapArray*")
        library.check(library.lib().oxrtOpacityMicromapArrayBuild(context.handle, options, made))
        self._array = made[0]

    @property
    def handle(self) -> Any:
        """The runtime's object; raises after `destroy()`."""
        if self._array is None:
            raise InvalidValueError("this opacity micromap array was destroyed")
        return self._array

    def destroy(self) -> None:
        """Gives the array back; nothing happens the second time."""
        array, self._array = self._array, None
        if array is not None and self._context.is_alive:
            library.check(library.lib().oxrtOpacityMicromapArrayDestroy(array))

    def __del__(self) -> None:
        if getattr(self, "_array", None) is not None and not sys.is_finalizing():
            self.destroy()


def build_array(context: Any, data: Any, descs: Any, histogram: Any, flags: int) -> OpacityMicromapArray:
    """From a list of OpacityMicromap, or from raw bytes with descriptors; a histogram that is not given is counted."""
    word = take_member(flags, _FLAGS, "opacity_micromap_array_build: flags")
    if isinstance(data, Sequence) and not isinstance(data, bytes | bytearray):
        if descs is not None:
            raise InvalidValueError("descs go with raw bytes; a list of OpacityMicromap tells its own")
        data, descs = _pack(data)
    raw = np.frombuffer(data, np.uint8) if isinstance(data, bytes | bytearray) else data
    if not isinstance(raw, np.ndarray) or raw.dtype != np.uint8 or raw.ndim != 1:
        raise InvalidValueError("data takes a list of OpacityMicromap, or bytes or a uint8 array of one dimension")
    table = _table(descs, DESC_DTYPE, "descs")
    counts = _histogram(table) if histogram is None else _table(histogram, COUNT_DTYPE, "histogram")
    return OpacityMicromapArray(context, np.ascontiguousarray(raw), table, counts, word)


def _pack(maps: Sequence[Any]) -> tuple[Words, Words]:
    parts: list[Words] = []
    rows = []
    offset = 0
    for number, one in enumerate(maps):
        if not isinstance(one, OpacityMicromap):
            raise InvalidValueError(f"micromap {number} is a {type(one).__name__}, not an OpacityMicromap")
        part = one.packed()
        rows.append((offset, one.level, int(one.format)))
        parts.append(part)
        offset += part.size
    if offset >= 1 << 32:
        raise InvalidValueError(f"the micromaps need {offset} bytes; offsets have 32 bits")
    return (np.concatenate(parts) if parts else np.zeros(0, np.uint8)), np.array(rows, DESC_DTYPE)


def take_numbers(values: Any, where: str) -> Words:
    try:
        return np.asarray(values)
    except ValueError as error:
        raise InvalidValueError(f"{where} takes an array of numbers, not {values!r:.60}") from error


def _table(rows: Any, dtype: np.dtype[Any], name: str) -> Words:
    if rows is None:
        raise InvalidValueError(f"{name} is missing: raw bytes need one row ({', '.join(dtype.names or ())}) for each micromap")
    if isinstance(rows, np.ndarray) and rows.dtype == dtype:
        return np.ascontiguousarray(rows)
    try:
        return np.array([tuple(int(value) for value in row) for row in rows], dtype)
    except (TypeError, ValueError, OverflowError) as error:
        raise InvalidValueError(f"{name} takes rows of ({', '.join(dtype.names or ())})") from error


def _histogram(descs: Words) -> Words:
    pairs, counts = np.unique(np.stack([descs["subdivision_level"], descs["format"]], axis=1), axis=0, return_counts=True)
    return np.array([(count, level, kind) for (level, kind), count in zip(pairs, counts, strict=True)], COUNT_DTYPE)


@dataclass(frozen=True)
class BuildInputOpacityMicromap:
    """Which micromap of `array` each triangle has: `indices` int16 or int32 (m,), or None for triangle i has micromap i.

    Negative indices stand for whole triangles: -1 transparent, -2 opaque, -3 unknown-transparent, -4 unknown-opaque; `index_offset` is
    added to the others. `array` may be None where all are negative. `usage_counts`, rows of (count, level, format), are checked if given.
    """

    array: OpacityMicromapArray | None
    indices: Any = None
    index_offset: int = 0
    usage_counts: Any = None


def pack_micromaps(given: Any, triangles: int, kept: list[Any]) -> Any:
    """An OxrtOpacityMicromapInput with everything it points to."""
    if not isinstance(given, BuildInputOpacityMicromap):
        raise InvalidValueError(f"opacity_micromap takes a BuildInputOpacityMicromap, not {type(given).__name__}")
    ffi = library.ffi()
    made = ffi.new("OxrtOpacityMicromapInput*")
    if given.array is not None and not isinstance(given.array, OpacityMicromapArray):
        raise InvalidValueError(f"BuildInputOpacityMicromap.array takes an OpacityMicromapArray, not {type(given.array).__name__}")
    made.array = given.array.handle if given.array is not None else ffi.NULL
    made.indexOffset = take_whole(given.index_offset, 0, WORD_LIMIT - 1, "BuildInputOpacityMicromap.index_offset")
    mode = OpacityMicromapArrayIndexingMode.LINEAR
    if given.indices is not None:
        mode = OpacityMicromapArrayIndexingMode.INDEXED
        indices = take_numbers(given.indices, "BuildInputOpacityMicromap.indices")
        signed = {np.dtype(np.int16), np.dtype(np.int32), np.dtype(np.int64)}
        if indices.dtype not in signed or indices.shape != (triangles,):
            raise InvalidValueError(f"micromap indices take int16 or int32 of shape ({triangles},), not {indices.dtype} {indices.shape}")
        far = np.flatnonzero(np.abs(indices.astype(np.float64)) >= WORD_LIMIT // 2)
        if len(far):
            raise InvalidValueError(f"the micromap index of triangle {far[0]} is {indices[far[0]]}; indices are int32")
        words = np.ascontiguousarray(indices, np.int32)
        made.indices = ffi.cast("int32_t*", words.ctypes.data)
        kept.append(words)
    made.indexingMode = int(mode)
    if given.usage_counts is not None:
        counts = _table(given.usage_counts, COUNT_DTYPE, "usage_counts")
        made.usageCounts = ffi.cast("OxrtOpacityMicromapCount*", counts.ctypes.data)
        made.numUsageCounts = len(counts)
        kept.append(counts)
    kept.extend((made, given.array))
    return made
