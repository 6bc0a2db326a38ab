"""Where a value lives: which expressions name a struct or fixed array that others may see, which are read-only, which are new."""

from __future__ import annotations

import ast
from dataclasses import dataclass
from enum import Enum

from optixc.frontend.checked import ConstantUse, ElementUse, FieldUse, IndexUse, LocalUse, ParamsUse, PayloadAccess, SwizzleUse
from optixc.frontend.context import Context, place_text
from optixc.ir import types as t
from optixc.ir.nodes import Local, ParameterRole, is_reference_type
from optixc.ir.programs import CALLABLES


class Root(Enum):
    """What a chain of fields and indices starts at."""

    LOCAL = "a local"
    PARAMS = "the launch parameters"
    ELEMENT = "an array's element"
    CONSTANT = "a constant of the module"
    VALUE = "a value"


@dataclass(frozen=True)
class Place:
    """The root of a chain and its first field, "" where the root itself is meant."""

    root: Root
    local: Local | None = None
    field: str = ""


def place_of(c: Context, node: ast.expr) -> Place:
    """The place that a checked expression names."""
    field = ""
    while True:
        use = c.info(node).use
        match node, use:
            case ast.Attribute(value=base), FieldUse(name=name):
                field, node = name, base
            case (ast.Attribute(value=base), SwizzleUse()) | (ast.Subscript(value=base), IndexUse()):
                node = base
            case ast.Subscript(), ElementUse():
                return Place(Root.ELEMENT)
            case _, LocalUse(local=local):
                return Place(Root.LOCAL, local, field)
            case _, ParamsUse():
                return Place(Root.PARAMS, None, field)
            case _, ConstantUse():
                return Place(Root.CONSTANT)
            case _:
                return Place(Root.VALUE)


def parameter_role(c: Context, local: Local) -> ParameterRole | None:
    """The role of a parameter, None for a local that is none."""
    for parameter in c.instance.parameters:
        if parameter.local is local:
            return parameter.role
    return None


def is_payload_parameter(c: Context, local: Local) -> bool:
    """Whether a local is a parameter that names a ray's payload."""
    is_payload = isinstance(local.type, t.Struct) and local.type.kind is t.StructKind.PAYLOAD
    return is_payload and parameter_role(c, local) is not None


def why_read_only(c: Context, place: Place) -> str | None:
    """Why a place cannot be written, or None if it can."""
    if place.root is Root.PARAMS:
        return "launch parameters are read-only"
    if place.root is Root.CONSTANT:
        return "a constant of the module is read-only"
    if place.root is Root.VALUE:
        return "this is a value, not a place"
    if place.local is not None:
        role = parameter_role(c, place.local)
        if role is ParameterRole.RECORD:
            return "the data of an SBT record is read-only" if c.instance.kind not in CALLABLES else "a callable's structs are read-only"
        if role is ParameterRole.ATTRIBUTES:
            return "attributes are read-only"
        if role is ParameterRole.VALUE and c.instance.kind is not None and is_reference_type(place.local.type):
            return "the arguments of a callable are read-only"
    return None


def note_write(c: Context, place: Place, node: ast.AST) -> None:
    """Remember what writing a place means for the callers of this function."""
    if place.root is Root.ELEMENT:
        c.instance.writes = True
    if place.local is None:
        return
    for parameter in c.instance.parameters:
        if parameter.local is place.local and parameter.local.by_reference:
            parameter.written = True
    if is_payload_parameter(c, place.local) and place.field:
        c.note_payload_access(place.local, PayloadAccess(place.field, True, c.span(node)))


def check_no_alias(c: Context, node: ast.expr, what: str | ast.expr) -> bool:
    """Refuse a second name for a struct or fixed array that already has one."""
    info = c.info(node)
    if isinstance(node, ast.Tuple):
        fine = [check_no_alias(c, element, what) for element in node.elts]
        return all(fine)
    if isinstance(node, ast.IfExp):
        return check_no_alias(c, node.body, what) and check_no_alias(c, node.orelse, what)
    if info.fresh or not _holds_reference(info.type):
        return True
    text = ast.unparse(node)
    text = text if len(text) <= 40 else "..."
    c.error("OX308", node, f"{place_text(what)} would be a second name of the {info.type} `{text}`", f"write ox.copy({text})")
    return False


def _holds_reference(type_: object) -> bool:
    if isinstance(type_, t.Tuple):
        return any(_holds_reference(item) for item in type_.items)
    return isinstance(type_, t.Struct | t.FixedArray) and is_reference_type(type_)
