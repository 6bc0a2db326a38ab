"""Locals that hold one constant for their whole life are replaced by it, so that `mode = params.mode` hides no bound value.

Only pipelines with bound values need this; elsewhere the C++ compiler does it, and the author's names stay readable. Debug builds keep
locals.
"""

from __future__ import annotations

from dataclasses import replace

from optixc.ir.nodes import Assign, Expr, Function, Literal, LocalRef, Pipeline, Stmt
from optixc.ir.walk import Body, map_blocks, rewrite_body, statements
from optixc.passes.fold_constants import fold_constants
from optixc.passes.uses import stored_local


def propagate_constants(pipeline: Pipeline) -> Pipeline:
    """The pipeline with such locals replaced and folded again, until nothing changes."""
    if not pipeline.options.bound_values or pipeline.options.debug:
        return pipeline
    while True:
        helpers = tuple(_of_function(function) for function in pipeline.helpers)
        programs = tuple(_of_function(function) for function in pipeline.programs)
        changed = any(a is not b for a, b in zip((*helpers, *programs), (*pipeline.helpers, *pipeline.programs), strict=True))
        if not changed:
            return pipeline
        pipeline = fold_constants(replace(pipeline, helpers=helpers, programs=programs))


def _of_function(function: Function) -> Function:
    own = {local.name for local in function.locals}
    stores: dict[str, list[Stmt]] = {}
    for statement in statements(function.body):
        local = stored_local(statement)
        if local is not None:
            stores.setdefault(local.name, []).append(statement)
    constants: dict[str, Literal] = {}
    for name, found in stores.items():
        match found:
            case [Assign(target=LocalRef(local=local), value=Literal() as value)] if name in own and value.type == local.type:
                constants[name] = value
    if not constants:
        return function

    def change(expression: Expr) -> Expr:
        if isinstance(expression, LocalRef):
            return constants.get(expression.local.name, expression)
        return expression

    body = rewrite_body(_without_stores(function.body, set(constants)), change)
    return replace(function, body=body, locals=tuple(local for local in function.locals if local.name not in constants))


def _without_stores(body: Body, names: set[str]) -> Body:
    """The block without the assignments to these locals."""
    kept = (s for s in body if not (isinstance(s, Assign) and isinstance(s.target, LocalRef) and s.target.local.name in names))
    return tuple(map_blocks(statement, lambda block: _without_stores(block, names)) for statement in kept)
