"""Which conversions happen by themselves, and what two operands have in common.

By themselves: literals to any number type that holds them, integers to wider integers of the same values, integers to floats, float32
to float64, element-wise in vectors, a tuple of numbers to a vector. Everything else is written out by the author (`int32(x)`), so that
a shader never changes a value silently where Python would not.
"""

from __future__ import annotations

from optixc.frontend.weak import (
    INVALID,
    WEAK_FLOAT,
    WEAK_INT,
    CheckType,
    ConstantValue,
    Invalid,
    WeakFloat,
    WeakInt,
    is_float,
    is_weak,
    tuple_of,
    widened,
)
from optixc.ir import types as t


def fits(value: ConstantValue, type_: t.Scalar) -> bool:
    """Whether an integer constant is one of the values of an integer type."""
    if type_.kind is t.ScalarKind.INT:
        return -(1 << (type_.bits - 1)) <= value < 1 << (type_.bits - 1)
    if type_.kind is t.ScalarKind.UINT:
        return 0 <= value < 1 << type_.bits
    return True


def can_convert(source: CheckType, target: CheckType) -> bool:
    """Whether `source` becomes `target` by itself; ranges of literals are checked apart (`fits`)."""
    if source == target or isinstance(source, Invalid) or isinstance(target, Invalid):
        return True
    if isinstance(target, t.Scalar | t.Vector) and widened(target) != target:
        return can_convert(source, widened(target))
    if isinstance(target, t.Scalar):
        return _can_convert_scalar(source, target)
    if isinstance(target, t.Vector):
        if isinstance(source, t.Vector):
            return source.size == target.size and can_convert(source.element, target.element)
        if isinstance(source, t.Tuple):
            return len(source.items) == target.size and all(can_convert(item, target.element) for item in source.items)
    if isinstance(target, t.Tuple) and isinstance(source, t.Tuple):
        return len(source.items) == len(target.items) and all(can_convert(a, b) for a, b in zip(source.items, target.items, strict=True))
    return False


def _can_convert_scalar(source: CheckType, target: t.Scalar) -> bool:
    if target.kind is t.ScalarKind.BOOL:
        return False
    if isinstance(source, WeakInt):
        return True
    if isinstance(source, WeakFloat):
        return target.kind is t.ScalarKind.FLOAT
    if not isinstance(source, t.Scalar) or source.kind is t.ScalarKind.BOOL:
        return False
    if target.kind is t.ScalarKind.FLOAT:
        return source.kind is not t.ScalarKind.FLOAT or source.bits <= target.bits
    if source.kind is t.ScalarKind.FLOAT:
        return False
    if source.kind is target.kind:
        return source.bits <= target.bits
    return source.kind is t.ScalarKind.UINT and source.bits < target.bits


def common_scalar(left: CheckType, right: CheckType) -> CheckType | None:
    """The type in which two numbers meet, or None: int32 and uint32 do not, because Python's answer is neither."""
    if left == right:
        return left if not isinstance(left, t.Scalar) or left.kind is not t.ScalarKind.BOOL else None
    if isinstance(left, WeakInt) and isinstance(right, WeakInt):
        return left if left.flag_bits else right
    if is_weak(left) and is_weak(right):
        return WEAK_FLOAT
    if is_weak(right):
        left, right = right, left
    if not isinstance(right, t.Scalar) or right.kind is t.ScalarKind.BOOL:
        return None
    if isinstance(left, WeakInt):
        return right
    if isinstance(left, WeakFloat):
        return right if right.kind is t.ScalarKind.FLOAT else t.FLOAT32
    if not isinstance(left, t.Scalar) or left.kind is t.ScalarKind.BOOL:
        return None
    if is_float(left) or is_float(right):
        return t.FLOAT64 if t.FLOAT64 in (left, right) else t.FLOAT32
    if can_convert(left, right):
        return right
    return left if can_convert(right, left) else None


def common_type(left: CheckType, right: CheckType) -> CheckType | None:
    """The type in which two values meet: numbers, vectors of one size, a vector and a number (spread), or equal types."""
    if isinstance(left, Invalid) or isinstance(right, Invalid):
        return INVALID
    if isinstance(left, t.Vector) or isinstance(right, t.Vector):
        size = left.size if isinstance(left, t.Vector) else right.size if isinstance(right, t.Vector) else 0
        if isinstance(left, t.Vector) and isinstance(right, t.Vector) and left.size != right.size:
            return None
        a = left.element if isinstance(left, t.Vector) else left
        b = right.element if isinstance(right, t.Vector) else right
        if a == b == t.BOOL:
            return t.Vector(t.BOOL, size)
        element = common_scalar(a, b)
        return t.Vector(element, size) if isinstance(element, t.Scalar) else None
    number = common_scalar(left, right)
    if number is not None:
        return number
    if left == right:
        return left
    if isinstance(left, t.Tuple) and isinstance(right, t.Tuple) and len(left.items) == len(right.items):
        items = [common_type(a, b) for a, b in zip(left.items, right.items, strict=True)]
        if all(item is not None for item in items):
            return tuple_of(item for item in items if item is not None)
    return None


def weak_of(value: ConstantValue) -> CheckType:
    """The type of a constant that has none of its own."""
    if isinstance(value, bool):
        return t.BOOL
    return WEAK_INT if isinstance(value, int) else WEAK_FLOAT
