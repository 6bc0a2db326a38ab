"""Bound values: fields of the launch parameters that the host fixed when it made the pipeline become literals."""

from __future__ import annotations

from dataclasses import replace

from optixc.ir.nodes import Expr, FieldRef, ParamsRef, Pipeline
from optixc.ir.walk import rewrite_body


def specialize(pipeline: Pipeline) -> Pipeline:
    """Every read of a bound field (`light.enabled` for one inside a struct) replaced by its value."""
    values = dict(pipeline.options.bound_values)
    if not values:
        return pipeline

    def change(expression: Expr) -> Expr:
        path = parameter_path(expression)
        return values.get(path, expression) if path is not None else expression

    helpers = tuple(replace(f, body=rewrite_body(f.body, change)) for f in pipeline.helpers)
    programs = tuple(replace(f, body=rewrite_body(f.body, change)) for f in pipeline.programs)
    return replace(pipeline, helpers=helpers, programs=programs)


def parameter_path(expression: Expr) -> str | None:
    """The dotted name of a field of the launch parameters; None for anything else."""
    names: list[str] = []
    while isinstance(expression, FieldRef):
        names.append(expression.name)
        expression = expression.base
    return ".".join(reversed(names)) if names and isinstance(expression, ParamsRef) else None
