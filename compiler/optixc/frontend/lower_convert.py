"""Conversions between types in IR, as the checker decided them."""

from __future__ import annotations

from optixc.frontend.lower_block import literal
from optixc.frontend.weak import ConstantValue, widened
from optixc.ir import types as t
from optixc.ir.nodes import Binary, BinaryOp, ComponentRef, Construct, Convert, Expr, Literal, LocalRef, TupleItem
from optixc.source import Span


def convert(value: Expr, target: t.Type, span: Span) -> Expr:
    """`value` as `target`; bool of a number is a comparison with zero."""
    source = value.type
    if source == target:
        return value
    match source, target:
        case t.Tuple(items=items), t.Vector(element=element):
            return Construct(target, tuple(convert(_item(value, i, item), element, span) for i, item in enumerate(items)))
        case t.Tuple(items=items), t.Tuple(items=wanted):
            parts = tuple(convert(_item(value, i, item), wanted[i], span) for i, item in enumerate(items))
            return Construct(target, parts)
        case t.Scalar(), t.Scalar(kind=t.ScalarKind.BOOL):
            return Binary(BinaryOp.NOT_EQUAL, value, literal(0, source), t.BOOL, span)
        case t.Scalar(), t.Scalar() if isinstance(value, Literal) and not isinstance(value.value, tuple):
            if source.kind is not t.ScalarKind.FLOAT or target.kind is t.ScalarKind.FLOAT:
                return literal(value.value, target)
        case t.Scalar(), t.Vector(element=element, size=size) if isinstance(value, Literal):
            one = convert(value, element, span)
            if isinstance(one, Literal) and not isinstance(one.value, tuple):
                return Literal((one.value,) * size, target)
    return Convert(value, target)


def _item(value: Expr, index: int, type_: t.Type) -> Expr:
    if isinstance(value, Construct):
        return value.arguments[index]
    return TupleItem(value, index, type_)


def read(place: Expr) -> Expr:
    """The value of a place: storage numbers widen."""
    wide = widened(place.type)
    return place if wide == place.type else Convert(place, wide)


def narrow(value: Expr, target: t.Type) -> Expr:
    """A value as a storage type and back: what `uint8(x)` keeps of x."""
    wide = widened(target)
    narrowed = value if value.type == target else Convert(value, target)
    return narrowed if wide == target else Convert(narrowed, wide)


def component(vector: Expr, index: int) -> Expr:
    """One component of a vector."""
    assert isinstance(vector.type, t.Vector)
    if isinstance(vector, Construct) and all(isinstance(argument.type, t.Scalar) for argument in vector.arguments):
        return vector.arguments[index]
    return ComponentRef(vector, (index,), vector.type.element)


def is_simple(value: Expr) -> bool:
    """Whether writing the expression twice costs nothing."""
    return isinstance(value, Literal | LocalRef)


def numbers_of(literal_: Literal) -> tuple[ConstantValue, ...]:
    """The components of a literal vector, or the one number."""
    return literal_.value if isinstance(literal_.value, tuple) else (literal_.value,)
