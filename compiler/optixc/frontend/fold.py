"""Arithmetic on literals, exactly as Python does it; used for module constants, enum members and array sizes, and by the checker.

Results of folding stay weak literals. What Python cannot do (division by zero, a negative shift, a huge power) raises `FoldError`
with the words of the diagnostic.
"""

from __future__ import annotations

import ast
import math
import struct

from optixc.frontend import builtin_names as names
from optixc.frontend.declarations import Declarations
from optixc.frontend.resolve_name import resolve_dotted
from optixc.frontend.symbols import ConstantSymbol, ValueSymbol
from optixc.frontend.weak import ConstantValue

_MAX_BITS = 4096


class FoldError(Exception):
    """An operation on constants that has no value; `code` and `str(error)` make the diagnostic."""

    def __init__(self, code: str, message: str) -> None:
        self.code = code
        super().__init__(message)


def fold_unary(op: ast.unaryop, value: ConstantValue, flag_bits: int = 0) -> ConstantValue | None:
    """`op value`, or None where Python refuses; `~` of a member of an `IntFlag` gives the other bits of the class, `flag_bits`."""
    match op:
        case ast.USub():
            return -value
        case ast.UAdd():
            return +value
        case ast.Not():
            return not value
        case ast.Invert() if isinstance(value, int) and not isinstance(value, bool):
            return flag_bits & ~value if flag_bits else ~value
    return None


def fold_binary(op: ast.operator, left: ConstantValue, right: ConstantValue) -> ConstantValue | None:
    """`left op right`, or None where the operator does not take these values."""
    try:
        match op:
            case ast.Add():
                return left + right
            case ast.Sub():
                return left - right
            case ast.Mult():
                return left * right
            case ast.Div():
                return left / right
            case ast.FloorDiv():
                return left // right
            case ast.Mod():
                return left % right
            case ast.Pow():
                return _power(left, right)
    except ZeroDivisionError:
        raise FoldError("OX314", "this divides a constant by zero") from None
    except OverflowError:
        raise FoldError("OX313", "the result of this constant operation is too large") from None
    if isinstance(left, int) and isinstance(right, int):
        return _fold_bits(op, left, right)
    return None


def _power(left: ConstantValue, right: ConstantValue) -> ConstantValue | None:
    if isinstance(left, int) and isinstance(right, int) and abs(left) > 1 and right * left.bit_length() > _MAX_BITS:
        raise FoldError("OX313", "the result of this constant operation is too large")
    result = left**right
    return result if isinstance(result, int | float) else None


def _fold_bits(op: ast.operator, left: int, right: int) -> ConstantValue | None:
    match op:
        case ast.BitAnd():
            return left & right
        case ast.BitOr():
            return left | right
        case ast.BitXor():
            return left ^ right
        case ast.LShift() | ast.RShift() if right < 0:
            raise FoldError("OX313", "a shift count is negative")
        case ast.LShift() if right + left.bit_length() > _MAX_BITS:
            raise FoldError("OX313", "the result of this constant operation is too large")
        case ast.LShift():
            return left << right
        case ast.RShift():
            return left >> right
    return None


def fold_comparison(op: ast.cmpop, left: ConstantValue, right: ConstantValue) -> bool | None:
    """`left op right`, or None for `in` and `is`."""
    match op:
        case ast.Eq():
            return left == right
        case ast.NotEq():
            return left != right
        case ast.Lt():
            return left < right
        case ast.LtE():
            return left <= right
        case ast.Gt():
            return left > right
        case ast.GtE():
            return left >= right
    return None


def constant_of(scope: Declarations, node: ast.expr) -> ConstantValue | None:
    """The value of an expression of literals and named constants, or None if it is not one. Raises FoldError."""
    match node:
        case ast.Constant(value=bool() | int() | float() as value):
            return value
        case ast.UnaryOp(op=op, operand=operand):
            inner = constant_of(scope, operand)
            return None if inner is None else fold_unary(op, inner)
        case ast.BinOp(left=left, op=operator, right=right):
            a, b = constant_of(scope, left), constant_of(scope, right)
            return None if a is None or b is None else fold_binary(operator, a, b)
        case ast.Name() | ast.Attribute():
            symbol = resolve_dotted(scope, node)
            if isinstance(symbol, ValueSymbol):
                return symbol.value
            if isinstance(symbol, ConstantSymbol):
                return constant_of(symbol.scope, symbol.node)
        case ast.Call(func=func, args=[argument], keywords=[]):
            called = resolve_dotted(scope, func)
            name = getattr(called, "name", "")
            inner = constant_of(scope, argument) if name in names.SCALAR_TYPES else None
            if inner is not None and name.startswith(("int", "uint")):
                return int(inner) if math.isfinite(inner) else None
    return None


def rounded(value: float, bits: int) -> float:
    """The number of a floating type of 16, 32 or 64 bits nearest to the value; infinite beyond its range."""
    code = {16: "e", 32: "f", 64: "d"}[bits]
    try:
        number: float = struct.unpack(code, struct.pack(code, value))[0]
    except OverflowError:
        return math.copysign(math.inf, value)
    return number
