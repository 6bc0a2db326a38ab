"""Expressions in IR. Calls are in `lower_call`; this module knows names, places, operators and the order of evaluation."""

from __future__ import annotations

import ast
from collections.abc import Callable, Sequence
from functools import partial

from optixc.frontend.checked import (
    ConstantUse,
    ElementUse,
    FieldUse,
    IndexUse,
    LocalUse,
    ParamsUse,
    ShapeUse,
    SwizzleUse,
    TupleUse,
    VectorUse,
)
from optixc.frontend.lower_block import Block, FunctionLowering, is_stable, literal
from optixc.frontend.lower_call import lower_call
from optixc.frontend.lower_convert import convert, is_simple, read
from optixc.frontend.weak import default_type
from optixc.ir import types as t
from optixc.ir.nodes import (
    ArrayShape,
    Assign,
    Binary,
    BinaryOp,
    ComponentRef,
    Construct,
    ElementRef,
    Expr,
    FieldRef,
    If,
    IndexRef,
    Literal,
    LocalRef,
    Logical,
    ParamsRef,
    Select,
    TupleItem,
    Unary,
    UnaryOp,
)

_BINARY: dict[type[ast.operator], BinaryOp] = {
    ast.Add: BinaryOp.ADD,
    ast.Sub: BinaryOp.SUBTRACT,
    ast.Mult: BinaryOp.MULTIPLY,
    ast.Div: BinaryOp.DIVIDE,
    ast.FloorDiv: BinaryOp.FLOOR_DIVIDE,
    ast.Mod: BinaryOp.MODULO,
    ast.Pow: BinaryOp.POWER,
    ast.MatMult: BinaryOp.MATRIX_MULTIPLY,
    ast.BitAnd: BinaryOp.BIT_AND,
    ast.BitOr: BinaryOp.BIT_OR,
    ast.BitXor: BinaryOp.BIT_XOR,
    ast.LShift: BinaryOp.SHIFT_LEFT,
    ast.RShift: BinaryOp.SHIFT_RIGHT,
}

_COMPARE: dict[type[ast.cmpop], BinaryOp] = {
    ast.Eq: BinaryOp.EQUAL,
    ast.NotEq: BinaryOp.NOT_EQUAL,
    ast.Lt: BinaryOp.LESS,
    ast.LtE: BinaryOp.LESS_EQUAL,
    ast.Gt: BinaryOp.GREATER,
    ast.GtE: BinaryOp.GREATER_EQUAL,
}


def lower_expression(low: FunctionLowering, node: ast.expr, block: Block) -> Expr:
    """The value of an expression, converted as its place asks; what it does besides goes to `block`."""
    substitute = low.substitutes.get(node)
    info = low.info(node)
    if substitute is not None:
        value = substitute
    elif info.constant is not None:
        type_ = info.converted or default_type(info.type)
        scalar = type_.element if isinstance(type_, t.Vector) else type_
        assert isinstance(scalar, t.Scalar)
        value = literal(info.constant, scalar)
    else:
        value = _natural(low, node, block)
    return convert(value, info.converted, low.span(node)) if info.converted is not None else value


def _natural(low: FunctionLowering, node: ast.expr, block: Block) -> Expr:
    match node:
        case ast.Name() | ast.Attribute() | ast.Subscript():
            return read(lower_place(low, node, block, keep_indices=False))
        case ast.BinOp(left=left, op=op, right=right):
            a, b = low.in_order([left, right], block)
            return _binary(low, node, _BINARY[type(op)], a, b)
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            return Unary(UnaryOp.NOT, lower_expression(low, operand, block), t.BOOL)
        case ast.UnaryOp(op=op, operand=operand):
            value = lower_expression(low, operand, block)
            if isinstance(op, ast.UAdd):
                return value
            return Unary(UnaryOp.NEGATE if isinstance(op, ast.USub) else UnaryOp.INVERT, value, value.type)
        case ast.BoolOp(op=op, values=values):
            parts = [partial(lower_expression, low, value) for value in values]
            return lower_logical(low, isinstance(op, ast.And), parts, block, node)
        case ast.Compare():
            return _compare(low, node, block)
        case ast.IfExp():
            return _conditional(low, node, block)
        case ast.Tuple(elts=elements):
            items = low.in_order(elements, block)
            return Construct(t.Tuple(tuple(item.type for item in items)), tuple(items))
        case ast.Call():
            return lower_call(low, node, block)
    raise AssertionError(f"unchecked expression {type(node).__name__}")


def _binary(low: FunctionLowering, node: ast.BinOp, op: BinaryOp, left: Expr, right: Expr) -> Expr:
    type_ = low.info(node).type
    assert isinstance(type_, t.Scalar | t.Vector | t.Matrix)
    span = low.span(node)
    if op is BinaryOp.POWER:
        # `**` has no mixed form; the others take a number beside a vector as it is.
        left, right = convert(left, type_, span), convert(right, type_, span)
    return Binary(op, left, right, type_, span)


def lower_place(low: FunctionLowering, node: ast.expr, block: Block, keep_indices: bool, is_target: bool = False) -> Expr:
    """A name, field, component or element as a place; `keep_indices` evaluates indices now, for places used twice.

    Of what `is_target` nothing is copied on the way, whatever its indices do.
    """
    info = low.info(node)
    match info.use:
        case LocalUse(local=local):
            return LocalRef(local)
        case ParamsUse(struct=struct):
            return ParamsRef(struct)
        case VectorUse(values=values):
            assert isinstance(info.type, t.Vector)
            return Literal(values, info.type)
        case ConstantUse(symbol=symbol, body=body):
            return lower_expression(low.within(body), symbol.node, block)
        case ShapeUse():
            return lower_shape(low, info.use, info.type, block)
    assert isinstance(node, ast.Attribute | ast.Subscript)
    match info.use:
        case FieldUse(name=name, stored=stored):
            return FieldRef(_base(low, node.value, block, keep_indices, is_target), name, stored)
        case SwizzleUse(components=components):
            base = _base(low, node.value, block, keep_indices, is_target)
            assert isinstance(base.type, t.Vector)
            element = base.type.element
            return ComponentRef(base, components, element if len(components) == 1 else t.Vector(element, len(components)))
        case TupleUse(index=index):
            base = lower_expression(low, node.value, block)
            if isinstance(base, Construct):
                return base.arguments[index]
            return TupleItem(base, index, t.VOID if info.type is None else default_type(info.type))
        case IndexUse(index=index, stored=stored):
            # A fixed array is a reference: what the index writes to it is read. A vector or matrix is taken before the index is evaluated.
            is_place = keep_indices or is_target or isinstance(low.info(node.value).type, t.FixedArray)
            parts = [partial(_base_of, low, node.value, is_place), partial(lower_expression, low, index)]
            base, position = low.in_order_by(parts, block, [node.value, index], places=(0,) if is_place else ())
            item = base.type.element if isinstance(base.type, t.Vector) else stored
            return IndexRef(base, _kept(low, position, block, index, keep_indices), item)
        case ElementUse(indices=indices, stored=stored):
            array, *positions = low.in_order([node.value, *indices], block)
            kept = [_kept(low, value, block, index, keep_indices) for value, index in zip(positions, indices, strict=True)]
            return ElementRef(array, tuple(kept), stored, low.span(node))
    raise AssertionError(f"unresolved expression {ast.unparse(node)}")


def _base_of(low: FunctionLowering, node: ast.expr, keep_indices: bool, block: Block) -> Expr:
    return _base(low, node, block, keep_indices)


def _base(low: FunctionLowering, node: ast.expr, block: Block, keep_indices: bool, is_target: bool = False) -> Expr:
    """What a field or component is taken of: a place where possible, so that nothing is copied. One that is written is not widened."""
    if isinstance(node, ast.Name | ast.Attribute | ast.Subscript) and low.info(node).constant is None and node not in low.substitutes:
        place = lower_place(low, node, block, keep_indices, is_target)
        return place if keep_indices or is_target or not isinstance(place.type, t.Vector | t.Scalar) else read(place)
    return lower_expression(low, node, block)


def _kept(low: FunctionLowering, value: Expr, block: Block, node: ast.expr, keep: bool) -> Expr:
    return low.keep(value, block, low.span(node), "index") if keep and not is_stable(value) else value


def lower_shape(low: FunctionLowering, use: ShapeUse, type_: object, block: Block) -> Expr:
    """`array.shape` or one axis of it."""
    array = lower_expression(low, use.array, block)
    if use.axis is not None:
        return ArrayShape(array, use.axis, t.INT32)
    assert isinstance(type_, t.Tuple)
    return Construct(type_, tuple(ArrayShape(array, axis, t.INT32) for axis in range(len(type_.items))))


def lower_logical(low: FunctionLowering, is_and: bool, parts: Sequence[Callable[[Block], Expr]], block: Block, node: ast.AST) -> Expr:
    """`a and b and c`; a part that does something is only evaluated if it decides."""
    result = parts[0](block)
    for part in parts[1:]:
        inner = Block()
        right = part(inner)
        if not inner.statements:
            result = Logical(is_and, result, right, t.BOOL)
            continue
        span = low.span(node)
        kept = low.keep(result, block, span, "condition")
        inner.emit(Assign(kept, right, span))
        test: Expr = kept if is_and else Unary(UnaryOp.NOT, kept, t.BOOL)
        block.emit(If(test, tuple(inner.statements), (), span))
        result = kept
    return result


def _compare(low: FunctionLowering, node: ast.Compare, block: Block) -> Expr:
    operands = [node.left, *node.comparators]
    left, right = low.in_order(operands[:2], block)
    return _compare_rest(low, node, operands, 0, left, right, block)


def _compare_rest(
    low: FunctionLowering, node: ast.Compare, operands: list[ast.expr], position: int, left: Expr, right: Expr, block: Block
) -> Expr:
    """The comparison of operands `position` and the next, and of those after them; a middle operand is evaluated once."""
    op = _COMPARE[type(node.ops[position])]
    if position + 2 == len(operands):
        return Binary(op, left, right, t.BOOL, low.span(node))
    later_writes = any(low.info(operand).writes for operand in operands[position + 2 :])
    if not is_simple(right) and (later_writes or not _is_path(right)):
        right = low.keep(right, block, low.span(operands[position + 1]), "middle")
    pair = Binary(op, left, right, t.BOOL, low.span(node))

    def rest(inner: Block) -> Expr:
        following = lower_expression(low, operands[position + 2], inner)
        return _compare_rest(low, node, operands, position + 1, right, following, inner)

    return lower_logical(low, True, [lambda _: pair, rest], block, node)


def _is_path(value: Expr) -> bool:
    while isinstance(value, FieldRef | ComponentRef):
        value = value.base
    return isinstance(value, LocalRef | ParamsRef)


def _conditional(low: FunctionLowering, node: ast.IfExp, block: Block) -> Expr:
    condition = lower_expression(low, node.test, block)
    then_block, else_block = Block(), Block()
    then = lower_expression(low, node.body, then_block)
    other = lower_expression(low, node.orelse, else_block)
    if not then_block.statements and not else_block.statements:
        return Select(condition, then, other, then.type)
    span = low.span(node)
    local = low.temporary("chosen", then.type)
    then_block.emit(Assign(LocalRef(local), then, span))
    else_block.emit(Assign(LocalRef(local), other, span))
    block.emit(If(condition, tuple(then_block.statements), tuple(else_block.statements), span))
    return LocalRef(local)
