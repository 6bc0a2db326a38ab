"""Scalar arithmetic as compiled code does it, on plain Python numbers.

A bool is a bool, an integer of any width an int within its range, a float32 a float that binary32 holds, a float64 a float. Each
function takes the type and gives the operation for it. `+ - * / sqrt` of float32 are computed in binary64 and rounded once more, which
is the correctly rounded result (Figueroa 1995: 53 >= 2 * 24 + 2).
"""

from __future__ import annotations

import ctypes
import math
import struct
from collections.abc import Callable
from typing import Any

import numpy as np

from optixc.ir import types as t
from optixc.ir.nodes import BinaryOp, UnaryOp

Number = Any
Operation = Callable[[Number, Number], Number]

INVALID_RESULT: float = struct.unpack("<f", struct.pack("<I", 0xFFC00000))[0]
"""The NaN of an invalid operation on x86."""

_COMPARISONS: dict[BinaryOp, Operation] = {
    BinaryOp.EQUAL: lambda a, b: a == b,
    BinaryOp.NOT_EQUAL: lambda a, b: a != b,
    BinaryOp.LESS: lambda a, b: a < b,
    BinaryOp.LESS_EQUAL: lambda a, b: a <= b,
    BinaryOp.GREATER: lambda a, b: a > b,
    BinaryOp.GREATER_EQUAL: lambda a, b: a >= b,
}

_BITS: dict[BinaryOp, Operation] = {
    BinaryOp.BIT_AND: lambda a, b: a & b,
    BinaryOp.BIT_OR: lambda a, b: a | b,
    BinaryOp.BIT_XOR: lambda a, b: a ^ b,
}

_ARITHMETIC: dict[BinaryOp, Operation] = {
    BinaryOp.ADD: lambda a, b: a + b,
    BinaryOp.SUBTRACT: lambda a, b: a - b,
    BinaryOp.MULTIPLY: lambda a, b: a * b,
}


def float32(value: float) -> float:
    """Rounded to binary32; beyond its range infinite."""
    return ctypes.c_float(value).value


def float16(value: float) -> float:
    """Rounded to binary16."""
    with np.errstate(all="ignore"):
        return float(np.float16(value))


def wrap(type_: t.Scalar) -> Callable[[int], int]:
    """Integers modulo 2^bits, as the type holds them."""
    mask, sign = (1 << type_.bits) - 1, 1 << (type_.bits - 1)
    if type_.kind is t.ScalarKind.UINT:
        return lambda value: value & mask
    return lambda value: ((value & mask) ^ sign) - sign


def limits(type_: t.Scalar) -> tuple[int, int]:
    """The least and the greatest integer of the type."""
    if type_.kind is t.ScalarKind.UINT:
        return 0, (1 << type_.bits) - 1
    return -(1 << (type_.bits - 1)), (1 << (type_.bits - 1)) - 1


def rounding(type_: t.Scalar) -> Callable[[float], float]:
    """What makes a binary64 number one of this floating type."""
    by_bits: dict[int, Callable[[float], float]] = {16: float16, 32: float32, 64: float}
    return by_bits[type_.bits]


def convert(source: t.Scalar, target: t.Scalar) -> Callable[[Number], Number]:
    """A change of scalar type: float to integer truncates and saturates, NaN gives 0; integers wrap."""
    if target.kind is t.ScalarKind.BOOL:
        return bool
    if target.kind is t.ScalarKind.FLOAT:
        if source.kind is t.ScalarKind.FLOAT or source.bits < 64:
            return rounding(target)
        wide = np.int64 if source.kind is t.ScalarKind.INT else np.uint64
        narrow = {16: np.float16, 32: np.float32, 64: np.float64}[target.bits]
        return lambda value: float(wide(value).astype(narrow))
    if source.kind is t.ScalarKind.FLOAT:
        low, high = limits(t.Scalar(target.kind, max(target.bits, 32)))
        narrowed = wrap(target)
        return lambda value: narrowed(_truncated(value, low, high))
    return wrap(target)


def _truncated(value: float, low: int, high: int) -> int:
    if value != value:
        return 0
    if math.isinf(value):
        return high if value > 0 else low
    return min(max(int(value), low), high)


def unary(op: UnaryOp, type_: t.Scalar) -> Callable[[Number], Number]:
    """`-x`, `~x`, `not x`."""
    if op is UnaryOp.NOT:
        return lambda value: not value
    if type_.kind is t.ScalarKind.FLOAT:
        return lambda value: -value
    wrapped = wrap(type_)
    return (lambda value: wrapped(-value)) if op is UnaryOp.NEGATE else (lambda value: wrapped(~value))


def binary(op: BinaryOp, type_: t.Scalar, native: Callable[[str], Callable[..., Any]]) -> Operation:
    """`a op b` of two numbers of one type; `native` finds compiled functions by name."""
    if op in _COMPARISONS:
        return _COMPARISONS[op]
    if op in _BITS:
        return _BITS[op]
    if type_.kind is t.ScalarKind.FLOAT:
        return _float_binary(op, type_, native)
    return _integer_binary(op, type_)


def _float_binary(op: BinaryOp, type_: t.Scalar, native: Callable[[str], Callable[..., Any]]) -> Operation:
    rounded = rounding(type_)
    if op in _ARITHMETIC:
        exact = _ARITHMETIC[op]
        return lambda a, b: rounded(exact(a, b))
    if op is BinaryOp.DIVIDE:
        return lambda a, b: rounded(divide(a, b))
    names = {BinaryOp.FLOOR_DIVIDE: "floorDivide", BinaryOp.MODULO: "modulo", BinaryOp.POWER: "power"}
    return native(f"{names[op]}:{type_}")


def divide(a: float, b: float) -> float:
    """IEEE division, by zero too."""
    if b != 0.0:
        return a / b
    if a == 0.0 or a != a:
        return a if a != a else INVALID_RESULT
    return math.copysign(math.inf, math.copysign(1.0, a) * math.copysign(1.0, b))


def _integer_binary(op: BinaryOp, type_: t.Scalar) -> Operation:
    wrapped = wrap(type_)
    match op:
        case BinaryOp.ADD | BinaryOp.SUBTRACT | BinaryOp.MULTIPLY:
            exact = _ARITHMETIC[op]
            return lambda a, b: wrapped(exact(a, b))
        case BinaryOp.DIVIDE:
            to_float = convert(type_, t.FLOAT32)
            return lambda a, b: float32(divide(to_float(a), to_float(b)))
        case BinaryOp.FLOOR_DIVIDE:
            return lambda a, b: wrapped(a // b) if b else 0
        case BinaryOp.MODULO:
            return lambda a, b: wrapped(a % b) if b else 0
        case BinaryOp.POWER:
            return lambda a, b: wrapped(_integer_power(a, b, type_.bits))
        case BinaryOp.SHIFT_LEFT:
            return lambda a, b: wrapped(a << b) if 0 <= b < type_.bits else 0
        case BinaryOp.SHIFT_RIGHT:
            return lambda a, b: a >> (b if 0 <= b < type_.bits else type_.bits)
        case _:
            raise AssertionError(f"no {op.value} of {type_}")


def _integer_power(base: int, exponent: int, bits: int) -> int:
    """Repeated multiplication; of negative exponents only those of 1 and -1 are no fraction."""
    if exponent >= 0:
        return pow(base, exponent, 1 << bits)
    if base in (1, -1):
        return base ** (-exponent % 2) if base == -1 else 1
    return 0
