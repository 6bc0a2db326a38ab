"""Operators and conversions on every type that has them: what the rewritten tree calls, chosen once by type.

Vectors work component by component, a number beside a vector counts for every component.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from optixc.host.matrices import Matrix
from optixc.host.vectors import Vector
from optixc.interpret import native, numbers, values
from optixc.ir import types as t
from optixc.ir.nodes import BinaryOp, UnaryOp

Operation = Callable[..., Any]

_EQUALITY = {BinaryOp.EQUAL, BinaryOp.NOT_EQUAL}


def binary(op: BinaryOp, left: t.Type, right: t.Type, result: t.Type) -> Operation:
    """`a op b`."""
    if op is BinaryOp.MATRIX_MULTIPLY:
        bound = native.bind(f"matmul:{left}:{right}", (left, right), result)
        return lambda a, b: bound(None, a, b)
    if isinstance(left, t.Matrix) or isinstance(right, t.Matrix):
        return _matrix_binary(op, left, right)
    scalar = t.scalar_of(left)
    if scalar is None:
        # Handles compare as the 64-bit numbers that they are.
        return numbers.binary(op, t.UINT64, native.binary_float)
    one = numbers.binary(op, scalar, native.binary_float)
    if isinstance(left, t.Scalar) and isinstance(right, t.Scalar):
        return one
    if op in _EQUALITY:
        is_equal = op is BinaryOp.EQUAL
        return lambda a, b: all(x == y for x, y in zip(a, b, strict=True)) == is_equal
    assert isinstance(result, t.Vector)
    size, type_ = result.size, result

    def by_component(a: Any, b: Any) -> Vector:
        xs = tuple(a) if isinstance(a, Vector) else (a,) * size
        ys = tuple(b) if isinstance(b, Vector) else (b,) * size
        return values.make_vector(type_, tuple(one(x, y) for x, y in zip(xs, ys, strict=True)))

    return by_component


def _matrix_binary(op: BinaryOp, left: t.Type, right: t.Type) -> Operation:
    one = numbers.binary(op, t.FLOAT32, native.binary_float)
    type_ = left if isinstance(left, t.Matrix) else right
    assert isinstance(type_, t.Matrix)
    count = type_.rows * type_.columns

    def flat(value: Any) -> list[float]:
        return [number for row in value for number in row] if isinstance(value, Matrix) else [value] * count

    if op in _EQUALITY:
        return lambda a, b: (flat(a) == flat(b)) == (op is BinaryOp.EQUAL)
    return lambda a, b: values.make_matrix(type_, [one(x, y) for x, y in zip(flat(a), flat(b), strict=True)])


def unary(op: UnaryOp, type_: t.Type) -> Operation:
    """`-a`, `~a`, `not a`."""
    scalar = t.scalar_of(type_)
    assert scalar is not None
    one = numbers.unary(op, scalar)
    match type_:
        case t.Vector():
            return lambda value: values.make_vector(type_, tuple(one(number) for number in value))
        case t.Matrix():
            return lambda value: values.make_matrix(type_, [one(number) for row in value for number in row])
        case _:
            return one


def convert(source: t.Type, target: t.Type) -> Operation | None:
    """The conversion from one type to another, None where both hold the same values."""
    if source == target:
        return None
    match source, target:
        case t.Scalar(), t.Scalar():
            return numbers.convert(source, target)
        case t.Scalar(), t.Vector(element=element, size=size):
            to_element = numbers.convert(source, element)
            return lambda value: values.make_vector(target, (to_element(value),) * size)
        case t.Vector(element=old), t.Vector(element=new):
            each = numbers.convert(old, new)
            return lambda value: values.make_vector(target, tuple(each(number) for number in value))
        case t.Tuple(items=items), t.Vector(element=element):
            parts = [_or_same(convert(item, element)) for item in items]
            return lambda value: values.make_vector(target, tuple(part(item) for part, item in zip(parts, value, strict=True)))
        case t.Tuple(items=items), t.Tuple(items=wanted):
            parts = [_or_same(convert(item, want)) for item, want in zip(items, wanted, strict=True)]
            return lambda value: tuple(part(item) for part, item in zip(parts, value, strict=True))
        case (t.Traversable() | t.Texture() | t.Scalar()), (t.Traversable() | t.Texture() | t.Scalar()):
            return lambda value: int(value) & 0xFFFFFFFFFFFFFFFF
    raise AssertionError(f"no conversion of {source} to {target}")


def _or_same(conversion: Operation | None) -> Operation:
    return conversion or (lambda value: value)


def components(indices: tuple[int, ...], result: t.Type) -> Operation:
    """`v.x`, `v.zyx`."""
    if not isinstance(result, t.Vector):
        return lambda value: value[indices[0]]
    return lambda value: values.make_vector(result, tuple(value[index] for index in indices))


def item(base: t.Type) -> Operation:
    """`base[index]` of a fixed array, vector of any kind or matrix; out of range it is zero."""
    match base:
        case t.FixedArray() | t.CoopVec():
            return lambda value, index: value[index]
        case t.Vector(element=element, size=size):
            nothing: Any = values.zero(element)
        case t.Matrix(rows=size, columns=columns):
            nothing = values.zero(t.Vector(t.FLOAT32, columns))
        case _:
            raise AssertionError(f"{base} has no items")
    return lambda value, index: value[index] if 0 <= index < size else nothing


def construct(target: t.Type, sources: tuple[t.Type, ...], spread: bool) -> Operation:
    """A vector, matrix, struct, fixed array, cooperative vector or handle of its parts."""
    match target:
        case t.Vector():
            return _construct_vector(target, sources, spread)
        case t.Matrix():
            return lambda *parts: values.make_matrix(target, [n for part in parts for n in (part if isinstance(part, Vector) else (part,))])
        case t.Struct(fields=fields):
            kind = values.struct_class(target)
            narrows = [values.narrow(field.type) for field in fields]
            return lambda *parts: kind(*(narrow(part) for narrow, part in zip(narrows, parts, strict=True)))
        case t.FixedArray(element=element, size=size):
            narrow = values.narrow(element)
            return lambda *parts: (
                values.FixedArrayValue(target, [narrow(part) for part in parts] or [values.zero(element) for _ in range(size)])
            )
        case t.CoopVec(element=element, size=size):
            narrow = values.narrow(element)
            return lambda *parts: values.CoopVecValue(
                target, tuple(narrow(part) for part in (parts * size if len(parts) == 1 else parts)) or (values.zero(element),) * size
            )
        case t.Traversable() | t.Texture():
            return lambda value: int(value) & 0xFFFFFFFFFFFFFFFF
    raise AssertionError(f"no constructor of {target}")


def _construct_vector(target: t.Vector, sources: tuple[t.Type, ...], spread: bool) -> Operation:
    result = values.widened(target)
    narrow = values.narrow(target.element)
    scalars = [t.scalar_of(source) for source in sources]
    parts = [numbers.convert(scalar, target.element) if scalar is not None and scalar != target.element else narrow for scalar in scalars]
    size = target.size

    def build(*given: Any) -> Vector:
        found: list[Any] = []
        for part, value in zip(parts, given, strict=True):
            found += [part(number) for number in (value if isinstance(value, Vector) else (value,))]
        if spread:
            found = found * size if len(found) == 1 else found[:size]
        return values.make_vector(result, tuple(found))

    return build
