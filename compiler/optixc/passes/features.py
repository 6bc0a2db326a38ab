"""What a pipeline compiles in, and which line asked for it: the text of `pipeline.report()`, and what the emitters may leave out."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from optixc.ir.control import polls
from optixc.ir.intrinsic_rows import ATOMIC_NAMES, INTRINSICS
from optixc.ir.intrinsics import State
from optixc.ir.nodes import (
    Assert,
    CallCallable,
    CallIntrinsic,
    ElementRef,
    Expr,
    ForRange,
    Function,
    IntrinsicCall,
    Literal,
    Pipeline,
    Print,
    Stmt,
    Trace,
    While,
)
from optixc.ir.programs import ProgramKind
from optixc.ir.types import CoopVec
from optixc.ir.walk import expressions, statements
from optixc.source import Span

_RAY_FLAGS_ARGUMENT = 7
_CULLING = 16 | 32 | 64 | 128
_TERMINATE = 4


@dataclass(frozen=True)
class Feature:
    """One thing that a pipeline may contain; `span` is the first place that asked for it, None for an option or if it is out."""

    name: str
    is_in: bool
    span: Span | None = None
    reason: str = ""

    def describe(self) -> str:
        """One line: the name and who asked for it, or that it is out."""
        if not self.is_in:
            return f"{self.name}: not compiled in"
        asked = f"{self.span.path}:{self.span.line}" if self.span is not None else self.reason
        return f"{self.name}: {asked}" if asked else self.name


@dataclass(frozen=True)
class Features:
    """All features, in a fixed order."""

    items: tuple[Feature, ...]

    @property
    def compiled_in(self) -> tuple[Feature, ...]:
        return tuple(feature for feature in self.items if feature.is_in)

    def has(self, name: str) -> bool:
        return any(feature.name == name and feature.is_in for feature in self.items)


def features(pipeline: Pipeline) -> Features:
    """Looks through the programs and helpers that are left after the passes."""
    options = pipeline.options
    return Features(
        (
            *_of_programs(pipeline),
            _first(pipeline, "recursion", lambda s: isinstance(s, Trace), of=_is_shader),
            _first(pipeline, "occlusion queries", lambda s: isinstance(s, Trace) and _may(s, _TERMINATE)),
            _first(pipeline, "face and any-hit culling", lambda s: isinstance(s, Trace) and _may(s, _CULLING)),
            _hit_objects(pipeline),
            _first(pipeline, "callables", lambda s: isinstance(s, CallCallable)),
            _first(pipeline, "exceptions thrown", lambda s: isinstance(s, CallIntrinsic) and s.name == "throw_exception"),
            _first(pipeline, "atomics", lambda s: isinstance(s, CallIntrinsic) and s.name in ATOMIC_NAMES),
            _first_expression(pipeline, "textures", lambda e: isinstance(e, IntrinsicCall) and e.name.startswith("tex")),
            _coop_vecs(pipeline),
            _first(pipeline, "print", lambda s: isinstance(s, Print)),
            _first(pipeline, "loops that poll for cancellation", lambda s: isinstance(s, While | ForRange) and polls(s)),
            _option("assertions", options.debug or options.validation, _first(pipeline, "", lambda s: isinstance(s, Assert)).span),
            _option("NaN traps", options.trap_nan),
            _bounds_checks(pipeline),
            _option("validation", options.validation),
            _option("motion", options.uses_motion_blur),
            _option("opacity micromaps", options.allow_opacity_micromaps),
            _option("bound values", bool(options.bound_values)),
        )
    )


def _of_programs(pipeline: Pipeline) -> Iterator[Feature]:
    for kind in ProgramKind:
        if kind is ProgramKind.RAYGEN:
            continue
        found = next((program for program in pipeline.programs if program.kind is kind), None)
        name = f"{kind.value.replace('_', ' ')} programs"
        yield Feature(name, found is not None, found.span if found is not None else None)


def _is_shader(function: Function) -> bool:
    return function.kind in (ProgramKind.CLOSESTHIT, ProgramKind.MISS, ProgramKind.CONTINUATION_CALLABLE)


def _functions(pipeline: Pipeline) -> tuple[Function, ...]:
    return (*pipeline.programs, *pipeline.helpers)


def _first(
    pipeline: Pipeline, name: str, matches: Callable[[Stmt], bool], of: Callable[[Function], bool] = lambda function: True
) -> Feature:
    for function in _functions(pipeline):
        if of(function):
            for statement in statements(function.body):
                if matches(statement):
                    return Feature(name, True, statement.span)
    return Feature(name, False)


def _first_expression(pipeline: Pipeline, name: str, matches: Callable[[Expr], bool]) -> Feature:
    for function in _functions(pipeline):
        for expression in expressions(function.body):
            if matches(expression):
                return Feature(name, True, getattr(expression, "span", None))
    return Feature(name, False)


def _coop_vecs(pipeline: Pipeline) -> Feature:
    """A local, parameter or result that is a cooperative vector; whatever uses one has one."""
    for function in _functions(pipeline):
        locals_ = (*(parameter.local for parameter in function.parameters), *function.locals)
        found = any(isinstance(type_, CoopVec) for type_ in (function.result, *(local.type for local in locals_)))
        if found or any(isinstance(expression.type, CoopVec) for expression in expressions(function.body)):
            return Feature("cooperative vectors", True, function.span)
    return Feature("cooperative vectors", False)


def _hit_objects(pipeline: Pipeline) -> Feature:
    """Traverse, invoke, or any function on the outgoing hit object."""
    name = "hit objects"
    traced = _first(pipeline, name, lambda s: isinstance(s, Trace) and s.name != "trace")
    called = _first(pipeline, name, lambda s: isinstance(s, CallIntrinsic) and INTRINSICS[s.name].state is State.HIT_OBJECT)
    read = _first_expression(pipeline, name, lambda e: isinstance(e, IntrinsicCall) and INTRINSICS[e.name].state is State.HIT_OBJECT)
    return next((feature for feature in (traced, called, read) if feature.is_in), traced)


def _bounds_checks(pipeline: Pipeline) -> Feature:
    options, name = pipeline.options, "array bounds checks"
    if not (options.checks_bounds or options.debug or options.validation):
        return Feature(name, False)
    return _first_expression(pipeline, name, lambda e: isinstance(e, ElementRef))


def _option(name: str, is_on: bool, span: Span | None = None) -> Feature:
    return Feature(name, is_on, span if is_on else None, "asked for by the pipeline's options")


def _may(trace: Trace, flags: int) -> bool:
    """Whether the ray flags of a trace may hold one of these."""
    if not trace.arguments:
        return False
    given = trace.arguments[_RAY_FLAGS_ARGUMENT]
    return bool(int(given.value) & flags) if isinstance(given, Literal) and not isinstance(given.value, tuple) else True
