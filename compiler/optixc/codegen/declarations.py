"""Where a function's locals are declared in C++.

A local is declared by its first assignment if that assignment stands in the block that holds all its uses and before all of them;
the variable of a counting loop in the loop's head; everything else at the top of the function.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from optixc.ir.nodes import Assign, CallCallable, CallHelper, ForRange, Function, Local, LocalRef, Stmt, Trace, While
from optixc.ir.walk import Body, place_root, statements
from optixc.passes.uses import assigned_local, mentions, mentions_in, mentions_itself, reads, turn_blocks


@dataclass
class Declarations:
    """`at_top`: in order of first assignment. `at_statement`: by the id of the statement that declares. `unread`: never read."""

    at_top: list[Local] = field(default_factory=list)
    at_statement: dict[int, Local] = field(default_factory=dict)
    unread: set[str] = field(default_factory=set)


def declarations(function: Function, splits_loops: bool = False) -> Declarations:
    """Decides for every local of a function. With `splits_loops`, several loops that count with one local declare it each."""
    result = Declarations()
    read = _read_names(function.body)
    for local in function.locals:
        if not _is_mentioned(function.body, local.name):
            continue
        if local.name not in read:
            result.unread.add(local.name)
        declaring = _declaring_statements(function.body, local.name, splits_loops)
        if not declaring:
            result.at_top.append(local)
        for statement in declaring:
            result.at_statement[id(statement)] = local
    return result


def is_changed(body: Body, name: str) -> bool:
    """Whether anything in a block gives the local a new value, in whole or in part."""
    return any(_changes(statement, name) for statement in statements(body))


def _changes(statement: Stmt, name: str) -> bool:
    target = assigned_local(statement)
    if target is not None and target.name == name:
        return True
    if isinstance(statement, Assign):
        root = place_root(statement.target)
        return root is not None and root.name == name
    if isinstance(statement, CallHelper | CallCallable):
        return any(isinstance(a, LocalRef) and a.local.name == name for a in statement.arguments)
    if isinstance(statement, Trace) and statement.payload is not None:
        root = place_root(statement.payload)
        return root is not None and root.name == name
    return False


def _read_names(body: Body) -> set[str]:
    return {name for statement in statements(body) for name in reads(statement)}


def _is_mentioned(body: Body, name: str) -> bool:
    return any(mentions(statement, name) for statement in body)


def _declaring_statements(body: Body, name: str, splits_loops: bool) -> list[Stmt]:
    """The statements that can declare the local: the first mention in the innermost block that holds all of them, or every loop that
    counts with it if nothing else mentions it there."""
    mentioning = [statement for statement in body if mentions(statement, name)]
    if (splits_loops or len(mentioning) == 1) and all(_counts_alone(statement, name) for statement in mentioning):
        return mentioning
    first = mentioning[0]
    target = assigned_local(first)
    if target is not None and target.name == name and not isinstance(first, ForRange):
        return [] if name in reads(first) else [first]
    if len(mentioning) > 1:
        return []
    holders = [block for block in turn_blocks(first) if _is_mentioned(block, name)]
    if len(holders) != 1 or (mentions_itself(first, name) and not _is_inside_loop(first, name)):
        return []
    return _declaring_statements(holders[0], name, splits_loops)


def _counts_alone(statement: Stmt, name: str) -> bool:
    """Whether the statement is a loop that counts with this local, which nothing else of it changes."""
    if not isinstance(statement, ForRange) or statement.target.name != name or is_changed(statement.body, name):
        return False
    return not any(mentions_in(bound, name) for bound in (statement.start, statement.stop, statement.step))


def _is_inside_loop(statement: Stmt, name: str) -> bool:
    """Whether a loop's condition mentions a local only behind what is hoisted from it, which stands in the loop's own block."""
    return isinstance(statement, While) and _is_mentioned(statement.condition_body, name)
