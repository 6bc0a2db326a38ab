"""trace, traverse and invoke: their arguments and the two forms of payload."""

from __future__ import annotations

import ast

from optixc.frontend.arguments import bind_arguments, check_written
from optixc.frontend.check_intrinsic import require_row
from optixc.frontend.checked import Argument, DefaultArgument, ExprInfo, PayloadAccess, TraceUse
from optixc.frontend.context import Context, describe
from optixc.frontend.places import Root, is_payload_parameter, note_write, place_of, why_read_only
from optixc.frontend.weak import INVALID, Invalid, WeakInt
from optixc.ir import types as t
from optixc.ir.intrinsic_rows import INTRINSICS
from optixc.ir.intrinsics import Generic
from optixc.ir.nodes import Local
from optixc.ir.payload_semantics import is_passed, is_returned

MAX_WORDS = 32
_CLASS = "use an `@ox.payload` class"


def check_trace(c: Context, node: ast.Call, name: str) -> ExprInfo:
    """A call of trace, traverse or invoke; with a tuple as payload its result is the tuple afterwards."""
    row = INTRINSICS[name]
    names = [parameter.name for parameter in row.parameters]
    optional = [parameter.name for parameter in row.parameters if parameter.default is not None]
    if len(node.args) > len(names) + 1:
        note = "payload words go into one argument: `payload=(p0, p1)`, and the call gives them back"
        c.error("OX305", node.args[len(names) + 1], f"{name}() takes {len(names) + 1} arguments, here are {len(node.args)}", note)
        return ExprInfo(INVALID)
    bound = bind_arguments(c, node, name, [*names, "payload"], [*optional, "payload"])
    check_written(c, node)
    require_row(c, row, name, node)
    c.instance.writes = True
    if bound is None:
        return ExprInfo(INVALID)
    fine = True
    arguments: list[Argument] = []
    for parameter, argument in zip(row.parameters, bound, strict=False):
        assert not isinstance(parameter.type, Generic)
        if argument is None:
            assert parameter.default is not None
            arguments.append(DefaultArgument(parameter.default, parameter.type))
            continue
        fine = c.coerce(argument, parameter.type, f"argument `{parameter.name}`") and fine
        arguments.append(argument)
    payload = bound[-1]
    if payload is None:
        return ExprInfo(t.VOID if fine else INVALID, use=TraceUse(name, tuple(arguments), None, None), writes=True)
    info = c.info(payload)
    if isinstance(info.type, Invalid) or not fine:
        return ExprInfo(INVALID)
    if isinstance(info.type, t.Tuple):
        return _check_tuple_payload(c, name, tuple(arguments), payload)
    return _check_struct_payload(c, name, tuple(arguments), payload)


def _check_struct_payload(c: Context, name: str, arguments: tuple[Argument, ...], payload: ast.expr) -> ExprInfo:
    type_ = c.info(payload).type
    if not isinstance(type_, t.Struct) or type_.kind is not t.StructKind.PAYLOAD:
        note = "an `@ox.payload` struct or a tuple of numbers of 32 bits"
        return c.error("OX318", payload, f"a payload cannot be {describe(type_)}", note)
    place = place_of(c, payload)
    reason = why_read_only(c, place)
    if place.root is Root.VALUE:
        return c.error("OX318", payload, "the payload changes in the call, so it needs a name", "bind it to a local first")
    if reason is not None or place.root is Root.ELEMENT:
        return c.error("OX307", payload, f"the payload changes in the call, but {reason or 'it is an element of an array'}", "use a local")
    note_write(c, place, payload)
    if place.local is not None and is_payload_parameter(c, place.local):
        _note_passed_on(c, place.local, type_, name, payload)
    return ExprInfo(t.VOID, use=TraceUse(name, arguments, payload, type_), writes=True)


def _note_passed_on(c: Context, local: Local, struct: t.Struct, name: str, payload: ast.expr) -> None:
    """A program that traces with its own payload reads what the trace takes from it and writes what the trace brings back."""
    for field in struct.fields:
        for is_write, happens in ((False, is_passed(field, name)), (True, is_returned(field, name))):
            if happens:
                c.note_payload_access(local, PayloadAccess(field.name, is_write, c.span(payload)))


def _check_tuple_payload(c: Context, name: str, arguments: tuple[Argument, ...], payload: ast.expr) -> ExprInfo:
    type_ = c.info(payload).type
    assert isinstance(type_, t.Tuple)
    if len(type_.items) > MAX_WORDS:
        return c.error("OX318", payload, f"a payload has at most {MAX_WORDS} words, here are {len(type_.items)}", "")
    words: list[t.Type] = []
    for item in type_.items:
        # A literal without a type is a word: OptiX's payload words are unsigned.
        word: t.Type = t.UINT32 if isinstance(item, WeakInt) else t.FLOAT32 if not isinstance(item, t.Scalar) else item
        if not isinstance(item, t.Scalar | WeakInt) and str(item) != "float literal":
            return c.error(
                "OX318", payload, f"a payload tuple holds numbers of 32 bits, here is {describe(item)}", "use an `@ox.payload` class"
            )
        if isinstance(word, t.Scalar) and (word.bits != 32 or word.kind is t.ScalarKind.BOOL):
            return c.error("OX318", payload, f"a payload tuple holds numbers of 32 bits, here is {word}", _CLASS)
        words.append(word)
    target = t.Tuple(tuple(words))
    if isinstance(payload, ast.Tuple):
        for element, word, item in zip(payload.elts, words, type_.items, strict=True):
            # Negative literals keep their bits in an unsigned word only if the author says so.
            if isinstance(item, WeakInt) and (c.info(element).constant or 0) < 0:
                return c.error("OX313", element, "a payload word is uint32, which does not hold a negative literal", "write int32(...)")
            if not c.coerce(element, word, "a payload word"):
                return ExprInfo(INVALID)
    elif not c.coerce(payload, target, "the payload"):
        return ExprInfo(INVALID)
    c.info(payload).converted = target
    return ExprInfo(target, use=TraceUse(name, arguments, payload, None, tuple(words)), writes=True, fresh=True)
