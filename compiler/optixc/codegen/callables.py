"""Callables: every signature that the pipeline calls gets one dispatcher over the callables that have it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from optixc.ir.nodes import CallCallable, Function, ParameterRole, Pipeline
from optixc.ir.programs import ProgramKind
from optixc.ir.types import Type
from optixc.ir.walk import statements


@dataclass(frozen=True)
class CallableSignature:
    """Kind, argument types and result type of a callable's call."""

    is_direct: bool
    arguments: tuple[Type, ...]
    result: Type


def signature_of_call(call: CallCallable) -> CallableSignature:
    return CallableSignature(call.is_direct, tuple(argument.type for argument in call.arguments), call.result)


def signature_of_program(program: Function) -> CallableSignature:
    values = tuple(p.local.type for p in program.parameters if p.role is ParameterRole.VALUE)
    return CallableSignature(program.kind is ProgramKind.DIRECT_CALLABLE, values, program.result)


def signatures_called(pipeline: Pipeline) -> list[CallableSignature]:
    """Every signature that some call has, in order of first use."""
    return list(dict.fromkeys(signature_of_call(call) for call in _calls(pipeline)))


def callables_with(pipeline: Pipeline, signature: CallableSignature) -> list[Function]:
    """The callables that a call with this signature can run."""
    kind = ProgramKind.DIRECT_CALLABLE if signature.is_direct else ProgramKind.CONTINUATION_CALLABLE
    return [program for program in pipeline.programs if program.kind is kind and signature_of_program(program) == signature]


def _calls(pipeline: Pipeline) -> Iterator[CallCallable]:
    for function in (*pipeline.programs, *pipeline.helpers):
        yield from (statement for statement in statements(function.body) if isinstance(statement, CallCallable))
