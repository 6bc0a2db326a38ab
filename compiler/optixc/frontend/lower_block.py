"""The state of lowering one function: its statements so far, its temporaries, and the order of evaluation."""

from __future__ import annotations

import ast
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial

from optixc.frontend.checked import ExprInfo, FunctionInstance
from optixc.frontend.weak import ConstantValue
from optixc.ir import types as t
from optixc.ir.intrinsic_rows import INTRINSICS
from optixc.ir.intrinsic_rows_coop_vec import COOP_VEC_NAMES
from optixc.ir.intrinsics import State
from optixc.ir.nodes import (
    Assign,
    Binary,
    ComponentRef,
    Construct,
    Convert,
    Expr,
    FieldRef,
    IndexRef,
    IntrinsicCall,
    Literal,
    Local,
    LocalRef,
    ParamsRef,
    Select,
    Stmt,
    TupleItem,
    Unary,
    is_reference_type,
)
from optixc.source import Span


@dataclass(eq=False)
class Block:
    """Statements in order; `emit` appends."""

    statements: list[Stmt] = field(default_factory=list)

    def emit(self, statement: Stmt) -> None:
        """Append a statement."""
        self.statements.append(statement)


@dataclass(eq=False)
class FunctionLowering:
    """One function on its way to IR. `substitutes` are expressions that stand for nodes already evaluated."""

    instance: FunctionInstance
    made_structs: dict[str, t.Struct]
    expression: Callable[[FunctionLowering, ast.expr, Block], Expr]
    records_needed: Callable[[FunctionInstance], tuple[t.Struct, ...]]
    temporaries: list[Local] = field(default_factory=list)
    records: dict[t.Struct, Local] = field(default_factory=dict)
    substitutes: dict[ast.expr, Expr] = field(default_factory=dict)
    _names: set[str] = field(default_factory=set)

    def __post_init__(self) -> None:
        self._names.update(parameter.local.name for parameter in self.instance.parameters)
        self._names.update(local.name for local in self.instance.all_locals())

    def within(self, body: FunctionInstance) -> FunctionLowering:
        """The same function, with the expression infos of a module constant or default."""
        inner = FunctionLowering(body, self.made_structs, self.expression, self.records_needed)
        inner.temporaries = self.temporaries
        inner.records = self.records
        inner._names = self._names
        return inner

    def info(self, node: ast.expr) -> ExprInfo:
        """What the checker found for an expression."""
        return self.instance.info[node]

    def span(self, node: ast.AST) -> Span:
        """The place of a node."""
        return self.instance.source.span(node)

    def temporary(self, stem: str, type_: t.Type) -> Local:
        """A new local."""
        name, number = stem, 2
        while name in self._names:
            name, number = f"{stem}_{number}", number + 1
        self._names.add(name)
        local = Local(name, type_)
        self.temporaries.append(local)
        return local

    def unique_name(self, stem: str) -> str:
        """A name that no local of the function has."""
        name, number = stem, 2
        while name in self._names:
            name, number = f"{stem}_{number}", number + 1
        self._names.add(name)
        return name

    def keep(self, value: Expr, block: Block, span: Span, stem: str = "value") -> LocalRef:
        """Evaluate now: the value in a new temporary."""
        local = self.temporary(stem, value.type)
        block.emit(Assign(LocalRef(local), value, span))
        return LocalRef(local)

    def in_order(self, nodes: Sequence[ast.expr], block: Block) -> list[Expr]:
        """Evaluate expressions from left to right; those whose value a later one could change are kept in temporaries."""
        return self.in_order_by([partial(self.expression, self, node) for node in nodes], block, nodes)

    def in_order_by(
        self, parts: Sequence[Callable[[Block], Expr]], block: Block, nodes: Sequence[ast.AST], places: Sequence[int] = ()
    ) -> list[Expr]:
        """The same for any way of lowering each part. `nodes` give the source places; parts numbered in `places` are never copied."""
        results: list[Expr] = []
        marks: list[int] = []
        for part in parts:
            results.append(part(block))
            marks.append(len(block.statements))
        end = len(block.statements)
        # From the last to the first, so that earlier marks stay right.
        for position in range(len(results) - 2, -1, -1):
            if marks[position] != end and position not in places and not is_stable(results[position]):
                local = self.temporary("value", results[position].type)
                block.statements.insert(marks[position], Assign(LocalRef(local), results[position], self.span(nodes[position])))
                results[position] = LocalRef(local)
        return results


def is_stable(expression: Expr) -> bool:
    """Whether no statement that `lower` hoists can change its value: it reads no memory, no struct local, no state of the ray."""
    match expression:
        case Literal() | ParamsRef():
            return True
        case LocalRef(local=local):
            return not is_reference_type(local.type)
        case FieldRef(base=base) | ComponentRef(base=base) | TupleItem(base=base):
            return is_stable(base)
        case IndexRef(base=base, index=index):
            return is_stable(base) and is_stable(index)
        case Unary(operand=operand) | Convert(operand=operand):
            return is_stable(operand)
        case Binary(left=left, right=right):
            return is_stable(left) and is_stable(right)
        case Select(condition=condition, if_true=if_true, if_false=if_false):
            return is_stable(condition) and is_stable(if_true) and is_stable(if_false)
        case Construct(arguments=arguments):
            return all(is_stable(argument) for argument in arguments)
        case IntrinsicCall(name=name, arguments=arguments):
            is_free = INTRINSICS[name].state is State.NONE and (not INTRINSICS[name].optix or name in COOP_VEC_NAMES)
            return is_free and all(is_stable(argument) for argument in arguments)
    return False


def literal(value: ConstantValue, type_: t.Scalar) -> Literal:
    """A literal of a scalar type; integers wrap into it, so that explicit conversions of constants have C's values."""
    if type_.kind is t.ScalarKind.BOOL:
        return Literal(bool(value), type_)
    if type_.kind is t.ScalarKind.FLOAT:
        return Literal(float(value), type_)
    number = int(value) & ((1 << type_.bits) - 1)
    if type_.kind is t.ScalarKind.INT and number >> (type_.bits - 1):
        number -= 1 << type_.bits
    return Literal(number, type_)


def zero_of(type_: t.Type) -> Expr:
    """Zero of a scalar, vector or matrix."""
    match type_:
        case t.Scalar():
            return literal(0, type_)
        case t.Vector(element=element, size=size):
            return Construct(type_, (literal(0, element),) * size)
    raise AssertionError(f"no zero of {type_}")
