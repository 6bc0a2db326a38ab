"""What checked builds look at: the values that a failing assertion shows, and floats that became NaN, on request.

NaN traps look where a float gets a name, goes on or decides: assignments, stores to memory, results of functions and callables, arguments
of traces, conditions.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from dataclasses import replace

from optixc.ir.nodes import (
    ArrayShape,
    Assert,
    Assign,
    Binary,
    BinaryOp,
    CallCallable,
    ComponentRef,
    Convert,
    ElementRef,
    Expr,
    FieldRef,
    Function,
    If,
    Literal,
    Local,
    LocalRef,
    Logical,
    ParamsRef,
    Pipeline,
    Return,
    Stmt,
    Trace,
    Unary,
    UnaryOp,
    While,
)
from optixc.ir.types import BOOL, FixedArray, Matrix, Scalar, ScalarKind, Struct, Type, Vector
from optixc.ir.walk import Body, map_blocks, operands, place_root
from optixc.source import Span

MAX_VALUES = 8
_COMPARISONS = frozenset({BinaryOp.EQUAL, BinaryOp.NOT_EQUAL, BinaryOp.LESS, BinaryOp.LESS_EQUAL, BinaryOp.GREATER, BinaryOp.GREATER_EQUAL})
_PLAIN = frozenset({BinaryOp.ADD, BinaryOp.SUBTRACT, BinaryOp.MULTIPLY})


def explain_assertions(pipeline: Pipeline) -> Pipeline:
    """Assertions of checked builds know the values that their condition compares."""
    if not (pipeline.options.debug or pipeline.options.validation):
        return pipeline

    def of_body(body: Body) -> Body:
        return tuple(of_statement(statement) for statement in body)

    def of_statement(statement: Stmt) -> Stmt:
        if isinstance(statement, Assert):
            return replace(statement, values=_unique(_compared(statement.condition)))
        return map_blocks(statement, of_body)

    return _with_bodies(pipeline, lambda function: replace(function, body=of_body(function.body)))


def trap_nans(pipeline: Pipeline) -> Pipeline:
    """The pipeline with an assertion behind each statement that may make a NaN."""
    if not pipeline.options.trap_nan:
        return pipeline
    return _with_bodies(pipeline, lambda function: _Traps(function).function())


def _with_bodies(pipeline: Pipeline, change: Callable[[Function], Function]) -> Pipeline:
    return replace(pipeline, helpers=tuple(map(change, pipeline.helpers)), programs=tuple(map(change, pipeline.programs)))


class _Traps:
    """Puts the traps into one function; values that have no name get one."""

    def __init__(self, function: Function) -> None:
        self._function = function
        self._taken = {local.name for local in function.locals} | {parameter.local.name for parameter in function.parameters}
        self._made: list[Local] = []

    def function(self) -> Function:
        """The function with its traps."""
        body = self._body(self._function.body)
        return replace(self._function, body=body, locals=(*self._function.locals, *self._made))

    def _body(self, body: Body) -> Body:
        return tuple(inner for statement in body for inner in self._statement(map_blocks(statement, self._body)))

    def _statement(self, statement: Stmt) -> Iterator[Stmt]:
        match statement:
            case Assign(target=target, value=value, span=span) if _can_be_nan(value):
                # What memory or a smaller type makes of the value is not what is looked at.
                if place_root(target) is not None and target.type == value.type:
                    yield statement
                    yield from _trap(target, f"{author_text(target)} is NaN", value, span)
                else:
                    named = yield from self._name(value, f"{author_text(target)} is NaN", span)
                    yield replace(statement, value=named)
            case Return(value=value, span=span) if value is not None and _can_be_nan(value):
                named = yield from self._name(value, f"the result of {self._function.source_name} is NaN", span)
                yield replace(statement, value=named)
            case Trace(arguments=arguments, span=span):
                checked = []
                for argument, name in zip(arguments, ("handle", "origin", "direction", "tmin", "tmax", "ray_time"), strict=False):
                    if _can_be_nan(argument):
                        argument = yield from self._name(argument, f"{name} of {statement.name} is NaN", span)
                    checked.append(argument)
                yield replace(statement, arguments=(*checked, *arguments[len(checked) :]))
            case If(condition=condition, span=span):
                yield from _trap_condition(condition, span)
                yield statement
            case While(condition_body=before, condition=condition, span=span):
                yield replace(statement, condition_body=(*before, *_trap_condition(condition, span)))
            case CallCallable(target=Local() as target, is_direct=is_direct, span=span) if _is_float(target.type):
                yield statement
                name = "direct_call" if is_direct else "continuation_call"
                yield from _trap(LocalRef(target), f"the result of {name} is NaN", statement.index, span)
            case _:
                yield statement

    def _name(self, value: Expr, message: str, span: Span) -> Generator[Stmt, None, Expr]:
        """Gives a value a name and traps it; the generator's own value is the reference to it."""
        name, number = "value", 2
        while name in self._taken:
            name, number = f"value_{number}", number + 1
        self._taken.add(name)
        local = Local(name, value.type)
        self._made.append(local)
        yield Assign(LocalRef(local), value, span)
        yield from _trap(LocalRef(local), message, value, span)
        return LocalRef(local)


def _trap(place: Expr, message: str, value: Expr, span: Span) -> Iterator[Stmt]:
    # A number equals itself; vectors are equal where all components are.
    condition = Binary(BinaryOp.EQUAL, place, place, BOOL, span)
    yield Assert(condition, message, span, _unique(_simple_parts(value)))


def _trap_condition(condition: Expr, span: Span) -> Iterator[Stmt]:
    """Traps of the floats that a condition compares in any case; what `and` and `or` may leave out is not looked at."""
    for side in _first_compared(condition):
        yield from _trap(side, f"{author_text(side)} in a condition is NaN", side, span)


def _first_compared(condition: Expr) -> Iterator[Expr]:
    match condition:
        case Logical(left=left):
            yield from _first_compared(left)
        case Unary(op=UnaryOp.NOT, operand=operand):
            yield from _first_compared(operand)
        case Binary(op=op, left=left, right=right) if op in _COMPARISONS:
            yield from (side for side in (left, right) if _can_be_nan(side))


def _can_be_nan(value: Expr) -> bool:
    """Whether it is a float scalar or vector that is computed: names and literals are no news."""
    return not isinstance(value, Literal | LocalRef) and _is_float(value.type)


def _is_float(type_: Type) -> bool:
    match type_:
        case Scalar(kind=kind):
            return kind is ScalarKind.FLOAT
        case Vector(element=element):
            return element.kind is ScalarKind.FLOAT
        case _:
            return False


def _compared(condition: Expr) -> Iterator[Expr]:
    """The numbers that decide a condition, without literals."""
    match condition:
        case Logical(left=left, right=right):
            yield from _compared(left)
            yield from _compared(right)
        case Unary(op=UnaryOp.NOT, operand=operand):
            yield from _compared(operand)
        case Binary(op=op, left=left, right=right) if op in _COMPARISONS:
            for side in (left, right):
                yield from (side,) if _is_simple(side) and _is_number_type(side.type) else _simple_parts(side)
        case _:
            yield from _simple_parts(condition)


def _simple_parts(expression: Expr) -> Iterator[Expr]:
    """The named numbers in an expression: locals, launch parameters, their fields."""
    if isinstance(expression, LocalRef | FieldRef | ComponentRef | ArrayShape) and _is_simple(expression):
        if _is_number_type(expression.type):
            yield expression
        return
    for operand in operands(expression):
        yield from _simple_parts(operand)


def _is_simple(expression: Expr) -> bool:
    """Whether looking at it again costs little and cannot fail: no memory, no division, no calls."""
    match expression:
        case Literal() | LocalRef() | ParamsRef():
            return True
        case Binary(op=op):
            return op in _PLAIN and all(_is_simple(part) for part in operands(expression))
        case FieldRef() | ComponentRef() | ArrayShape() | Convert() | Unary():
            return all(_is_simple(part) for part in operands(expression))
        case _:
            return False


def _is_number_type(type_: Type) -> bool:
    return isinstance(type_, Vector) or (isinstance(type_, Scalar) and type_.kind is not ScalarKind.BOOL)


def _unique(expressions: Iterator[Expr]) -> tuple[Expr, ...]:
    """Each once, vectors by components, no literals, and no more than a message has room for."""
    found: dict[str, Expr] = {}
    for expression in expressions:
        if isinstance(expression, Literal):
            continue
        match expression.type:
            case Vector(element=element, size=size):
                parts: list[Expr] = [ComponentRef(expression, (index,), element) for index in range(size)]
            case Struct() | FixedArray() | Matrix():
                parts = []
            case _:
                parts = [expression]
        for part in parts:
            found.setdefault(author_text(part), part)
    return tuple(found.values())[:MAX_VALUES]


def author_text(expression: Expr) -> str:
    """A simple expression as its author would write it."""
    match expression:
        case LocalRef(local=local):
            return local.name
        case ParamsRef():
            return "params"
        case FieldRef(base=base, name=name):
            return f"{author_text(base)}.{name}"
        case ComponentRef(base=base, components=components):
            letters = "".join("xyzw"[index] for index in components)
            inner = author_text(base)
            return f"({inner}).{letters}" if isinstance(base, Binary | Unary) else f"{inner}.{letters}"
        case ArrayShape(array=array, axis=axis):
            return f"{author_text(array)}.shape[{axis}]"
        case ElementRef(array=array):
            return f"an element of {author_text(array)}"
        case Literal(value=value):
            return str(value)
        case Convert(operand=operand):
            return author_text(operand)
        case Unary(op=op, operand=operand):
            return f"{op.value}{_operand_text(operand, None)}"
        case Binary(op=op, left=left, right=right):
            return f"{_operand_text(left, op)} {op.value} {_operand_text(right, None)}"
        case _:
            return "a value"


def _operand_text(operand: Expr, same: BinaryOp | None) -> str:
    """In parentheses where it is an operation itself, other than the one before."""
    text = author_text(operand)
    return f"({text})" if isinstance(operand, Binary) and operand.op is not same else text
