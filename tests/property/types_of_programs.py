"""The types that generated programs use, and literals of them with the values on which arithmetic goes wrong."""

from __future__ import annotations

from dataclasses import dataclass
from random import Random

INTEGERS = ("int32", "uint32", "int64", "uint64")
FLOATS = ("float32", "float64")
NUMBERS = (*INTEGERS, *FLOATS)
SCALARS = ("bool", *NUMBERS)
WIDENS_TO = {
    "int32": ("int64", "float32", "float64"),
    "uint32": ("int64", "uint64", "float32", "float64"),
    "int64": ("float32", "float64"),
    "uint64": ("float32", "float64"),
    "float32": ("float64",),
    "float64": (),
}
"""Into what a number goes without a conversion."""

_FAMILIES = (
    ("float", "float32"),
    ("int", "int32"),
    ("uint", "uint32"),
    ("double", "float64"),
    ("longlong", "int64"),
    ("ulonglong", "uint64"),
)
VECTORS = {f"{family}{size}": (element, size) for family, element in _FAMILIES for size in (2, 3, 4)}
VECTOR_OF = {of: name for name, of in VECTORS.items()}
MATRICES = {"float3x3": (3, 3), "float3x4": (3, 4), "float4x4": (4, 4)}

_WHOLE = ("0", "1", "2", "3", "5", "7", "8", "12", "31", "32", "33", "63", "64", "100", "255", "65535", "0x55555555", "0x7fffffff")
_LARGE = {
    "int32": ("0x7ffffffe", "-1", "-2", "-7", "-100", "-2147483648", "-2147483647"),
    "uint32": ("0xffffffff", "0x80000000", "0xfffffffe"),
    "int64": ("-1", "-3", "0x7fffffffffffffff", "-0x8000000000000000", "0x123456789abcdef", "-4294967297"),
    "uint64": ("0xffffffffffffffff", "0x8000000000000000", "0x100000000"),
}
_REAL = (
    *("0.0", "1.0", "-1.0", "0.5", "-0.5", "2.0", "3.25", "-7.5", "1e-3", "0.1", "1e10", "-3e38", "1e-40"),
    *("16777217.0", "2147483648.0", "3", "-2"),
)

NAMED = ("Mode.SECOND", "LIMIT", "(Bits.A | Bits.C)", "Bits.BOTH", "(LIMIT << 2)")
"""Enum members and constants of the module, which are literals to the compiler; none is zero."""


@dataclass(frozen=True)
class StructType:
    """A struct class of the generated module, with the types of its fields; storage types read as `widened` says."""

    name: str
    fields: tuple[tuple[str, str], ...]


STORAGE = {
    **{"int8": "int32", "uint8": "uint32", "int16": "int32", "uint16": "uint32", "float16": "float32"},
    **{"char3": "int3", "uchar4": "uint4", "short2": "int2", "ushort3": "uint3", "half4": "float4"},
}
"""Types of memory only, and what reading them gives."""


def is_integer(type_: str) -> bool:
    """Whether it is one of the four integer types."""
    return type_ in INTEGERS


def literal(random: Random, type_: str, nonzero: bool = False) -> str:
    """A literal without a type of its own that the type takes."""
    if type_ == "bool":
        return random.choice(("True", "False"))
    choices = _REAL if type_ in FLOATS else (*_WHOLE, *_LARGE[type_])
    if type_ in INTEGERS and random.random() < 0.08:
        return random.choice(NAMED)
    text = random.choice(choices)
    while nonzero and float(int(text, 0) if type_ not in FLOATS else text) == 0.0:
        text = random.choice(choices)
    return f"({text})" if text.startswith("-") else text


def constant(random: Random, type_: str) -> str:
    """An expression of exactly this scalar type that holds a constant; never zero, by which nothing may be divided."""
    text = literal(random, type_, nonzero=type_ != "bool")
    return text if type_ == "bool" else f"{type_}({text})"
