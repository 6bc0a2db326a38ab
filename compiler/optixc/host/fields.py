"""Field types of struct classes on the host: what an annotation means in memory, and how a Python value becomes those bytes.

A field type knows its text (`float3`, `Array2[float4]`, the form of `ir.layout.describe`), its numpy dtype and alignment, and
`store`, which checks a value, writes its bytes and gives back what reading the field returns. Arrays are stored as pointer and
shape: the numpy memory itself is what shaders see, so the array object must stay alive as long as the struct.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from optixc.errors import InvalidValueError
from optixc.host.matrices import Matrix
from optixc.host.vectors import Vector

Buffer = bytearray | memoryview


class FieldType(Protocol):
    """How one field lies in memory and takes values."""

    @property
    def text(self) -> str: ...
    @property
    def dtype(self) -> np.dtype[Any]: ...
    @property
    def alignment(self) -> int: ...
    def store(self, buffer: Buffer, offset: int, value: Any, where: str) -> Any: ...
    def default(self) -> Any: ...


def refuse(where: str, wanted: str, value: object) -> InvalidValueError:
    """The error for a value that a field does not take."""
    got = (
        f"an array of {value.dtype} with shape {value.shape}" if isinstance(value, np.ndarray) else f"{type(value).__name__} {value!r:.60}"
    )
    return InvalidValueError(f"{where} takes {wanted}, not {got}")


_INTEGER_CODES = {"int8": "<b", "uint8": "<B", "int16": "<h", "uint16": "<H", "int32": "<i", "uint32": "<I", "int64": "<q", "uint64": "<Q"}
_FLOAT_CODES = {"float16": "<e", "float32": "<f", "float64": "<d"}


@dataclass(frozen=True)
class ScalarField:
    """A number; integers must fit, floats are rounded."""

    text: str

    @property
    def dtype(self) -> np.dtype[Any]:
        return np.dtype(self.text)

    @property
    def alignment(self) -> int:
        return self.dtype.itemsize

    def default(self) -> Any:
        return False if self.text == "bool" else 0.0 if self.text in _FLOAT_CODES else 0

    def store(self, buffer: Buffer, offset: int, value: Any, where: str) -> Any:
        try:
            if self.text == "bool":
                if not isinstance(value, bool | np.bool_) and value not in (0, 1):
                    raise TypeError
                buffer[offset] = int(value)
                return bool(value)
            if self.text in _FLOAT_CODES:
                return self._store_float(buffer, offset, value)
            number = value.__index__()
            # pack_into would have cleared the bytes before it finds that a number does not fit.
            data = struct.pack(_INTEGER_CODES[self.text], number)
            buffer[offset : offset + len(data)] = data
            return value if isinstance(value, int) else number
        except (TypeError, AttributeError, struct.error, ValueError) as error:
            raise refuse(where, f"a {self.text}", value) from error

    def _store_float(self, buffer: Buffer, offset: int, value: Any) -> float:
        if isinstance(value, str | bytes):
            raise TypeError
        code = _FLOAT_CODES[self.text]
        number = float(value)
        try:
            struct.pack_into(code, buffer, offset, number)
        except OverflowError:
            struct.pack_into(code, buffer, offset, float("inf") if number > 0 else float("-inf"))
        stored: float = struct.unpack_from(code, buffer, offset)[0]
        return stored


@dataclass(frozen=True)
class VectorField:
    """A vector; takes the vector class, a tuple, list or 1-D array of the right length, or one number to spread."""

    kind: type[Vector]

    @property
    def text(self) -> str:
        return self.kind.__name__

    @property
    def dtype(self) -> np.dtype[Any]:
        return np.dtype((self.kind.element, (self.kind.size,)))

    @property
    def alignment(self) -> int:
        return self.kind.element.itemsize

    def default(self) -> Any:
        return self.kind()

    def store(self, buffer: Buffer, offset: int, value: Any, where: str) -> Any:
        if type(value) is not self.kind:
            value = self._convert(value, where)
        data = value.__array__().tobytes()
        buffer[offset : offset + len(data)] = data
        return value

    def _convert(self, value: Any, where: str) -> Vector:
        spread = isinstance(value, int | float | np.number) and not isinstance(value, bool)
        if not spread and not (isinstance(value, Vector | tuple | list | np.ndarray) and len(value) == self.kind.size):
            raise refuse(where, f"a {self.text} or {self.kind.size} numbers", value)
        numbers = [value] * self.kind.size if spread else list(value)
        if not all(isinstance(number, int | float | np.number | np.bool_) for number in numbers):
            raise refuse(where, f"a {self.text} or {self.kind.size} numbers", value)
        if self.kind.element.kind in "iu":
            limits = np.iinfo(self.kind.element)
            if any(int(number) != number or not limits.min <= number <= limits.max for number in numbers):
                raise refuse(where, f"a {self.text} of whole numbers from {limits.min} to {limits.max}", value)
        return self.kind(*numbers)


@dataclass(frozen=True)
class MatrixField:
    """A matrix; takes the class, or anything that numpy makes an array of its shape."""

    kind: type[Matrix]

    @property
    def text(self) -> str:
        return self.kind.__name__

    @property
    def dtype(self) -> np.dtype[Any]:
        return np.dtype((np.float32, (self.kind.rows, self.kind.columns)))

    @property
    def alignment(self) -> int:
        return 4

    def default(self) -> Any:
        return self.kind(np.zeros((self.kind.rows, self.kind.columns), np.float32))

    def store(self, buffer: Buffer, offset: int, value: Any, where: str) -> Any:
        if type(value) is not self.kind:
            try:
                array = np.asarray(value, np.float32)
            except (TypeError, ValueError) as error:
                raise refuse(where, f"a {self.text}", value) from error
            if array.shape != (self.kind.rows, self.kind.columns):
                raise refuse(where, f"a {self.text} of shape ({self.kind.rows}, {self.kind.columns})", value)
            value = self.kind(array)
        data = value.__array__().tobytes()
        buffer[offset : offset + len(data)] = data
        return value


@dataclass(frozen=True)
class HandleField:
    """A traversable or texture handle; takes an object that has `.handle`, or the handle itself, which is kept with its owner."""

    text: str

    @property
    def dtype(self) -> np.dtype[Any]:
        return np.dtype(np.uint64)

    @property
    def alignment(self) -> int:
        return 8

    def default(self) -> Any:
        return 0

    def store(self, buffer: Buffer, offset: int, value: Any, where: str) -> Any:
        handle = getattr(value, "handle", value)
        if isinstance(handle, bool) or not isinstance(handle, int | np.integer) or not 0 <= handle < 1 << 64:
            raise refuse(where, f"a {self.text}: an object with .handle, or a handle", value)
        if getattr(handle, "of", self.text) != self.text:
            raise refuse(where, f"a {self.text}", value)
        struct.pack_into("<Q", buffer, offset, int(handle))
        return handle


@dataclass(frozen=True)
class FixedArrayField:
    """Elements by value; takes anything that numpy makes an array of the right shape, reads as a read-only array."""

    element: FieldType
    size: int

    @property
    def text(self) -> str:
        return f"FixedArray[{self.element.text},{self.size}]"

    @property
    def dtype(self) -> np.dtype[Any]:
        return np.dtype((self.element.dtype.base, (self.size, *self.element.dtype.shape)))

    @property
    def alignment(self) -> int:
        return self.element.alignment

    def default(self) -> Any:
        return np.zeros(1, self.dtype)[0]

    def store(self, buffer: Buffer, offset: int, value: Any, where: str) -> Any:
        base, shape = self.dtype.base, self.dtype.shape
        array: np.ndarray[Any, Any]
        try:
            if base.names is not None and isinstance(value, tuple | list):
                array = copy_structs(self.element, value, where)
            else:
                array = np.array(value, base, subok=isinstance(value, StructArray))
        except (TypeError, ValueError, OverflowError) as error:
            raise refuse(where, f"{self.size} elements of {self.element.text}", value) from error
        if array.shape != shape:
            raise refuse(where, f"{self.size} elements of {self.element.text}, shape {shape}", value)
        data = array.tobytes()
        buffer[offset : offset + len(data)] = data
        array.flags.writeable = False
        return array


class StructArray(np.ndarray[Any, Any]):
    """Structs copied into one array; `sources` holds them as they were then, and with them the arrays that their copies point to."""

    sources: tuple[Any, ...] = ()

    def __array_finalize__(self, origin: Any) -> None:
        """Views and copies point to the same arrays."""
        self.sources = getattr(origin, "sources", ())

    def __reduce__(self) -> Any:
        """Pickled are the structs: addresses mean nothing in another process. A field that takes this array takes a list of them too."""
        if len(self.sources) != len(self):
            raise TypeError("a part of an array of structs cannot be pickled; pickle the structs")
        return list, (list(self.sources),)


def copy_structs(element: FieldType, values: Sequence[Any], where: str) -> StructArray:
    """The bytes of structs, one behind the other."""
    array = np.zeros(len(values), element.dtype).view(StructArray)
    memory, size = array.view(np.ndarray).reshape(-1).view(np.uint8).data, element.dtype.itemsize
    stored = [element.store(memory, number * size, item, f"{where}[{number}]") for number, item in enumerate(values)]
    # Fixed arrays of structs are copies already.
    snapshot = getattr(element, "snapshot", None)
    array.sources = tuple(stored if snapshot is None else map(snapshot, stored))
    return array


@dataclass(frozen=True)
class ArrayField:
    """A view of numpy memory: pointer and shape; takes C-contiguous arrays of the element's dtype and the right rank, or None. A list of
    structs is copied into an array."""

    element: FieldType
    rank: int

    @property
    def text(self) -> str:
        return f"Array{self.rank}[{self.element.text}]"

    @property
    def dtype(self) -> np.dtype[Any]:
        return np.dtype([("data", np.uint64), ("shape", np.uint64, (self.rank,))])

    @property
    def alignment(self) -> int:
        return 8

    def default(self) -> Any:
        return None

    def store(self, buffer: Buffer, offset: int, value: Any, where: str) -> Any:
        if value is None:
            struct.pack_into(f"<{1 + self.rank}Q", buffer, offset, *([0] * (1 + self.rank)))
            return None
        if not isinstance(value, np.ndarray):
            value = self._copy_structs(value, where)
        self._check(value, where)
        struct.pack_into(f"<{1 + self.rank}Q", buffer, offset, value.ctypes.data if value.size else 0, *value.shape[: self.rank])
        return value

    def _copy_structs(self, value: Any, where: str) -> np.ndarray[Any, Any]:
        base = self.element.dtype.base
        if base.names is None or self.rank != 1 or not isinstance(value, tuple | list):
            raise InvalidValueError(
                f"{where} takes a numpy array ({self._wanted()}), whose memory shaders then use, not {type(value).__name__}"
            )
        return copy_structs(self.element, value, where)

    def _check(self, array: np.ndarray[Any, Any], where: str) -> None:
        base, inner = self.element.dtype.base, self.element.dtype.shape
        got = f"not an array of {array.dtype} with shape {array.shape}"
        if array.dtype != base:
            remedy = "" if base.names else f"; convert with array.astype(numpy.{base.name})"
            raise InvalidValueError(f"{where} takes {self._wanted()}, {got}{remedy}")
        if array.ndim != self.rank + len(inner) or array.shape[self.rank :] != inner:
            raise InvalidValueError(f"{where} takes {self._wanted()}, {got}")
        if not array.flags.c_contiguous:
            raise InvalidValueError(
                f"{where} takes a C-contiguous array; use numpy.ascontiguousarray(array) and keep the result to read it back"
            )
        if not array.flags.aligned:
            raise InvalidValueError(f"{where} takes an array aligned as its element; use array.copy()")

    def _wanted(self) -> str:
        base, inner = self.element.dtype.base, self.element.dtype.shape
        axes = ", ".join([*"nml"[: self.rank], *map(str, inner)])
        shape = f"shape ({axes},)" if "," not in axes else f"shape ({axes})"
        if base.names is None:
            return f"{self.text}: dtype {base.name}, {shape}"
        return f"dtype of the struct, {shape}{', or a list of structs' if self.rank == 1 else ''}"
