"""Which programs a trace can run.

A program belongs to a trace if its own payload class is the trace's, has the same words, or if it has none and reads no register beyond
the payload's last.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from optixc.ir.layout import payload_scalars, payload_words
from optixc.ir.nodes import (
    Binary,
    BinaryOp,
    Expr,
    Function,
    Literal,
    ParameterRole,
    Pipeline,
    Trace,
)
from optixc.ir.programs import ProgramKind
from optixc.ir.types import Struct
from optixc.ir.walk import Body, called_helpers, called_intrinsics, statements

RAY_DISABLE_CLOSESTHIT = 8
PAYLOAD_GETTER, PAYLOAD_SETTER = "get_payload_", "set_payload_"


def traces_of(pipeline: Pipeline) -> Iterator[tuple[Function, Trace]]:
    """Every trace, traverse and invoke with the function that it stands in."""
    for function in (*pipeline.programs, *pipeline.helpers):
        for statement in statements(function.body):
            if isinstance(statement, Trace):
                yield function, statement


def payload_of(function: Function) -> Struct | None:
    """The payload class that a program takes."""
    for parameter in function.parameters:
        if parameter.role is ParameterRole.PAYLOAD:
            assert isinstance(parameter.local.type, Struct)
            return parameter.local.type
    return None


def accepts(pipeline: Pipeline, program: Function, payload: Struct | None) -> bool:
    """Whether a trace with this payload may run the program."""
    own = payload_of(program)
    if own is not None and (payload is None or (own != payload and tuple(payload_scalars(own)) != tuple(payload_scalars(payload)))):
        return False
    return words_by_number(pipeline, program) <= (payload_words(payload) if payload is not None else 0)


def reachable_functions(pipeline: Pipeline, start: Function) -> list[Function]:
    """The function and every helper that it reaches."""
    helpers = {helper.name: helper for helper in pipeline.helpers}
    found = {start.name: start}
    stack = [start]
    while stack:
        for name in called_helpers(stack.pop().body):
            if name not in found:
                found[name] = helpers[name]
                stack.append(helpers[name])
    return list(found.values())


def may_run(pipeline: Pipeline, shader: Function, trace: Trace) -> bool:
    if not accepts(pipeline, shader, trace.payload_type):
        return False
    flags = known_flags(trace)
    never = shader.kind is ProgramKind.CLOSESTHIT and flags is not None and bool(flags & RAY_DISABLE_CLOSESTHIT)
    return not never


def known_flags(trace: Trace) -> int | None:
    """The ray flags of a trace if they are a constant."""
    return constant(trace.arguments[7]) if trace.arguments else None


def constant(expression: Expr) -> int | None:
    """The value of an integer expression of literals and `|`, None for any other."""
    match expression:
        case Literal(value=int(value)):
            return value
        case Binary(op=BinaryOp.BIT_OR, left=left, right=right):
            a, b = constant(left), constant(right)
            return None if a is None or b is None else a | b
        case _:
            return None


def words_by_number(pipeline: Pipeline, program: Function) -> int:
    """One more than the highest payload register that the program or a helper addresses by number; 0 if they address none."""
    return max((number + 1 for function in reachable_functions(pipeline, program) for number in registers(function.body)), default=0)


def registers(body: Body) -> Iterator[int]:
    """The payload registers that are read or written by number."""
    for name in called_intrinsics(body):
        for prefix in (PAYLOAD_GETTER, PAYLOAD_SETTER):
            number = register_number(name, prefix)
            if number is not None:
                yield number


def address_registers(functions: Iterable[Function]) -> bool:
    """Whether any of the functions reads or writes a payload register by number."""
    return any(True for function in functions for _ in registers(function.body))


def register_number(name: str, prefix: str) -> int | None:
    """The register that a device function addresses."""
    number = name.removeprefix(prefix)
    return int(number) if name.startswith(prefix) and number.isdigit() else None
