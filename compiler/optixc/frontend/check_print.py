"""print() and the messages of assert: the only places where text may stand."""

from __future__ import annotations

import ast

from optixc.frontend.checked import ExprInfo
from optixc.frontend.context import Context, describe
from optixc.frontend.weak import Invalid
from optixc.ir import types as t


def message_of(c: Context, node: ast.expr) -> str:
    """The text of an assert's message; it must be a literal, because it becomes a constant of the compiled program."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    c.error("OX403", node, "the message of an assert must be plain text", "values are printed by print()")
    return ""


def check_print(c: Context, node: ast.Call) -> None:
    """`print("x", x, f"y {y}", sep=" ", end="\\n")`."""
    c.instance.writes = True
    for keyword in node.keywords:
        if keyword.arg in ("sep", "end"):
            if not (isinstance(keyword.value, ast.Constant) and isinstance(keyword.value.value, str)):
                c.error("OX403", keyword.value, f"`{keyword.arg}` of print() must be plain text", "")
        else:
            c.error("OX305", keyword.value, f"print() has no parameter `{keyword.arg}` in shaders", "it takes sep and end")
    for argument in node.args:
        for part in print_parts(argument):
            if isinstance(part, ast.Constant) and isinstance(part.value, str):
                continue
            if isinstance(part, ast.FormattedValue):
                if part.format_spec is not None or part.conversion not in (-1, 115):
                    c.error("OX403", part, "format specifications are not part of restricted Python", "print the value as it is")
                part = part.value
            _check_item(c, part)


def print_parts(argument: ast.expr) -> list[ast.expr]:
    """The parts of one argument: those of an f-string, or itself."""
    return list(argument.values) if isinstance(argument, ast.JoinedStr) else [argument]


def _check_item(c: Context, node: ast.expr) -> ExprInfo:
    info = c.check(node)
    if isinstance(info.type, Invalid):
        return info
    if not isinstance(info.type, t.Scalar | t.Vector) and not str(info.type).endswith("literal"):
        return c.error("OX302", node, f"print() takes numbers, vectors and text, this is {describe(info.type)}", "print its parts")
    c.settle(node)
    return info
