"""Callables: what each one's struct parameters are, which call can run which, and one dispatcher for every signature that is called.

The last `@ox.struct` parameter of a callable is the data of its SBT record, unless no call of the pipeline leaves it out while some call
passes it: then it is an argument like the others. So `direct_call(i, hit)` runs both `f(hit: Hit)` and `g(hit: Hit, data: Data)`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from optixc.ir.nodes import CallCallable, Function, Parameter, ParameterRole, Pipeline
from optixc.ir.programs import ProgramKind
from optixc.ir.types import Type
from optixc.ir.walk import statements

_KINDS = (ProgramKind.DIRECT_CALLABLE, ProgramKind.CONTINUATION_CALLABLE)
_SHOWN = 8


class CallableError(Exception):
    """A call that no callable of the pipeline answers; the message says what there is."""


@dataclass(frozen=True)
class CallableSignature:
    """Kind, argument types and result type of a callable's call."""

    is_direct: bool
    arguments: tuple[Type, ...]
    result: Type

    def __str__(self) -> str:
        name = "direct" if self.is_direct else "continuation"
        return f"{name} callable ({', '.join(map(str, self.arguments))}) -> {self.result}"


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


def resolve_callables(pipeline: Pipeline) -> Pipeline:
    """The pipeline with the roles of all callables' struct parameters decided. Raises CallableError for a call that nothing answers."""
    called = set(signatures_called(pipeline))
    programs = tuple(_decide(program, called) if program.kind in _KINDS else program for program in pipeline.programs)
    resolved = replace(pipeline, programs=programs)
    _check_calls(resolved)
    return resolved


def _decide(program: Function, called: set[CallableSignature]) -> Function:
    if signature_of_program(program) in called:
        return program
    all_values = replace(program, parameters=tuple(_as_value(parameter) for parameter in program.parameters))
    return all_values if signature_of_program(all_values) in called else program


def _as_value(parameter: Parameter) -> Parameter:
    is_own = parameter.role is ParameterRole.RECORD and not parameter.hidden
    return replace(parameter, role=ParameterRole.VALUE) if is_own else parameter


def _check_calls(pipeline: Pipeline) -> None:
    """Every call has a callable, if the pipeline has callables of its kind at all."""
    for call in _calls(pipeline):
        signature = signature_of_call(call)
        kind = _KINDS[0] if signature.is_direct else _KINDS[1]
        offered = [program for program in pipeline.programs if program.kind is kind]
        if offered and not callables_with(pipeline, signature):
            there = "\n".join(f"  {program.name} is a {signature_of_program(program)}" for program in offered[:_SHOWN])
            name = "direct_call" if signature.is_direct else "continuation_call"
            raise CallableError(
                f"{call.span.path}:{call.span.line}: this {name} wants a {signature}, and no callable of the pipeline is one:\n{there}\n"
                "Give the call the callable's argument types and result=, or add the callable's group to the pipeline"
            )


def _calls(pipeline: Pipeline) -> Iterator[CallCallable]:
    for function in (*pipeline.programs, *pipeline.helpers):
        yield from (statement for statement in statements(function.body) if isinstance(statement, CallCallable))
