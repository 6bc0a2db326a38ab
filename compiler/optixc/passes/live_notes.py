"""What liveness says about traces and programs, as lines for the printed IR.

Behind each trace: which words of its payload hold a value that somebody may read, where it begins (`in`) and behind it (`out`), which
only its programs hand to each other (`between`), and which nobody reads (`not carried`); and the locals that are live across it. Behind
the head of each program the same for its own payload. The semantics of the payload class count: what the caller does not pass is not
`in`, what it does not get back is not `out`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from optixc.ir.layout import WORD_SIZE
from optixc.ir.nodes import Function, ParameterRole, Pipeline, Trace
from optixc.ir.payload_semantics import is_passed, is_returned
from optixc.ir.text import Notes
from optixc.ir.types import Struct, StructField
from optixc.ir.walk import statements
from optixc.passes.live_flow import REGISTERS, Liveness
from optixc.passes.live_words import full, names_of, place_words, words_of
from optixc.passes.liveness import liveness
from optixc.passes.traced_programs import payload_of, traces_of


@dataclass(frozen=True)
class Carried:
    """Words of a trace's payload, as the bits of ints; together they are all of its words."""

    into: int
    out_of: int
    between: int
    dead: int

    @property
    def carried(self) -> int:
        return self.into | self.out_of | self.between


def live_notes(pipeline: Pipeline) -> Notes:
    """The lines for all traces and programs of a pipeline."""
    live = liveness(pipeline)
    notes: dict[int, tuple[str, ...]] = {}
    for function in (*pipeline.helpers, *pipeline.programs):
        payload = payload_of(function)
        if payload is not None:
            into, out_of = (masks[function.name] & full(words_of(payload)) for masks in (live.into, live.out_of))
            notes[id(function)] = (f"payload: {_parts(payload, (('in', into), ('out', out_of)))}",)
        for trace in statements(function.body):
            if isinstance(trace, Trace):
                notes[id(trace)] = tuple(_of_trace(function, trace, live))
    return notes


def carried_words(pipeline: Pipeline) -> dict[int, Carried]:
    """The words of every trace that has a payload, by its id."""
    found = [(function, trace) for function, trace in traces_of(pipeline) if trace.payload is not None]
    live = liveness(pipeline, payloads_only=True) if found else Liveness()
    return {id(trace): _carried(function, trace, live) for function, trace in found}


def _carried(function: Function, trace: Trace, live: Liveness) -> Carried:
    """The words of the payload of a trace that has one."""
    assert trace.payload is not None and trace.payload_type is not None
    everything = full(words_of(trace.payload_type))
    words, state = place_words(trace.payload), live.behind[id(trace)]
    name = None if words is None else REGISTERS if words.local == _payload_name(function) else words.local
    if function.name in live.pinned or words is None or name is None or not words.is_exact:
        behind = everything
    else:
        behind = state.get(name, 0) >> words.first & everything
    passed = _mask(trace.payload_type, lambda field: is_passed(field, trace.name))
    returned = _mask(trace.payload_type, lambda field: is_returned(field, trace.name))
    reads = live.reads[id(trace)] & everything
    into, out_of = (reads | behind & returned) & passed, behind & returned
    between = reads & ~into & ~out_of
    return Carried(into, out_of, between, everything & ~into & ~out_of & ~between)


def _of_trace(function: Function, trace: Trace, live: Liveness) -> Iterator[str]:
    own: str | None = None
    if trace.payload is not None and trace.payload_type is not None:
        masks = _carried(function, trace, live)
        words = place_words(trace.payload)
        own = words.local if words is not None else None
        optional = [(name, mask) for name, mask in (("between", masks.between), ("not carried", masks.dead)) if mask]
        yield f"payload: {_parts(trace.payload_type, (('in', masks.into), ('out', masks.out_of), *optional))}"
    state = live.behind[id(trace)]
    across = []
    for local in (*(p.local for p in function.parameters if p.role is not ParameterRole.RECORD), *function.locals):
        mask = state.get(REGISTERS if local.name == _payload_name(function) else local.name, 0)
        if mask and local.name != own:
            across.append((local.name, mask.bit_count()))
    size = f" ({_size(sum(count for _, count in across))})" if across else ""
    yield f"live across: {', '.join(name for name, _ in across) or 'nothing'}{size}"


def _payload_name(function: Function) -> str | None:
    return next((p.local.name for p in function.parameters if p.role is ParameterRole.PAYLOAD), None)


def _mask(struct: Struct, allows: Callable[[StructField], bool]) -> int:
    mask, first = 0, 0
    for field in struct.fields:
        count = words_of(field.type)
        mask |= full(count) << first if allows(field) else 0
        first += count
    return mask


def _parts(struct: Struct, masks: Iterable[tuple[str, int]]) -> str:
    def text(mask: int) -> str:
        return f"{', '.join(names_of(struct, mask))} ({_size(mask.bit_count())})" if mask else "nothing"

    return "; ".join(f"{name} {text(mask)}" for name, mask in masks)


def _size(words: int) -> str:
    return f"{words} word{'' if words == 1 else 's'}, {words * WORD_SIZE} bytes"
