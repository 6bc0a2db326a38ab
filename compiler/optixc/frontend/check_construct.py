"""Constructors: numbers, vectors, matrices, structs, fixed arrays, cooperative vectors."""

from __future__ import annotations

import ast
import math

from optixc.frontend.arguments import bind_arguments, check_written, refuse_stars
from optixc.frontend.checked import Argument, ConstructUse, ConvertUse, DefaultArgument, DefaultExpression, ExprInfo
from optixc.frontend.context import Context, describe, range_of
from optixc.frontend.conversions import can_convert, fits
from optixc.frontend.fold import rounded
from optixc.frontend.places import check_no_alias
from optixc.frontend.symbols import StructSymbol
from optixc.frontend.weak import INVALID, ConstantValue, Invalid, WeakInt, is_number, is_weak, widened
from optixc.ir import types as t


def construct_type(c: Context, node: ast.Call, target: t.Type) -> ExprInfo:
    """`float3(...)`, `int(...)`, `ox.FixedArray[T, N](...)`."""
    if not refuse_stars(c, node):
        return ExprInfo(INVALID)
    if node.keywords:
        return c.error("OX305", node.keywords[0].value, f"{target}() takes no keywords", "give the components in order")
    infos = [c.check(argument) for argument in node.args]
    if any(isinstance(info.type, Invalid) for info in infos):
        return ExprInfo(INVALID)
    match target:
        case t.Scalar():
            return _construct_scalar(c, node, target)
        case t.Vector():
            return _construct_vector(c, node, target)
        case t.Matrix():
            return _construct_matrix(c, node, target)
        case t.FixedArray():
            return _construct_fixed_array(c, node, target)
        case t.CoopVec():
            return _construct_coop_vec(c, node, target)
        case t.Traversable() | t.Texture():
            if len(node.args) == 1 and c.coerce(node.args[0], t.UINT64, "a handle"):
                return ExprInfo(target, use=ConstructUse(target, (node.args[0],)), writes=infos[0].writes)
    return c.error("OX305", node, f"{target} cannot be made in a shader", "it comes from launch parameters and records")


def _writes(c: Context, node: ast.Call) -> bool:
    return any(c.info(argument).writes for argument in node.args)


def _construct_scalar(c: Context, node: ast.Call, target: t.Scalar) -> ExprInfo:
    if not node.args:
        return ExprInfo(widened(target), use=ConvertUse(DefaultArgument(_zero(target), target), target))
    if len(node.args) != 1:
        return c.error("OX305", node.args[1], f"{target}() takes one argument", "")
    argument = node.args[0]
    info = c.info(argument)
    if not (is_number(info.type) or info.type == t.BOOL):
        return c.error("OX302", argument, f"{target}() takes a number, this is {describe(info.type)}", "name a component")
    if is_weak(info.type) and info.constant is not None:
        return _constant_scalar(c, node, info, target)
    c.settle(argument)
    constant: ConstantValue | None = None
    return ExprInfo(widened(target), constant=constant, use=ConvertUse(argument, target), writes=info.writes)


def _constant_scalar(c: Context, node: ast.Call, info: ExprInfo, target: t.Scalar) -> ExprInfo:
    """A literal in a constructor: out of range is an error, not a wrap, so that `uint8(300)` is told."""
    value = info.constant
    assert value is not None
    if target.kind is t.ScalarKind.BOOL:
        constant: ConstantValue = bool(value)
    elif target.kind is t.ScalarKind.FLOAT:
        constant = rounded(float(value), target.bits)
    elif isinstance(value, float) and not math.isfinite(value):
        return c.error("OX313", node, f"{target} does not hold {value}", f"expected {range_of(target)}")
    else:
        constant = int(value)
        if not fits(constant, target):
            return c.error("OX313", node, f"{target} does not hold {constant}", f"expected {range_of(target)}")
    if target.kind is not t.ScalarKind.FLOAT or target.bits >= 32:
        return ExprInfo(widened(target), constant=constant, use=ConvertUse(node.args[0], target))
    c.settle(node.args[0])
    return ExprInfo(widened(target), use=ConvertUse(node.args[0], target))


def _zero(target: t.Scalar) -> ConstantValue:
    if target.kind is t.ScalarKind.BOOL:
        return False
    return 0.0 if target.kind is t.ScalarKind.FLOAT else 0


def _construct_vector(c: Context, node: ast.Call, target: t.Vector) -> ExprInfo:
    result = widened(target)
    assert isinstance(result, t.Vector)
    writes = _writes(c, node)
    if not node.args:
        zeros = DefaultArgument(_zero(result.element), result.element)
        return ExprInfo(result, use=ConstructUse(target, (zeros,), spread=True))
    if len(node.args) == 1:
        argument = node.args[0]
        info = c.info(argument)
        if is_number(info.type) or info.type == t.BOOL:
            return (
                ExprInfo(result, use=ConstructUse(target, (argument,), spread=True), writes=writes)
                if _component(c, argument, result)
                else ExprInfo(INVALID)
            )
        if isinstance(info.type, t.Vector) and info.type.size >= target.size:
            # float3(int3) converts, float3(float4) keeps the first components.
            return ExprInfo(result, use=ConstructUse(target, (argument,), spread=True), writes=writes)
        if isinstance(info.type, t.Tuple) and can_convert(info.type, result):
            c.coerce(argument, result, "this tuple")
            return ExprInfo(result, use=ConstructUse(target, (argument,), spread=True), writes=writes)
    count = 0
    for argument in node.args:
        info = c.info(argument)
        if isinstance(info.type, t.Vector):
            count += info.type.size
        elif is_number(info.type) or info.type == t.BOOL:
            count += 1
            if not _component(c, argument, result):
                return ExprInfo(INVALID)
        else:
            return c.error("OX302", argument, f"a component must be a number, this is {describe(info.type)}", f"of {target}")
    if count != target.size:
        return c.error("OX305", node, f"{target}() takes {target.size} components, here are {count}", "or one number for all")
    return ExprInfo(result, use=ConstructUse(target, tuple(node.args)), writes=writes)


def _component(c: Context, argument: ast.expr, vector: t.Vector) -> bool:
    """A literal takes the vector's element type; everything else is converted by the constructor."""
    info = c.info(argument)
    element = vector.element
    if is_weak(info.type) and info.constant is not None:
        if can_convert(info.type, element):
            return c.coerce(argument, element, "a component")
        if element.kind in (t.ScalarKind.INT, t.ScalarKind.UINT):
            c.error("OX302", argument, f"a component of {vector} must be an integer, this is {describe(info.type)}", "write int(...)")
            return False
    c.settle(argument)
    return True


def _construct_matrix(c: Context, node: ast.Call, target: t.Matrix) -> ExprInfo:
    row = t.Vector(t.FLOAT32, target.columns)
    writes = _writes(c, node)
    if not node.args:
        return ExprInfo(target, use=ConstructUse(target, (DefaultArgument(0.0, t.FLOAT32),) * (target.rows * target.columns)))
    if len(node.args) == target.rows:
        fits = [c.coerce(argument, row, "a row") for argument in node.args]
    elif len(node.args) == target.rows * target.columns:
        fits = [c.coerce(argument, t.FLOAT32, "an element") for argument in node.args]
    else:
        message = f"{target}() takes {target.rows} rows or {target.rows * target.columns} numbers, here are {len(node.args)}"
        return c.error("OX305", node, message, f"rows are {row}")
    return ExprInfo(target, use=ConstructUse(target, tuple(node.args)), writes=writes) if all(fits) else ExprInfo(INVALID)


def _construct_fixed_array(c: Context, node: ast.Call, target: t.FixedArray) -> ExprInfo:
    if not node.args:
        return ExprInfo(target, use=ConstructUse(target, ()), fresh=True)
    if len(node.args) != target.size:
        message = f"{target}() takes {target.size} items or none (all zero), here are {len(node.args)}"
        return c.error("OX305", node, message, "")
    for argument in node.args:
        if not c.coerce(argument, target.element, "an item") or not check_no_alias(c, argument, "this item"):
            return ExprInfo(INVALID)
    return ExprInfo(target, use=ConstructUse(target, tuple(node.args)), writes=_writes(c, node), fresh=True)


def _construct_coop_vec(c: Context, node: ast.Call, target: t.CoopVec) -> ExprInfo:
    """All zero, one number for all elements, or one number for each."""
    if len(node.args) not in (0, 1, target.size):
        message = f"{target}() takes {target.size} elements, one for all, or none (all zero), here are {len(node.args)}"
        return c.error("OX305", node, message, "")
    for argument in node.args:
        if not c.coerce(argument, target.element, "an element"):
            return ExprInfo(INVALID)
    return ExprInfo(target, use=ConstructUse(target, tuple(node.args)), writes=_writes(c, node))


def construct_struct(c: Context, node: ast.Call, symbol: StructSymbol) -> ExprInfo:
    """`Material(albedo, roughness=0.5)`."""
    struct = symbol.type
    bound = bind_arguments(c, node, struct.name, [field.name for field in struct.fields], symbol.defaults)
    check_written(c, node)
    if bound is None:
        return ExprInfo(INVALID)
    arguments: list[Argument] = []
    fine = True
    for field, argument in zip(struct.fields, bound, strict=True):
        if isinstance(field.type, t.Void):
            return ExprInfo(INVALID)
        if argument is None:
            default = symbol.defaults[field.name]
            body = c.hooks.expression_of(symbol.scope, default)
            info = body.info[default]
            if not can_convert(info.type, field.type):
                message = f"the default of `{field.name}` must be {field.type}, this is {describe(info.type)}"
                c.diagnostics.add(symbol.scope.file.source, "OX302", default, message)
                fine = False
            elif not isinstance(info.type, Invalid):
                info.converted = widened(field.type)
            arguments.append(DefaultExpression(default, body))
            continue
        fine = c.coerce(argument, field.type, f"field `{field.name}`") and check_no_alias(c, argument, f"field `{field.name}`") and fine
        arguments.append(argument)
    writes = any(c.info(argument).writes for argument in arguments if isinstance(argument, ast.expr))
    if not fine:
        return ExprInfo(INVALID)
    return ExprInfo(struct, use=ConstructUse(struct, tuple(arguments)), writes=writes, fresh=True)


def is_literal_int(info: ExprInfo) -> bool:
    """Whether an expression is an integer literal."""
    return isinstance(info.type, WeakInt)
