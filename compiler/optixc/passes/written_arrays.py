"""Which arrays of launch parameters and SBT records a pipeline may write: a read-only numpy array there is refused before a launch.

Arrays are views that may be bound to locals, passed to helpers and callables inside of structs, and returned. What a local may be bound
to is followed without looking at the order of statements, so an array counts as written if some path through the program writes it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from optixc.ir.intrinsic_rows import ATOMIC_NAMES
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
class WrittenArray:
    """An array that some statement may write; `path` begins with `params`, `record PROGRAM` or `struct NAME`."""

    path: Path
    span: Span


def written_arrays(pipeline: Pipeline) -> tuple[WrittenArray, ...]:
    """The arrays, each once with the first place that writes it."""
    search = _Search(pipeline)
    search.collect()
    found: dict[Path, Span] = {}
    for path, span in search.writes:
        for root in sorted(search.roots(path, frozenset())):
            found.setdefault(root, span)
    return tuple(WrittenArray(path, span) for path, span in found.items())


@dataclass
class _Search:
    pipeline: Pipeline
    bindings: dict[Path, set[Path]] = field(default_factory=dict)
    writes: list[tuple[Path, Span]] = field(default_factory=list)

    def collect(self) -> None:
        """Notes what is bound to what, and what is written."""
        functions = {function.name: function for function in (*self.pipeline.programs, *self.pipeline.helpers)}
        for function in functions.values():
            for parameter in function.parameters:
                if parameter.role is ParameterRole.RECORD:
                    self._bind(_local(function, parameter.local.name), [(f"record {function.name}",)])
            for expression in expressions(function.body):
                if isinstance(expression, HelperCall):
                    self._pass(function, functions[expression.function], expression.arguments)
            for statement in statements(function.body):
                self._statement(function, statement, functions)

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
            case CallIntrinsic(name=name, arguments=arguments, span=span) if name in ATOMIC_NAMES:
                self._write(function, arguments[0], span)
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
        self.writes += [(path, span) for path in self._paths(function, place.array)]

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
