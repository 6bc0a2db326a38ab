"""The region of each local: the innermost statement inside of which all its uses lie, and which gives it a value first.

What happens to a local outside of its region matters to nobody: lanes that do not run the region need not keep its value.
"""

from __future__ import annotations

from optixc.ir.nodes import (
    Assign,
    CallCallable,
    CallHelper,
    CallIntrinsic,
    ForRange,
    Function,
    Local,
    LocalRef,
    Stmt,
    While,
)
from optixc.ir.walk import Body, blocks, operands, place_root, subexpressions

Region = tuple[Stmt, ...]
"""The statements around, outermost first; () is the whole function."""


def homes(function: Function) -> dict[str, Region]:
    """The region of every local; parameters belong to the whole function."""
    result: dict[str, Region] = {parameter.local.name: () for parameter in function.parameters}
    for local in function.locals:
        result[local.name] = _home(function.body, local.name, (), ())
    return result


def _home(body: Body, name: str, path: Region, best: Region) -> Region:
    """The deepest region in which the local is whole. `best` is the one found so far."""
    mentioning = [statement for statement in body if mentions(statement, name)]
    if not mentioning:
        return best
    first = mentioning[0]
    if assigns_whole(first, name) and not isinstance(first, ForRange) and name not in reads(first):
        best = path
    if len(mentioning) > 1:
        return best
    if isinstance(first, ForRange) and first.target.name == name:
        is_read_before = any(_reads_expression(bound, name) for bound in (first.start, first.stop, first.step))
        return best if is_read_before else (*path, first)
    if _mentions_itself(first, name) and not isinstance(first, While):
        return best
    inner = _inner_blocks(first)
    if isinstance(first, While) and _mentions_itself(first, name) and not any(mentions(s, name) for s in first.condition_body):
        return best
    holders = [block for block in inner if any(mentions(statement, name) for statement in block)]
    if len(holders) != 1:
        return best
    return _home(holders[0], name, (*path, first), best)


def assigns_whole(statement: Stmt, name: str) -> bool:
    """Whether the statement gives the local a whole new value."""
    target = assigned_local(statement)
    return target is not None and target.name == name


def assigned_local(statement: Stmt) -> Local | None:
    """The local that a statement gives a whole new value, None if there is none."""
    match statement:
        case Assign(target=LocalRef(local=local)):
            return local
        case CallHelper(target=target) | CallIntrinsic(target=target) | CallCallable(target=target) | ForRange(target=target):
            return target
        case _:
            return None


def stored_local(statement: Stmt) -> Local | None:
    """The local that a statement changes, in whole or in part; places behind calls apart."""
    return place_root(statement.target) if isinstance(statement, Assign) else assigned_local(statement)


def reads(statement: Stmt) -> set[str]:
    """Names of locals that a statement reads itself, its blocks apart; the root of a place that is stored to is not read."""
    names: set[str] = set()
    for position, operand in enumerate(operands(statement)):
        is_target = isinstance(statement, Assign) and position == 0
        root = place_root(operand) if is_target else None
        for part in subexpressions(operand):
            if isinstance(part, LocalRef) and not (root is not None and part.local.name == root.name):
                names.add(part.local.name)
    return names


def mentions(statement: Stmt, name: str) -> bool:
    """Whether the local occurs in the statement or its blocks."""
    if _mentions_itself(statement, name):
        return True
    return any(mentions(inner, name) for block in blocks(statement) for inner in block)


def _mentions_itself(statement: Stmt, name: str) -> bool:
    if assigns_whole(statement, name):
        return True
    return any(_reads_expression(operand, name) for operand in operands(statement))


def _reads_expression(expression: object, name: str) -> bool:
    return any(isinstance(part, LocalRef) and part.local.name == name for part in subexpressions(expression))  # type: ignore[arg-type]


def _inner_blocks(statement: Stmt) -> tuple[Body, ...]:
    """What runs in one turn of a loop is one block: what is hoisted from the condition, then the body."""
    if isinstance(statement, While):
        return ((*statement.condition_body, *statement.body),)
    return blocks(statement)
