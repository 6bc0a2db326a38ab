"""Classes of programs: one for every payload that some trace carries; and how deep traces and callables nest."""

from __future__ import annotations

from dataclasses import dataclass

from optixc.codegen.needs import EXCEPTION_FLAG_STACK_OVERFLOW, EXCEPTION_FLAG_TRACE_DEPTH, Needs
from optixc.ir.nodes import (
    CallCallable,
    Function,
    Pipeline,
    Trace,
)
from optixc.ir.programs import CALLABLES, ProgramKind
from optixc.ir.types import Struct
from optixc.ir.walk import statements
from optixc.passes.traced_programs import accepts, may_run, reachable_functions, traces_of


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
                if not may_run(pipeline, shader, trace):
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
