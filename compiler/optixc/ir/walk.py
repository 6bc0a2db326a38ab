"""Walking and rebuilding IR: which parts of a node are expressions, and which are blocks of statements.

The two tables below are the only list of that; every walk and every pass goes through them. Rebuilding keeps a node that did not
change as the same object, so that a pass that does nothing costs little.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any, TypeVar

from optixc.ir.nodes import (
    ArrayShape,
    Assert,
    Assign,
    Binary,
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
    HelperCall,
    If,
    IndexRef,
    IntrinsicCall,
    Literal,
    Local,
    LocalRef,
    Logical,
    ParamsRef,
    Print,
    Return,
    Select,
    Stmt,
    Trace,
    TupleItem,
    Unary,
    While,
)

Body = tuple[Stmt, ...]
Node = TypeVar("Node", bound=Expr | Stmt)

_OPERANDS: dict[type, tuple[str, ...]] = {
    Literal: (),
    LocalRef: (),
    ParamsRef: (),
    FieldRef: ("base",),
    ComponentRef: ("base",),
    IndexRef: ("base", "index"),
    TupleItem: ("base",),
    ElementRef: ("array", "indices"),
    ArrayShape: ("array",),
    Unary: ("operand",),
    Binary: ("left", "right"),
    Logical: ("left", "right"),
    Select: ("condition", "if_true", "if_false"),
    Convert: ("operand",),
    Construct: ("arguments",),
    IntrinsicCall: ("arguments",),
    HelperCall: ("arguments",),
    Assign: ("target", "value"),
    If: ("condition",),
    While: ("condition",),
    ForRange: ("start", "stop", "step"),
    Break: (),
    Continue: (),
    Return: ("value",),
    CallHelper: ("arguments",),
    CallIntrinsic: ("arguments",),
    Trace: ("arguments", "payload"),
    CallCallable: ("index", "arguments"),
    Assert: ("condition", "values"),
    Print: ("items",),
}
"""Fields that hold an expression, a tuple of them, or None; strings among the items of a print are no expressions."""

_BLOCKS: dict[type, tuple[str, ...]] = {
    If: ("then_body", "else_body"),
    While: ("condition_body", "body"),
    ForRange: ("body",),
}


def operands(node: Expr | Stmt) -> Iterator[Expr]:
    """The expressions directly below an expression or statement, in order of evaluation."""
    for name in _OPERANDS[type(node)]:
        value: Any = getattr(node, name)
        if isinstance(value, tuple):
            yield from (item for item in value if not isinstance(item, str))
        elif value is not None:
            yield value


def blocks(statement: Stmt) -> tuple[Body, ...]:
    """The blocks of statements directly inside a statement."""
    return tuple(getattr(statement, name) for name in _BLOCKS.get(type(statement), ()))


def subexpressions(expression: Expr) -> Iterator[Expr]:
    """The expression and everything below it, parents first."""
    stack = [expression]
    while stack:
        node = stack.pop()
        yield node
        stack.extend(reversed(tuple(operands(node))))


def statements(body: Body) -> Iterator[Stmt]:
    """Every statement of a block, those inside of others included, in order of the source."""
    for statement in body:
        yield statement
        for block in blocks(statement):
            yield from statements(block)


def expressions(body: Body) -> Iterator[Expr]:
    """Every expression of a block, parents first."""
    for statement in statements(body):
        for operand in operands(statement):
            yield from subexpressions(operand)


def map_operands(node: Node, change: Callable[[Expr], Expr]) -> Node:
    """The node with `change` applied to the expressions directly below it."""
    changes: dict[str, Any] = {}
    for name in _OPERANDS[type(node)]:
        old: Any = getattr(node, name)
        new: Any
        if isinstance(old, tuple):
            new = tuple(item if isinstance(item, str) else change(item) for item in old)
            if all(a is b for a, b in zip(old, new, strict=True)):
                continue
        elif old is None or (new := change(old)) is old:
            continue
        changes[name] = new
    return replace(node, **changes) if changes else node


def rewrite(expression: Expr, change: Callable[[Expr], Expr]) -> Expr:
    """`change` applied to every part of an expression, parts first."""
    return change(map_operands(expression, lambda part: rewrite(part, change)))


def map_blocks(statement: Stmt, change: Callable[[Body], Body]) -> Stmt:
    """The statement with `change` applied to its blocks."""
    changes: dict[str, Any] = {}
    for name in _BLOCKS.get(type(statement), ()):
        old = getattr(statement, name)
        new = change(old)
        if new is not old:
            changes[name] = new
    return replace(statement, **changes) if changes else statement


def rewrite_body(body: Body, change: Callable[[Expr], Expr]) -> Body:
    """The block with `change` applied to every part of every expression."""

    def of_statement(statement: Stmt) -> Stmt:
        changed = map_operands(statement, lambda expression: rewrite(expression, change))
        return map_blocks(changed, lambda block: rewrite_body(block, change))

    new = tuple(of_statement(statement) for statement in body)
    return body if all(a is b for a, b in zip(body, new, strict=True)) else new


def called_helpers(body: Body) -> Iterator[str]:
    """Names of the helpers that a block calls, in order, repeats included."""
    for statement in statements(body):
        if isinstance(statement, CallHelper):
            yield statement.function
        for operand in operands(statement):
            for part in subexpressions(operand):
                if isinstance(part, HelperCall):
                    yield part.function


def called_intrinsics(body: Body) -> Iterator[str]:
    """Names of the device functions that a body calls, for their values and as statements."""
    yield from (one.name for one in expressions(body) if isinstance(one, IntrinsicCall))
    yield from (one.name for one in statements(body) if isinstance(one, CallIntrinsic))


def place_origin(place: Expr) -> Expr:
    """What a chain of fields, components and indices starts from."""
    while isinstance(place, FieldRef | ComponentRef | IndexRef | TupleItem):
        place = place.base
    return place


def chosen_items(place: Expr) -> list[IndexRef]:
    """The items on the way to a place whose index is no constant, from the origin of the place on."""
    found: list[IndexRef] = []
    while isinstance(place, FieldRef | ComponentRef | IndexRef | TupleItem):
        if isinstance(place, IndexRef) and not isinstance(place.index, Literal):
            found.append(place)
        place = place.base
    return found[::-1]


def place_root(place: Expr) -> Local | None:
    """The local that a chain of fields, components and indices starts from; None if it is memory, parameters or a value."""
    origin = place_origin(place)
    return origin.local if isinstance(origin, LocalRef) else None
