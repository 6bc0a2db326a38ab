"""What a name or dotted name means at module level; used for decorators, annotations, base classes and calls."""

from __future__ import annotations

import ast

from optixc.frontend.builtin_symbols import attribute_of, python_builtin
from optixc.frontend.declarations import Declarations
from optixc.frontend.symbols import PythonName, Symbol


def resolve_global(scope: Declarations, name: str) -> Symbol | None:
    """What a name means outside of any function: the file's, else Python's."""
    return scope.lookup(name) or python_builtin(name)


def resolve_dotted(scope: Declarations, node: ast.expr) -> Symbol | None:
    """The symbol that `a` or `a.b.c` names, or None if it is neither or means nothing. Decorator calls name their function."""
    match node:
        case ast.Name(id=name):
            return resolve_global(scope, name)
        case ast.Attribute(value=value, attr=name):
            base = resolve_dotted(scope, value)
            if base is None:
                return None
            if isinstance(base, PythonName) and base.module == "optixc":
                return _stdlib_module(scope, name)
            return attribute_of(base, name)
    return None


def _stdlib_module(scope: Declarations, name: str) -> Symbol | None:
    """`optixc.stdlib.NAME`, written out in full."""
    return scope.stdlib(name) if scope.stdlib is not None else None
