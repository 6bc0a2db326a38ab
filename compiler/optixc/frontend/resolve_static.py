"""Names inside a function that mean something of the module: those that the function itself does not bind."""

from __future__ import annotations

import ast

from optixc.frontend.context import Context
from optixc.frontend.resolve_name import resolve_dotted
from optixc.frontend.symbols import Symbol


def _bound_in(function: ast.FunctionDef) -> frozenset[str]:
    """Every name that the function binds anywhere: Python makes it a local everywhere in it."""
    arguments = function.args
    names = {argument.arg for argument in (*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs)}
    pending: list[ast.AST] = list(function.body)
    while pending:
        node = pending.pop()
        match node:
            case ast.Name(id=name, ctx=ast.Store()):
                names.add(name)
            case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name) | ast.ClassDef(name=name):
                names.add(name)
                continue
            case ast.Lambda() | ast.ListComp() | ast.SetComp() | ast.DictComp() | ast.GeneratorExp():
                continue
        pending.extend(ast.iter_child_nodes(node))
    return frozenset(names)


def local_names(c: Context) -> frozenset[str]:
    """The names that the current function binds."""
    symbol = c.instance.symbol
    if symbol is None:
        return frozenset()
    known = c.hooks.bound_names
    if symbol.node not in known:
        known[symbol.node] = _bound_in(symbol.node)
    return known[symbol.node]


def static_symbol(c: Context, node: ast.expr) -> Symbol | None:
    """The module-level symbol that a name or dotted name means in this function, or None."""
    root = node
    while isinstance(root, ast.Attribute):
        root = root.value
    if not isinstance(root, ast.Name) or root.id in local_names(c) or c.environment.get(root.id) is not None:
        return None
    return resolve_dotted(c.scope, node)
