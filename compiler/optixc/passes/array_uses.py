"""Which arrays of launch parameters and SBT records a pipeline may read or write: a launch refuses None there, and read-only numpy
arrays where they are written.

Arrays are views that may be bound to locals, passed to helpers and callables inside of structs, and returned. What a local may be bound
to is followed without looking at the order of statements, so an array counts as used if some path through the program uses it. Reading
its shape is no use: that of no array is zero.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from optixc.ir.intrinsic_rows import ATOMIC_NAMES
from optixc.ir.intrinsic_rows_coop_vec import MEMORY_ARGUMENTS
from optixc.ir.nodes import (
    Assign,
    CallCallable,
    CallHelper,
    CallIntrinsic,
    ComponentRef,
    Construct,
    Convert,
    ElementRef,
    Expr,
    FieldRef,
    Function,
    HelperCall,
    IndexRef,
    IntrinsicCall,
    LocalRef,
    ParameterRole,
    ParamsRef,
    Pipeline,
    Return,
    Select,
    Stmt,
    Trace,
    TupleItem,
)
from optixc.ir.types import Array, FixedArray, Struct, Tuple, Type
from optixc.ir.walk import expressions, statements
from optixc.passes.callables import callables_with, signature_of_call
from optixc.source import Span

PARAMS = "params"
ELEMENT = "[]"

Path = tuple[str, ...]
"""A root and the fields below it: `params`, `record PROGRAM`, `struct NAME` (a record of unknown place), `local FUNCTION.NAME`,
`result FUNCTION`. `[]` stands for any element."""


@dataclass(frozen=True)
class ArrayUse:
    """An array whose elements some program may read or write; `path` begins with `params`, `record PROGRAM` or `struct NAME`.

    `used` and `written` are the first places that do so, `written` None for an array that is only read.
    """

    path: Path
    used: Span
    written: Span | None


def array_uses(pipeline: Pipeline) -> tuple[ArrayUse, ...]:
    """The arrays that are used, each once."""
    search = _Search(pipeline)
    search.collect()
    used, written = search.at_roots(search.uses), search.at_roots(search.writes)
    return tuple(ArrayUse(path, span, written.get(path)) for path, span in used.items())


@dataclass
class _Search:
    pipeline: Pipeline
    bindings: dict[Path, set[Path]] = field(default_factory=dict)
    uses: dict[Path, Span] = field(default_factory=dict)
    writes: dict[Path, Span] = field(default_factory=dict)

    def collect(self) -> None:
        """Notes what is bound to what, what is used and what is written."""
        functions = {function.name: function for function in (*self.pipeline.programs, *self.pipeline.helpers)}
        for function in functions.values():
            for parameter in function.parameters:
                if parameter.role is ParameterRole.RECORD:
                    self._bind(_local(function, parameter.local.name), [(f"record {function.name}",)])
            for expression in expressions(function.body):
                self._expression(function, expression, functions)
            for statement in statements(function.body):
                self._statement(function, statement, functions)

    def _expression(self, function: Function, expression: Expr, functions: dict[str, Function]) -> None:
        match expression:
            case HelperCall(function=name, arguments=arguments):
                self._pass(function, functions[name], arguments)
            case ElementRef(array=array, span=span):
                self._note(self.uses, function, array, span)
            case IntrinsicCall(arguments=arguments, span=span):
                self._use_whole(function, arguments, span)
            case _:
                pass

    def _use_whole(self, function: Function, arguments: tuple[Expr, ...], span: Span) -> None:
        """Device functions that take an array look at its elements."""
        for argument in arguments:
            if isinstance(argument.type, Array):
                self._note(self.uses, function, argument, span)

    def _note(self, target: dict[Path, Span], function: Function, array: Expr, span: Span) -> None:
        for path in self._paths(function, array):
            target.setdefault(path, span)

    def _statement(self, function: Function, statement: Stmt, functions: dict[str, Function]) -> None:
        match statement:
            case Assign(target=target, value=value, span=span):
                self._write(function, target, span)
                if _holds_arrays(value.type):
                    for place in self._paths(function, target):
                        self._bind_value(function, place, value)
            case Return(value=value) if value is not None and _holds_arrays(value.type):
                self._bind_value(function, (f"result {function.name}",), value)
            case CallHelper(target=local, function=name, arguments=arguments, span=span):
                callee = functions[name]
                self._pass(function, callee, arguments)
                for parameter, argument in zip(callee.parameters, arguments, strict=True):
                    if parameter.written:
                        self._write(function, argument, span)
                if local is not None and _holds_arrays(local.type):
                    self._bind(_local(function, local.name), [(f"result {name}",)])
            case CallCallable():
                for program in callables_with(self.pipeline, signature_of_call(statement)):
                    self._pass(function, program, statement.arguments)
                    if statement.target is not None and _holds_arrays(statement.target.type):
                        self._bind(_local(function, statement.target.name), [(f"result {program.name}",)])
            case CallIntrinsic(name=name, arguments=arguments, span=span):
                self._use_whole(function, arguments, span)
                if name in ATOMIC_NAMES:
                    self._write(function, arguments[0], span)
                elif name in MEMORY_ARGUMENTS:
                    self._note(self.writes, function, arguments[MEMORY_ARGUMENTS[name]], span)
            case Trace(payload=payload, span=span) if payload is not None:
                self._write(function, payload, span)
            case _:
                pass

    def _pass(self, caller: Function, callee: Function, arguments: tuple[Expr, ...]) -> None:
        """Arguments are bound to parameters, in order; a record's parameter is none of a call's."""
        parameters = [one for one in callee.parameters if callee.kind is None or one.role is not ParameterRole.RECORD]
        for parameter, argument in zip(parameters, arguments, strict=True):
            if _holds_arrays(argument.type):
                self._bind_value(caller, _local(callee, parameter.local.name), argument)

    def _bind_value(self, function: Function, place: Path, value: Expr) -> None:
        """A struct or tuple that is made on the spot is bound field by field."""
        if isinstance(value, Construct):
            names = [one.name for one in value.type.fields] if isinstance(value.type, Struct) else None
            for number, argument in enumerate(value.arguments):
                if _holds_arrays(argument.type):
                    step = names[number] if names is not None else str(number) if isinstance(value.type, Tuple) else ELEMENT
                    self._bind_value(function, (*place, step), argument)
            return
        self._bind(place, self._paths(function, value))

    def _bind(self, place: Path, sources: Iterator[Path] | list[Path]) -> None:
        self.bindings.setdefault(place, set()).update(source for source in sources if source != place)

    def _write(self, function: Function, place: Expr, span: Span) -> None:
        """A store goes into the array nearest to it; one into a local goes into none."""
        while not isinstance(place, ElementRef):
            if not isinstance(place, FieldRef | ComponentRef | IndexRef | TupleItem):
                return
            place = place.base
        self._note(self.writes, function, place.array, span)

    def _paths(self, function: Function, expression: Expr) -> Iterator[Path]:
        """What an expression that holds or is an array may be."""
        match expression:
            case ParamsRef():
                yield (PARAMS,)
            case LocalRef(local=local):
                yield _local(function, local.name)
            case FieldRef(base=base, name=name):
                yield from ((*path, name) for path in self._paths(function, base))
            case TupleItem(base=base, index=index):
                yield from ((*path, str(index)) for path in self._paths(function, base))
            case IndexRef(base=base):
                yield from ((*path, ELEMENT) for path in self._paths(function, base))
            case ElementRef(array=array):
                yield from ((*path, ELEMENT) for path in self._paths(function, array))
            case Select(if_true=if_true, if_false=if_false):
                yield from self._paths(function, if_true)
                yield from self._paths(function, if_false)
            case HelperCall(function=name):
                yield (f"result {name}",)
            case IntrinsicCall(type=Struct(name=name)):
                yield (f"struct {name}",)
            case Convert(operand=operand):
                yield from self._paths(function, operand)
            case _:
                return

    def at_roots(self, noted: dict[Path, Span]) -> dict[Path, Span]:
        """What was noted of views, at the arrays of parameters and records that they may be."""
        found: dict[Path, Span] = {}
        for path, span in noted.items():
            for root in sorted(self.roots(path, frozenset())):
                found.setdefault(root, span)
        return found

    def roots(self, path: Path, seen: frozenset[Path]) -> set[Path]:
        """The arrays in parameters and records that a path may lead to."""
        if path in seen:
            return set()
        if not path[0].startswith(("local ", "result ")):
            return {path}
        found: set[Path] = set()
        for length in range(1, len(path) + 1):
            for source in self.bindings.get(path[:length], ()):
                found |= self.roots((*source, *path[length:]), seen | {path})
        return found


def _local(function: Function, name: str) -> Path:
    return (f"local {function.name}.{name}",)


def _holds_arrays(type_: Type) -> bool:
    match type_:
        case Array():
            return True
        case Struct(fields=fields):
            return any(_holds_arrays(one.type) for one in fields)
        case FixedArray(element=element):
            return _holds_arrays(element)
        case Tuple(items=items):
            return any(_holds_arrays(item) for item in items)
        case _:
            return False
