"""`while` and `for ... in range(...)`: a loop's body is checked once, then what it binds is compared with what it started from."""

from __future__ import annotations

import ast
from collections.abc import Callable

from optixc.frontend.arguments import refuse_stars
from optixc.frontend.check_assign import bind_invalid, bind_local
from optixc.frontend.check_operators import check_condition
from optixc.frontend.context import Context, Loop, describe
from optixc.frontend.conversions import common_type
from optixc.frontend.environment import Bound, Environment, Way, join
from optixc.frontend.resolve_static import local_names, static_symbol
from optixc.frontend.symbols import BuiltinName
from optixc.frontend.weak import CheckType, Invalid, WeakInt, is_integer
from optixc.ir import types as t

Block = Callable[[Context, list[ast.stmt]], bool]


def check_while(c: Context, node: ast.While, check_block: Block) -> bool:
    """`while condition:`; control leaves it where the condition fails, and at each break."""
    base = c.environment
    condition_layer = base.fork()
    c.environment = condition_layer
    condition = check_condition(c, node.test)
    c.environment = base
    endless = condition.constant is True
    loop, ends = _check_body(c, node, base, check_block)
    leaves = [*loop.breaks]
    if not endless:
        leaves += [Way({}, f"if the loop in line {node.lineno} does not run"), *ends]
    join(base, leaves)
    _refuse_else(c, node)
    return bool(leaves)


def _refuse_else(c: Context, node: ast.While | ast.For) -> None:
    if node.orelse:
        message = "`else` of a loop is not part of restricted Python"
        c.error("OX401", node.orelse[0], message, "set a flag before the break and test it after the loop")


def _check_body(
    c: Context,
    node: ast.While | ast.For,
    base: Environment,
    check_block: Block,
    target: ast.Name | None = None,
    type_: t.Type | None = None,
) -> tuple[Loop, list[Way]]:
    """Check the body in a layer of its own; the ways that reach the next turn."""
    c.environment = base.fork()
    if target is not None and type_ is not None:
        bind_local(c, target, type_)
    loop = Loop(base)
    c.loops.append(loop)
    falls_through = check_block(c, node.body)
    c.loops.pop()
    ends = [*loop.continues]
    if falls_through:
        ends.append(Way(c.environment.changes_since(base), f"at the end of the loop in line {node.lineno}"))
    c.environment = base
    for way in ends:
        _check_types_kept(c, node, base, way)
    return loop, ends


def _check_types_kept(c: Context, node: ast.While | ast.For, base: Environment, way: Way) -> None:
    for name, binding in way.changes.items():
        before = base.get(name)
        if isinstance(before, Bound) and isinstance(binding, Bound) and before.local != binding.local and name not in c.poisoned:
            message = f"`{name}` changes its type in the loop: it is {before.local.type} before and {binding.local.type} after a turn"
            if binding.local.type == t.VOID or before.local.type == t.VOID:
                continue
            c.error("OX320", binding.span, message, f"give it type {binding.local.type} in line {before.span.line}")


def check_for(c: Context, node: ast.For, check_block: Block) -> bool:
    """`for i in range(...)`."""
    base = c.environment
    bounds = _range_of(c, node)
    _refuse_else(c, node)
    if not isinstance(node.target, ast.Name):
        c.error("OX401", node.target, "the target of a loop must be a name", "write `for i in range(n)`")
        bind_invalid(c, node.target)
        bounds = None
    if bounds is None:
        bind_invalid(c, node.target)
        _check_body(c, node, base, check_block)
        return True
    type_, runs = bounds
    assert isinstance(node.target, ast.Name)
    loop, ends = _check_body(c, node, base, check_block, node.target, type_)
    leaves = [*ends, *loop.breaks]
    if not runs:
        leaves.append(Way({}, f"if the loop in line {node.lineno} does not run"))
    join(base, leaves)
    return bool(leaves)


def _range_of(c: Context, node: ast.For) -> tuple[t.Type, bool] | None:
    """The counter's type, and whether the loop runs at least once for certain; None after a diagnostic."""
    call = node.iter
    symbol = static_symbol(c, call.func) if isinstance(call, ast.Call) and isinstance(call.func, ast.Name) else None
    if isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id in local_names(c):
        c.error("OX319", call.func, f"`{call.func.id}` is a local here, not a function", "give the local another name")
        return None
    if not isinstance(call, ast.Call) or symbol != BuiltinName("range"):
        c.error("OX401", call, "a loop runs over range(...) only", "write `for i in range(len(a))` and index")
        return None
    if not refuse_stars(c, call):
        return None
    if call.keywords or not 1 <= len(call.args) <= 3:
        c.error("OX305", call, "range() takes one to three arguments without names", "range(start, stop, step)")
        return None
    infos = [c.check(argument) for argument in call.args]
    common: CheckType = WeakInt()
    for argument, info in zip(call.args, infos, strict=True):
        if isinstance(info.type, Invalid):
            return None
        if not is_integer(info.type):
            c.error("OX302", argument, f"range() takes integers, this is {describe(info.type)}", "write int(...)")
            return None
        met = common_type(common, info.type)
        if met is None:
            c.error("OX302", call, f"range() does not take {describe(common)} and {describe(info.type)} together", "convert one of them")
            return None
        common = met
    type_ = t.INT32 if isinstance(common, WeakInt) else common
    if type_ not in (t.INT32, t.UINT32):
        c.error("OX302", call, f"a loop counts in int32 or uint32, this is {describe(common)}", "write int(...)")
        return None
    assert isinstance(type_, t.Scalar)
    if len(call.args) == 3 and infos[2].constant == 0:
        c.error("OX314", call.args[2], "the step of range() is zero", "")
        return None
    fits = [c.coerce(argument, type_, "a bound of range()") for argument in call.args]
    if not all(fits):
        return None
    constants = [info.constant for info in infos if isinstance(info.constant, int)]
    return type_, len(constants) == len(infos) and len(range(*constants)) > 0
