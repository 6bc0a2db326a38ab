"""Which words of a payload the programs behind a trace really look at: the others stay in the caller's locals, and cost nothing.

Programs take the payload by reference and are inlined, so that the C++ compiler moves a word only where a program reads or writes it. This
says which those are, for the report; it changes no code.
"""

from __future__ import annotations

from collections.abc import Iterator

from optixc.codegen.cpp_types import word_count
from optixc.codegen.program_classes import accepts, reachable_functions
from optixc.ir.nodes import (
    CallHelper,
    CallIntrinsic,
    Expr,
    FieldRef,
    Function,
    HelperCall,
    IntrinsicCall,
    LocalRef,
    ParameterRole,
    Pipeline,
)
from optixc.ir.programs import ProgramKind
from optixc.ir.types import Struct
from optixc.ir.walk import expressions, operands, statements

_WORD_PREFIXES = ("get_payload_", "set_payload_")
_TRACED = frozenset({ProgramKind.CLOSESTHIT, ProgramKind.ANYHIT, ProgramKind.INTERSECTION, ProgramKind.MISS})


def used_words(pipeline: Pipeline, payload: Struct) -> frozenset[int]:
    """Numbers of the words that some program which a trace with this payload may run reads or writes."""
    helpers = {helper.name: helper for helper in pipeline.helpers}
    found: set[int] = set()
    for program in pipeline.programs:
        if program.kind not in _TRACED or not accepts(pipeline, program, payload):
            continue
        for function in reachable_functions(pipeline, program):
            found.update(_words_by_number(function))
        for parameter in program.parameters:
            if parameter.role is ParameterRole.PAYLOAD and isinstance(parameter.local.type, Struct):
                fields = set(_fields(program, parameter.local.name, parameter.local.type, helpers, set()))
                found.update(_words_of(parameter.local.type, fields))
    return frozenset(found)


def _words_by_number(function: Function) -> Iterator[int]:
    names = [one.name for one in expressions(function.body) if isinstance(one, IntrinsicCall)]
    names += [one.name for one in statements(function.body) if isinstance(one, CallIntrinsic)]
    yield from (int(name.rsplit("_", 1)[1]) for name in names if name.startswith(_WORD_PREFIXES))


def _words_of(payload: Struct, fields: set[str]) -> Iterator[int]:
    first = 0
    for field in payload.fields:
        count = word_count(field.type)
        if field.name in fields:
            yield from range(first, first + count)
        first += count


def _fields(function: Function, name: str, type_: Struct, helpers: dict[str, Function], seen: set[tuple[str, str]]) -> Iterator[str]:
    """Fields of a struct that a function mentions under a local's name, itself or through helpers that it passes the struct to."""
    if (function.name, name) in seen:
        return
    seen.add((function.name, name))

    def of_call(callee: str, arguments: tuple[Expr, ...]) -> Iterator[str]:
        for parameter, argument in zip(helpers[callee].parameters, arguments, strict=True):
            if isinstance(argument, LocalRef) and argument.local.name == name:
                yield from _fields(helpers[callee], parameter.local.name, type_, helpers, seen)
            else:
                yield from of_expression(argument)

    def of_expression(expression: Expr) -> Iterator[str]:
        match expression:
            case FieldRef(base=LocalRef(local=local), name=field) if local.name == name:
                yield field
            case LocalRef(local=local) if local.name == name:
                yield from (field.name for field in type_.fields)
            case HelperCall(function=callee, arguments=arguments):
                yield from of_call(callee, arguments)
            case _:
                for operand in operands(expression):
                    yield from of_expression(operand)

    for statement in statements(function.body):
        if isinstance(statement, CallHelper):
            yield from of_call(statement.function, statement.arguments)
            continue
        for operand in operands(statement):
            yield from of_expression(operand)
