"""The result of a function: from its annotation, or from all its return statements together."""

from __future__ import annotations

import ast

from optixc.frontend.checked import LocalUse, returned_value
from optixc.frontend.context import Context, describe
from optixc.frontend.conversions import common_type
from optixc.frontend.places import check_no_alias, parameter_role
from optixc.frontend.symbols import FunctionSymbol
from optixc.frontend.weak import CheckType, Invalid, default_type
from optixc.ir import types as t
from optixc.ir.nodes import Local


def check_returns(c: Context, symbol: FunctionSymbol, declared: t.Type | None, falls_through: bool) -> None:
    """Set the instance's result and convert every returned value to it."""
    returned = [returned_value(node) for node in c.returns]
    values = [value for value in returned if value is not None]
    if c.instance.kind is not None and declared not in (None, t.VOID) and "callable" not in c.instance.kind.value:
        assert symbol.node.returns is not None
        c.error("OX316", symbol.node.returns, f"a {c.instance.kind.value} program returns no value", "write `-> None`")
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
    for node, given in zip(c.returns, returned, strict=True):
        if given is None:
            c.error("OX316", node, f"`{symbol.name}` returns {result}, here is no value", "return a value on every way")
        elif c.coerce(given, result, "the result"):
            _check_result_alias(c, given, set())
    if falls_through:
        message = f"`{symbol.name}` returns {result}, but can reach its end without a return"
        c.error("OX316", symbol.span, message, "return a value on every way")


def _check_result_alias(c: Context, node: ast.expr, returned: set[Local]) -> None:
    """A local that is no parameter may be returned, once: its name ends with the function, so the result is no second one."""
    if isinstance(node, ast.Tuple):
        for element in node.elts:
            _check_result_alias(c, element, returned)
        return
    if isinstance(node, ast.IfExp):
        _check_result_alias(c, node.body, set(returned))
        _check_result_alias(c, node.orelse, returned)
        return
    use = c.info(node).use
    if isinstance(use, LocalUse) and parameter_role(c, use.local) is None and use.local not in returned:
        returned.add(use.local)
        return
    check_no_alias(c, node, "the result")


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
