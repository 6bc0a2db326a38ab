"""Calls in IR: constructors and pure functions are expressions, everything that can write becomes a statement."""

from __future__ import annotations

import ast
from functools import partial

from optixc.frontend.checked import (
    Argument,
    AtomicUse,
    CallableUse,
    ConstructUse,
    ConvertUse,
    CoopVecUse,
    CopyUse,
    DefaultArgument,
    DefaultExpression,
    HelperUse,
    IntrinsicUse,
    ReportUse,
    SbtDataUse,
    ShapeUse,
    TraceUse,
)
from optixc.frontend.lower_block import Block, FunctionLowering, literal
from optixc.frontend.lower_convert import component, convert, is_simple, narrow, numbers_of
from optixc.frontend.lower_place import lower_place_of
from optixc.frontend.weak import widened
from optixc.ir import types as t
from optixc.ir.intrinsics import Effect
from optixc.ir.nodes import (
    ArrayShape,
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
    HelperCall,
    IndexRef,
    IntrinsicCall,
    Literal,
    Local,
    LocalRef,
    ParameterRole,
    ParamsRef,
    Trace,
    TupleItem,
    is_reference_type,
)

_STEMS = {"report_intersection": "accepted", "coop_vec_mat_mul": "product", "coop_vec_load": "loaded"}
"""What the temporaries of statements are called."""

NOTHING = Construct(t.Tuple(()), ())
"""What a call without result gives as an expression; no one uses it."""


def lower_call(low: FunctionLowering, node: ast.Call, block: Block) -> Expr:
    """A call as a value."""
    info = low.info(node)
    match info.use:
        case ConvertUse(argument=argument, target=target):
            return _convert(low, node, argument, target, block)
        case ConstructUse():
            return _construct(low, node, info.use, block)
        case ShapeUse(array=array, axis=axis):
            return ArrayShape(low.expression(low, array, block), axis or 0, t.INT32)
        case CopyUse(argument=argument):
            value = low.expression(low, argument, block)
            return low.keep(value, block, low.span(node), "copy") if is_reference_type(value.type) else value
        case SbtDataUse(struct=struct, row=row):
            if row is not None:
                return IntrinsicCall(row.name, (), struct, low.span(node))
            return LocalRef(low.records[struct])
        case IntrinsicUse(row=row) if row.name == "set_payload_types":
            # A statement for the checker: which trace can run the program follows from payload classes and words.
            return NOTHING
        case IntrinsicUse():
            return _intrinsic(low, node, info.use, block)
        case CoopVecUse():
            return _coop_vec(low, node, info.use, block)
        case AtomicUse():
            return _atomic(low, node, info.use, block)
        case ReportUse(row=row, arguments=arguments):
            values = _in_source_order(low, node, arguments, block)
            return _effect(low, node, row.name, values, t.VOID if row.effect is Effect.ENDS_LAUNCH_INDEX else t.BOOL, block)
        case TraceUse():
            return _trace(low, node, info.use, block)
        case CallableUse():
            return _callable(low, node, info.use, block)
        case HelperUse():
            return _helper(low, node, info.use, block)
    raise AssertionError(f"unresolved call {ast.unparse(node)}")


def _argument(low: FunctionLowering, argument: Argument, block: Block) -> Expr:
    match argument:
        case DefaultArgument(value=value, type=type_):
            return _default(value, type_)
        case DefaultExpression(node=node, body=body):
            return low.expression(low.within(body), node, block)
        case _:
            return low.expression(low, argument, block)


def _default(value: bool | int | float, type_: t.Type) -> Expr:
    assert isinstance(type_, t.Scalar)
    return literal(value, type_)


def _in_source_order(
    low: FunctionLowering, node: ast.Call, arguments: tuple[Argument, ...], block: Block, places: frozenset[ast.expr] = frozenset()
) -> list[Expr]:
    """The values of arguments in parameter order, evaluated in the order of the source. `places` are passed by reference."""
    written = [*node.args, *(keyword.value for keyword in node.keywords)]
    given = [argument for argument in arguments if isinstance(argument, ast.expr)]
    nodes = sorted(given, key=written.index)
    parts = [partial(lower_place_of, low, item) if item in places else partial(low.expression, low, item) for item in nodes]
    numbers = [position for position, item in enumerate(nodes) if item in places]
    values = dict(zip(nodes, low.in_order_by(parts, block, nodes, places=numbers), strict=True))
    return [values[item] if isinstance(item, ast.expr) else _argument(low, item, block) for item in arguments]


def _convert(low: FunctionLowering, node: ast.Call, argument: Argument, target: t.Scalar, block: Block) -> Expr:
    value = _argument(low, argument, block)
    if widened(target) == target:
        return convert(value, target, low.span(node))
    return narrow(value, target)


def _construct(low: FunctionLowering, node: ast.Call, use: ConstructUse, block: Block) -> Expr:
    values = _in_source_order(low, node, use.arguments, block)
    target = use.target
    match target:
        case t.Vector():
            return _construct_vector(low, node, target, values, use.spread, block)
        case t.FixedArray() | t.Struct() | t.CoopVec():
            return Construct(target, tuple(values))
        case t.Matrix():
            return Construct(target, tuple(values))
        case t.Traversable() | t.Texture():
            return Convert(values[0], target)
    raise AssertionError(f"no constructor of {target}")


def _construct_vector(low: FunctionLowering, node: ast.Call, target: t.Vector, values: list[Expr], spread: bool, block: Block) -> Expr:
    """A vector from numbers and vectors; storage vectors keep what their element type holds."""
    result = widened(target)
    assert isinstance(result, t.Vector)
    span = low.span(node)
    if spread:
        value = values[0]
        if isinstance(value.type, t.Scalar):
            number = _element(value, target.element, low, node)
            return convert(number, result, span)
        assert isinstance(value.type, t.Vector)
        if value.type.size > target.size:
            value = ComponentRef(value, tuple(range(target.size)), t.Vector(value.type.element, target.size))
        if result == target:
            return convert(value, result, span)
        kept = value if is_simple(value) else low.keep(value, block, span, "vector")
        return Construct(result, tuple(_element(component(kept, i), target.element, low, node) for i in range(target.size)))
    parts: list[Expr] = []
    for value in values:
        if isinstance(value.type, t.Vector) and result == target:
            parts.append(convert(value, t.Vector(result.element, value.type.size), span))
        elif isinstance(value.type, t.Vector):
            kept = value if is_simple(value) else low.keep(value, block, span, "vector")
            parts += [_element(component(kept, i), target.element, low, node) for i in range(value.type.size)]
        else:
            parts.append(_element(value, target.element, low, node))
    numbers = [number for part in parts if isinstance(part, Literal) for number in numbers_of(part)]
    return Literal(tuple(numbers), result) if len(numbers) == result.size else Construct(result, tuple(parts))


def _element(value: Expr, element: t.Scalar, low: FunctionLowering, node: ast.AST) -> Expr:
    if widened(element) == element:
        return convert(value, element, low.span(node))
    return narrow(value, element)


def _intrinsic(low: FunctionLowering, node: ast.Call, use: IntrinsicUse, block: Block) -> Expr:
    values = _in_source_order(low, node, use.arguments, block)
    type_ = low.info(node).type
    assert isinstance(type_, t.Scalar | t.Vector | t.Matrix | t.Tuple | t.Traversable | t.Struct | t.FixedArray | t.Void)
    if use.row.effect is Effect.PURE:
        return IntrinsicCall(use.row.name, tuple(values), type_, low.span(node))
    return _effect(low, node, use.row.name, values, type_, block)


def _coop_vec(low: FunctionLowering, node: ast.Call, use: CoopVecUse, block: Block) -> Expr:
    """The constants of a product stand behind its values. Products and loads are statements: they are done once, before later stores."""
    values = _in_source_order(low, node, use.arguments, block)
    type_ = low.info(node).type
    assert isinstance(type_, t.CoopVec | t.Void)
    if use.row.effect is Effect.PURE:
        return IntrinsicCall(use.row.name, tuple(values), type_, low.span(node))
    return _effect(low, node, use.row.name, [*values, *(literal(one, t.INT32) for one in use.settings)], type_, block)


def _effect(low: FunctionLowering, node: ast.Call, name: str, values: list[Expr], type_: t.Type, block: Block) -> Expr:
    """A device function that does something: a statement, its result a temporary."""
    target = None if isinstance(type_, t.Void) else low.temporary(_STEMS.get(name, "result"), type_)
    block.emit(CallIntrinsic(target, name, tuple(values), low.span(node)))
    return NOTHING if target is None else LocalRef(target)


def _atomic(low: FunctionLowering, node: ast.Call, use: AtomicUse, block: Block) -> Expr:
    array, *rest = low.in_order([use.array, *use.indices, *use.values], block)
    indices, values = rest[: len(use.indices)], rest[len(use.indices) :]
    assert isinstance(array.type, t.Array)
    element = ElementRef(array, tuple(indices), array.type.element, low.span(node))
    target = low.temporary("before", array.type.element)
    block.emit(CallIntrinsic(target, use.row.name, (element, *values), low.span(node)))
    return LocalRef(target)


def _trace(low: FunctionLowering, node: ast.Call, use: TraceUse, block: Block) -> Expr:
    span = low.span(node)
    arguments = use.arguments
    if use.payload is None:
        values = _in_source_order(low, node, arguments, block)
        block.emit(Trace(use.name, tuple(values), None, None, span))
        return NOTHING
    if use.words is None:
        *values, place = _in_source_order(low, node, (*arguments, use.payload), block, frozenset({use.payload}))
        block.emit(Trace(use.name, tuple(values), place, use.payload_type, span))
        return NOTHING
    *values, words = _in_source_order(low, node, (*arguments, use.payload), block)
    struct = _words_struct(low, use.words)
    local = low.temporary("payload", struct)
    if not isinstance(words, Construct):
        words = low.keep(words, block, span, "words")
    items = tuple(tuple_item(words, index) for index in range(len(use.words)))
    block.emit(Assign(LocalRef(local), Construct(struct, items), span))
    block.emit(Trace(use.name, tuple(values), LocalRef(local), struct, span))
    results = tuple(FieldRef(LocalRef(local), field.name, field.type) for field in struct.fields)
    return Construct(t.Tuple(use.words), results)


def tuple_item(value: Expr, index: int) -> Expr:
    """Item `index` of a tuple; of a tuple just made, the item itself."""
    if isinstance(value, Construct):
        return value.arguments[index]
    assert isinstance(value.type, t.Tuple)
    return TupleItem(value, index, value.type.items[index])


def _words_struct(low: FunctionLowering, words: tuple[t.Type, ...]) -> t.Struct:
    """The payload struct that a tuple of words travels in; one per list of types."""
    name = "PayloadWords_" + "_".join(str(word) for word in words)
    struct = low.made_structs.get(name)
    if struct is None:
        fields = tuple(t.StructField(f"w{i}", word) for i, word in enumerate(words))
        struct = low.made_structs[name] = t.Struct(name, t.StructKind.PAYLOAD, fields)
    return struct


def _callable(low: FunctionLowering, node: ast.Call, use: CallableUse, block: Block) -> Expr:
    index, *arguments = low.in_order([use.index, *use.arguments], block)
    target = None if isinstance(use.result, t.Void) else low.temporary("result", use.result)
    block.emit(CallCallable(target, use.is_direct, index, tuple(arguments), use.result, low.span(node)))
    return NOTHING if target is None else LocalRef(target)


def _helper(low: FunctionLowering, node: ast.Call, use: HelperUse, block: Block) -> Expr:
    instance = use.instance
    references = frozenset(
        argument
        for argument, parameter in zip(use.arguments, instance.parameters, strict=True)
        if isinstance(argument, ast.expr) and is_reference_type(parameter.local.type)
    )
    values = _in_source_order(low, node, use.arguments, block, references)
    for position, parameter in enumerate(instance.parameters):
        if parameter.written and parameter.local.by_reference and not _can_be_written(low, values[position]):
            values[position] = low.keep(values[position], block, low.span(node), parameter.local.name)
    values += [LocalRef(low.records[struct]) for struct in low.records_needed(instance)]
    span = low.span(node)
    does_something = instance.writes or any(parameter.written for parameter in instance.parameters)
    if not does_something and not isinstance(instance.result, t.Void):
        return HelperCall(instance.name, tuple(values), instance.result, span)
    target: Local | None = None
    if not isinstance(instance.result, t.Void):
        target = low.temporary("result", instance.result)
    block.emit(CallHelper(target, instance.name, tuple(values), span))
    return NOTHING if target is None else LocalRef(target)


def _can_be_written(low: FunctionLowering, value: Expr) -> bool:
    """Whether a reference may name this place: a local, or a part of one; elements of arrays are read as values."""
    while isinstance(value, FieldRef | IndexRef):
        value = value.base
    if not isinstance(value, LocalRef):
        return False
    roles = {parameter.local: parameter.role for parameter in low.instance.parameters}
    return roles.get(value.local) not in (ParameterRole.RECORD, ParameterRole.ATTRIBUTES) and not isinstance(value, ParamsRef)
