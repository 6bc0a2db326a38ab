"""Values of an interpreted program: vectors, structs, fixed arrays, views of the host's arrays, and their bytes in memory.

Vectors and matrices are the host's own classes; a struct is a `StructValue`, one class per struct type, with the fields as
attributes, so that a debugger shows them; arrays read and write the host's memory in place.
"""

from __future__ import annotations

import ctypes
import struct as binary
from collections.abc import Callable
from functools import cache
from typing import Any

from optixc.host.matrices import Matrix, float3x3, float3x4, float4x4
from optixc.host.vectors import Vector, vector_class
from optixc.interpret import numbers
from optixc.ir import layout
from optixc.ir import types as t

Memory = Any
"""Something that `ctypes` can name: bytes at an address."""

_CODES = {
    (t.ScalarKind.BOOL, 8): "?",
    (t.ScalarKind.INT, 8): "b",
    (t.ScalarKind.UINT, 8): "B",
    (t.ScalarKind.INT, 16): "h",
    (t.ScalarKind.UINT, 16): "H",
    (t.ScalarKind.INT, 32): "i",
    (t.ScalarKind.UINT, 32): "I",
    (t.ScalarKind.INT, 64): "q",
    (t.ScalarKind.UINT, 64): "Q",
    (t.ScalarKind.FLOAT, 16): "e",
    (t.ScalarKind.FLOAT, 32): "f",
    (t.ScalarKind.FLOAT, 64): "d",
}
_MATRICES: dict[tuple[int, int], type[Matrix]] = {(3, 3): float3x3, (3, 4): float3x4, (4, 4): float4x4}


class StructValue:
    """A struct of a program: fields are attributes; two names for one value are two names for the same object."""

    TYPE: t.Struct

    def __init__(self, *values: Any) -> None:
        for field, value in zip(self.TYPE.fields, values, strict=True):
            setattr(self, field.name, value)

    def __repr__(self) -> str:
        return f"{self.TYPE.name}({', '.join(f'{field.name}={getattr(self, field.name)!r}' for field in self.TYPE.fields)})"


class FixedArrayValue:
    """`size` elements by value; an index out of range reads zero and drops writes, as in compiled code."""

    def __init__(self, type_: t.FixedArray, items: list[Any]) -> None:
        self.type = type_
        self.items = items

    def __getitem__(self, index: int) -> Any:
        return self.items[index] if 0 <= index < len(self.items) else zero(self.type.element)

    def __setitem__(self, index: int, value: Any) -> None:
        if 0 <= index < len(self.items):
            self.items[index] = value

    def __len__(self) -> int:
        return len(self.items)

    def __repr__(self) -> str:
        return repr(self.items)


class CoopVecValue:
    """A cooperative vector: a value, so that writing an element makes a new one. Elements are numbers that its type holds."""

    def __init__(self, type_: t.CoopVec, items: tuple[Any, ...]) -> None:
        self.type = type_
        self.items = items

    def __getitem__(self, index: int) -> Any:
        return self.items[index] if 0 <= index < len(self.items) else zero(self.type.element)

    def __len__(self) -> int:
        return len(self.items)

    def __repr__(self) -> str:
        return f"CoopVec{list(self.items)}"


class ArrayValue:
    """A view of the host's memory with the shape of the array; C-contiguous."""

    def __init__(self, type_: t.Array, address: int, shape: tuple[int, ...]) -> None:
        self.type = type_
        self.address = address
        self.shape = shape
        self._size = layout.size_of(type_.element)

    def place(self, *indices: int) -> int:
        """The address of an element. Raises IndexError outside of the shape; negative indices do not wrap."""
        position = 0
        for index, extent in zip(indices, self.shape, strict=True):
            if not 0 <= index < extent:
                raise IndexError(f"index {indices} is out of range of an array of shape {self.shape}")
            position = position * extent + index
        return self.address + position * self._size

    def load(self, *indices: int) -> Any:
        """An element as a value."""
        return load(self.type.element, self.place(*indices))

    def store(self, value: Any, *indices: int) -> None:
        """Writes an element."""
        store(self.type.element, self.place(*indices), value)

    def __repr__(self) -> str:
        return f"<{self.type} of shape {self.shape}>"


@cache
def struct_class(type_: t.Struct) -> type[StructValue]:
    """The class of the values of a struct type."""
    return type(type_.name, (StructValue,), {"TYPE": type_})


def make_vector(type_: t.Vector, values: tuple[Any, ...]) -> Vector:
    """A vector of numbers that its element type holds already."""
    kind = _vector_class(type_)
    made = kind.__new__(kind)
    object.__setattr__(made, "_values", values)
    return made


@cache
def _vector_class(type_: t.Vector) -> type[Vector]:
    return vector_class(str(type_)[:-1], type_.size)


def make_matrix(type_: t.Matrix, numbers_: list[float]) -> Matrix:
    """A matrix of its numbers row by row."""
    return _MATRICES[type_.rows, type_.columns](*numbers_)


def zero(type_: t.Type) -> Any:
    """Zero of a type, field by field."""
    match type_:
        case t.Scalar(kind=kind):
            return {t.ScalarKind.BOOL: False, t.ScalarKind.FLOAT: 0.0}.get(kind, 0)
        case t.Vector(element=element, size=size):
            return make_vector(type_, (zero(element),) * size)
        case t.Matrix(rows=rows, columns=columns):
            return make_matrix(type_, [0.0] * (rows * columns))
        case t.Struct(fields=fields):
            return struct_class(type_)(*(zero(field.type) for field in fields))
        case t.FixedArray(element=element, size=size):
            return FixedArrayValue(type_, [zero(element) for _ in range(size)])
        case t.CoopVec(element=element, size=size):
            return CoopVecValue(type_, (zero(element),) * size)
        case t.Array(rank=rank):
            return ArrayValue(type_, 0, (0,) * rank)
        case t.Tuple(items=items):
            return tuple(zero(item) for item in items)
        case t.Traversable() | t.Texture():
            return 0
        case t.Void():
            return None


def copy(value: Any) -> Any:
    """A value that shares nothing with the old one but the host's arrays."""
    match value:
        case StructValue():
            return type(value)(*(copy(getattr(value, field.name)) for field in value.TYPE.fields))
        case FixedArrayValue():
            return FixedArrayValue(value.type, [copy(item) for item in value.items])
        case tuple():
            return tuple(copy(item) for item in value)
        case _:
            return value


def load(type_: t.Type, address: int) -> Any:
    """The value at an address, laid out as C does."""
    match type_:
        case t.Scalar():
            return _scalar_at(type_).unpack(ctypes.string_at(address, layout.size_of(type_)))[0]
        case t.Vector(element=element, size=size):
            numbers_ = _numbers_at(element, size).unpack(ctypes.string_at(address, layout.size_of(type_)))
            return make_vector(widened(type_), numbers_)
        case t.Matrix(rows=rows, columns=columns):
            return make_matrix(type_, list(_numbers_at(t.FLOAT32, rows * columns).unpack(ctypes.string_at(address, 4 * rows * columns))))
        case t.Struct(fields=fields):
            offsets = layout.struct_layout(type_).offsets
            return struct_class(type_)(*(load(field.type, address + offset) for field, offset in zip(fields, offsets, strict=True)))
        case t.FixedArray(element=element, size=size):
            step = layout.size_of(element)
            return FixedArrayValue(type_, [load(element, address + step * index) for index in range(size)])
        case t.Array(rank=rank):
            data, *shape = _numbers_at(t.UINT64, 1 + rank).unpack(ctypes.string_at(address, 8 + 8 * rank))
            return ArrayValue(type_, data, tuple(shape))
        case t.Traversable() | t.Texture():
            return load(t.UINT64, address)
        case t.Tuple(items=items):
            values, place = [], address
            for item in items:
                values.append(load(item, place))
                place += layout.size_of(item)
            return tuple(values)
        case t.Void():
            return None
        case t.CoopVec(element=element, size=size):
            return CoopVecValue(type_, _numbers_at(element, size).unpack(ctypes.string_at(address, layout.size_of(type_))))


def store(type_: t.Type, address: int, value: Any) -> None:
    """Writes a value at an address, laid out as C does; storage numbers narrow."""
    match type_:
        case t.Scalar():
            ctypes.memmove(address, _scalar_at(type_).pack(narrow(type_)(value)), layout.size_of(type_))
        case t.Vector(element=element):
            narrowed = narrow(element)
            ctypes.memmove(address, _numbers_at(element, type_.size).pack(*map(narrowed, value)), layout.size_of(type_))
        case t.Matrix():
            for row in range(type_.rows):
                store(t.Vector(t.FLOAT32, type_.columns), address + 4 * type_.columns * row, value[row])
        case t.Struct(fields=fields):
            for field, offset in zip(fields, layout.struct_layout(type_).offsets, strict=True):
                store(field.type, address + offset, getattr(value, field.name))
        case t.FixedArray(element=element, size=size):
            for index in range(size):
                store(element, address + layout.size_of(element) * index, value[index])
        case t.Array():
            ctypes.memmove(address, _numbers_at(t.UINT64, 1 + type_.rank).pack(value.address, *value.shape), 8 + 8 * type_.rank)
        case t.Traversable() | t.Texture():
            store(t.UINT64, address, value)
        case t.CoopVec(element=element, size=size):
            ctypes.memmove(address, _numbers_at(element, size).pack(*value.items), layout.size_of(type_))
        case t.Tuple() | t.Void():
            raise AssertionError(f"{type_} is not stored")


def to_words(type_: t.Type, value: Any) -> list[int]:
    """The 32-bit payload or attribute words of a value: numbers of up to 32 bits take one, of 64 bits two."""
    match type_:
        case t.Scalar(bits=64):
            low, high = binary.unpack("<II", binary.pack("<" + _CODES[type_.kind, 64], value))
            return [low, high]
        case t.Scalar(kind=t.ScalarKind.FLOAT):
            return list(binary.unpack("<I", binary.pack("<f", value)))
        case t.Scalar():
            return [int(value) & 0xFFFFFFFF]
        case t.Vector(element=element):
            return [word for part in value for word in to_words(element, part)]
        case t.Matrix(columns=columns):
            return [word for row in value for word in to_words(t.Vector(t.FLOAT32, columns), row)]
        case t.Struct(fields=fields):
            return [word for field in fields for word in to_words(field.type, getattr(value, field.name))]
        case t.FixedArray(element=element):
            return [word for item in value.items for word in to_words(element, item)]
        case t.Traversable() | t.Texture():
            return to_words(t.UINT64, value)
        case _:
            raise AssertionError(f"{type_} has no words")


def from_words(type_: t.Type, words: list[int]) -> Any:
    """The value that the first words hold; they are taken off the list."""
    match type_:
        case t.Scalar(bits=64):
            return binary.unpack("<" + _CODES[type_.kind, 64], binary.pack("<II", words.pop(0), words.pop(0)))[0]
        case t.Scalar(kind=t.ScalarKind.FLOAT):
            return binary.unpack("<f", binary.pack("<I", words.pop(0)))[0]
        case t.Scalar(kind=t.ScalarKind.BOOL):
            return words.pop(0) != 0
        case t.Scalar():
            return numbers.wrap(type_)(words.pop(0))
        case t.Vector(element=element, size=size):
            return make_vector(widened(type_), tuple(from_words(element, words) for _ in range(size)))
        case t.Matrix(rows=rows, columns=columns):
            return make_matrix(type_, [from_words(t.FLOAT32, words) for _ in range(rows * columns)])
        case t.Struct(fields=fields):
            return struct_class(type_)(*(from_words(field.type, words) for field in fields))
        case t.FixedArray(element=element, size=size):
            return FixedArrayValue(type_, [from_words(element, words) for _ in range(size)])
        case t.Traversable() | t.Texture():
            return from_words(t.UINT64, words)
        case _:
            raise AssertionError(f"{type_} has no words")


def narrow(type_: t.Type) -> Callable[[Any], Any]:
    """What storing in a place of this type keeps of a value: storage numbers take their low bits or are rounded."""
    match type_:
        case t.Scalar(kind=t.ScalarKind.BOOL):
            return bool
        case t.Scalar(kind=t.ScalarKind.FLOAT):
            return numbers.rounding(type_)
        case t.Scalar():
            wrapped = numbers.wrap(type_)
            return lambda value: wrapped(int(value))
        case t.Vector(element=element) if widened(type_) != type_:
            part = narrow(element)
            return lambda value: make_vector(widened(type_), tuple(part(number) for number in value))
        case _:
            return lambda value: value


def widened(type_: t.Vector) -> t.Vector:
    """The vector type that reading a storage vector gives."""
    element = type_.element
    wide = t.Scalar(element.kind, 32) if element.kind is not t.ScalarKind.BOOL and element.bits < 32 else element
    return t.Vector(wide, type_.size)


@cache
def _scalar_at(type_: t.Scalar) -> binary.Struct:
    return binary.Struct("<" + _CODES[type_.kind, type_.bits])


@cache
def _numbers_at(element: t.Scalar, count: int) -> binary.Struct:
    return binary.Struct(f"<{count}{_CODES[element.kind, element.bits]}")
