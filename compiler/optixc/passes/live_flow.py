"""What is live before each statement of one function, given what is live behind it.

Backward, loops again until nothing changes. What helpers, and programs that traces run, do to what they are given by reference stands in
`Known`; see `liveness` for how it comes about.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from optixc.ir.intrinsic_rows import INTRINSICS
from optixc.ir.intrinsics import Effect
from optixc.ir.nodes import (
    Assign,
    Break,
    CallCallable,
    CallHelper,
    CallIntrinsic,
    ComponentRef,
    Construct,
    Continue,
    ElementRef,
    Expr,
    FieldRef,
    ForRange,
    Function,
    HelperCall,
    If,
    IndexRef,
    IntrinsicCall,
    Local,
    ParameterRole,
    Return,
    Stmt,
    Trace,
    TupleItem,
    While,
)
from optixc.ir.programs import ProgramKind
from optixc.ir.types import Struct, StructKind, Type
from optixc.ir.walk import Body, operands, statements
from optixc.passes.live_words import State, Words, full, joined, place_words, with_words, without_words, words_of
from optixc.passes.traced_programs import PAYLOAD_GETTER, PAYLOAD_SETTER, register_number

REGISTERS = "payload registers"
"""The payload of a program, and the registers by number everywhere: no author's name has a space."""

IN_TRAVERSAL = (ProgramKind.ANYHIT, ProgramKind.INTERSECTION)
EMPTY: State = {}
ALL_REGISTERS = full(32)


@dataclass
class Liveness:
    """`behind`: by the id of each statement, what is live after it. `reads`: words that a trace's programs may read, by its id.
    `into` and `out_of`: payload words live where a program begins and ends, by its name. `pinned`: helpers of which nothing is known,
    because two of their references may name one thing."""

    behind: dict[int, State] = field(default_factory=dict)
    reads: dict[int, int] = field(default_factory=dict)
    into: dict[str, int] = field(default_factory=dict)
    out_of: dict[str, int] = field(default_factory=dict)
    pinned: set[str] = field(default_factory=set)


@dataclass
class Known:
    """What the flows of all functions know of each other, by names: of helpers and programs `mentions`, the words that one may read if its
    caller wants all that it writes; `reads`: of these, the words that it does read for what its callers do want; `writes`: on every way.
    `ending`: helpers that may end their program. `run_by`: the programs of each trace, by its id."""

    helpers: dict[str, Function]
    mentions: dict[str, State]
    reads: dict[str, State]
    writes: dict[str, State]
    run_by: dict[int, list[Function]]
    ending: set[str]
    by_number: bool
    """Whether any function addresses registers by number."""
    payloads_only: bool
    """Whether only payloads are followed, which is quicker: other locals count as wanted everywhere."""


@dataclass(frozen=True)
class _Uses:
    """What an expression reads: words of locals, registers by number, and what the helpers in it read of what they are given."""

    words: State
    calls: tuple[tuple[str, str, Words], ...]
    """Helper, its parameter, and what it is given for it."""
    helpers: tuple[str, ...]


class Flow:
    """Walks one function backward."""

    def __init__(self, known: Known, function: Function) -> None:
        self._known = known
        self._function = function
        self._references = references_of(function)
        self._tracked = {local.name for local in locals_of(function) if not known.payloads_only or is_payload(local.type)}
        self._is_idle = known.payloads_only and not self._tracked and not known.by_number
        self._payload = next((p.local.name for p in function.parameters if p.role is ParameterRole.PAYLOAD), None)
        self._uses: dict[int, _Uses] = {}
        self._exit: State = EMPTY
        self._result: Liveness | None = None
        self._jumps: list[tuple[State, State]] = []
        self._live: dict[int, State] = {}

    def run(self, at_end: State, result: Liveness | None = None) -> State:
        """What is live where the function begins, if this is live at its end; statements are entered into `result`.

        Without `result` the function is summed up: its caller may want whatever it writes.
        """
        self._exit, self._result = at_end, result
        if self._is_idle:
            return at_end
        return self._block(self._function.body, at_end)

    def handed_on(self) -> Iterable[tuple[str, State]]:
        """What is live behind each helper that the last run called, and behind each program that its traces run."""
        for statement in statements(self._function.body):
            behind = self._live.get(id(statement))
            if behind is None:
                continue
            if isinstance(statement, CallHelper):
                yield statement.function, self._behind_helper(statement, behind)
            elif isinstance(statement, Trace):
                yield from self._behind_programs(statement, behind)

    def _behind_helper(self, call: CallHelper, behind: State) -> State:
        given: State = only(behind, [REGISTERS])
        for parameter, words in self._given(call.function, call.arguments):
            given = with_words(given, parameter, _taken(behind, words))
        return given

    def _behind_programs(self, trace: Trace, behind: State) -> Iterable[tuple[str, State]]:
        if trace.payload is None:
            return
        words = self._place(trace.payload)
        live = ALL_REGISTERS if words is None else _taken(behind, words)
        programs = self._known.run_by[id(trace)]
        for program in programs:
            later = self._reads_of(programs) if program.kind in IN_TRAVERSAL else 0
            yield program.name, {REGISTERS: live | later}

    def _reads_of(self, programs: list[Function]) -> int:
        mask = 0
        for program in programs:
            mask |= self._read_by(program.name).get(REGISTERS, 0)
        return mask

    def _read_by(self, function: str) -> State:
        """What a helper or program reads of what it is given."""
        return (self._known.mentions if self._result is None else self._known.reads)[function]

    # ---- statements ----------------------------------------------------------------------------------------------------------

    def _block(self, body: Body, state: State) -> State:
        for statement in reversed(body):
            self._live[id(statement)] = state
            if self._result is not None:
                self._result.behind[id(statement)] = state
            state = self._statement(statement, state)
        return state

    def _statement(self, statement: Stmt, behind: State) -> State:
        match statement:
            case If(condition=condition, then_body=then_body, else_body=else_body):
                return self._read(joined(self._block(then_body, behind), self._block(else_body, behind)), condition)
            case While() | ForRange():
                return self._loop(statement, behind)
            case Break():
                return self._jumps[-1][0]
            case Continue():
                return self._jumps[-1][1]
            case Return(value=value):
                return self._exit if value is None else self._read(self._exit, value)
            case Assign():
                return self._assign(statement, behind)
            case CallHelper(target=target, function=function, arguments=arguments):
                return self._call(function, arguments, self._given_value(target, behind))
            case CallIntrinsic():
                return self._intrinsic(statement, behind)
            case CallCallable(target=target):
                return self._read(self._given_value(target, behind), *operands(statement))
            case Trace(arguments=arguments, payload=payload):
                return self._read(self._traced(statement, payload, behind), *arguments)
            case _:
                return self._read(behind, *operands(statement))

    def _loop(self, loop: While | ForRange, behind: State) -> State:
        """What is live at the head only grows, turn by turn."""
        head: State = behind
        while True:
            self._jumps.append((behind, head))
            state = self._block(loop.body, head)
            self._jumps.pop()
            if isinstance(loop, While):
                self._jumps.append((behind, head))
                state = self._block(loop.condition_body, self._read(joined(state, behind), loop.condition))
                self._jumps.pop()
            else:
                state = self._given_value(loop.target, state)
            new = joined(head, state)
            if new == head:
                break
            head = new
        return self._read(head, loop.start, loop.stop, loop.step) if isinstance(loop, ForRange) else head

    def _assign(self, statement: Assign, behind: State) -> State:
        target = self._place(statement.target)
        if target is None:
            return self._read(behind, statement.target, statement.value)
        is_given = self._result is None and target.local in self._references
        live = target.mask if is_given else behind.get(target.local, 0) & target.mask
        if not live:
            return behind
        state = without_words(behind, target.local, target.mask) if target.is_exact else behind
        state = self._read_indices(state, statement.target)
        if target.is_exact:
            return self._read_parts(state, statement.value, live >> target.first)
        return self._read(state, statement.value)

    def _read_parts(self, state: State, value: Expr, live: int) -> State:
        """A value of which only these words are wanted."""
        if isinstance(value, Construct) and isinstance(value.type, Struct):
            first = 0
            for part, argument in zip(value.type.fields, value.arguments, strict=True):
                count = words_of(part.type)
                wanted = live >> first & full(count)
                state = self._read_parts(state, argument, wanted) if wanted else state
                first += count
            return state
        words = self._place(value) if isinstance(value.type, Struct) else None
        if words is None or not words.is_exact:
            return self._read(state, value)
        return with_words(self._read_indices(state, value), words.local, live << words.first)

    def _given_value(self, target: Local | None, state: State) -> State:
        return state if target is None else without_words(state, target.name, full(words_of(target.type)))

    def _intrinsic(self, call: CallIntrinsic, behind: State) -> State:
        state = self._given_value(call.target, behind)
        written = register_number(call.name, PAYLOAD_SETTER)
        if written is not None:
            state = without_words(state, REGISTERS, 1 << written)
        if ends_program(call):
            state = joined(state, self._at_forced_end())
        return self._read(state, *call.arguments)

    def _at_forced_end(self) -> State:
        """What is live where the program ends: a helper does not know its program."""
        return self._exit if self._function.kind is not None else references_of(self._function)

    def _call(self, function: str, arguments: tuple[Expr, ...], behind: State) -> State:
        state = joined(behind, self._at_forced_end()) if function in self._known.ending else behind
        reads, writes = self._read_by(function), self._known.writes[function]
        state = without_words(state, REGISTERS, writes.get(REGISTERS, 0))
        given = list(self._given(function, arguments))
        for parameter, words in given:
            if words.is_exact:
                state = without_words(state, words.local, (writes.get(parameter, 0) & full(words.size)) << words.first)
        for parameter, words in given:
            state = with_words(state, words.local, _shifted(reads.get(parameter, 0), words))
        state = with_words(state, REGISTERS, reads.get(REGISTERS, 0))
        by_reference = {id(argument) for argument in self._by_reference(function, arguments)}
        for argument in arguments:
            state = self._read_indices(state, argument) if id(argument) in by_reference else self._read(state, argument)
        return state

    def _traced(self, trace: Trace, payload: Expr | None, behind: State) -> State:
        if payload is None:
            return behind
        reads = self._reads_of(self._known.run_by[id(trace)])
        if self._result is not None:
            self._result.reads[id(trace)] = reads
        words = self._place(payload)
        if words is None:
            return self._read(behind, payload)
        return self._read_indices(with_words(behind, words.local, _shifted(reads, words)), payload)

    # ---- expressions ---------------------------------------------------------------------------------------------------------

    def _place(self, place: Expr) -> Words | None:
        words = place_words(place)
        if words is None or words.local not in self._tracked:
            return None
        return words._replace(local=REGISTERS) if words.local == self._payload else words

    def _by_reference(self, function: str, arguments: tuple[Expr, ...]) -> Iterable[Expr]:
        for parameter, argument in zip(self._known.helpers[function].parameters, arguments, strict=True):
            if parameter.local.by_reference and place_words(argument) is not None:
                yield argument

    def _given(self, function: str, arguments: tuple[Expr, ...]) -> Iterable[tuple[str, Words]]:
        """What a helper is given by reference out of locals."""
        for parameter, argument in zip(self._known.helpers[function].parameters, arguments, strict=True):
            words = self._place(argument) if parameter.local.by_reference else None
            if words is not None:
                yield parameter.local.name, words

    def _read(self, state: State, *read: Expr) -> State:
        for expression in read:
            uses = self._uses.get(id(expression))
            if uses is None:
                uses = self._uses[id(expression)] = self._uses_of(expression)
            state = joined(state, uses.words) if uses.words else state
            for helper, parameter, words in uses.calls:
                state = with_words(state, words.local, _shifted(self._read_by(helper).get(parameter, 0), words))
            for helper in uses.helpers:
                state = with_words(state, REGISTERS, self._read_by(helper).get(REGISTERS, 0))
        return state

    def _read_indices(self, state: State, place: Expr) -> State:
        """What is read to find a place: its indices, not itself."""
        return self._read(state, *_indices(place))

    def _uses_of(self, expression: Expr) -> _Uses:
        words: State = EMPTY
        calls: list[tuple[str, str, Words]] = []
        helpers: list[str] = []
        stack = [expression]
        while stack:
            node = stack.pop()
            place = self._place(node)
            if place is not None:
                words = with_words(words, place.local, place.mask)
                stack.extend(_indices(node))
                continue
            if isinstance(node, IntrinsicCall) and (number := register_number(node.name, PAYLOAD_GETTER)) is not None:
                words = with_words(words, REGISTERS, 1 << number)
            if isinstance(node, HelperCall):
                helpers.append(node.function)
                calls += [(node.function, parameter, given) for parameter, given in self._given(node.function, node.arguments)]
                by_reference = {id(argument) for argument in self._by_reference(node.function, node.arguments)}
                stack.extend(argument for argument in node.arguments if id(argument) not in by_reference)
                continue
            stack.extend(operands(node))
        return _Uses(words, tuple(calls), tuple(helpers))


def _indices(place: Expr) -> Iterable[Expr]:
    """The indices by which a place is found."""
    while True:
        match place:
            case IndexRef(base=base, index=index):
                yield index
                place = base
            case FieldRef(base=base) | ComponentRef(base=base) | TupleItem(base=base):
                place = base
            case ElementRef(indices=indices):
                yield from indices
                return
            case _:
                return


def _taken(state: State, words: Words) -> int:
    """The live ones among these words, counted from their first; all of them where an index picks some."""
    return (state.get(words.local, 0) & words.mask) >> words.first if words.is_exact else full(words.size)


def _shifted(mask: int, words: Words) -> int:
    """Words of a parameter as words of what was given for it."""
    if not words.is_exact:
        return words.mask if mask else 0
    return (mask & full(words.size)) << words.first


def only(state: State, names: Iterable[str]) -> dict[str, int]:
    return {name: state[name] for name in names if state.get(name)}


def locals_of(function: Function) -> list[Local]:
    """Parameters and locals."""
    return [*(parameter.local for parameter in function.parameters), *function.locals]


def is_payload(type_: Type) -> bool:
    """Whether values of the type are payloads."""
    return isinstance(type_, Struct) and type_.kind is StructKind.PAYLOAD


def references_of(function: Function) -> State:
    """All words that a caller gives by reference, by the names that states use: the payload of a program is its registers."""
    named = [p.local for p in function.parameters if p.local.by_reference and p.role is ParameterRole.VALUE]
    return {**{local.name: full(words_of(local.type)) for local in named}, REGISTERS: ALL_REGISTERS}


def ends_program(call: CallIntrinsic) -> bool:
    """Whether the program may end here, or other programs run that take its payload."""
    return INTRINSICS[call.name].effect in (Effect.ENDS_PROGRAM, Effect.ENDS_LAUNCH_INDEX) or call.name == "report_intersection"
