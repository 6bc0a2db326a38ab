"""Calls: what is called, and calls of helpers. Constructors, device functions and special forms have modules of their own."""

from __future__ import annotations

import ast

from optixc.frontend import builtin_names as names
from optixc.frontend.annotations import resolve_type
from optixc.frontend.arguments import bind_arguments, check_written, refuse_stars
from optixc.frontend.check_construct import construct_struct, construct_type
from optixc.frontend.check_coop_vec import check_coop_vec
from optixc.frontend.check_intrinsic import check_atomic, check_intrinsic
from optixc.frontend.check_special import check_special
from optixc.frontend.check_trace import check_trace
from optixc.frontend.checked import Argument, DefaultExpression, ExprInfo, FunctionInstance, HelperUse, ShapeUse
from optixc.frontend.context import Context, describe
from optixc.frontend.conversions import can_convert
from optixc.frontend.places import Root, note_write, place_of, why_read_only
from optixc.frontend.resolve_static import local_names, static_symbol
from optixc.frontend.symbols import (
    BuiltinName,
    ConstantSymbol,
    EnumSymbol,
    FunctionSymbol,
    ParamsSymbol,
    SkippedName,
    StructSymbol,
    ValueSymbol,
    VectorSymbol,
)
from optixc.frontend.weak import INVALID, Invalid, default_type
from optixc.ir import types as t
from optixc.ir.intrinsic_rows import ATOMIC_NAMES, INTRINSICS
from optixc.ir.intrinsic_rows_coop_vec import COOP_VEC_NAMES
from optixc.ir.nodes import is_reference_type


def check_call(c: Context, node: ast.Call) -> ExprInfo:
    """Any call."""
    if isinstance(node.func, ast.Subscript):
        return _check_generic_type(c, node, node.func)
    symbol = static_symbol(c, node.func) if isinstance(node.func, ast.Name | ast.Attribute) else None
    match symbol:
        case FunctionSymbol():
            return _check_helper(c, node, symbol)
        case StructSymbol():
            return construct_struct(c, node, symbol)
        case BuiltinName(name=name):
            return _check_builtin(c, node, name)
        case ConstantSymbol(node=ast.Subscript() as generic, scope=scope):
            target = resolve_type(scope, generic, c.diagnostics)
            return ExprInfo(INVALID) if target is None else construct_type(c, node, target)
        case EnumSymbol(is_flag=is_flag):
            return construct_type(c, node, t.UINT32 if is_flag else t.INT32)
        case SkippedName(reason=reason, span=span, code=code):
            place = f", see {span}" if span is not None else ""
            text = ast.unparse(node.func)
            note = "only helpers of shader files can be called" if not reason.startswith("a function of Python's math") else ""
            return c.error(code, node.func, f"`{text}` cannot be called in a shader: it is {reason}{place}", note)
        case ParamsSymbol() | ConstantSymbol() | ValueSymbol() | VectorSymbol():
            return c.error("OX319", node.func, f"`{ast.unparse(node.func)}` is a value, not a function", "")
    return _not_callable(c, node)


def _not_callable(c: Context, node: ast.Call) -> ExprInfo:
    match node.func:
        case ast.Name(id=name) if name in local_names(c):
            return c.error("OX319", node.func, f"`{name}` is a local here, not a function", "give the local another name")
        case ast.Name(id=name):
            note = names.CONVERSION_REMEDIES.get(name)
            if note is not None or name in _PYTHON_BUILTINS:
                message = f"Python's built-in `{name}` is not part of restricted Python"
                return c.error("OX406", node.func, message, f"use {note}" if note else _PYTHON_BUILTINS[name])
        case ast.Attribute(value=base, attr=name) if static_symbol(c, base) is None:
            info = c.check(base)
            if isinstance(info.type, Invalid):
                return info
            text = ast.unparse(base)
            note = f"write ox.{name}({text})" if name in INTRINSICS else "call a helper function with it"
            return c.error("OX319", node.func, f"{describe(info.type)} has no methods", note)
    info = c.check(node.func)
    return info if isinstance(info.type, Invalid) else c.error("OX319", node.func, f"{describe(info.type)} is not a function", "")


_PYTHON_BUILTINS = {
    "isinstance": "types are known when the shader is compiled",
    "type": "types are known when the shader is compiled",
    "str": "text stands in print() and assert messages only",
    "list": "use a FixedArray",
    "dict": "use an `@ox.struct` class",
    "set": "use a FixedArray",
    "enumerate": "write `for i in range(n)`",
    "zip": "write `for i in range(n)`",
    "map": "write a loop",
    "filter": "write a loop",
    "reversed": "write a range with step -1",
    "any": "write a loop, or `or`",
    "all": "write a loop, or `and`",
    "open": "a shader reads arrays and textures only",
    "input": "a shader reads arrays and textures only",
    "getattr": "name the field",
    "setattr": "name the field",
    "hasattr": "name the field",
    "eval": "a shader is compiled before it runs",
    "exec": "a shader is compiled before it runs",
    "complex": "use float2",
    "id": "values have no identity",
    "hash": "use optixc.stdlib.random.hash_uint",
    "super": "a struct has no methods",
    "iter": "write `for i in range(n)`",
    "next": "write `for i in range(n)`",
    "ord": "text is not a value in shaders",
    "chr": "text is not a value in shaders",
}


def _check_generic_type(c: Context, node: ast.Call, func: ast.Subscript) -> ExprInfo:
    symbol = static_symbol(c, func.value) if isinstance(func.value, ast.Name | ast.Attribute) else None
    if isinstance(symbol, BuiltinName) and symbol.name in names.SIZED_TYPES:
        target = resolve_type(c.scope, func, c.diagnostics)
        return ExprInfo(INVALID) if target is None else construct_type(c, node, target)
    if isinstance(symbol, BuiltinName) and symbol.name in names.ARRAY_RANKS:
        return c.error("OX402", node, "an array cannot be made in a shader", "arrays come from launch parameters and records")
    return c.error("OX319", node.func, "this is not a function", "")


def _check_builtin(c: Context, node: ast.Call, name: str) -> ExprInfo:
    if name in names.TYPE_NAMES:
        return construct_type(c, node, names.TYPE_NAMES[name])
    if name in ("trace", "traverse", "invoke"):
        return check_trace(c, node, name)
    if name in ATOMIC_NAMES:
        return check_atomic(c, node, INTRINSICS[name])
    if name in COOP_VEC_NAMES:
        return check_coop_vec(c, node, name)
    if name in names.SPECIAL_FORMS:
        return check_special(c, node, name)
    if name in INTRINSICS:
        return check_intrinsic(c, node, name)
    if name == "len":
        return _check_length(c, node)
    if name in ("print", "breakpoint"):
        return c.error("OX402", node, f"{name}() gives no value", "write it as a statement of its own")
    if name == "range":
        return c.error("OX402", node, "range() stands in `for` only", "write `for i in range(n)`")
    return c.error("OX319", node.func, f"`{name}` cannot be called in a shader", "")


def _check_length(c: Context, node: ast.Call) -> ExprInfo:
    bound = bind_arguments(c, node, "len", ["array"])
    if bound is None or bound[0] is None:
        return ExprInfo(INVALID)
    info = c.check(bound[0])
    match info.type:
        case Invalid():
            return info
        case t.Array():
            return ExprInfo(t.INT32, use=ShapeUse(bound[0], 0), writes=info.writes)
        case t.FixedArray(size=size) | t.CoopVec(size=size):
            return ExprInfo(t.INT32, constant=size)
        case t.Tuple(items=items):
            return ExprInfo(t.INT32, constant=len(items))
    return c.error("OX302", bound[0], f"len() takes an array, this is {describe(info.type)}", "")


def _check_helper(c: Context, node: ast.Call, symbol: FunctionSymbol) -> ExprInfo:
    if symbol.kind is not None:
        message = f"`{symbol.name}` is a program and cannot be called"
        return c.error("OX319", node.func, message, "programs run by trace, launch or callables records")
    arguments = symbol.node.args
    parameters = [argument.arg for argument in (*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs)]
    defaults = default_nodes(symbol)
    if arguments.vararg is not None or arguments.kwarg is not None:
        # Its definition is the mistake: the hook tells it.
        c.hooks.helper(c, symbol, [], node)
        return ExprInfo(INVALID)
    if not refuse_stars(c, node):
        return ExprInfo(INVALID)
    bound = bind_arguments(c, node, symbol.name, parameters, defaults)
    check_written(c, node)
    if bound is None:
        return ExprInfo(INVALID)
    filled: list[Argument] = []
    types: list[t.Type | None] = []
    for name, argument in zip(parameters, bound, strict=True):
        if argument is None:
            body = c.hooks.expression_of(symbol.scope, defaults[name])
            filled.append(DefaultExpression(defaults[name], body))
            info = body.info[defaults[name]]
        else:
            filled.append(argument)
            info = c.info(argument)
        if isinstance(info.type, Invalid):
            return ExprInfo(INVALID)
        if isinstance(info.type, t.Void):
            return c.error("OX321", node, f"argument `{name}` has no value: the call gives none", "")
        types.append(default_type(info.type))
    instance = c.hooks.helper(c, symbol, types, node)
    if instance is None:
        return ExprInfo(INVALID)
    return _finish_helper(c, node, instance, filled)


def default_nodes(symbol: FunctionSymbol) -> dict[str, ast.expr]:
    """The default of each parameter that has one."""
    arguments = symbol.node.args
    positional = [*arguments.posonlyargs, *arguments.args]
    found = dict(zip([a.arg for a in positional[len(positional) - len(arguments.defaults) :]], arguments.defaults, strict=True))
    for argument, default in zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True):
        if default is not None:
            found[argument.arg] = default
    return found


def _finish_helper(c: Context, node: ast.Call, instance: FunctionInstance, arguments: list[Argument]) -> ExprInfo:
    """Convert the arguments, check what is passed by reference, note what the call does."""
    writes = instance.writes
    payloads: list[tuple[str, str]] = []
    for parameter, argument in zip(instance.parameters, arguments, strict=True):
        name = parameter.local.name
        if isinstance(argument, DefaultExpression):
            info = argument.body.info[argument.node]
            if not can_convert(info.type, parameter.local.type):
                message = f"the default of `{name}` must be {parameter.local.type}, this is {describe(info.type)}"
                c.diagnostics.add(instance.source, "OX302", argument.node, message)
                return ExprInfo(INVALID)
            info.converted = parameter.local.type
        if not isinstance(argument, ast.expr):
            continue
        if not c.coerce(argument, parameter.local.type, f"argument `{name}`"):
            return ExprInfo(INVALID)
        writes = writes or c.info(argument).writes
        if not is_reference_type(parameter.local.type):
            continue
        place = place_of(c, argument)
        if parameter.written:
            writes = True
            if isinstance(argument, ast.IfExp):
                return c.error("OX308", argument, f"`{instance.name}` changes `{name}`, which must be one place", "choose with if and else")
            reason = why_read_only(c, place) if place.root is not Root.VALUE else None
            if reason is not None:
                return c.error("OX307", argument, f"`{instance.name}` changes `{name}`, but {reason}", "pass ox.copy(...) of it")
            if place.root is Root.LOCAL:
                note_write(c, place, argument)
        if place.local is not None and not place.field:
            payloads.append((place.local.name, name))
    c.note_call(instance, node, tuple(payloads))
    return ExprInfo(instance.result, use=HelperUse(instance, tuple(arguments)), writes=writes, fresh=True)
