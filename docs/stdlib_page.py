"""The page of the shader library: what each module gives, with the parameters and the first sentence of every function."""

from __future__ import annotations

import ast
import re
from pathlib import Path

_FOLDER = Path(__file__).resolve().parents[1] / "stdlib"
_FOR_HOSTS = ("shapes",)
_SENTENCE = re.compile(r".*?(?<!e\.g)(?<!ed)\.(?=\s+[A-Z]|$)")
INTRODUCTION = """# The shader library

Functions and structs to import in shaders, `from optixc.stdlib.random import pcg32, pcg32_float`. They are shaders themselves: the
[source](../../stdlib) says where each comes from, and the interpreter steps through it. Only what a program reaches is compiled in. A
struct that a function takes is changed in place, as in Python.

This page is made by `python docs/generate.py`.
"""


def stdlib_page() -> str:
    """The text of the page."""
    lines = [INTRODUCTION]
    for path in sorted(_FOLDER.glob("*.py")):
        if path.stem not in ("__init__", *_FOR_HOSTS):
            lines += _module_lines(path)
    return "\n".join(lines).rstrip() + "\n"


def _module_lines(path: Path) -> list[str]:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    rows = [_function_row(node) if isinstance(node, ast.FunctionDef) else _struct_row(node) for node in tree.body
            if isinstance(node, ast.FunctionDef | ast.ClassDef)]
    return [f"## `optixc.stdlib.{path.stem}`", "", _text(tree), "", "| | |", "|---|---|", *rows, ""]


def _function_row(node: ast.FunctionDef) -> str:
    parameters = ", ".join(
        f"{one.arg}: {ast.unparse(one.annotation)}" if one.annotation is not None else one.arg for one in node.args.args
    )
    result = f" -> {ast.unparse(node.returns)}" if node.returns is not None else ""
    return f"| `{node.name}({parameters}){result}` | {_first_sentence(node)} |"


def _struct_row(node: ast.ClassDef) -> str:
    fields = ", ".join(f"{ast.unparse(one.target)}: {ast.unparse(one.annotation)}" for one in node.body if isinstance(one, ast.AnnAssign))
    return f"| `struct {node.name}({fields})` | {_first_sentence(node)} |"


def _text(node: ast.Module | ast.FunctionDef | ast.ClassDef) -> str:
    return " ".join((ast.get_docstring(node) or "").split("\n\n")[0].split())


def _first_sentence(node: ast.FunctionDef | ast.ClassDef) -> str:
    text = _text(node)
    found = _SENTENCE.match(text)
    return (found.group() if found is not None else text).replace("|", "\\|")
