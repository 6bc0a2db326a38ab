"""Matching a call's positional and keyword arguments with parameter names; order and doubles are told like Python does."""

from __future__ import annotations

import ast
import difflib
from collections.abc import Collection, Sequence

from optixc.frontend.context import Context


def bind_arguments(
    c: Context, node: ast.Call, function: str, names: Sequence[str], optional: Collection[str] = ()
) -> list[ast.expr | None] | None:
    """The argument for each name, None where an optional one is left out; None altogether after a diagnostic."""
    if not refuse_stars(c, node):
        return None
    if len(node.args) > len(names):
        count = f"{len(names)} argument{'s' if len(names) != 1 else ''}"
        c.error("OX305", node.args[len(names)], f"{function}() takes {count}, here are {len(node.args)}", _signature(names, optional))
        return None
    bound: dict[str, ast.expr] = dict(zip(names, node.args, strict=False))
    for keyword in node.keywords:
        assert keyword.arg is not None
        if keyword.arg not in names:
            near = difflib.get_close_matches(keyword.arg, names, 1)
            note = f"did you mean `{near[0]}`?" if near else _signature(names, optional)
            c.error("OX305", keyword.value, f"{function}() has no parameter `{keyword.arg}`", note)
            return None
        if keyword.arg in bound:
            c.error("OX305", keyword.value, f"{function}() gets `{keyword.arg}` twice", "")
            return None
        bound[keyword.arg] = keyword.value
    missing = [name for name in names if name not in bound and name not in optional]
    if missing:
        text = ", ".join(f"`{name}`" for name in missing)
        c.error("OX305", node, f"{function}() misses {text}", _signature(names, optional))
        return None
    return [bound.get(name) for name in names]


def refuse_stars(c: Context, node: ast.Call) -> bool:
    """Refuse `*args` and `**keywords` in a call."""
    for argument in node.args:
        if isinstance(argument, ast.Starred):
            c.error("OX404", argument, "`*` in a call is not part of restricted Python", "name the arguments one by one")
            return False
    for keyword in node.keywords:
        if keyword.arg is None:
            c.error("OX404", keyword.value, "`**` in a call is not part of restricted Python", "name the arguments one by one")
            return False
    return True


def check_written(c: Context, node: ast.Call) -> None:
    """Check all arguments in the order of the source, so that errors and effects come in Python's order."""
    for argument in (*node.args, *(keyword.value for keyword in node.keywords)):
        if not isinstance(argument, ast.Starred):
            c.check(argument)


def _signature(names: Sequence[str], optional: Collection[str]) -> str:
    if not names:
        return "it takes none"
    return "it takes " + ", ".join(f"{name}=..." if name in optional else name for name in names)
