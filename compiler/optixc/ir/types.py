"""The types of shader programs.

A type is a frozen value: equal types are equal Python objects, so that they can be dictionary keys and be compared with `==`.
This module knows sizes of nothing (`layout` does) and decides no conversions (the checker does).
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class ScalarKind(Enum):
    """What a scalar's bits mean; arithmetic is done on BOOL, and on INT, UINT and FLOAT of 32 and 64 bits only."""

    BOOL = "bool"
    INT = "int"
    UINT = "uint"
    FLOAT = "float"


@dataclass(frozen=True)
class Scalar:
    """One number. `bits` is 8 for bool; 8 and 16 bit numbers are storage types: reading one gives the 32-bit type."""

    kind: ScalarKind
    bits: int

    def __str__(self) -> str:
        return "bool" if self.kind is ScalarKind.BOOL else f"{self.kind.value}{self.bits}"


@dataclass(frozen=True)
class Vector:
    """`size` (2 to 4) numbers of one scalar type, named x y z w."""

    element: Scalar
    size: int

    def __str__(self) -> str:
        return f"{_VECTOR_PREFIX[self.element]}{self.size}"


@dataclass(frozen=True)
class Matrix:
    """`rows` x `columns` float32 numbers, stored row by row; `m[i]` is row i as a vector."""

    rows: int
    columns: int

    def __str__(self) -> str:
        return f"float{self.rows}x{self.columns}"


class StructKind(Enum):
    """Which decorator made the struct: that decides where it may stand and how it is laid out."""

    PLAIN = "struct"
    PAYLOAD = "payload"
    ATTRIBUTES = "attributes"


@dataclass(frozen=True)
class StructField:
    """A named member. `semantics` is the payload word semantics (bits of `payload_word`), None where not given."""

    name: str
    type: Type
    semantics: int | None = None


@dataclass(frozen=True)
class Struct:
    """A record of named fields. Two structs are the same type if name, kind and fields are equal."""

    name: str
    kind: StructKind
    fields: tuple[StructField, ...]

    def __str__(self) -> str:
        return self.name

    def field(self, name: str) -> StructField | None:
        """The field called `name`, or None."""
        return next((field for field in self.fields if field.name == name), None)


@dataclass(frozen=True)
class FixedArray:
    """`size` elements of `element`, held by value inside a local or a struct."""

    element: Type
    size: int

    def __str__(self) -> str:
        return f"FixedArray[{self.element}, {self.size}]"


@dataclass(frozen=True)
class CoopVec:
    """A cooperative vector: `size` numbers of one type, a value of locals, parameters and results, never a part of a struct or array."""

    element: Scalar
    size: int

    def __str__(self) -> str:
        return f"CoopVec[{self.element}, {self.size}]"


@dataclass(frozen=True)
class Array:
    """A view of host memory with `rank` axes: `{T* data; uint64_t shape[rank];}`, C-contiguous."""

    element: Type
    rank: int

    def __str__(self) -> str:
        return f"Array{self.rank if self.rank > 1 else ''}[{self.element}]"


@dataclass(frozen=True)
class Tuple:
    """Several values at once: multiple results, tuple assignment, the tuple form of a payload."""

    items: tuple[Type, ...]

    def __str__(self) -> str:
        return f"tuple[{', '.join(str(item) for item in self.items)}]"


@dataclass(frozen=True)
class Traversable:
    """A 64-bit traversable handle (slot and generation); 0 is never valid."""

    def __str__(self) -> str:
        return "Traversable"


@dataclass(frozen=True)
class Texture:
    """A 64-bit texture handle (slot and generation); 0 is never valid."""

    def __str__(self) -> str:
        return "Texture"


@dataclass(frozen=True)
class Void:
    """The result of a function that returns nothing."""

    def __str__(self) -> str:
        return "None"


Type = Scalar | Vector | Matrix | Struct | FixedArray | CoopVec | Array | Tuple | Traversable | Texture | Void

BOOL = Scalar(ScalarKind.BOOL, 8)
INT8 = Scalar(ScalarKind.INT, 8)
UINT8 = Scalar(ScalarKind.UINT, 8)
INT16 = Scalar(ScalarKind.INT, 16)
UINT16 = Scalar(ScalarKind.UINT, 16)
INT32 = Scalar(ScalarKind.INT, 32)
UINT32 = Scalar(ScalarKind.UINT, 32)
INT64 = Scalar(ScalarKind.INT, 64)
UINT64 = Scalar(ScalarKind.UINT, 64)
FLOAT16 = Scalar(ScalarKind.FLOAT, 16)
FLOAT32 = Scalar(ScalarKind.FLOAT, 32)
FLOAT64 = Scalar(ScalarKind.FLOAT, 64)
FLOAT2, FLOAT3, FLOAT4 = (Vector(FLOAT32, size) for size in (2, 3, 4))
UINT2, UINT3, UINT4 = (Vector(UINT32, size) for size in (2, 3, 4))
INT2, INT3, INT4 = (Vector(INT32, size) for size in (2, 3, 4))
VOID = Void()
TRAVERSABLE = Traversable()
TEXTURE = Texture()

_VECTOR_PREFIX = {
    BOOL: "bool",
    INT8: "char",
    UINT8: "uchar",
    INT16: "short",
    UINT16: "ushort",
    INT32: "int",
    UINT32: "uint",
    INT64: "longlong",
    UINT64: "ulonglong",
    FLOAT16: "half",
    FLOAT32: "float",
    FLOAT64: "double",
}


def scalar_of(type_: Type) -> Scalar | None:
    """The scalar that a scalar, vector or matrix is made of; None for every other type."""
    match type_:
        case Scalar():
            return type_
        case Vector():
            return type_.element
        case Matrix():
            return FLOAT32
        case _:
            return None
