"""`match` on integers, enums and bools: patterns are constants, alternatives of them, and `_`."""

from __future__ import annotations

import ast
from collections.abc import Callable

from optixc.frontend.check_assign import bind_invalid
from optixc.frontend.check_operators import check_condition
from optixc.frontend.context import Context, describe
from optixc.frontend.environment import Way, join
from optixc.frontend.weak import Invalid, is_integer
from optixc.ir import types as t

Block = Callable[[Context, list[ast.stmt]], bool]


def check_match(c: Context, node: ast.Match, check_block: Block) -> bool:
    """Check subject, patterns and bodies; the first pattern that fits wins."""
    subject = c.check(node.subject)
    usable = not isinstance(subject.type, Invalid)
    if usable and not is_integer(subject.type) and subject.type != t.BOOL:
        c.error("OX407", node.subject, f"match takes an integer, an enum or a bool, this is {describe(subject.type)}", "write if and elif")
        usable = False
    type_ = c.settle(node.subject) if usable else None
    base = c.environment
    ways = []
    exhaustive = False
    for case in node.cases:
        catches_all = _check_pattern(c, case.pattern, type_)
        if case.guard is not None:
            check_condition(c, case.guard)
        c.environment = base.fork()
        if check_block(c, case.body):
            ways.append(Way(c.environment.changes_since(base), f"in the case of line {case.pattern.lineno}"))
        exhaustive = exhaustive or (catches_all and case.guard is None)
    c.environment = base
    if not exhaustive:
        ways.append(Way({}, f"if no case of the match in line {node.lineno} fits"))
    join(base, ways)
    return bool(ways)


def _check_pattern(c: Context, pattern: ast.pattern, type_: t.Type | None) -> bool:
    """Check a pattern against the subject's type; True if it catches everything."""
    match pattern:
        case ast.MatchValue(value=value):
            info = c.check(value)
            if isinstance(info.type, Invalid):
                return False
            if info.constant is None:
                c.error("OX407", value, "a pattern must be a constant", "write `case x if x == ...` as if and elif")
            elif type_ is not None:
                c.coerce(value, type_, "this pattern")
            return False
        case ast.MatchSingleton(value=bool()):
            if type_ is not None and type_ != t.BOOL:
                c.error("OX407", pattern, f"this pattern is a bool, the subject {type_}", "")
            return False
        case ast.MatchOr(patterns=patterns):
            found = [_check_pattern(c, inner, type_) for inner in patterns]
            return any(found)
        case ast.MatchAs(pattern=None, name=None):
            return True
        case ast.MatchAs(name=name):
            if name is not None:
                bind_invalid(c, ast.copy_location(ast.Name(name, ast.Store()), pattern))
            c.error("OX407", pattern, "a pattern that binds a name is not part of restricted Python", "write `case _:` and use the subject")
            return True
    c.error("OX407", pattern, "this pattern is not part of restricted Python", "constants, `|` and `_` are")
    return False
