"""Statements: what they bind, where control goes, and on which ways a name has a value.

Every function returns whether control can reach the statement after it; statements that it cannot reach are noted as dead.
"""

from __future__ import annotations

import ast

from optixc.frontend.check_assign import check_annotated, check_assign, check_augmented
from optixc.frontend.check_loops import check_for, check_while
from optixc.frontend.check_match import check_match
from optixc.frontend.check_operators import check_condition
from optixc.frontend.check_print import check_print, message_of
from optixc.frontend.checked import BreakpointUse, ExprInfo, IntrinsicUse, ReportUse, returned_value
from optixc.frontend.context import Context
from optixc.frontend.environment import Way, join
from optixc.frontend.refusals import refuse_statement
from optixc.frontend.resolve_static import static_symbol
from optixc.frontend.symbols import BuiltinName
from optixc.ir import types as t
from optixc.ir.intrinsics import Effect
from optixc.ir.programs import ProgramKind

_ENDS = (Effect.ENDS_PROGRAM, Effect.ENDS_LAUNCH_INDEX)


def check_block(c: Context, body: list[ast.stmt]) -> bool:
    """Check statements in order; True if control can reach their end."""
    for position, statement in enumerate(body):
        if not check_statement(c, statement):
            c.instance.dead.update(body[position + 1 :])
            return False
    return True


def check_statement(c: Context, node: ast.stmt) -> bool:
    """Check one statement."""
    match node:
        case ast.Expr():
            return _check_expression_statement(c, node)
        case ast.Assign():
            check_assign(c, node)
        case ast.AnnAssign():
            check_annotated(c, node)
        case ast.AugAssign():
            check_augmented(c, node)
        case ast.If():
            return _check_if(c, node)
        case ast.While():
            return check_while(c, node, check_block)
        case ast.For():
            return check_for(c, node, check_block)
        case ast.Match():
            return check_match(c, node, check_block)
        case ast.Return():
            return _check_return(c, node)
        case ast.Break() | ast.Continue():
            return _check_jump(c, node)
        case ast.Assert():
            _check_assert(c, node)
        case ast.Pass():
            pass
        case _:
            refuse_statement(c, node)
    return True


def _check_expression_statement(c: Context, node: ast.Expr) -> bool:
    if isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
        return True
    func = node.value.func if isinstance(node.value, ast.Call) else None
    symbol = static_symbol(c, func) if isinstance(func, ast.Name | ast.Attribute) else None
    if symbol == BuiltinName("print"):
        assert isinstance(node.value, ast.Call)
        check_print(c, node.value)
        return True
    if symbol == BuiltinName("breakpoint"):
        assert isinstance(node.value, ast.Call)
        _check_breakpoint(c, node.value)
        return True
    info = c.check(node.value)
    match info.use:
        case IntrinsicUse(row=row) | ReportUse(row=row):
            return row.effect not in _ENDS
    if not info.writes and info.type is not None:
        c.settle(node.value)
    return True


def _check_breakpoint(c: Context, node: ast.Call) -> None:
    if node.args or node.keywords:
        c.error("OX305", node, "breakpoint() takes no arguments in shaders", "write breakpoint()")
    c.instance.info[node] = ExprInfo(t.VOID, use=BreakpointUse())


def _check_if(c: Context, node: ast.If) -> bool:
    check_condition(c, node.test)
    base = c.environment
    ways = []
    for body, description in ((node.body, f"if the condition in line {node.lineno} holds"), (node.orelse, _otherwise(node))):
        c.environment = base.fork()
        if check_block(c, body):
            ways.append(Way(c.environment.changes_since(base), description))
    c.environment = base
    join(base, ways)
    return bool(ways)


def _otherwise(node: ast.If) -> str:
    return f"if the condition in line {node.lineno} does not hold"


def _check_return(c: Context, node: ast.Return) -> bool:
    c.returns.append(node)
    kind = c.instance.kind
    value = returned_value(node)
    if value is not None and kind is not None and kind not in (ProgramKind.DIRECT_CALLABLE, ProgramKind.CONTINUATION_CALLABLE):
        c.check(value)
        c.error("OX316", node, f"a {kind.value} program returns no value", "write to the payload, or to an array")
    elif value is not None:
        c.check(value)
    return False


def _check_jump(c: Context, node: ast.Break | ast.Continue) -> bool:
    if not c.loops:
        word = "break" if isinstance(node, ast.Break) else "continue"
        c.error("OX401", node, f"`{word}` outside of a loop", "write return to leave the program")
        return False
    loop = c.loops[-1]
    if isinstance(node, ast.Break):
        loop.breaks.append(Way(c.environment.changes_since(loop.base), f"at the break in line {node.lineno}"))
    else:
        loop.continues.append(Way(c.environment.changes_since(loop.base), f"at the continue in line {node.lineno}"))
    return False


def _check_assert(c: Context, node: ast.Assert) -> None:
    check_condition(c, node.test)
    c.instance.writes = True
    if node.msg is not None:
        message_of(c, node.msg)
