"""Whether the programs of a pipeline keep to the numbers of payload and attribute words that its options allow."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal as Of

from optixc.ir.layout import payload_words
from optixc.ir.nodes import CallIntrinsic, Function, IntrinsicCall, ParameterRole, Pipeline
from optixc.ir.types import Struct
from optixc.ir.walk import expressions, statements
from optixc.passes.traced_programs import PAYLOAD_GETTER, PAYLOAD_SETTER, payload_of, traces_of
from optixc.source import Span

SMALLEST_ATTRIBUTE_LIMIT = 2
Excess = tuple[Of["payload", "attribute"], str]


def first_excess(pipeline: Pipeline, payload_limit: int | None, attribute_limit: int | None) -> Excess | None:
    """What uses more words than its limit and where, in a sentence; None if nothing does. No limit: None, or 0 for payloads."""
    if payload_limit:
        for words, what, span in _payload_uses(pipeline):
            if words > payload_limit:
                return "payload", _sentence(span, what, words, "payload", payload_limit)
    if attribute_limit is not None:
        limit = max(attribute_limit, SMALLEST_ATTRIBUTE_LIMIT)
        for words, what, span in _attribute_uses(pipeline):
            if words > limit:
                return "attribute", _sentence(span, what, words, "attribute", limit)
    return None


def _sentence(span: Span, what: str, words: int, kind: str, limit: int) -> str:
    return (
        f"{span.path}:{span.line}: {what} uses {words} {kind} words, and num_{kind}_values is {limit}; "
        f"raise it, or leave it out: the shader's classes tell the number"
    )


def _payload_uses(pipeline: Pipeline) -> Iterator[tuple[int, str, Span]]:
    for program in pipeline.programs:
        payload = payload_of(program)
        if payload is not None:
            yield payload_words(payload), f"the payload {payload.name} of {program.name}", program.span
    for _, trace in traces_of(pipeline):
        if trace.payload_type is not None:
            yield payload_words(trace.payload_type), f"the payload of {trace.name}()", trace.span
    yield from _numbered(pipeline, (PAYLOAD_GETTER, PAYLOAD_SETTER))


def _attribute_uses(pipeline: Pipeline) -> Iterator[tuple[int, str, Span]]:
    for program in pipeline.programs:
        for parameter in program.parameters:
            if parameter.role is ParameterRole.ATTRIBUTES and isinstance(parameter.local.type, Struct):
                struct = parameter.local.type
                yield payload_words(struct), f"the attributes {struct.name} of {program.name}", program.span
    for function in _functions(pipeline):
        for statement in statements(function.body):
            if isinstance(statement, CallIntrinsic) and statement.name == "report_intersection":
                given = statement.arguments[2:]
                is_struct = len(given) == 1 and isinstance(given[0].type, Struct)
                words = payload_words(given[0].type) if is_struct and isinstance(given[0].type, Struct) else len(given)
                yield words, "report_intersection()", statement.span
    yield from _numbered(pipeline, ("get_attribute_", "hit_object_get_attribute_"))


def _numbered(pipeline: Pipeline, prefixes: tuple[str, ...]) -> Iterator[tuple[int, str, Span]]:
    """Device functions that address a word by its number."""
    for function in _functions(pipeline):
        found = [(e.name, e.span) for e in expressions(function.body) if isinstance(e, IntrinsicCall)]
        found += [(s.name, s.span) for s in statements(function.body) if isinstance(s, CallIntrinsic)]
        for name, span in found:
            if name.startswith(prefixes):
                yield int(name.rsplit("_", 1)[1]) + 1, f"{name}()", span


def _functions(pipeline: Pipeline) -> tuple[Function, ...]:
    return (*pipeline.programs, *pipeline.helpers)
