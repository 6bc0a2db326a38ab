"""Sizes, alignments and offsets of types in host memory: the natural C layout that host, runtime and generated code share.

A vector or matrix aligns as its scalar (float3: 12 bytes, aligned to 4), bool is one byte, handles are 64 bits, an array is
`{T* data; uint64_t shape[rank];}`. Payload structs travel in registers: `payload_words` counts their 32-bit words. Tuples and
void have no place in memory; asking for theirs is an error of the caller.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np

from optixc.ir.types import (
    FLOAT32,
    UINT64,
    Array,
    CoopVec,
    FixedArray,
    Matrix,
    Scalar,
    ScalarKind,
    Struct,
    Texture,
    Traversable,
    Tuple,
    Type,
    Vector,
    Void,
)

POINTER_SIZE = 8
HANDLE_SIZE = 8
WORD_SIZE = 4

_NUMPY_KIND = {ScalarKind.BOOL: "?", ScalarKind.INT: "i", ScalarKind.UINT: "u", ScalarKind.FLOAT: "f"}


@dataclass(frozen=True)
class StructLayout:
    """Where the fields of a struct lie, in bytes from its start; `size` is padded to a multiple of `alignment`."""

    size: int
    alignment: int
    offsets: tuple[int, ...]


def scalar_size(scalar: Scalar) -> int:
    """Bytes of one number; bool is one byte."""
    return scalar.bits // 8


@cache
def struct_layout(struct: Struct) -> StructLayout:
    """Offsets by the rules of C: each field at the next multiple of its alignment."""
    offset, alignment, offsets = 0, 1, []
    for field in struct.fields:
        field_alignment = alignment_of(field.type)
        offset = round_up(offset, field_alignment)
        offsets.append(offset)
        offset += size_of(field.type)
        alignment = max(alignment, field_alignment)
    return StructLayout(round_up(offset, alignment), alignment, tuple(offsets))


def size_of(type_: Type) -> int:
    """`sizeof` of the type in memory."""
    match type_:
        case Scalar():
            return scalar_size(type_)
        case Vector():
            return scalar_size(type_.element) * type_.size
        case Matrix():
            return 4 * type_.rows * type_.columns
        case Struct():
            return struct_layout(type_).size
        case FixedArray() | CoopVec():
            return size_of(type_.element) * type_.size
        case Array():
            return POINTER_SIZE + 8 * type_.rank
        case Traversable() | Texture():
            return HANDLE_SIZE
        case Tuple() | Void():
            raise AssertionError(f"{type_} has no layout in memory")


def alignment_of(type_: Type) -> int:
    """`alignof` of the type in memory."""
    match type_:
        case Scalar():
            return scalar_size(type_)
        case Vector():
            return scalar_size(type_.element)
        case Matrix():
            return 4
        case Struct():
            return struct_layout(type_).alignment
        case FixedArray() | CoopVec():
            return alignment_of(type_.element)
        case Array() | Traversable() | Texture():
            return 8
        case Tuple() | Void():
            raise AssertionError(f"{type_} has no layout in memory")


@cache
def dtype_of(type_: Type) -> np.dtype[np.void] | np.dtype[np.generic]:
    """The numpy dtype with the same bytes; vectors, matrices and fixed arrays are sub-arrays, structs are structured."""
    match type_:
        case Scalar():
            return np.dtype(f"{_NUMPY_KIND[type_.kind]}{scalar_size(type_) if type_.kind is not ScalarKind.BOOL else ''}")
        case Vector():
            return np.dtype((dtype_of(type_.element), (type_.size,)))
        case Matrix():
            return np.dtype((np.float32, (type_.rows, type_.columns)))
        case Struct():
            layout = struct_layout(type_)
            return np.dtype(
                {
                    "names": [field.name for field in type_.fields],
                    "formats": [dtype_of(field.type) for field in type_.fields],
                    "offsets": list(layout.offsets),
                    "itemsize": layout.size,
                }
            )
        case FixedArray() | CoopVec():
            return np.dtype((dtype_of(type_.element), (type_.size,)))
        case Array():
            return np.dtype([("data", np.uint64), ("shape", np.uint64, (type_.rank,))])
        case Traversable() | Texture():
            return np.dtype(np.uint64)
        case Tuple() | Void():
            raise AssertionError(f"{type_} has no layout in memory")


def payload_words(type_: Type) -> int:
    """How many payload words a value takes: one for up to 32 bits, two for 64 bits, in field order."""
    match type_:
        case Scalar():
            return max(1, scalar_size(type_) // WORD_SIZE)
        case Vector():
            return payload_words(type_.element) * type_.size
        case Matrix():
            return type_.rows * type_.columns
        case Struct():
            return sum(payload_words(field.type) for field in type_.fields)
        case FixedArray():
            return payload_words(type_.element) * type_.size
        case Traversable() | Texture():
            return HANDLE_SIZE // WORD_SIZE
        case Array() | CoopVec() | Tuple() | Void():
            raise AssertionError(f"{type_} cannot travel in payload words")


def payload_scalars(type_: Type) -> Iterator[Scalar]:
    """What the words of a payload hold, in order: equal sequences can stand for each other."""
    match type_:
        case Scalar():
            yield type_
        case Vector():
            yield from [type_.element] * type_.size
        case Matrix():
            yield from [FLOAT32] * (type_.rows * type_.columns)
        case FixedArray():
            for _ in range(type_.size):
                yield from payload_scalars(type_.element)
        case Struct():
            for field in type_.fields:
                yield from payload_scalars(field.type)
        case Traversable() | Texture():
            yield UINT64
        case Array() | CoopVec() | Tuple() | Void():
            raise AssertionError(f"{type_} has no payload words")


def describe(struct: Struct) -> str:
    """The fields as text, `name:type@offset;...`, nested structs expanded: equal texts mean equal bytes.

    This is what the host compares a struct class with, so `host.structs` writes the same form.
    """
    layout = struct_layout(struct)
    fields = (f"{field.name}:{_describe_type(field.type)}@{offset}" for field, offset in zip(struct.fields, layout.offsets, strict=True))
    return ";".join(fields)


def _describe_type(type_: Type) -> str:
    match type_:
        case Struct():
            return f"{{{describe(type_)}}}"
        case FixedArray():
            return f"FixedArray[{_describe_type(type_.element)},{type_.size}]"
        case Array():
            return f"Array{type_.rank}[{_describe_type(type_.element)}]"
        case _:
            return str(type_)


def round_up(value: int, multiple: int) -> int:
    """The smallest multiple of `multiple` that is not below `value`."""
    return -(-value // multiple) * multiple
