"""Which words are live where: what some statement behind may still read, through helpers, traces and the programs that traces run.

Backward over each function, again until nothing changes. A helper's or program's effect on what it is given by reference is summed up
as words it may read before it writes them, and words it writes on every way; what is live at its end comes from all its callers. The
payload of a program and its registers by number are one thing. A trace reads what its programs may read and writes nothing for sure,
because a record may be empty. What a payload class's semantics leave undefined keeps the caller's value, so that they play no
part here.
"""

from __future__ import annotations

from collections.abc import Iterable

from optixc.ir.nodes import (
    CallHelper,
    CallIntrinsic,
    Expr,
    Function,
    HelperCall,
    Pipeline,
    Trace,
)
from optixc.ir.programs import ProgramKind
from optixc.ir.walk import Body, expressions, statements
from optixc.passes.live_flow import (
    EMPTY,
    IN_TRAVERSAL,
    REGISTERS,
    Flow,
    Known,
    Liveness,
    ends_program,
    only,
    references_of,
)
from optixc.passes.live_words import State, joined, place_words
from optixc.passes.traced_programs import address_registers, may_run, reachable_functions, traces_of

_BEHIND_TRAVERSAL = (ProgramKind.CLOSESTHIT, ProgramKind.MISS)
_KINDS = {"trace": (*IN_TRAVERSAL, *_BEHIND_TRAVERSAL), "traverse": IN_TRAVERSAL, "invoke": _BEHIND_TRAVERSAL}


def liveness(pipeline: Pipeline, payloads_only: bool = False) -> Liveness:
    """Of every function of a pipeline; of payloads only, if nothing else is asked for."""
    analysis = _Analysis(pipeline, payloads_only)
    while analysis.turn():
        pass
    return analysis.result


class _Analysis:
    """The fixed point over all functions. Mentions, reads and `exits`, what callers want of a function, grow; writes shrink."""

    def __init__(self, pipeline: Pipeline, payloads_only: bool) -> None:
        self.pipeline = pipeline
        self.helpers = {helper.name: helper for helper in pipeline.helpers}
        self.functions = (*pipeline.helpers, *pipeline.programs)
        nothing: dict[str, State] = {function.name: EMPTY for function in self.functions}
        self.exits = dict(nothing)
        self.known = Known(
            helpers=self.helpers,
            mentions=dict(nothing),
            reads=dict(nothing),
            writes={function.name: references_of(function) for function in self.functions},
            run_by={id(trace): self._programs_of(trace) for _, trace in traces_of(pipeline)},
            ending={name for name, helper in self.helpers.items() if _may_end(pipeline, helper)},
            by_number=address_registers(self.functions),
            payloads_only=payloads_only,
        )
        self.result = Liveness(pinned=self._aliased())
        self.pinned = self.result.pinned
        self.flows = {function.name: Flow(self.known, function) for function in self.functions}

    def _programs_of(self, trace: Trace) -> list[Function]:
        kinds = _KINDS[trace.name]
        return [program for program in self.pipeline.programs if program.kind in kinds and may_run(self.pipeline, program, trace)]

    def _aliased(self) -> set[str]:
        """Helpers whose references may name one struct twice; all of them where helpers address registers by number."""
        if address_registers(self.pipeline.helpers):
            return set(self.helpers)
        several = {name for name, helper in self.helpers.items() if sum(p.local.by_reference for p in helper.parameters) > 1}
        found: set[str] = set()
        for function in self.functions if several else ():
            for callee, arguments in _calls(function.body):
                given = zip(self.helpers[callee].parameters, arguments, strict=True)
                places = [place_words(argument) for parameter, argument in given if parameter.local.by_reference]
                roots = [words.local for words in places if words is not None]
                if len(set(roots)) < len(roots):
                    found.add(callee)
        return found

    def turn(self) -> bool:
        """Goes through all functions once; whether anything changed."""
        known, changed = self.known, False
        for function in self.functions:
            flow, name, references = self.flows[function.name], function.name, references_of(function)
            mentions = references if name in self.pinned else only(flow.run(EMPTY), references)
            writes = {} if name in self.pinned else _rest(flow.run(references), references)
            if mentions != known.mentions[name] or writes != known.writes[name]:
                known.mentions[name], known.writes[name], changed = mentions, writes, True
        for function in self.functions:
            name, is_pinned = function.name, function.name in self.pinned
            exits = references_of(function) if is_pinned else self.exits[name]
            into = self.flows[name].run(exits, self.result)
            mentions = known.mentions[name]
            reads = mentions if is_pinned else {given: mask & into.get(given, 0) for given, mask in mentions.items()}
            if reads != known.reads[name]:
                known.reads[name], changed = reads, True
            if function.kind is not None:
                self.result.into[name], self.result.out_of[name] = into.get(REGISTERS, 0), exits.get(REGISTERS, 0)
        return self._flowed() or changed

    def _flowed(self) -> bool:
        """Hands what is live behind calls and traces on to those that they run; whether that was news."""
        changed = False
        for function in self.functions:
            for name, state in self.flows[function.name].handed_on():
                new = joined(self.exits[name], state)
                if new != self.exits[name]:
                    self.exits[name], changed = new, True
        return changed


def _rest(state: State, everything: State) -> dict[str, int]:
    return {name: mask & ~state.get(name, 0) for name, mask in everything.items()}


def _may_end(pipeline: Pipeline, helper: Function) -> bool:
    """Whether a helper may end the program that called it."""
    calls = (s for f in reachable_functions(pipeline, helper) for s in statements(f.body) if isinstance(s, CallIntrinsic))
    return any(ends_program(call) for call in calls)


def _calls(body: Body) -> Iterable[tuple[str, tuple[Expr, ...]]]:
    for statement in statements(body):
        if isinstance(statement, CallHelper):
            yield statement.function, statement.arguments
    for expression in expressions(body):
        if isinstance(expression, HelperCall):
            yield expression.function, expression.arguments
