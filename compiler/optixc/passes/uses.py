"""What statements do to locals: which they give a new value, which they read, where a local occurs."""

from __future__ import annotations

from optixc.ir.nodes import Assign, CallCallable, CallHelper, CallIntrinsic, Expr, ForRange, Local, LocalRef, Stmt, While
from optixc.ir.walk import Body, blocks, operands, place_root, subexpressions


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
    if mentions_itself(statement, name):
        return True
    return any(mentions(inner, name) for block in blocks(statement) for inner in block)


def mentions_itself(statement: Stmt, name: str) -> bool:
    """Whether the local occurs in the statement, its blocks apart."""
    if assigns_whole(statement, name):
        return True
    return any(mentions_in(operand, name) for operand in operands(statement))


def mentions_in(expression: Expr, name: str) -> bool:
    """Whether the local occurs in an expression."""
    return any(isinstance(part, LocalRef) and part.local.name == name for part in subexpressions(expression))


def turn_blocks(statement: Stmt) -> tuple[Body, ...]:
    """What runs in one turn of a loop is one block: what is hoisted from the condition, then the body."""
    if isinstance(statement, While):
        return ((*statement.condition_body, *statement.body),)
    return blocks(statement)
