"""Captured Python values that shader files could write as constants too: tuples, matrices, structs. They become the text of such constants.

An array, a list or a dictionary has no such text; neither has a struct that holds one.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from optixc.frontend.builtin_names import MATRIX_TYPES, SCALAR_TYPES, VECTOR_TYPES
from optixc.frontend.builtin_symbols import builtin_symbol
from optixc.frontend.declarations import Declarations
from optixc.frontend.declare import Declarer
from optixc.frontend.parse import parse_text
from optixc.frontend.source_file import Diagnostics
from optixc.frontend.symbols import ConstantSymbol, StructSymbol, Symbol


class NoConstant(Exception):
    """The value cannot be written as a constant of a shader file."""


def constant_symbol(name: str, value: Any, struct: Callable[[type[Any]], Symbol | None], declarer: Declarer) -> ConstantSymbol | None:
    """The constant that a captured value is, None if it is none. `struct` gives the symbol of a live struct class."""
    structs: dict[str, Symbol] = {}
    try:
        text = _text(value, struct, structs)
    except NoConstant:
        return None
    file = parse_text(f"{name} = {text}\n", f"<value of {name}>", Path.cwd(), Diagnostics())
    assert file is not None
    scope = Declarations(file, declarer.resolve, star_imports=[lambda asked: structs.get(asked) or builtin_symbol(asked)])
    node: Any = file.tree.body[0]
    return ConstantSymbol(node.value, None, scope.span(node.value), scope)


def _text(value: Any, struct: Callable[[type[Any]], Symbol | None], structs: dict[str, Symbol]) -> str:
    shown = type(value).__name__
    match value:
        case bool():
            return str(value)
        case int():
            return str(int(value))
        case float():
            return repr(float(value)) if math.isfinite(value) else f"({value})"
        case np.generic() if value.dtype.name in SCALAR_TYPES:
            return f"{value.dtype.name}({_text(value.item(), struct, structs)})"
        case tuple():
            return f"({''.join(f'{_text(item, struct, structs)}, ' for item in value)})"
    if hasattr(type(value), "__optixc_kind__"):
        symbol = struct(type(value))
        if not isinstance(symbol, StructSymbol) or structs.setdefault(shown, symbol) is not symbol:
            raise NoConstant
        parts = [getattr(value, field) for field in type(value).__match_args__]
    elif shown in VECTOR_TYPES and type(value).__module__.startswith("optixc"):
        parts = list(value)
    elif shown in MATRIX_TYPES and type(value).__module__.startswith("optixc"):
        parts = np.asarray(value).ravel().tolist()
    else:
        raise NoConstant
    return f"{shown}({', '.join(_text(part, struct, structs) for part in parts)})"
