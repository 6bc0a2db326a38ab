"""The region of each local: the innermost statement inside of which all its uses lie, and which gives it a value first; what is read later.

What happens to a local outside of its region matters to nobody: lanes that do not run the region need not keep its value.
"""

from __future__ import annotations

from optixc.ir.nodes import Break, Continue, ForRange, Function, Stmt, While
from optixc.ir.walk import Body, blocks, statements
from optixc.passes.uses import assigns_whole, mentions, mentions_in, mentions_itself, reads, turn_blocks

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
        is_read_before = any(mentions_in(bound, name) for bound in (first.start, first.stop, first.step))
        return best if is_read_before else (*path, first)
    if mentions_itself(first, name) and not isinstance(first, While):
        return best
    inner = turn_blocks(first)
    if isinstance(first, While) and mentions_itself(first, name) and not any(mentions(s, name) for s in first.condition_body):
        return best
    holders = [block for block in inner if any(mentions(statement, name) for statement in block)]
    if len(holders) != 1:
        return best
    return _home(holders[0], name, (*path, first), best)


def is_read_behind(body: Body, path: Region, loop: ForRange, name: str) -> bool:
    """Whether a local that the loop sets may be read behind it, before it has another value. Says yes where it does not know."""
    child: Stmt = loop
    for owner in (*reversed(path), None):
        around = (body,) if owner is None else turn_blocks(owner)
        block = next(one for one in around if any(statement is child for statement in one))
        position = next(i for i, statement in enumerate(block) if statement is child)
        is_loop = isinstance(owner, While | ForRange)
        if owner is not None and is_loop and mentions_itself(owner, name):
            return True
        following = (*block[position + 1 :], *block[:position]) if is_loop else block[position + 1 :]
        may_leave = is_loop
        for statement in following:
            if assigns_whole(statement, name) and name not in reads(statement):
                if not may_leave:
                    return False
                break
            if _reads_from_outside(statement, name):
                return True
            may_leave = may_leave or any(isinstance(inner, Break | Continue) for inner in statements((statement,)))
        if owner is not None:
            child = owner
    return False


def _reads_from_outside(statement: Stmt, name: str) -> bool:
    """Whether the local occurs in the statement other than in loops that count with it."""
    if isinstance(statement, ForRange) and statement.target.name == name:
        return any(mentions_in(bound, name) for bound in (statement.start, statement.stop, statement.step))
    if mentions_itself(statement, name):
        return True
    return any(_reads_from_outside(inner, name) for block in blocks(statement) for inner in block)
