"""Checks the typing rules that the IR's nodes state: what `lower` and every pass promise to keep.

It takes a module or a linked pipeline and returns one sentence for each broken rule, none if all hold. A sentence is about a fault of
ours, never of the author; tests demand an empty list after each pass.
"""

from __future__ import annotations

from collections.abc import Iterator

from optixc.ir.intrinsic_rows import INTRINSICS
from optixc.ir.intrinsics import Effect
from optixc.ir.nodes import (
    ArrayShape,
    Assert,
    Assign,
    Binary,
    BinaryOp,
    Break,
    CallCallable,
    CallHelper,
    CallIntrinsic,
    ComponentRef,
    Construct,
    Continue,
    Convert,
    ElementRef,
    Expr,
    FieldRef,
    ForRange,
    Function,
    HelperCall,
    If,
    IndexRef,
    IntrinsicCall,
    Literal,
    Local,
    LocalRef,
    Logical,
    Module,
    ParamsRef,
    Pipeline,
    Return,
    Select,
    Stmt,
    Trace,
    TupleItem,
    Unary,
    UnaryOp,
    While,
)
from optixc.ir.types import (
    BOOL,
    UINT64,
    VOID,
    Array,
    CoopVec,
    FixedArray,
    Matrix,
    Scalar,
    ScalarKind,
    Struct,
    Texture,
    Traversable,
    Tuple,
    Type,
    Vector,
    scalar_of,
)
from optixc.ir.walk import operands, statements, subexpressions

_COMPARISONS = frozenset(
    {BinaryOp.EQUAL, BinaryOp.NOT_EQUAL, BinaryOp.LESS, BinaryOp.LESS_EQUAL, BinaryOp.GREATER, BinaryOp.GREATER_EQUAL}
)
_SHIFTS = frozenset({BinaryOp.SHIFT_LEFT, BinaryOp.SHIFT_RIGHT})


def verify(module: Module | Pipeline) -> list[str]:
    """One sentence for each rule that the module breaks."""
    helpers = {helper.name: helper for helper in module.helpers}
    problems = [] if len(helpers) == len(module.helpers) else ["two helpers share a name"]
    for function in (*module.helpers, *module.programs):
        problems += [f"{function.name}: {problem}" for problem in _function(function, helpers, module.params)]
    return problems


def _function(function: Function, helpers: dict[str, Function], params: Struct | None) -> Iterator[str]:
    known = {parameter.local for parameter in function.parameters} | set(function.locals)
    names = [local.name for local in known]
    if len(set(names)) != len(names):
        yield "two locals share a name"
    for statement in statements(function.body):
        yield from _statement(statement, function, helpers)
        for local in _locals_of(statement):
            if local not in known:
                yield f"local {local.name} is not declared"
        for operand in operands(statement):
            for expression in subexpressions(operand):
                yield from _expression(expression, helpers, params)
    yield from _loop_exits(function.body, in_loop=False)


def _locals_of(statement: Stmt) -> Iterator[Local]:
    for operand in operands(statement):
        yield from (part.local for part in subexpressions(operand) if isinstance(part, LocalRef))
    match statement:
        case ForRange():
            yield statement.target
        case CallHelper() | CallIntrinsic() | CallCallable() if statement.target is not None:
            yield statement.target
        case _:
            pass


def _loop_exits(body: tuple[Stmt, ...], in_loop: bool) -> Iterator[str]:
    for statement in body:
        match statement:
            case Break() | Continue() if not in_loop:
                yield "break or continue outside a loop"
            case If():
                yield from _loop_exits(statement.then_body, in_loop)
                yield from _loop_exits(statement.else_body, in_loop)
            case While():
                yield from _loop_exits(statement.condition_body, in_loop=False)
                yield from _loop_exits(statement.body, in_loop=True)
            case ForRange():
                yield from _loop_exits(statement.body, in_loop=True)
            case _:
                pass


def _statement(statement: Stmt, function: Function, helpers: dict[str, Function]) -> Iterator[str]:
    match statement:
        case Assign():
            if not _is_place(statement.target):
                yield f"assignment to something that is no place: {type(statement.target).__name__}"
            if _widened(statement.target.type) != _widened(statement.value.type):
                yield f"assignment of {statement.value.type} to {statement.target.type} in line {statement.span.line}"
        case If() | While() | Assert():
            if statement.condition.type != BOOL:
                yield f"condition of type {statement.condition.type} in line {statement.span.line}"
        case ForRange():
            types = {statement.target.type, statement.start.type, statement.stop.type, statement.step.type}
            if len(types) != 1 or not _is_integer(statement.target.type):
                yield f"range over mixed types in line {statement.span.line}"
        case Return():
            value = VOID if statement.value is None else statement.value.type
            if value != function.result:
                yield f"return of {value} where {function.result} is due in line {statement.span.line}"
        case CallHelper():
            yield from _call(statement.function, statement.arguments, helpers)
        case CallIntrinsic():
            row = INTRINSICS.get(statement.name)
            if row is None or row.effect is Effect.PURE:
                yield f"{statement.name} is called as a statement but the table has no such row with an effect"
        case Trace():
            if len(statement.arguments) != (0 if statement.name == "invoke" else 11):
                yield f"{statement.name} with {len(statement.arguments)} arguments in line {statement.span.line}"
            if statement.payload is not None and statement.payload.type != statement.payload_type:
                yield f"{statement.name} with a payload of another type in line {statement.span.line}"
        case _:
            pass


def _call(name: str, arguments: tuple[Expr, ...], helpers: dict[str, Function]) -> Iterator[str]:
    helper = helpers.get(name)
    if helper is None:
        yield f"call of unknown helper {name}"
    elif len(arguments) != len(helper.parameters):
        yield f"call of {name} with {len(arguments)} arguments instead of {len(helper.parameters)}"
    else:
        for argument, parameter in zip(arguments, helper.parameters, strict=True):
            if argument.type != parameter.local.type:
                yield f"call of {name}: {parameter.local.name} is {parameter.local.type}, not {argument.type}"
            if parameter.written and parameter.local.by_reference and not _is_place(argument):
                yield f"call of {name}: {parameter.local.name} is written, so its argument must be a place"


def _is_place(expression: Expr) -> bool:
    while isinstance(expression, FieldRef | ComponentRef | IndexRef):
        expression = expression.base
    return isinstance(expression, LocalRef | ElementRef)


def _expression(expression: Expr, helpers: dict[str, Function], params: Struct | None) -> Iterator[str]:
    match expression:
        case Literal():
            yield from _literal(expression)
        case ParamsRef():
            if expression.type != params:
                yield "launch parameters of another type than the module's"
        case FieldRef():
            base = expression.base.type
            field = base.field(expression.name) if isinstance(base, Struct) else None
            if field is None or field.type != expression.type:
                yield f"field {expression.name} of {base} is not {expression.type}"
        case ComponentRef():
            yield from _component(expression)
        case IndexRef() | TupleItem() | ElementRef() | ArrayShape():
            yield from _item(expression)
        case Unary():
            if expression.operand.type != expression.type or (expression.op is UnaryOp.NOT and expression.type != BOOL):
                yield f"{expression.op.value} of {expression.operand.type} gives {expression.type}"
        case Binary():
            yield from _binary(expression)
        case Logical():
            if {expression.left.type, expression.right.type, expression.type} != {BOOL}:
                yield "and/or of something that is not bool"
        case Select():
            if expression.condition.type != BOOL or {expression.if_true.type, expression.if_false.type} != {expression.type}:
                yield f"conditional expression of {expression.if_true.type} and {expression.if_false.type} is {expression.type}"
        case Convert():
            is_handle = isinstance(expression.type, Traversable | Texture) and expression.operand.type == UINT64
            if not is_handle and (scalar_of(expression.operand.type) is None or scalar_of(expression.type) is None):
                yield f"conversion of {expression.operand.type} to {expression.type}"
        case Construct():
            yield from _construct(expression)
        case IntrinsicCall():
            row = INTRINSICS.get(expression.name)
            if row is None or row.effect is not Effect.PURE:
                yield f"{expression.name} stands in an expression but the table has no such pure row"
        case HelperCall():
            yield from _call(expression.function, expression.arguments, helpers)
        case _:
            pass


def _literal(literal: Literal) -> Iterator[str]:
    size = literal.type.size if isinstance(literal.type, Vector) else 1
    values = literal.value if isinstance(literal.value, tuple) else (literal.value,)
    if isinstance(literal.value, tuple) != isinstance(literal.type, Vector) or len(values) != size:
        yield f"literal of {len(values)} values is {literal.type}"
    if scalar_of(literal.type) is None:
        yield f"literal of type {literal.type}"


def _component(reference: ComponentRef) -> Iterator[str]:
    base, count = reference.base.type, len(reference.components)
    if not isinstance(base, Vector) or max(reference.components) >= base.size:
        yield f"component of {base}"
    elif reference.type != (base.element if count == 1 else Vector(base.element, count)):
        yield f"{count} components of {base} are {reference.type}"


def _item(expression: IndexRef | TupleItem | ElementRef | ArrayShape) -> Iterator[str]:
    match expression:
        case IndexRef():
            if _item_type(expression.base.type) != expression.type or not _is_integer(expression.index.type):
                yield f"item of {expression.base.type} is {expression.type}"
        case TupleItem():
            base = expression.base.type
            items = base.items if isinstance(base, Tuple) else ()
            if not 0 <= expression.index < len(items) or items[expression.index] != expression.type:
                yield f"item {expression.index} of {base} is {expression.type}"
        case ElementRef():
            array = expression.array.type
            if not isinstance(array, Array) or array.element != expression.type or len(expression.indices) != array.rank:
                yield f"element of {array} is {expression.type} in line {expression.span.line}"
        case ArrayShape():
            array = expression.array.type
            if not isinstance(array, Array) or not 0 <= expression.axis < array.rank:
                yield f"shape of {array}, axis {expression.axis}"


def _item_type(base: Type) -> Type | None:
    match base:
        case FixedArray() | CoopVec():
            return base.element
        case Vector():
            return base.element
        case Matrix():
            return Vector(Scalar(ScalarKind.FLOAT, 32), base.columns)
        case _:
            return None


def _binary(binary: Binary) -> Iterator[str]:
    left, right, result = _widened(binary.left.type), _widened(binary.right.type), _widened(binary.type)
    sentence = f"{left} {binary.op.value} {right} gives {result} in line {binary.span.line}"
    if binary.op in _COMPARISONS:
        if left != right or result != BOOL:
            yield sentence
    elif binary.op is BinaryOp.MATRIX_MULTIPLY:
        if not isinstance(left, Matrix):
            yield sentence
    elif binary.op in _SHIFTS:
        if left != result:
            yield sentence
    elif result not in (left, right) or scalar_of(left) != scalar_of(right) or not {left, right} <= {result, scalar_of(result)}:
        yield sentence


def _construct(construct: Construct) -> Iterator[str]:
    match construct.type:
        case Vector():
            given = sum(part.type.size if isinstance(part.type, Vector) else 1 for part in construct.arguments)
            if given != construct.type.size:
                yield f"{construct.type} made of {given} numbers"
        case Struct():
            if [_widened(part.type) for part in construct.arguments] != [_widened(field.type) for field in construct.type.fields]:
                yield f"{construct.type} made of {', '.join(str(part.type) for part in construct.arguments)}"
        case Tuple():
            if tuple(part.type for part in construct.arguments) != construct.type.items:
                yield f"{construct.type} made of other types"
        case FixedArray():
            if len(construct.arguments) not in (0, construct.type.size):
                yield f"{construct.type} made of {len(construct.arguments)} elements"
        case CoopVec():
            if len(construct.arguments) not in (0, 1, construct.type.size):
                yield f"{construct.type} made of {len(construct.arguments)} elements"
        case Matrix():
            pass
        case _:
            yield f"construction of {construct.type}"


def _is_integer(type_: Type) -> bool:
    return isinstance(type_, Scalar) and type_.kind in (ScalarKind.INT, ScalarKind.UINT)


def _widened(type_: Type) -> Type:
    """The type with storage scalars replaced by what reading them gives."""
    match type_:
        case Scalar() if type_.kind is not ScalarKind.BOOL and type_.bits < 32:
            return Scalar(type_.kind, 32)
        case Vector():
            element = _widened(type_.element)
            return Vector(element, type_.size) if isinstance(element, Scalar) else type_
        case _:
            return type_
