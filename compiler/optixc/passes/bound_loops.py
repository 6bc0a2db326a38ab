"""Marks `while` loops that surely end: a counter goes towards a bound that stays, by the same step in every turn, and cannot wrap.

`while i < n:` with `i += 1` in its body is the pattern; further conditions joined by `and` only end the loop sooner. Loops without the
mark look in every turn whether the launch is to stop, which keeps packets and helpers from being simple.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from optixc.ir.nodes import (
    ArrayShape,
    Assign,
    Binary,
    BinaryOp,
    Continue,
    Convert,
    Expr,
    FieldRef,
    ForRange,
    Literal,
    Local,
    LocalRef,
    Logical,
    ParamsRef,
    Pipeline,
    Stmt,
    Unary,
    UnaryOp,
    While,
)
from optixc.ir.types import Scalar, ScalarKind
from optixc.ir.walk import Body, blocks, map_blocks, statements, subexpressions
from optixc.passes.uses import stored_local

_SWAPPED = {
    BinaryOp.LESS: BinaryOp.GREATER,
    BinaryOp.LESS_EQUAL: BinaryOp.GREATER_EQUAL,
    BinaryOp.GREATER: BinaryOp.LESS,
    BinaryOp.GREATER_EQUAL: BinaryOp.LESS_EQUAL,
}


def bound_loops(pipeline: Pipeline) -> Pipeline:
    """The pipeline with `bounded` set where it is proved."""
    helpers = tuple(replace(function, body=_of_body(function.body)) for function in pipeline.helpers)
    programs = tuple(replace(function, body=_of_body(function.body)) for function in pipeline.programs)
    return replace(pipeline, helpers=helpers, programs=programs)


def _of_body(body: Body) -> Body:
    return tuple(_of_statement(statement) for statement in body)


def _of_statement(statement: Stmt) -> Stmt:
    mapped = map_blocks(statement, _of_body)
    if isinstance(mapped, While) and _ends(mapped):
        return replace(mapped, bounded=True)
    return mapped


def _ends(loop: While) -> bool:
    """Whether one of the comparisons that keep the loop going fails after finitely many turns."""
    stores = [local.name for inner in statements((loop,)) if (local := stored_local(inner)) is not None]
    return any(_runs_out(loop, counter, op, bound, stores) for counter, op, bound in _comparisons(loop.condition))


def _comparisons(condition: Expr) -> Iterator[tuple[Local, BinaryOp, Expr]]:
    """The comparisons of a local that must hold for another turn, the local on the left."""
    match condition:
        case Logical(is_and=True, left=left, right=right):
            yield from _comparisons(left)
            yield from _comparisons(right)
        case Binary(op=op, left=left, right=right) if op in _SWAPPED:
            if isinstance(left, LocalRef):
                yield left.local, op, right
            if isinstance(right, LocalRef):
                yield right.local, _SWAPPED[op], left


def _runs_out(loop: While, counter: Local, op: BinaryOp, bound: Expr, stores: list[str]) -> bool:
    is_integer = isinstance(counter.type, Scalar) and counter.type.kind in (ScalarKind.INT, ScalarKind.UINT)
    if not is_integer or counter.by_reference or stores.count(counter.name) != 1 or not _stays(bound, stores):
        return False
    step = _step(loop.body, counter)
    up = op in (BinaryOp.LESS, BinaryOp.LESS_EQUAL)
    if step is None or step == 0 or up != (step > 0):
        return False
    return _cannot_wrap(counter, op, bound, step)


def _cannot_wrap(counter: Local, op: BinaryOp, bound: Expr, step: int) -> bool:
    """Whether the step from the last value that passes the comparison stays within the type."""
    assert isinstance(counter.type, Scalar)
    includes = op in (BinaryOp.LESS_EQUAL, BinaryOp.GREATER_EQUAL)
    value = _constant(bound)
    if value is None:
        return abs(step) == 1 and not includes
    last = value if includes else value - (1 if step > 0 else -1)
    bits, is_signed = counter.type.bits, counter.type.kind is ScalarKind.INT
    low, high = (-(1 << bits - 1), (1 << bits - 1) - 1) if is_signed else (0, (1 << bits) - 1)
    return low <= last + step <= high


def _stays(bound: Expr, stores: list[str]) -> bool:
    """Whether an expression has the same value in every turn: constants, launch parameters and locals that the loop leaves alone."""
    for part in subexpressions(bound):
        match part:
            case LocalRef(local=local):
                if local.by_reference or not isinstance(local.type, Scalar) or local.name in stores:
                    return False
            case Literal() | ParamsRef() | FieldRef() | ArrayShape() | Unary() | Binary() | Convert():
                pass
            case _:
                return False
    return True


def _step(body: Body, counter: Local) -> int | None:
    """What every turn adds to the counter: one statement of the body itself, which no `continue` goes around."""
    for statement in body:
        match statement:
            case Assign(target=LocalRef(local=local), value=value) if local.name == counter.name:
                return _added(value, counter)
        if _continues(statement):
            return None
    return None


def _added(value: Expr, counter: Local) -> int | None:
    match value:
        case Binary(op=BinaryOp.ADD, left=LocalRef(local=local), right=right) if local.name == counter.name:
            return _constant(right)
        case Binary(op=BinaryOp.ADD, left=left, right=LocalRef(local=local)) if local.name == counter.name:
            return _constant(left)
        case Binary(op=BinaryOp.SUBTRACT, left=LocalRef(local=local), right=right) if local.name == counter.name:
            constant = _constant(right)
            return None if constant is None else -constant
        case _:
            return None


def _constant(expression: Expr) -> int | None:
    match expression:
        case Literal(value=int() as value):
            return value
        case Unary(op=UnaryOp.NEGATE, operand=Literal(value=int() as value)):
            return -value
        case _:
            return None


def _continues(statement: Stmt) -> bool:
    """Whether the statement may go on with the next turn of the loop around it."""
    if isinstance(statement, Continue):
        return True
    if isinstance(statement, While | ForRange):
        return False
    return any(_continues(inner) for block in blocks(statement) for inner in block)
