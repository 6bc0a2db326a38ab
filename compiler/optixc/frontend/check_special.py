"""Special forms: copy, get_sbt_data, report_intersection, throw_exception, direct_call, continuation_call."""

from __future__ import annotations

import ast

from optixc.frontend.annotations import resolve_type, resolve_value_type
from optixc.frontend.arguments import bind_arguments, refuse_stars
from optixc.frontend.check_intrinsic import require_row
from optixc.frontend.checked import CallableUse, CopyUse, ExprInfo, PayloadAccess, ReportUse, SbtDataUse
from optixc.frontend.context import Context, describe
from optixc.frontend.places import is_payload_parameter, place_of
from optixc.frontend.weak import INVALID, Invalid, WeakInt, is_weak
from optixc.ir import types as t
from optixc.ir.intrinsic_rows import INTRINSICS
from optixc.ir.intrinsics import Effect
from optixc.ir.layout import payload_words

MAX_WORDS = 8
MAX_HIT_KIND = 127
MAX_EXCEPTION_CODE = (1 << 30) - 1


def check_special(c: Context, node: ast.Call, name: str) -> ExprInfo:
    """One of the forms whose types no row can tell."""
    if not refuse_stars(c, node):
        return ExprInfo(INVALID)
    match name:
        case "copy":
            return _check_copy(c, node)
        case "get_sbt_data" | "hit_object_get_sbt_data":
            return _check_sbt_data(c, node, name)
        case "report_intersection" | "throw_exception":
            return _check_report(c, node, name)
        case "direct_call" | "continuation_call":
            return _check_callable(c, node, name)
        case "payload_word":
            return c.error("OX402", node, "payload_word() belongs into an `@ox.payload` class", "")
        case "launch_params":
            return c.error("OX402", node, "launch_params() belongs to module level", "write params = ox.launch_params(Params)")
    return c.error("OX319", node.func, f"`{name}` cannot be called like this", f"write ox.{name}[float, 8]()")


def _check_copy(c: Context, node: ast.Call) -> ExprInfo:
    bound = bind_arguments(c, node, "copy", ["value"])
    if bound is None or bound[0] is None:
        return ExprInfo(INVALID)
    info = c.check(bound[0])
    if isinstance(info.type, t.Array | t.Void):
        return c.error("OX302", bound[0], f"copy() does not take {describe(info.type)}", "a struct or fixed array")
    if isinstance(info.type, Invalid):
        return info
    place = place_of(c, bound[0])
    if place.local is not None and isinstance(info.type, t.Struct) and not place.field and is_payload_parameter(c, place.local):
        for field in info.type.fields:
            c.note_payload_access(place.local, PayloadAccess(field.name, False, c.span(bound[0])))
    return ExprInfo(c.settle(bound[0]), use=CopyUse(bound[0]), writes=info.writes, fresh=True)


def _check_sbt_data(c: Context, node: ast.Call, name: str) -> ExprInfo:
    row = INTRINSICS[name]
    require_row(c, row, name, node)
    bound = bind_arguments(c, node, name, ["struct"])
    if bound is None or bound[0] is None:
        return ExprInfo(INVALID)
    type_ = resolve_type(c.scope, bound[0], c.diagnostics)
    if type_ is None:
        return ExprInfo(INVALID)
    if not isinstance(type_, t.Struct) or type_.kind is not t.StructKind.PLAIN:
        return c.error("OX302", bound[0], f"{name}() takes an `@ox.struct` class, this is {type_}", "")
    return ExprInfo(type_, use=SbtDataUse(type_, row if name != "get_sbt_data" else None), fresh=True)


def _check_report(c: Context, node: ast.Call, name: str) -> ExprInfo:
    row = INTRINSICS[name]
    require_row(c, row, name, node)
    c.instance.writes = True
    fixed = [parameter.name for parameter in row.parameters]
    head = ast.Call(func=node.func, args=node.args[: len(fixed)], keywords=node.keywords)
    bound = bind_arguments(c, ast.copy_location(head, node), name, fixed)
    for argument in (*node.args, *(keyword.value for keyword in node.keywords)):
        c.check(argument)
    if bound is None:
        return ExprInfo(INVALID)
    arguments = [argument for argument in bound if argument is not None]
    rest = node.args[len(fixed) :]
    if any(isinstance(c.info(argument).type, Invalid) for argument in (*arguments, *rest)):
        return ExprInfo(INVALID)
    fine = True
    for parameter, argument in zip(row.parameters, arguments, strict=True):
        assert isinstance(parameter.type, t.Scalar)
        fine = c.coerce(argument, parameter.type, f"argument `{parameter.name}`") and fine
    constant = c.info(arguments[-1]).constant
    if name == "report_intersection" and constant is not None and not 0 <= constant <= MAX_HIT_KIND:
        return c.error("OX313", arguments[-1], f"a hit kind is 0 to {MAX_HIT_KIND}, this is {constant}", "128 and above are OptiX's own")
    if name == "throw_exception" and constant is not None and not 0 <= constant <= MAX_EXCEPTION_CODE:
        return c.error("OX313", arguments[-1], f"an exception code is 0 to 2**30 - 1, this is {constant}", "negative codes are OptiX's own")
    fine = _check_words(c, name, rest) and fine
    if not fine:
        return ExprInfo(INVALID)
    ends = row.effect is Effect.ENDS_LAUNCH_INDEX
    return ExprInfo(t.VOID if ends else t.BOOL, use=ReportUse(row, (*arguments, *rest)), writes=True)


def _check_words(c: Context, name: str, rest: list[ast.expr]) -> bool:
    """One attributes struct, or up to eight scalars of 32 bits."""
    if name == "report_intersection" and len(rest) == 1:
        type_ = c.info(rest[0]).type
        if isinstance(type_, t.Struct):
            if type_.kind is t.StructKind.ATTRIBUTES:
                return True
            c.error("OX302", rest[0], f"{type_} is no attributes class", "decorate it with `@ox.attributes`")
            return False
    if len(rest) > MAX_WORDS:
        c.error("OX305", rest[MAX_WORDS], f"{name}() takes at most {MAX_WORDS} words, here are {len(rest)}", "")
        return False
    fine = True
    for argument in rest:
        info = c.info(argument)
        if is_weak(info.type):
            fine = c.coerce(argument, t.UINT32 if isinstance(info.type, WeakInt) else t.FLOAT32, "a word") and fine
        elif not isinstance(info.type, t.Scalar) or payload_words(info.type) != 1 or info.type == t.BOOL:
            c.error("OX302", argument, f"a word is a number of 32 bits, this is {describe(info.type)}", "name its components")
            fine = False
    return fine


def _check_callable(c: Context, node: ast.Call, name: str) -> ExprInfo:
    row = INTRINSICS[name]
    require_row(c, row, name, node)
    c.instance.writes = True
    result: t.Type | None = t.VOID
    for keyword in node.keywords:
        if keyword.arg != "result":
            return c.error("OX305", keyword.value, f"{name}() has no parameter `{keyword.arg}`", "it takes index, arguments, result=type")
        result = resolve_value_type(c.scope, keyword.value, c.diagnostics, "a result")
    if not node.args:
        return c.error("OX305", node, f"{name}() misses the index of the callables record", "")
    infos = [c.check(argument) for argument in node.args]
    if result is None or any(isinstance(info.type, Invalid) for info in infos):
        return ExprInfo(INVALID)
    if not c.coerce(node.args[0], t.UINT32, "argument `index`"):
        return ExprInfo(INVALID)
    for argument in node.args[1:]:
        type_ = c.settle(argument)
        if isinstance(type_, t.Void):
            return c.error("OX321", argument, "this call gives no value", "a callable's argument needs one")
    return ExprInfo(result, use=CallableUse(name == "direct_call", node.args[0], tuple(node.args[1:]), result), writes=True, fresh=True)
