"""What operators give on literals, exactly as compiled code computes it; None where folding is better left to the C++ compiler."""

from __future__ import annotations

import math
import struct

from optixc.ir.nodes import BinaryOp
from optixc.ir.types import Scalar, ScalarKind

Number = bool | int | float


def fit(value: Number, scalar: Scalar) -> Number:
    """The value as a number of this type: integers wrap, floats round."""
    match scalar.kind:
        case ScalarKind.BOOL:
            return bool(value)
        case ScalarKind.FLOAT:
            return _rounded(float(value), scalar.bits)
        case ScalarKind.UINT:
            return int(value) & ((1 << scalar.bits) - 1)
        case ScalarKind.INT:
            wrapped = int(value) & ((1 << scalar.bits) - 1)
            return wrapped - (1 << scalar.bits) if wrapped >> (scalar.bits - 1) else wrapped


def convert(value: Number, scalar: Scalar, source: Scalar | None = None) -> Number:
    """A conversion between scalar types: float to integer truncates and saturates, NaN gives 0."""
    value = value if source is None else fit(value, source)
    is_integer = scalar.kind in (ScalarKind.INT, ScalarKind.UINT)
    if isinstance(value, float) and is_integer:
        lowest = -(1 << (scalar.bits - 1)) if scalar.kind is ScalarKind.INT else 0
        highest = (1 << (scalar.bits - 1)) - 1 if scalar.kind is ScalarKind.INT else (1 << scalar.bits) - 1
        if math.isnan(value):
            return 0
        return lowest if value <= lowest else highest if value >= highest else int(value)
    return fit(value, scalar)


def binary(op: BinaryOp, left: Number, right: Number, operand: Scalar) -> Number | None:
    """`left op right` of operands of one type; comparisons give a bool."""
    left, right = fit(left, operand), fit(right, operand)
    compared = _compare(op, left, right)
    if compared is not None:
        return compared
    if operand.kind is ScalarKind.BOOL:
        return None
    match op:
        case BinaryOp.ADD:
            return fit(left + right, operand)
        case BinaryOp.SUBTRACT:
            return fit(left - right, operand)
        case BinaryOp.MULTIPLY:
            return fit(left * right, operand)
    if operand.kind is ScalarKind.FLOAT:
        return None
    a, b = int(left), int(right)
    match op:
        case BinaryOp.BIT_AND:
            return fit(a & b, operand)
        case BinaryOp.BIT_OR:
            return fit(a | b, operand)
        case BinaryOp.BIT_XOR:
            return fit(a ^ b, operand)
        case BinaryOp.FLOOR_DIVIDE:
            return fit(a // b, operand) if b else 0
        case BinaryOp.MODULO:
            return fit(a % b, operand) if b else 0
        case _:
            return None


def _compare(op: BinaryOp, left: Number, right: Number) -> bool | None:
    match op:
        case BinaryOp.EQUAL:
            return left == right
        case BinaryOp.NOT_EQUAL:
            return left != right
        case BinaryOp.LESS:
            return left < right
        case BinaryOp.LESS_EQUAL:
            return left <= right
        case BinaryOp.GREATER:
            return left > right
        case BinaryOp.GREATER_EQUAL:
            return left >= right
        case _:
            return None


def _rounded(value: float, bits: int) -> float:
    """Rounded once to binary32 or binary16: sums and products of two binary32 numbers are near enough exact in binary64."""
    if bits == 64 or math.isnan(value) or math.isinf(value):
        return value
    try:
        rounded: float = struct.unpack("f" if bits == 32 else "e", struct.pack("f" if bits == 32 else "e", value))[0]
    except OverflowError:
        return math.copysign(math.inf, value)
    return rounded
