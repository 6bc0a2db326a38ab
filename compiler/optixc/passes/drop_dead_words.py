"""Words of payloads that nobody reads are not written: stores to them go, and what they would have been made of is not computed.

A field of which no word is read anywhere then has no mention left, and the emitters leave it out of the struct (`unread_fields`).
Builds with debug or validation keep everything, so that a debugger shows it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from optixc.ir.layout import payload_scalars
from optixc.ir.nodes import Assign, Construct, Expr, FieldRef, Function, Literal, LocalRef, Pipeline, Stmt
from optixc.ir.types import Scalar, ScalarKind, Struct, Texture, Traversable, Type, Vector
from optixc.ir.walk import Body, expressions, map_blocks, place_root
from optixc.passes.live_flow import REGISTERS, Liveness, is_payload
from optixc.passes.live_words import full, place_words, words_of
from optixc.passes.liveness import liveness
from optixc.passes.traced_programs import address_registers, payload_of, traces_of


def drop_dead_words(pipeline: Pipeline) -> Pipeline:
    """The pipeline without stores to words of payloads that are dead."""
    options = pipeline.options
    if options.debug or options.validation or not any(trace.payload is not None for _, trace in traces_of(pipeline)):
        return pipeline
    while True:
        live = liveness(pipeline, payloads_only=True)
        helpers = tuple(_of_function(function, live) for function in pipeline.helpers)
        programs = tuple(_of_function(function, live) for function in pipeline.programs)
        if all(a is b for a, b in zip((*helpers, *programs), (*pipeline.helpers, *pipeline.programs), strict=True)):
            return pipeline
        pipeline = replace(pipeline, helpers=helpers, programs=programs)


def unread_fields(pipeline: Pipeline) -> dict[Struct, frozenset[str]]:
    """Fields of payload classes that no function mentions, where nothing else knows them by their number of words."""
    functions = (*pipeline.helpers, *pipeline.programs)
    payloads = {struct for struct in _payloads(pipeline) if struct.fields}
    if pipeline.options.debug or pipeline.options.validation or address_registers(functions):
        return {}
    mentioned = {
        (node.base.type, node.name) for function in functions for node in expressions(function.body) if isinstance(node, FieldRef)
    }
    held = {part for struct in pipeline.structs for field in struct.fields for part in _parts(field.type)}
    words = [tuple(payload_scalars(struct)) for struct in payloads]
    return {
        struct: frozenset(field.name for field in struct.fields if (struct, field.name) not in mentioned)
        for struct in payloads
        if struct not in held and words.count(tuple(payload_scalars(struct))) == 1
    }


def _payloads(pipeline: Pipeline) -> Iterator[Struct]:
    """Every payload class that a trace carries or a program takes."""
    found = [trace.payload_type for _, trace in traces_of(pipeline)] + [payload_of(program) for program in pipeline.programs]
    yield from dict.fromkeys(payload for payload in found if payload is not None)


def _parts(type_: Type) -> Iterator[Type]:
    """A type and the types of the items of arrays of it."""
    yield type_
    element = getattr(type_, "element", None)
    if element is not None:
        yield from _parts(element)


def _of_function(function: Function, live: Liveness) -> Function:
    if function.name in live.pinned:
        return function
    payload = payload_of(function)
    name = next((p.local.name for p in function.parameters if payload is not None and p.local.type == payload), None)

    def behind(statement: Assign) -> int:
        words = place_words(statement.target)
        assert words is not None
        state = live.behind[id(statement)]
        return (state.get(REGISTERS if words.local == name else words.local, 0) & words.mask) >> words.first

    def of_body(body: Body) -> Body:
        made = [of_statement(statement) for statement in body]
        same = all(a is b for a, b in zip(made, body, strict=True))
        return body if same else tuple(statement for statement in made if statement is not None)

    def of_statement(statement: Stmt) -> Stmt | None:
        if isinstance(statement, Assign) and _is_in_payload(statement.target):
            wanted = behind(statement)
            if isinstance(statement.target, LocalRef):
                value = _wanted(statement.value, wanted)
                return statement if value is statement.value else replace(statement, value=value)
            return statement if wanted else None
        return map_blocks(statement, of_body)

    body = of_body(function.body)
    return function if body is function.body else replace(function, body=body)


def _is_in_payload(target: Expr) -> bool:
    root = place_root(target)
    return root is not None and is_payload(root.type)


def _wanted(value: Expr, live: int) -> Expr:
    """A payload that is made anew, with zeros for what nobody reads."""
    if not isinstance(value, Construct) or not isinstance(value.type, Struct):
        return value
    arguments, first = [], 0
    for field, argument in zip(value.type.fields, value.arguments, strict=True):
        count = words_of(field.type)
        arguments.append(argument if live >> first & full(count) else _zero(argument))
        first += count
    same = all(a is b for a, b in zip(arguments, value.arguments, strict=True))
    return value if same else replace(value, arguments=tuple(arguments))


def _zero(value: Expr) -> Expr:
    """Zero of the same type; the value itself where that is no number."""
    if isinstance(value, Literal):
        return value
    match value.type:
        case Scalar(kind=kind) | Vector(element=Scalar(kind=kind)):
            zero = {ScalarKind.BOOL: False, ScalarKind.FLOAT: 0.0}.get(kind, 0)
            return Literal((zero,) * value.type.size if isinstance(value.type, Vector) else zero, value.type)
        case Traversable() | Texture():
            return Literal(0, value.type)
        case _:
            return value
