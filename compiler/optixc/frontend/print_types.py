"""The printed form of what the checker found: every function instance with its locals and the type of each expression."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from optixc.frontend.checked import Checked, ExprInfo, FunctionInstance

_LONGEST = 60


def print_types(checked: Checked) -> str:
    """Structs, then helpers and programs; expressions by place, `text: type`, with `-> type` where the place converts."""
    lines = [f"{checked.path}"]
    for struct in checked.structs:
        fields = ", ".join(f"{field.name}: {field.type}" for field in struct.fields)
        lines.append(f"{struct.kind.value} {struct.name}({fields})")
    if checked.params is not None:
        lines.append(f"launch parameters: {checked.params.name}")
    for function in (*checked.helpers, *checked.programs):
        lines += ["", *_function(function)]
    return "\n".join(lines)


def _function(function: FunctionInstance) -> Iterator[str]:
    parameters = ", ".join(
        f"{one.local.name}: {one.local.type}{f' ({one.role.value})' if one.role.value != 'value' else ''}" for one in function.parameters
    )
    kind = function.kind.value if function.kind is not None else "helper"
    yield f"{kind} {function.name}({parameters}) -> {function.result}"
    for local in function.all_locals():
        yield f"    local {local.name}: {local.type}"
    placed = sorted(function.info.items(), key=lambda item: (item[0].lineno, item[0].col_offset, -(item[0].end_col_offset or 0)))
    for node, info in placed:
        yield f"    {node.lineno}:{node.col_offset + 1}: {_shortened(node)}: {_type(info)}"


def _type(info: ExprInfo) -> str:
    converted = f" -> {info.converted}" if info.converted is not None else ""
    constant = f" = {info.constant!r}" if info.constant is not None else ""
    return f"{info.type}{constant}{converted}"


def _shortened(node: ast.expr) -> str:
    text = ast.unparse(node)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}..."
