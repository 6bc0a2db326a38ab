"""The state of rewriting one function: the names under which operations and constants stand in the new tree's globals."""

from __future__ import annotations

import ast
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from optixc.frontend.checked import ExprInfo, FunctionInstance
from optixc.frontend.weak import default_type
from optixc.interpret import numbers, values
from optixc.ir import types as t

PREFIX = "_ox_"


@dataclass(eq=False)
class Code:
    """One function instance on its way to Python code; `names` are the globals that the new tree uses."""

    instance: FunctionInstance
    machine: Any
    names: dict[str, Any]
    expression: Callable[[Code, ast.expr], ast.expr]
    substitutes: dict[ast.expr, ast.expr] = field(default_factory=dict)

    def within(self, body: FunctionInstance) -> Code:
        """The same function, with the expression infos of a module constant or default."""
        return Code(body, self.machine, self.names, self.expression)

    def info(self, node: ast.expr) -> ExprInfo:
        """What the checker found for an expression."""
        return self.instance.info[node]

    def type_of(self, node: ast.expr) -> t.Type:
        """The type of an expression after the conversion that its place asks for."""
        info = self.info(node)
        return info.converted or default_type(info.type)

    def keep(self, value: Any, stem: str = "") -> ast.expr:
        """A name for a Python object."""
        name = f"{PREFIX}{stem}{len(self.names)}"
        self.names[name] = value
        return ast.Name(name, ast.Load())

    def call(self, function: Any, arguments: list[ast.expr], place: ast.AST, stem: str = "") -> ast.expr:
        """A call of a Python object, at the place of a node of the author's tree."""
        made = ast.Call(self.keep(function, stem), arguments, [])
        return ast.copy_location(made, place)

    def constant(self, value: bool | int | float, type_: t.Type) -> ast.expr:
        """A literal of a scalar type, or one spread over a vector."""
        match type_:
            case t.Scalar():
                return self.keep(literal(value, type_))
            case t.Vector(element=element, size=size):
                return self.keep(values.make_vector(values.widened(type_), (literal(value, element),) * size))
        raise AssertionError(f"no literal of {type_}")


def literal(value: bool | int | float, type_: t.Scalar) -> bool | int | float:
    """A constant as its type holds it."""
    if type_.kind is t.ScalarKind.BOOL:
        return bool(value)
    if type_.kind is t.ScalarKind.FLOAT:
        return numbers.rounding(type_)(float(value))
    return numbers.wrap(type_)(int(value))
