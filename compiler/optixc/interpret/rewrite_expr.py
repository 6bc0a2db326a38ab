"""Expressions of the checked tree as Python expressions that compute what compiled code computes.

Every operator becomes a call of an operation chosen by type; names, attributes and control stay what they are, so that a debugger
shows the author's variables. Python's own order of evaluation holds, since each node stays where it was.
"""

from __future__ import annotations

import ast
from typing import Any

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
from optixc.frontend.weak import default_type
from optixc.interpret import operations, values
from optixc.interpret.code import Code
from optixc.interpret.rewrite_call import rewrite_call
from optixc.ir import types as t
from optixc.ir.nodes import BinaryOp, UnaryOp

BINARY: dict[type[ast.operator], BinaryOp] = {
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
COMPARE: dict[type[ast.cmpop], BinaryOp] = {
    ast.Eq: BinaryOp.EQUAL,
    ast.NotEq: BinaryOp.NOT_EQUAL,
    ast.Lt: BinaryOp.LESS,
    ast.LtE: BinaryOp.LESS_EQUAL,
    ast.Gt: BinaryOp.GREATER,
    ast.GtE: BinaryOp.GREATER_EQUAL,
}


def rewrite_expression(code: Code, node: ast.expr) -> ast.expr:
    """The value of an expression, converted as its place asks."""
    substitute = code.substitutes.get(node)
    info = code.info(node)
    if substitute is not None:
        value, type_ = substitute, default_type(info.type)
    elif info.constant is not None:
        return ast.copy_location(code.constant(info.constant, info.converted or default_type(info.type)), node)
    else:
        value, type_ = _natural(code, node), _natural_type(code, node)
    return convert(code, value, type_, info.converted, node)


def convert(code: Code, value: ast.expr, source: t.Type, target: t.Type | None, node: ast.AST) -> ast.expr:
    """`value` as `target`, None for no change."""
    conversion = operations.convert(source, target) if target is not None else None
    return value if conversion is None else code.call(conversion, [value], node, "convert_")


def _natural_type(code: Code, node: ast.expr) -> t.Type:
    """The type that `_natural` gives: a tuple's items are converted already."""
    if isinstance(node, ast.Tuple):
        return t.Tuple(tuple(code.type_of(element) for element in node.elts))
    if isinstance(node, ast.IfExp) and code.info(node).constant is None:
        return code.type_of(node.body)
    return default_type(code.info(node).type)


def _natural(code: Code, node: ast.expr) -> ast.expr:
    match node:
        case ast.Name() | ast.Attribute() | ast.Subscript():
            return rewrite_place(code, node)
        case ast.BinOp():
            return _binary(code, node)
        case ast.UnaryOp(op=ast.UAdd(), operand=operand):
            return rewrite_expression(code, operand)
        case ast.UnaryOp(op=op, operand=operand):
            kind = {ast.Not: UnaryOp.NOT, ast.USub: UnaryOp.NEGATE, ast.Invert: UnaryOp.INVERT}[type(op)]
            operation = operations.unary(kind, code.type_of(operand))
            return code.call(operation, [rewrite_expression(code, operand)], node, f"{kind.name.lower()}_")
        case ast.BoolOp(op=op, values=parts):
            return ast.copy_location(ast.BoolOp(op, [rewrite_expression(code, part) for part in parts]), node)
        case ast.Compare():
            return _compare(code, node)
        case ast.IfExp(test=test, body=body, orelse=orelse):
            parts_ = [rewrite_expression(code, part) for part in (test, body, orelse)]
            return ast.copy_location(ast.IfExp(*parts_), node)
        case ast.Tuple(elts=elements):
            return ast.copy_location(ast.Tuple([rewrite_expression(code, element) for element in elements], ast.Load()), node)
        case ast.Call():
            return rewrite_call(code, node)
    raise AssertionError(f"unchecked expression {type(node).__name__}")


def _binary(code: Code, node: ast.BinOp) -> ast.expr:
    op = BINARY[type(node.op)]
    result = default_type(code.info(node).type)
    left, right = rewrite_expression(code, node.left), rewrite_expression(code, node.right)
    left_type, right_type = operand_type(code, node.left), operand_type(code, node.right)
    if op is BinaryOp.POWER:
        left, right = convert(code, left, left_type, result, node), convert(code, right, right_type, result, node)
        left_type = right_type = result
    operation = operations.binary(op, left_type, right_type, result)
    return code.call(operation, [left, right], node, f"{op.name.lower()}_")


def operand_type(code: Code, node: ast.expr) -> t.Type:
    """The type of an operand as rewritten; one that stands for a value evaluated before has its own."""
    return code.type_of(node)


def _compare(code: Code, node: ast.Compare) -> ast.expr:
    """A chain of comparisons; a middle operand is evaluated once, and later ones only if they decide."""
    operands = [node.left, *node.comparators]
    pairs: list[ast.expr] = []
    left = rewrite_expression(code, operands[0])
    for position, op in enumerate(node.ops):
        right = rewrite_expression(code, operands[position + 1])
        operation = operations.binary(
            COMPARE[type(op)], code.type_of(operands[position]), code.type_of(operands[position + 1]), t.BOOL
        )
        following = ast.Name(f"_ox_middle{position}", ast.Load())
        if position + 1 < len(node.ops):
            right = ast.copy_location(ast.NamedExpr(ast.Name(following.id, ast.Store()), right), node)
        pairs.append(code.call(operation, [left, right], node, "compare_"))
        left = ast.copy_location(following, node)
    return pairs[0] if len(pairs) == 1 else ast.copy_location(ast.BoolOp(ast.And(), pairs), node)


def rewrite_place(code: Code, node: ast.Name | ast.Attribute | ast.Subscript) -> ast.expr:
    """A name, field, component or element, read. Structs and fixed arrays are the objects themselves, so that they can be passed on."""
    use = code.info(node).use
    match use:
        case LocalUse():
            assert isinstance(node, ast.Name)
            return ast.copy_location(ast.Name(node.id, ast.Load()), node)
        case ParamsUse():
            return ast.copy_location(code.keep(code.machine.params, "params_"), node)
        case VectorUse(values=numbers):
            type_ = code.info(node).type
            assert isinstance(type_, t.Vector)
            return ast.copy_location(code.keep(values.make_vector(type_, tuple(numbers))), node)
        case ConstantUse(symbol=symbol, body=body):
            return ast.copy_location(rewrite_expression(code.within(body), symbol.node), node)
        case ShapeUse():
            return rewrite_shape(code, use, node)
    assert isinstance(node, ast.Attribute | ast.Subscript)
    base = node.value
    match use:
        case FieldUse(name=name):
            return ast.copy_location(ast.Attribute(rewrite_expression(code, base), name, ast.Load()), node)
        case SwizzleUse(components=components):
            operation: Any = operations.components(components, default_type(code.info(node).type))
            return code.call(operation, [rewrite_expression(code, base)], node, "component_")
        case TupleUse(index=index):
            return ast.copy_location(ast.Subscript(rewrite_expression(code, base), ast.Constant(index), ast.Load()), node)
        case IndexUse(index=index_node):
            parts = [rewrite_expression(code, base), rewrite_expression(code, index_node)]
            return code.call(operations.item(code.type_of(base)), parts, node, "item_")
        case ElementUse(indices=indices):
            parts = [rewrite_expression(code, base), *(rewrite_expression(code, index) for index in indices)]
            return code.call(values.ArrayValue.load, parts, node, "load_")
    raise AssertionError(f"unresolved expression {ast.unparse(node)}")


def rewrite_shape(code: Code, use: ShapeUse, node: ast.AST) -> ast.expr:
    """`array.shape`, or one axis of it."""
    axis = use.axis
    take: Any = (lambda array: array.shape) if axis is None else (lambda array: array.shape[axis])
    return code.call(take, [rewrite_expression(code, use.array)], node, "shape_")
