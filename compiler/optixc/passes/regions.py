"""The region of each local: the innermost statement inside of which all its uses lie, and which gives it a value first.

What happens to a local outside of its region matters to nobody: lanes that do not run the region need not keep its value.
"""

from __future__ import annotations

from optixc.ir.nodes import ForRange, Function, Stmt, While
from optixc.ir.walk import Body
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
