"""What each function of a pipeline needs and can do, through everything that it calls.

The emitters ask: which hidden arguments does the C++ function take, does it need the class of programs as a template argument
(because it reports intersections), and must its callers look whether it ended the program or the launch index.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields, replace

from optixc.ir.control import polls
from optixc.ir.intrinsic_rows import INTRINSICS
from optixc.ir.intrinsic_rows_coop_vec import COOP_VEC_NAMES
from optixc.ir.intrinsics import Effect, State
from optixc.ir.nodes import (
    Assert,
    CallCallable,
    CallIntrinsic,
    ElementRef,
    Expr,
    ForRange,
    Function,
    IndexRef,
    IntrinsicCall,
    Literal,
    ParamsRef,
    Pipeline,
    Print,
    Stmt,
    Trace,
    While,
)
from optixc.ir.walk import called_helpers, expressions, statements

EXCEPTION_FLAG_STACK_OVERFLOW = 1
EXCEPTION_FLAG_TRACE_DEPTH = 2
EXCEPTION_FLAG_USER = 4
REPORT = "report_intersection"
THROW = "throw_exception"
HIT_OBJECT_DATA = "hit_object_get_sbt_data"


@dataclass(frozen=True)
class Needs:
    """`thread` and `ray`: hidden arguments; `names_thread`: its own code mentions the thread, even where it comes with the ray.
    `params`: uses launch parameters. `programs`: needs to know what the trace can run. `hit_object`: has an outgoing hit object.
    `ends`: may end the program. `throws`: may end the launch index."""

    thread: bool = False
    names_thread: bool = False
    ray: bool = False
    params: bool = False
    programs: bool = False
    hit_object: bool = False
    ends: bool = False
    throws: bool = False

    def __or__(self, other: Needs) -> Needs:
        return Needs(*(getattr(self, field.name) or getattr(other, field.name) for field in fields(Needs)))


@dataclass(frozen=True)
class Options:
    """What of the pipeline's options changes what functions need.

    Memory is looked at before it is touched wherever `checks_elements` is set; assertions and items of fixed arrays, vectors and matrices
    in builds with debug or validation only.
    """

    is_checked: bool
    checks_elements: bool
    user_exceptions: bool
    traces_throw: bool
    uses_motion: bool = False


def options_of(pipeline: Pipeline) -> Options:
    options = pipeline.options
    throwing = bool(options.exception_flags & EXCEPTION_FLAG_USER)
    return Options(
        is_checked=options.debug or options.validation,
        checks_elements=options.checks_bounds or options.debug or options.validation,
        user_exceptions=throwing,
        uses_motion=options.uses_motion_blur,
        traces_throw=throwing or bool(options.exception_flags & (EXCEPTION_FLAG_TRACE_DEPTH | EXCEPTION_FLAG_STACK_OVERFLOW)),
    )


def needs_of_pipeline(pipeline: Pipeline) -> dict[str, Needs]:
    """The needs of every program and helper, by name; a fixed point over the call graph."""
    options = options_of(pipeline)
    functions = (*pipeline.helpers, *pipeline.programs)
    calls = {function.name: tuple(dict.fromkeys(called_helpers(function.body))) for function in functions}
    needs = {function.name: _own_needs(function, options) for function in functions}
    changed = True
    while changed:
        changed = False
        for function in functions:
            joined = needs[function.name]
            for callee in calls[function.name]:
                joined = joined | _passed_on(needs[callee])
            if joined != needs[function.name]:
                needs[function.name] = joined
                changed = True
    for program in pipeline.programs:
        if needs[program.name].hit_object:
            # The hit object is a local of the program, and knows its thread.
            needs[program.name] = replace(needs[program.name], thread=True, names_thread=True)
    return needs


def _passed_on(callee: Needs) -> Needs:
    """What a caller needs because of a callee. Parameters are the callee's own affair, and the thread comes with the ray."""
    return replace(callee, params=False, names_thread=(callee.thread and not callee.ray) or callee.throws)


def _own_needs(function: Function, options: Options) -> Needs:
    own = _union(
        (
            *(_of_statement(statement, options) for statement in statements(function.body)),
            *(_of_expression(expression, options) for expression in expressions(function.body)),
        )
    )
    return replace(own, names_thread=own.thread)


def _union(parts: Iterable[Needs]) -> Needs:
    result = Needs()
    for part in parts:
        result = result | part
    return result


def _of_statement(statement: Stmt, options: Options) -> Needs:
    match statement:
        case Trace():
            return Needs(thread=True, hit_object=statement.name != "trace", throws=options.traces_throw)
        case CallCallable():
            return Needs(thread=True, throws=options.traces_throw)
        case Print():
            return Needs(thread=True)
        case Assert():
            return Needs(thread=options.is_checked)
        case While() | ForRange():
            return Needs(thread=polls(statement))
        case CallIntrinsic(name=name):
            return _of_intrinsic(name, options)
        case _:
            return Needs()


def _of_expression(expression: Expr, options: Options) -> Needs:
    match expression:
        case ParamsRef():
            return Needs(thread=True, params=True)
        case ElementRef():
            return Needs(thread=options.checks_elements)
        case IndexRef(index=index) if not isinstance(index, Literal):
            return Needs(thread=options.is_checked)
        case IntrinsicCall(name=name):
            return _of_intrinsic(name, options)
        case _:
            return Needs()


def _of_intrinsic(name: str, options: Options) -> Needs:
    row = INTRINSICS[name]
    if name == THROW:
        return Needs(thread=True, throws=True) if options.user_exceptions else Needs()
    state = row.state
    is_checked_memory = options.checks_elements and name in COOP_VEC_NAMES and row.effect is not Effect.PURE
    return Needs(
        thread=state is State.THREAD or is_checked_memory,
        ray=state is State.RAY,
        hit_object=state is State.HIT_OBJECT,
        programs=name == REPORT,
        ends=row.effect is Effect.ENDS_PROGRAM or name == REPORT,
    )
