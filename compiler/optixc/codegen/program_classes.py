"""Which programs a trace can run: one class of programs for every payload that some trace carries.

A program belongs to the class of a payload if its own payload class is that one, has the same words, or if it has none and reads no
register beyond the payload's last.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from optixc.codegen.cpp_types import payload_words, word_count
from optixc.codegen.needs import EXCEPTION_FLAG_STACK_OVERFLOW, EXCEPTION_FLAG_TRACE_DEPTH, Needs
from optixc.ir.nodes import (
    Binary,
    BinaryOp,
    CallCallable,
    CallIntrinsic,
    Expr,
    Function,
    IntrinsicCall,
    Literal,
    ParameterRole,
    Pipeline,
    Trace,
)
from optixc.ir.programs import CALLABLES, ProgramKind
from optixc.ir.types import Struct
from optixc.ir.walk import called_helpers, expressions, statements

RAY_DISABLE_CLOSESTHIT = 8
_WORD_PREFIXES = ("get_payload_", "set_payload_")


@dataclass(frozen=True)
class ProgramClass:
    """What traces with `payload` (None: without one) can run, in the pipeline's order of programs.

    `noticed`: kinds of programs that have a dispatcher even without programs, so that a record of another payload is noticed.
    """

    payload: Struct | None
    closesthit: tuple[Function, ...]
    anyhit: tuple[Function, ...]
    intersection: tuple[Function, ...]
    miss: tuple[Function, ...]
    noticed: frozenset[ProgramKind | None]
    may_throw: bool
    counts_depth: bool
    depth_throws: bool
    checks_stack: bool
    overflow_throws: bool

    @property
    def present(self) -> list[tuple[ProgramKind, tuple[Function, ...]]]:
        """The kinds that have a dispatcher, with their programs."""
        kinds = (
            (ProgramKind.CLOSESTHIT, self.closesthit),
            (ProgramKind.ANYHIT, self.anyhit),
            (ProgramKind.INTERSECTION, self.intersection),
            (ProgramKind.MISS, self.miss),
        )
        return [(kind, functions) for kind, functions in kinds if functions or kind in self.noticed]


def traces_of(pipeline: Pipeline) -> Iterator[tuple[Function, Trace]]:
    """Every trace, traverse and invoke with the function that it stands in."""
    for function in (*pipeline.programs, *pipeline.helpers):
        for statement in statements(function.body):
            if isinstance(statement, Trace):
                yield function, statement


def program_classes(pipeline: Pipeline, needs: dict[str, Needs]) -> dict[Struct | None, ProgramClass]:
    """The class of every payload that is traced, in order of first use."""
    payloads = list(dict.fromkeys(trace.payload_type for _, trace in traces_of(pipeline)))
    depth = trace_depth(pipeline)
    checks_stack = depth is None or bool(pipeline.options.exception_flags & EXCEPTION_FLAG_STACK_OVERFLOW)
    counts = checks_stack or depth is None or depth > pipeline.options.max_trace_depth
    return {payload: _program_class(pipeline, needs, payload, counts, checks_stack) for payload in payloads}


def _program_class(pipeline: Pipeline, needs: dict[str, Needs], payload: Struct | None, counts: bool, checks_stack: bool) -> ProgramClass:
    def of_kind(kind: ProgramKind) -> tuple[Function, ...]:
        return tuple(p for p in pipeline.programs if p.kind is kind and accepts(pipeline, p, payload))

    closesthit, anyhit = of_kind(ProgramKind.CLOSESTHIT), of_kind(ProgramKind.ANYHIT)
    intersection, miss = of_kind(ProgramKind.INTERSECTION), of_kind(ProgramKind.MISS)
    programs = (*closesthit, *anyhit, *intersection, *miss)
    return ProgramClass(
        payload=payload,
        closesthit=closesthit,
        anyhit=anyhit,
        intersection=intersection,
        miss=miss,
        noticed=frozenset(program.kind for program in pipeline.programs if pipeline.options.validation),
        may_throw=any(needs[program.name].throws for program in programs),
        counts_depth=counts,
        depth_throws=bool(pipeline.options.exception_flags & EXCEPTION_FLAG_TRACE_DEPTH),
        checks_stack=checks_stack,
        overflow_throws=bool(pipeline.options.exception_flags & EXCEPTION_FLAG_STACK_OVERFLOW),
    )


def callables_nest(pipeline: Pipeline) -> bool:
    """Whether callables can run inside of callables, as deep as they like."""
    callables = [program for program in pipeline.programs if program.kind in CALLABLES]
    reached = {id(function): function for program in callables for function in reachable_functions(pipeline, program)}
    found = (statement for function in reached.values() for statement in statements(function.body))
    return any(isinstance(one, CallCallable) or (isinstance(one, Trace) and one.name != "traverse") for one in found)


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
    if own is not None and (payload is None or (own != payload and tuple(payload_words(own)) != tuple(payload_words(payload)))):
        return False
    return _words_used(pipeline, program) <= (word_count(payload) if payload is not None else 0)


def _words_used(pipeline: Pipeline, program: Function) -> int:
    """One more than the highest payload register that the program or a helper addresses by number."""
    highest = 0
    for function in reachable_functions(pipeline, program):
        names = [e.name for e in expressions(function.body) if isinstance(e, IntrinsicCall)]
        names += [s.name for s in statements(function.body) if isinstance(s, CallIntrinsic)]
        for name in names:
            if name.startswith(_WORD_PREFIXES):
                highest = max(highest, int(name.rsplit("_", 1)[1]) + 1)
    return highest


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


def trace_depth(pipeline: Pipeline) -> int | None:
    """How deep traces can nest, None if there is no limit. Callables count as reaching every program that traces."""
    tracing = {
        program.name: [t for f in reachable_functions(pipeline, program) for t in statements(f.body) if isinstance(t, Trace)]
        for program in pipeline.programs
    }
    callables = [p for p in pipeline.programs if p.kind in (ProgramKind.DIRECT_CALLABLE, ProgramKind.CONTINUATION_CALLABLE)]
    shaders = [p for p in pipeline.programs if p.kind in (ProgramKind.CLOSESTHIT, ProgramKind.MISS)]
    from_callables = [trace for program in callables for trace in tracing[program.name]]

    def depth_below(traces: list[Trace], path: frozenset[str]) -> int | None:
        deepest = 0
        for trace in traces:
            inner = 1
            for shader in shaders:
                if not _may_run(pipeline, shader, trace):
                    continue
                if shader.name in path:
                    return None
                below = depth_below([*tracing[shader.name], *from_callables], path | {shader.name})
                if below is None:
                    return None
                inner = max(inner, 1 + below)
            deepest = max(deepest, inner)
        return deepest

    starts = [p for p in pipeline.programs if p.kind is ProgramKind.RAYGEN]
    if from_callables:
        return None
    depths = [depth_below(tracing[program.name], frozenset()) for program in starts]
    return None if any(depth is None for depth in depths) else max((d for d in depths if d is not None), default=0)


def _may_run(pipeline: Pipeline, shader: Function, trace: Trace) -> bool:
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
