"""The result of a function: from its annotation, or from all its return statements together."""

from __future__ import annotations

import ast

from optixc.frontend.checked import LocalUse
from optixc.frontend.context import Context, describe
from optixc.frontend.conversions import common_type
from optixc.frontend.places import check_no_alias, parameter_role
from optixc.frontend.symbols import FunctionSymbol
from optixc.frontend.weak import CheckType, Invalid, default_type, widened
from optixc.ir import types as t


def check_returns(c: Context, symbol: FunctionSymbol, declared: t.Type | None, falls_through: bool) -> None:
    """Set the instance's result and convert every returned value to it."""
    values = [node.value for node in c.returns if node.value is not None]
    if c.instance.kind is not None and declared not in (None, t.VOID) and "callable" not in c.instance.kind.value:
        assert symbol.node.returns is not None
        c.error("OX316", symbol.node.returns, f"a {c.instance.kind.value} program returns no value", "write `-> None`")
        return
    if declared is not None and widened(declared) != declared:
        assert symbol.node.returns is not None
        c.error("OX201", symbol.node.returns, f"a result cannot be {declared}", f"write {widened(declared)}")
        return
    result = declared if declared is not None else _joined(c, values)
    if result is None:
        return
    c.instance.result = result
    if isinstance(result, t.Void):
        for value in values:
            if not isinstance(c.info(value).type, Invalid | t.Void):
                c.error("OX316", value, f"`{symbol.name}` returns None, this is {describe(c.info(value).type)}", "change `-> None`")
        return
    for node in c.returns:
        if node.value is None:
            c.error("OX316", node, f"`{symbol.name}` returns {result}, here is no value", "return a value on every way")
        elif c.coerce(node.value, result, "the result") and not _is_own_local(c, node.value):
            check_no_alias(c, node.value, "the result")
    if falls_through:
        message = f"`{symbol.name}` returns {result}, but can reach its end without a return"
        c.error("OX316", symbol.span, message, "return a value on every way")


def _is_own_local(c: Context, node: ast.expr) -> bool:
    """Whether this is a local that is no parameter: its name ends with the function, so the result is no second one."""
    use = c.info(node).use
    return isinstance(node, ast.Name) and isinstance(use, LocalUse) and parameter_role(c, use.local) is None


def _joined(c: Context, values: list[ast.expr]) -> t.Type | None:
    """The type in which all returned values meet; None after a diagnostic."""
    if not values:
        return t.VOID
    joined: CheckType = c.info(values[0]).type
    for value in values[1:]:
        type_ = c.info(value).type
        met = common_type(joined, type_)
        if met is None or (isinstance(met, t.Vector) and not (isinstance(joined, t.Vector) and isinstance(type_, t.Vector))):
            c.error("OX316", value, f"this returns {describe(type_)}, an earlier return {describe(joined)}", "all returns give one type")
            return None
        joined = met
    if isinstance(joined, Invalid):
        return None
    return default_type(joined)
