"""Python that is not part of restricted Python: each construct by its name, with what to write instead."""

from __future__ import annotations

import ast

from optixc.frontend.checked import ExprInfo
from optixc.frontend.context import Context

_EXPRESSIONS: dict[type[ast.expr], tuple[str, str, str]] = {
    ast.NamedExpr: ("OX402", "an assignment expression (`:=`)", "assign in a statement of its own"),
    ast.Lambda: ("OX402", "a lambda", "write a helper function with `@ox.device`"),
    ast.Dict: ("OX402", "a dict", "write an `@ox.struct` class"),
    ast.Set: ("OX402", "a set", "use a FixedArray, or bits of an integer"),
    ast.List: ("OX402", "a list", "write a vector, `float3(x, y, z)`, or ox.FixedArray[T, N](...)"),
    ast.ListComp: ("OX402", "a list comprehension", "fill a FixedArray in a loop"),
    ast.SetComp: ("OX402", "a set comprehension", "write a loop"),
    ast.DictComp: ("OX402", "a dict comprehension", "write a loop"),
    ast.GeneratorExp: ("OX402", "a generator expression", "write a loop"),
    ast.Await: ("OX402", "`await`", "programs run to their end"),
    ast.Yield: ("OX402", "`yield`", "return a value, or write to an array"),
    ast.YieldFrom: ("OX402", "`yield from`", "return a value, or write to an array"),
    ast.Starred: ("OX402", "unpacking with `*`", "name the items one by one"),
    ast.Slice: ("OX402", "a slice", "index one element at a time"),
    ast.JoinedStr: ("OX403", "an f-string outside of print()", "text can only be printed"),
}

_STATEMENTS: dict[type[ast.stmt], tuple[str, str]] = {
    ast.FunctionDef: ("a function inside a function", "define the helper at module level"),
    ast.AsyncFunctionDef: ("an async function", "programs run to their end"),
    ast.ClassDef: ("a class inside a function", "define the struct at module level"),
    ast.Delete: ("`del`", "a local ends with its function"),
    ast.AsyncFor: ("`async for`", "write `for i in range(n)`"),
    ast.With: ("`with`", "nothing needs closing in a shader"),
    ast.AsyncWith: ("`async with`", "nothing needs closing in a shader"),
    ast.Raise: ("`raise`", "use ox.throw_exception(code), or assert"),
    ast.Try: ("`try`", "test before the operation; nothing raises in a shader"),
    ast.Import: ("an import inside a function", "import at the top of the file"),
    ast.ImportFrom: ("an import inside a function", "import at the top of the file"),
    ast.Global: ("`global`", "a shader cannot assign module-level names; write to an array or a payload"),
    ast.Nonlocal: ("`nonlocal`", "pass a struct to the helper"),
}


def refuse_expression(c: Context, node: ast.expr) -> ExprInfo:
    """Report an expression that shaders do not have."""
    if isinstance(node, ast.Constant):
        return _refuse_constant(c, node)
    code, name, note = _EXPRESSIONS.get(type(node), ("OX402", f"this expression ({type(node).__name__})", "write it with simpler ones"))
    return c.error(code, node, f"{name} is not part of restricted Python", note)


def _refuse_constant(c: Context, node: ast.Constant) -> ExprInfo:
    match node.value:
        case str() | bytes():
            return c.error("OX403", node, "text is not a value in shaders", "text stands in print() and assert messages only")
        case complex():
            return c.error("OX402", node, "a complex number is not part of restricted Python", "use float2 for real and imaginary part")
        case None:
            return c.error("OX402", node, "None is not a value in shaders", "use a number or flag that means nothing")
    return c.error("OX402", node, "`...` is not a value in shaders", "write a number")


def refuse_statement(c: Context, node: ast.stmt) -> None:
    """Report a statement that shaders do not have."""
    name, note = _STATEMENTS.get(type(node), (f"this statement ({type(node).__name__})", "write it with simpler ones"))
    c.error("OX401", c.source.header_span(node), f"{name} is not part of restricted Python", note)
