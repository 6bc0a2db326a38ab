"""Calls of the checked tree: constructors and mathematics are operations, rays and records go to the machine."""

from __future__ import annotations

import ast
from collections.abc import Callable, Sequence
from typing import Any

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
from optixc.frontend.weak import default_type, widened
from optixc.interpret import coop_vec, functions, operations, values
from optixc.interpret.atomics import atomic
from optixc.interpret.code import Code, literal
from optixc.ir import types as t


def rewrite_call(code: Code, node: ast.Call) -> ast.expr:
    """A call as a Python expression."""
    info = code.info(node)
    machine = code.machine
    match info.use:
        case ConvertUse(argument=argument, target=target):
            return _in_order(code, node, _conversion(_argument_type(code, argument), target), (argument,), "convert_")
        case ConstructUse(target=target, arguments=arguments, spread=spread):
            sources = tuple(_argument_type(code, argument) for argument in arguments)
            return _in_order(code, node, operations.construct(target, sources, spread), arguments, f"make_{_plain(target)}")
        case ShapeUse(array=array, axis=axis):
            number = axis or 0
            return code.call(lambda value: value.shape[number], [code.expression(code, array)], node, "shape_")
        case CopyUse(argument=argument):
            return code.call(values.copy, [code.expression(code, argument)], node, "copy_")
        case SbtDataUse(struct=struct, row=row):
            read = machine.record if row is None else machine.hit_object_record
            return code.call(lambda: read(struct), [], node, "record_")
        case IntrinsicUse(row=row, arguments=arguments):
            types = tuple(_argument_type(code, argument) for argument in arguments)
            result = default_type(info.type)
            return _in_order(code, node, functions.function(machine, row, types, result), arguments, f"{row.name}_")
        case AtomicUse(row=row, array=array, indices=indices, values=given):
            type_ = code.type_of(array)
            assert isinstance(type_, t.Array) and isinstance(type_.element, t.Scalar)
            parts = [code.expression(code, part) for part in (array, *indices, *given)]
            return code.call(atomic(row.name, type_.element, len(indices)), parts, node, f"{row.name}_")
        case CoopVecUse(row=row, arguments=arguments):
            evaluate = coop_vec.function(info.use, default_type(info.type))
            return _in_order(code, node, evaluate, arguments, f"{row.name}_")
        case ReportUse(row=row, arguments=arguments):
            types = tuple(code.type_of(argument) for argument in arguments)
            perform = machine.report if row.name == "report_intersection" else machine.throw
            return _in_order(code, node, lambda *parts: perform(types, *parts), arguments, f"{row.name}_")
        case TraceUse():
            return _trace(code, node, info.use)
        case CallableUse(is_direct=is_direct, index=index, arguments=arguments, result=result):
            call = machine.call_callable
            parts = [code.expression(code, part) for part in (index, *arguments)]
            return code.call(lambda *given: call(is_direct, result, *given), parts, node, "callable_")
        case HelperUse(instance=instance, arguments=arguments):
            return _in_order(code, node, machine.helper(instance), arguments, f"{instance.name}_")
    raise AssertionError(f"unresolved call {ast.unparse(node)}")


def _plain(type_: t.Type) -> str:
    return "".join(letter for letter in str(type_) if letter.isalnum())


def _conversion(source: t.Type, target: t.Scalar) -> Callable[[Any], Any]:
    conversion = operations.convert(source, target)
    if conversion is not None or widened(target) == target:
        return conversion or (lambda value: value)
    return values.narrow(target)


def _argument_type(code: Code, argument: Argument) -> t.Type:
    match argument:
        case DefaultArgument(type=type_):
            return type_
        case DefaultExpression(node=node, body=body):
            return code.within(body).type_of(node)
        case _:
            return code.type_of(argument)


def _in_order(code: Code, node: ast.Call, function: Callable[..., Any], arguments: Sequence[Argument], stem: str) -> ast.expr:
    """A call whose arguments are in the order of the parameters, evaluated in the order of the source."""
    written = [*node.args, *(keyword.value for keyword in node.keywords)]
    given = [argument for argument in arguments if isinstance(argument, ast.expr)]
    ordered = sorted(given, key=written.index)
    parts = [code.expression(code, argument) for argument in ordered]
    places: list[int] = []
    for argument in arguments:
        if isinstance(argument, ast.expr):
            places.append(ordered.index(argument))
            continue
        places.append(len(parts))
        parts.append(_default(code, argument))
    if places != list(range(len(parts))):
        order, inner = tuple(places), function
        function = lambda *values_: inner(*(values_[place] for place in order))  # noqa: E731
    return code.call(function, parts, node, stem)


def _default(code: Code, argument: DefaultArgument | DefaultExpression) -> ast.expr:
    match argument:
        case DefaultArgument(value=value, type=type_):
            assert isinstance(type_, t.Scalar)
            return code.keep(literal(value, type_))
        case DefaultExpression(node=node, body=body):
            return code.expression(code.within(body), node)


def _trace(code: Code, node: ast.Call, use: TraceUse) -> ast.expr:
    machine, name, payload_type, words = code.machine, use.name, use.payload_type, use.words
    if use.payload is None:
        return _in_order(code, node, lambda *rays: machine.trace(name, rays, None, None), use.arguments, f"{name}_")
    if words is None:
        return _in_order(
            code, node, lambda *parts: machine.trace(name, parts[:-1], payload_type, parts[-1]), (*use.arguments, use.payload), f"{name}_"
        )
    types = words
    return _in_order(
        code, node, lambda *parts: machine.trace_words(name, parts[:-1], types, parts[-1]), (*use.arguments, use.payload), f"{name}_"
    )
