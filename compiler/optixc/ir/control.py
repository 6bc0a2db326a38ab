"""Facts of control flow that both emitters need: which loops look whether the launch is to stop, and where that leaves a function.

Ctrl-C has to end a launch within a second, so a loop that may run for long polls the cancel word. A loop with few turns, known from its
bounds, need not: a poll costs little, though it keeps the C++ compiler from unrolling.
"""

from __future__ import annotations

from optixc.ir.nodes import Binary, CallCallable, CallHelper, Expr, ForRange, HelperCall, If, Literal, LocalRef, Logical, Stmt, While
from optixc.ir.walk import blocks, operands, subexpressions

MOST_TURNS_WITHOUT_POLL = 1 << 16
_TURNS_OF_A_CALL = 64


def polls(loop: While | ForRange) -> bool:
    """Whether the loop may turn so often, loops inside of it counted, that nobody would wait for its end."""
    return _turns_without_poll(loop) > MOST_TURNS_WITHOUT_POLL


def ends_in_loop(body: tuple[Stmt, ...]) -> bool:
    """Whether the end of a function that returns a value can be reached, because its last loop was told to stop."""
    match body[-1:]:
        case (While(),):
            return True
        case (If(then_body=then_body, else_body=else_body),):
            return ends_in_loop(then_body) or ends_in_loop(else_body)
        case _:
            return False


def _turns_without_poll(loop: While | ForRange) -> int:
    """An upper bound of the turns, inner loops counted; for a `while` that surely ends, its counter is taken to begin near zero."""
    if isinstance(loop, While):
        turns = _turns_of_while(loop.condition) if loop.bounded else None
    else:
        start, stop, step = (_constant(bound) for bound in (loop.start, loop.stop, loop.step))
        turns = len(range(start, stop, step)) if start is not None and stop is not None and step else None
    return MOST_TURNS_WITHOUT_POLL + 1 if turns is None else turns * _weight(loop.body)


def _turns_of_while(condition: Expr) -> int | None:
    match condition:
        case Logical(is_and=True, left=left, right=right):
            found = (_turns_of_while(left), _turns_of_while(right))
            return None if found[0] is None or found[1] is None else max(found[0], found[1])
        case Binary(left=left, right=right):
            bound = _constant(right) if isinstance(left, LocalRef) else _constant(left)
            return None if bound is None else abs(bound) + 1
        case _:
            return None


def _constant(bound: Expr) -> int | None:
    return bound.value if isinstance(bound, Literal) and isinstance(bound.value, int) else None


def _weight(body: tuple[Stmt, ...]) -> int:
    """How often the innermost statements of a block run; loops that poll by themselves and plain statements count once."""
    most = 1
    for statement in body:
        match statement:
            case ForRange() | While():
                most = max(most, 1 if polls(statement) else _turns_without_poll(statement))
            case If():
                most = max(most, *(_weight(block) for block in blocks(statement)))
            case _:
                most = max(most, _TURNS_OF_A_CALL if _calls(statement) else 1)
    return most


def _calls(statement: Stmt) -> bool:
    if isinstance(statement, CallHelper | CallCallable):
        return True
    return any(isinstance(part, HelperCall) for operand in operands(statement) for part in subexpressions(operand))
