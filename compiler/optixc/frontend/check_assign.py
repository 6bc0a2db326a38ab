"""Assignments: names get locals, places are written, tuples are taken apart, augmented forms become operators."""

from __future__ import annotations

import ast
import copy

from optixc.frontend.annotations import resolve_value_type
from optixc.frontend.checked import ElementUse, ExprInfo, FieldUse, IndexUse, SwizzleUse
from optixc.frontend.context import Context, describe, remedy
from optixc.frontend.conversions import can_convert
from optixc.frontend.environment import Bound
from optixc.frontend.places import check_no_alias, note_write, parameter_role, place_of, why_read_only
from optixc.frontend.resolve_static import static_symbol
from optixc.frontend.symbols import ParamsSymbol
from optixc.frontend.weak import CheckType, Invalid, WeakFloat, WeakInt, default_type, is_weak
from optixc.ir import types as t
from optixc.ir.nodes import Local, is_reference_type


def check_assign(c: Context, node: ast.Assign) -> None:
    """`a = value`, `a = b = value`, `a, b = value`."""
    info = c.check(node.value)
    check_no_value_lost(c, node.value, info)
    if len(node.targets) > 1 and isinstance(info.type, t.Struct | t.FixedArray):
        name = ast.unparse(node.targets[-1])
        c.error("OX308", node, f"both targets would be names of one {info.type}", f"assign ox.copy({name}) to the second")
    for target in node.targets:
        assign_target(c, target, node.value, info.type)


def check_annotated(c: Context, node: ast.AnnAssign) -> None:
    """`a: float = value`, or `a: float` alone, which only promises a type."""
    type_ = resolve_value_type(c.scope, node.annotation, c.diagnostics, "a local")
    if not isinstance(node.target, ast.Name):
        c.error("OX401", node.target, "only a local can be annotated here", "leave the annotation out")
        return
    if isinstance(type_, t.Void):
        c.error("OX201", node.annotation, "a local cannot be None", "")
        type_ = None
    if type_ is not None:
        c.declared[node.target.id] = type_
    if node.value is None:
        return
    info = c.check(node.value)
    check_no_value_lost(c, node.value, info)
    if type_ is None or isinstance(info.type, Invalid):
        bind_invalid(c, node.target)
        return
    if not c.coerce(node.value, type_, f"`{node.target.id}`"):
        bind_local(c, node.target, type_)
        return
    check_no_alias(c, node.value, f"`{node.target.id}`")
    bind_local(c, node.target, type_)


def check_no_value_lost(c: Context, node: ast.expr, info: ExprInfo) -> None:
    """Report a call without a result where a value is needed."""
    if isinstance(info.type, t.Void):
        c.error("OX321", node, "this call gives no value", "call it in a statement of its own")
        info.type = Invalid()


def bind_invalid(c: Context, target: ast.expr) -> None:
    """After an error: the names exist, so that their uses are no errors of their own."""
    if isinstance(target, ast.Name):
        c.environment.bind(target.id, Bound(Local(target.id, t.VOID), c.span(target)))
        c.poisoned.add(target.id)
    elif isinstance(target, ast.Tuple | ast.List):
        for element in target.elts:
            bind_invalid(c, element)


def assign_target(c: Context, target: ast.expr, value: ast.expr | None, type_: CheckType) -> None:
    """Assign a checked value to a target; `value` is None where it is an item of something already taken apart."""
    if isinstance(type_, Invalid):
        bind_invalid(c, target)
        return
    match target:
        case ast.Name():
            _assign_name(c, target, value, type_)
        case ast.Tuple() | ast.List():
            _assign_items(c, target, value, type_)
        case ast.Attribute() | ast.Subscript():
            stored = check_place(c, target)
            if stored is not None:
                _store(c, target, value, type_, stored)
        case ast.Starred():
            c.error("OX404", target, "unpacking with `*` is not part of restricted Python", "name the items one by one")
        case _:
            c.error("OX401", target, "this cannot be assigned", "")


def _store(c: Context, target: ast.expr, value: ast.expr | None, type_: CheckType, stored: t.Type) -> None:
    if value is None:
        if not can_convert(type_, stored):
            c.error("OX302", target, f"`{ast.unparse(target)}` is {stored}, this is {describe(type_)}", remedy(type_, stored))
        return
    if c.coerce(value, stored, target) and not isinstance(c.info(target).use, ElementUse):
        check_no_alias(c, value, target)


def _assign_name(c: Context, target: ast.Name, value: ast.expr | None, type_: CheckType) -> None:
    name = target.id
    wanted = _wanted_type(c, name, type_)
    if value is not None:
        if not check_no_alias(c, value, f"`{name}`"):
            bind_invalid(c, target)
            return
        if wanted is None:
            wanted = c.settle(value)
        elif not c.coerce(value, wanted, f"`{name}`"):
            bind_invalid(c, target)
            return
    elif wanted is None:
        wanted = default_type(type_)
    elif not can_convert(type_, wanted):
        c.error("OX302", target, f"`{name}` is {wanted}, this is {describe(type_)}", remedy(type_, wanted))
        return
    existing = c.environment.get(name)
    if isinstance(existing, Bound) and is_reference_type(existing.local.type) and parameter_role(c, existing.local) is not None:
        note = "assign its fields, or use another name"
        c.error("OX307", target, f"the parameter `{name}` names the caller's {existing.local.type} and cannot be bound anew", note)
        return
    bind_local(c, target, wanted)


def _wanted_type(c: Context, name: str, type_: CheckType) -> t.Type | None:
    """The type that a name has already and the value takes on: a local keeps its type where the value fits it."""
    declared = c.declared.get(name)
    if declared is not None:
        return declared
    existing = c.environment.get(name)
    if isinstance(existing, Bound) and name not in c.poisoned and can_convert(type_, existing.local.type):
        return existing.local.type
    if isinstance(type_, WeakInt | WeakFloat):
        # A literal in one branch takes the type that the other branch gave the name.
        types = c.instance.types_of(name)
        if len(types) == 1 and can_convert(type_, types[0]):
            return types[0]
    return None


def bind_local(c: Context, target: ast.Name, type_: t.Type) -> Local:
    """The local for a name and type; one name has one local per type in a function."""
    name = target.id
    existing = c.environment.get(name)
    if isinstance(existing, Bound) and existing.local.type == type_ and name not in c.poisoned:
        local = existing.local
    else:
        local = c.instance.local_of(name, type_)
    c.poisoned.discard(name)
    c.instance.bindings[target] = local
    c.environment.bind(name, Bound(local, c.span(target)))
    return local


def _assign_items(c: Context, target: ast.Tuple | ast.List, value: ast.expr | None, type_: CheckType) -> None:
    items: list[CheckType]
    match type_:
        case t.Tuple():
            items = list(type_.items)
        case t.Vector():
            items = [type_.element] * type_.size
        case _:
            c.error("OX302", target, f"{describe(type_)} cannot be taken apart", "tuples and vectors can")
            bind_invalid(c, target)
            return
    if any(isinstance(element, ast.Starred) for element in target.elts):
        c.error("OX404", target, "unpacking with `*` is not part of restricted Python", "name the items one by one")
        bind_invalid(c, target)
        return
    if len(items) != len(target.elts):
        c.error("OX302", target, f"{len(target.elts)} names for {len(items)} values", "one name for each value")
        bind_invalid(c, target)
        return
    if isinstance(value, ast.Tuple):
        for element, item in zip(target.elts, value.elts, strict=True):
            check_no_value_lost(c, item, c.info(item))
            assign_target(c, element, item, c.info(item).type)
        info = c.info(value)
        info.converted = t.Tuple(tuple(c.info(item).converted or default_type(c.info(item).type) for item in value.elts))
        return
    if value is not None:
        if isinstance(type_, t.Tuple):
            c.settle(value)
            items = [default_type(item) for item in items]
        if not check_no_alias(c, value, "an item"):
            bind_invalid(c, target)
            return
    for element, item_type in zip(target.elts, items, strict=True):
        assign_target(c, element, None, item_type)


def check_place(c: Context, target: ast.Attribute | ast.Subscript) -> t.Type | None:
    """Check a field, component or element that is assigned; its stored type, or None after a diagnostic."""
    symbol = static_symbol(c, target.value)
    if symbol is not None and not isinstance(symbol, ParamsSymbol) and static_symbol(c, target) is not None:
        c.error("OX307", target, f"`{ast.unparse(target)}` cannot be assigned in a shader", "write to an array or a payload")
        return None
    c.stored = _innermost(target)
    info = c.check(target)
    c.stored = None
    if isinstance(info.type, Invalid):
        return None
    stored: t.Type
    match info.use:
        case FieldUse(stored=stored) | ElementUse(stored=stored) | IndexUse(stored=stored):
            pass
        case SwizzleUse(components=(_,)):
            stored = t.VOID if is_weak(info.type) else default_type(info.type)
        case SwizzleUse():
            c.error("OX307", target, "several components cannot be assigned at once", "assign them one by one")
            return None
        case _:
            c.error("OX307", target, f"`{ast.unparse(target)}` cannot be assigned", "fields, components and elements can")
            return None
    place = place_of(c, target)
    reason = why_read_only(c, place)
    if reason is not None:
        c.error("OX307", target, f"`{ast.unparse(target)}` cannot be assigned: {reason}", "write to an array, a payload or a local")
        return None
    note_write(c, place, target)
    return stored


def _innermost(target: ast.Attribute | ast.Subscript) -> ast.expr:
    """The part of a place that stands on a name."""
    while isinstance(target.value, ast.Attribute | ast.Subscript):
        target = target.value
    return target


def check_augmented(c: Context, node: ast.AugAssign) -> None:
    """`a += b`: `a = a + b` with the place of `a` evaluated once."""
    left = copy.copy(node.target)
    if not isinstance(left, ast.Name | ast.Attribute | ast.Subscript):
        c.error("OX401", node.target, "this cannot be assigned", "")
        return
    left.ctx = ast.Load()
    operation = ast.copy_location(ast.BinOp(left=left, op=node.op, right=node.value), node)
    info = c.check(operation)
    c.instance.augmented[node] = operation
    if isinstance(info.type, Invalid):
        if isinstance(node.target, ast.Name):
            bind_invalid(c, node.target)
        return
    if isinstance(node.target, ast.Name):
        _assign_name(c, node.target, operation, info.type)
        return
    stored = check_place(c, node.target)
    if stored is not None:
        c.coerce(operation, stored, node.target)
