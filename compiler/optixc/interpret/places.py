"""Assignment to a path of fields, components and items: locals in place, elements of the host's arrays read, changed, written back."""

from __future__ import annotations

import ast
from collections.abc import Callable
from typing import Any

from optixc.frontend.checked import ElementUse, FieldUse, IndexUse, LocalUse, SwizzleUse
from optixc.host.matrices import Matrix
from optixc.host.vectors import Vector
from optixc.interpret import values
from optixc.interpret.code import Code
from optixc.ir import types as t

Step = tuple[str, Any]
Change = Callable[[Any], Any]


def changed(value: Any, steps: tuple[Any, ...], change: Change) -> Any:
    """`value` with what the steps lead to replaced by `change(old)`. Structs and fixed arrays change in place, vectors of both
    kinds are replaced."""
    if not steps:
        return change(value)
    step, rest = steps[0], steps[1:]
    if isinstance(step, str):
        setattr(value, step, changed(getattr(value, step), rest, change))
        return value
    if isinstance(value, values.FixedArrayValue):
        if 0 <= step < len(value):
            value[step] = changed(value[step], rest, change)
        else:
            change(changed_nothing(value, rest))
        return value
    if not 0 <= step < len(value):
        return value
    return _replaced(value, step, changed(value[step], rest, change))


def changed_nothing(value: values.FixedArrayValue, steps: tuple[Any, ...]) -> Any:
    """What a read behind the end of a fixed array gives."""
    found = values.zero(value.type.element)
    for step in steps:
        found = getattr(found, step) if isinstance(step, str) else found[step]
    return found


def _replaced(value: Any, index: int, part: Any) -> Any:
    if isinstance(value, values.CoopVecValue):
        return values.CoopVecValue(value.type, (*value.items[:index], part, *value.items[index + 1 :]))
    if isinstance(value, Matrix):
        rows = [list(row) for row in value]
        rows[index] = list(part)
        return type(value)(*(number for row in rows for number in row))
    assert isinstance(value, Vector)
    made = type(value).__new__(type(value))
    object.__setattr__(made, "_values", (*tuple(value)[:index], part, *tuple(value)[index + 1 :]))
    return made


def assign(code: Code, target: ast.Attribute | ast.Subscript, value: ast.expr) -> ast.stmt:
    """`target = value`, value first, as Python does."""
    return _write(code, target, value, is_change=False)


def augment(code: Code, target: ast.Attribute | ast.Subscript, operation: ast.expr) -> ast.stmt:
    """`target op= ...`: `operation` is an expression of the name `_ox_old`; the path is evaluated once."""
    argument = ast.arguments(posonlyargs=[], args=[ast.arg("_ox_old")], kwonlyargs=[], kw_defaults=[], defaults=[])
    return _write(code, target, ast.copy_location(ast.Lambda(argument, operation), target), is_change=True)


def _write(code: Code, target: ast.Attribute | ast.Subscript, value: ast.expr, is_change: bool) -> ast.stmt:
    narrow = values.narrow(stored_type(code, target))
    steps: list[ast.expr] = []
    node: ast.expr = target
    while True:
        use = code.info(node).use
        match node, use:
            case ast.Attribute(value=base), FieldUse(name=name):
                steps.append(ast.Constant(name))
                node = base
            case (ast.Attribute(value=base) | ast.Subscript(value=base)), SwizzleUse(components=components):
                steps.append(ast.Constant(components[0]))
                node = base
            case ast.Subscript(value=base), IndexUse(index=index):
                steps.append(code.expression(code, index))
                node = base
            case ast.Subscript(value=base), ElementUse(indices=indices):
                parts = [code.expression(code, base), *(code.expression(code, index) for index in indices)]
                return _write_element(code, target, parts, _path(steps, target), value, narrow, is_change)
            case ast.Name(id=name), LocalUse():
                return _write_local(code, target, name, _path(steps, target), value, narrow, is_change)
            case _:
                raise AssertionError(f"unchecked target {ast.unparse(target)}")


def _path(steps: list[ast.expr], target: ast.AST) -> ast.expr:
    return ast.copy_location(ast.Tuple(list(reversed(steps)), ast.Load()), target)


def stored_type(code: Code, target: ast.expr) -> t.Type:
    """The type that a place holds, storage types included."""
    use = code.info(target).use
    match target, use:
        case (ast.Attribute(value=base), SwizzleUse()) | (ast.Subscript(value=base), IndexUse()) if isinstance(
            code.info(base).type, t.Vector
        ):
            vector = stored_type(code, base)
            assert isinstance(vector, t.Vector)
            return vector.element
        case _, FieldUse(stored=stored) | ElementUse(stored=stored) | IndexUse(stored=stored):
            return stored
        case _:
            type_ = code.info(target).type
            assert isinstance(type_, t.Scalar | t.Vector)
            return type_


def _write_local(
    code: Code, target: ast.expr, name: str, path: ast.expr, value: ast.expr, narrow: Change, is_change: bool
) -> ast.stmt:
    def write(given: Any, root: Any, steps: tuple[Any, ...]) -> Any:
        return changed(root, steps, (lambda old: narrow(given(old))) if is_change else (lambda _: narrow(given)))

    root = ast.copy_location(ast.Name(name, ast.Load()), target)
    call = code.call(write, [value, root, path], target, "write_")
    return ast.copy_location(ast.Assign([ast.copy_location(ast.Name(name, ast.Store()), target)], call), target)


def _write_element(
    code: Code, target: ast.expr, parts: list[ast.expr], path: ast.expr, value: ast.expr, narrow: Change, is_change: bool
) -> ast.stmt:
    def write(given: Any, array: Any, *rest: Any) -> None:
        *indices, steps = rest
        if not steps and not is_change:
            array.store(narrow(given), *indices)
            return
        change: Change = (lambda old: narrow(given(old))) if is_change else (lambda _: narrow(given))
        array.store(changed(array.load(*indices), steps, change), *indices)

    return ast.copy_location(ast.Expr(code.call(write, [value, *parts, path], target, "store_")), target)
