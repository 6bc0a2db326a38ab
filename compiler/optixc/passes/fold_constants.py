"""Folds what literals decide, so that code behind a constant condition is gone before features are counted and C++ is written.

Folds numbers only as far as conditions need them: comparisons, logic, conversions, integer and simple float arithmetic. The C++
compiler does the rest.
"""

from __future__ import annotations

from dataclasses import replace

from optixc.ir.intrinsic_rows import INTRINSICS
from optixc.ir.intrinsics import Effect
from optixc.ir.nodes import (
    Binary,
    Break,
    CallIntrinsic,
    ComponentRef,
    Continue,
    Convert,
    Expr,
    Function,
    If,
    Literal,
    Logical,
    Pipeline,
    Return,
    Select,
    Stmt,
    Unary,
    UnaryOp,
    While,
)
from optixc.ir.types import Scalar, Vector
from optixc.ir.walk import Body, map_blocks, map_operands, rewrite
from optixc.passes import arithmetic


def fold_constants(pipeline: Pipeline) -> Pipeline:
    """The pipeline with constant conditions resolved and unreachable statements dropped."""
    is_throwing = bool(pipeline.options.exception_flags & 4)
    helpers = tuple(_of_function(function, is_throwing) for function in pipeline.helpers)
    programs = tuple(_of_function(function, is_throwing) for function in pipeline.programs)
    return replace(pipeline, helpers=helpers, programs=programs)


def _of_function(function: Function, is_throwing: bool) -> Function:
    body = _of_body(function.body, is_throwing)
    return function if body is function.body else replace(function, body=body)


def _of_body(body: Body, is_throwing: bool) -> Body:
    result: list[Stmt] = []
    for statement in body:
        result.extend(_of_statement(statement, is_throwing))
        if result and _leaves(result[-1], is_throwing):
            break
    same = len(result) == len(body) and all(a is b for a, b in zip(result, body, strict=True))
    return body if same else tuple(result)


def _of_statement(statement: Stmt, is_throwing: bool) -> Body:
    """What the statement becomes: itself, its live branch, or nothing."""
    folded = map_operands(statement, lambda expression: rewrite(expression, fold))
    folded = map_blocks(folded, lambda block: _of_body(block, is_throwing))
    match folded:
        case If(condition=Literal(value=bool(value))):
            return folded.then_body if value else folded.else_body
        case If(then_body=(), else_body=()):
            return ()
        case While(condition=Literal(value=False), condition_body=()):
            return ()
        case _:
            return (folded,)


def _leaves(statement: Stmt, is_throwing: bool) -> bool:
    """Whether nothing behind the statement in its block can run."""
    match statement:
        case Return() | Break() | Continue():
            return True
        case CallIntrinsic(name=name):
            effect = INTRINSICS[name].effect
            return effect is Effect.ENDS_PROGRAM or (effect is Effect.ENDS_LAUNCH_INDEX and is_throwing)
        case If(then_body=then_body, else_body=else_body):
            return bool(then_body and else_body) and _leaves(then_body[-1], is_throwing) and _leaves(else_body[-1], is_throwing)
        case _:
            return False


def fold(expression: Expr) -> Expr:
    """One node whose operands are folded already."""
    match expression:
        case Unary(op=op, operand=Literal(value=value), type=Scalar() as type_) if not isinstance(value, tuple):
            if op is UnaryOp.NOT:
                return Literal(not value, type_)
            return Literal(arithmetic.fit(-value if op is UnaryOp.NEGATE else ~int(value), type_), type_)
        case Binary(op=op, left=Literal(value=left, type=Scalar() as operand), right=Literal(value=right, type=Scalar())):
            assert not isinstance(left, tuple) and not isinstance(right, tuple)
            value_ = arithmetic.binary(op, left, right, operand) if operand == expression.right.type else None
            return expression if value_ is None else Literal(value_, expression.type)
        case Logical(is_and=is_and, left=Literal(value=bool(value))):
            return expression.right if value is is_and else expression.left
        case Logical(is_and=is_and, right=Literal(value=bool(value))) if value is is_and:
            return expression.left
        case ComponentRef(base=Literal(value=tuple(values)), components=components, type=type_):
            picked = tuple(values[component] for component in components)
            return Literal(picked if isinstance(type_, Vector) else picked[0], type_)
        case Select(condition=Literal(value=bool(value))):
            return expression.if_true if value else expression.if_false
        case Convert(operand=Literal(value=value, type=Scalar() as source), type=Scalar() as target) if not isinstance(value, tuple):
            return Literal(arithmetic.convert(value, target, source), target)
        case _:
            return expression
