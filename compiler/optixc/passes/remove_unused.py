"""Drops what nothing reaches: helpers that no program calls any more, locals that nobody reads, structs that nothing mentions.

Debug builds keep locals, so that a debugger shows them.
"""

from __future__ import annotations

from dataclasses import replace

from optixc.ir.intrinsic_rows import INTRINSICS
from optixc.ir.intrinsics import Effect
from optixc.ir.nodes import Assign, CallCallable, CallHelper, CallIntrinsic, ForRange, Function, LocalRef, Pipeline, Stmt
from optixc.ir.walk import Body, called_helpers, map_blocks, operands, place_root, statements, subexpressions


def remove_unused(pipeline: Pipeline) -> Pipeline:
    """The pipeline without unread locals and unreached helpers."""
    if not pipeline.options.debug:
        pipeline = replace(
            pipeline,
            helpers=tuple(_without_unread(function) for function in pipeline.helpers),
            programs=tuple(_without_unread(function) for function in pipeline.programs),
        )
    reached = _reached(pipeline)
    return replace(pipeline, helpers=tuple(helper for helper in pipeline.helpers if helper.name in reached))


def _reached(pipeline: Pipeline) -> set[str]:
    helpers = {helper.name: helper for helper in pipeline.helpers}
    reached: set[str] = set()
    stack = [name for program in pipeline.programs for name in called_helpers(program.body)]
    while stack:
        name = stack.pop()
        if name not in reached:
            reached.add(name)
            stack.extend(called_helpers(helpers[name].body))
    return reached


def _without_unread(function: Function) -> Function:
    """Drops assignments to locals that are never read, again while that makes others unread."""
    own = {local.name for local in function.locals}
    while True:
        unread = own - _read(function.body)
        body = _without(function.body, unread)
        if body is function.body:
            mentioned = _mentioned(body)
            return replace(function, locals=tuple(local for local in function.locals if local.name in mentioned))
        function = replace(function, body=body)


def _read(body: Body) -> set[str]:
    """Locals whose value somebody uses. Being the root of a place that is stored to is no use."""
    names: set[str] = set()
    for statement in statements(body):
        for position, operand in enumerate(operands(statement)):
            root = place_root(operand) if isinstance(statement, Assign) and position == 0 else None
            names.update(
                part.local.name
                for part in subexpressions(operand)
                if isinstance(part, LocalRef) and (root is None or part.local.name != root.name)
            )
    return names


def _mentioned(body: Body) -> set[str]:
    names = {
        part.local.name
        for statement in statements(body)
        for operand in operands(statement)
        for part in subexpressions(operand)
        if isinstance(part, LocalRef)
    }
    for statement in statements(body):
        if isinstance(statement, CallHelper | CallIntrinsic | CallCallable | ForRange) and statement.target is not None:
            names.add(statement.target.name)
    return names


def _without(body: Body, unread: set[str]) -> Body:
    result: list[Stmt] = []
    for statement in body:
        if isinstance(statement, Assign):
            root = place_root(statement.target)
            if root is not None and root.name in unread:
                continue
        elif isinstance(statement, CallHelper | CallIntrinsic | CallCallable):
            is_unread = statement.target is not None and statement.target.name in unread
            if is_unread and isinstance(statement, CallIntrinsic) and INTRINSICS[statement.name].effect is Effect.READS:
                continue
            statement = replace(statement, target=None) if is_unread else statement
        result.append(map_blocks(statement, lambda block: _without(block, unread)))
    same = len(result) == len(body) and all(a is b for a, b in zip(result, body, strict=True))
    return body if same else tuple(result)
