"""Functions of the checked tree as Python functions: the statements stay, what they evaluate is rewritten.

The new function keeps the author's file name, lines and variable names, so that tracebacks and debuggers show the shader.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Sequence
from typing import Any

from optixc.frontend.check_print import print_parts
from optixc.frontend.checked import BreakpointUse, FunctionInstance
from optixc.interpret import values
from optixc.interpret.code import Code
from optixc.interpret.places import assign, augment
from optixc.interpret.rewrite_expr import convert, rewrite_expression
from optixc.ir import types as t


def compile_instance(instance: FunctionInstance, machine: Any) -> Callable[..., Any]:
    """The Python function that runs one program or helper instance; its arguments are the instance's parameters in order."""
    names: dict[str, Any] = {}
    code = Code(instance, machine, names, rewrite_expression)
    symbol = instance.symbol
    assert symbol is not None
    node = symbol.node
    parameters = [ast.arg(argument.arg) for argument in (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs)]
    body = _body(code, node.body)
    made = ast.FunctionDef(
        node.name, ast.arguments(posonlyargs=[], args=parameters, kwonlyargs=[], kw_defaults=[], defaults=[]), body, [], None
    )
    module = ast.Module([ast.copy_location(made, node)], [])
    ast.fix_missing_locations(module)
    exec(compile(module, instance.source.path, "exec"), names)
    function: Callable[..., Any] = names[node.name]
    return function


class Functions:
    """The rewritten functions of a machine, each made when it first runs, so that helpers may call themselves."""

    def __init__(self, machine: Any) -> None:
        self._machine = machine
        self._made: dict[FunctionInstance, Callable[..., Any]] = {}

    def run(self, instance: FunctionInstance, arguments: Sequence[Any]) -> Any:
        """Call an instance."""
        known = self._made.get(instance)
        if known is None:
            known = self._made[instance] = compile_instance(instance, self._machine)
        return known(*arguments)

    def helper(self, instance: FunctionInstance) -> Callable[..., Any]:
        """The function of an instance for those who call it."""
        return lambda *arguments: self.run(instance, arguments)


def _body(code: Code, statements: list[ast.stmt]) -> list[ast.stmt]:
    made: list[ast.stmt] = []
    for statement in statements:
        if statement not in code.instance.dead:
            made += _statement(code, statement)
    return made or [ast.Pass()]


def _statement(code: Code, node: ast.stmt) -> list[ast.stmt]:
    match node:
        case ast.Expr(value=ast.Constant()) | ast.Pass():
            return [ast.copy_location(ast.Pass(), node)]
        case ast.Expr(value=value):
            if value in code.instance.info and isinstance(code.info(value).use, BreakpointUse):
                return [ast.copy_location(ast.Expr(code.call(breakpoint, [], value, "breakpoint")), node)]
            is_print = value not in code.instance.info
            made = _print(code, value) if is_print and isinstance(value, ast.Call) else rewrite_expression(code, value)
            return [ast.copy_location(ast.Expr(made), node)]
        case ast.Assign(targets=targets, value=value):
            return _assign(code, targets, value, node)
        case ast.AnnAssign(target=target, value=value):
            return [ast.copy_location(ast.Pass(), node)] if value is None else _assign(code, [target], value, node)
        case ast.AugAssign():
            return [_augmented(code, node)]
        case ast.If(test=test, body=body, orelse=orelse):
            made_if = ast.If(rewrite_expression(code, test), _body(code, body), _body(code, orelse) if orelse else [])
            return [ast.copy_location(made_if, node)]
        case ast.While(test=test, body=body):
            return [ast.copy_location(ast.While(rewrite_expression(code, test), _body(code, body), []), node)]
        case ast.For():
            return [_for(code, node)]
        case ast.Match():
            return _match(code, node)
        case ast.Return(value=value):
            made_value = None if value is None else rewrite_expression(code, value)
            return [ast.copy_location(ast.Return(made_value), node)]
        case ast.Assert(test=test, msg=message):
            return [ast.copy_location(ast.Assert(rewrite_expression(code, test), message), node)]
        case ast.Break() | ast.Continue():
            return [node]
        case _:
            raise AssertionError(f"unchecked statement {type(node).__name__}")


def _print(code: Code, node: ast.Call) -> ast.expr:
    options = {keyword.arg: keyword.value.value for keyword in node.keywords if isinstance(keyword.value, ast.Constant)}
    counts = [len(print_parts(argument)) for argument in node.args]
    parts = [part.value if isinstance(part, ast.FormattedValue) else part for argument in node.args for part in print_parts(argument)]
    evaluated = [
        part if isinstance(part, ast.Constant) and isinstance(part.value, str) else rewrite_expression(code, part) for part in parts
    ]
    separator, end = str(options.get("sep", " ")), str(options.get("end", "\n"))
    perform = code.machine.print

    def show(*given: Any) -> None:
        texts, position = [], 0
        for count in counts:
            texts.append("".join(map(shown, given[position : position + count])))
            position += count
        perform(separator.join(texts) + end)

    return code.call(show, evaluated, node, "print_")


def shown(value: Any) -> str:
    """A printed value: vectors in parentheses, as compiled code prints them."""
    if isinstance(value, str):
        return value
    if isinstance(value, float):
        return f"{value:.9g}" if value == value else "nan"
    if isinstance(value, bool | int):
        return str(value)
    return f"({', '.join(map(shown, value))})"


def _assign(code: Code, targets: list[ast.expr], value: ast.expr, node: ast.stmt) -> list[ast.stmt]:
    made = rewrite_expression(code, value)
    if len(targets) == 1 and not isinstance(targets[0], ast.Tuple | ast.List):
        return [_assign_one(code, targets[0], made, code.type_of(value), node)]
    holder = "_ox_value"
    statements: list[ast.stmt] = [ast.copy_location(ast.Assign([ast.Name(holder, ast.Store())], made), node)]
    for target in targets:
        statements += _spread(code, target, ast.Name(holder, ast.Load()), code.type_of(value), node)
    return statements


def _spread(code: Code, target: ast.expr, value: ast.expr, type_: t.Type, node: ast.stmt) -> list[ast.stmt]:
    """Assign a value that is named already to a target or to each of its elements."""
    if not isinstance(target, ast.Tuple | ast.List):
        return [_assign_one(code, target, value, type_, node)]
    items = type_.items if isinstance(type_, t.Tuple) else (type_.element,) * type_.size if isinstance(type_, t.Vector) else ()
    statements: list[ast.stmt] = []
    for position, (element, item) in enumerate(zip(target.elts, items, strict=True)):
        part = ast.Subscript(value, ast.Constant(position), ast.Load())
        statements += _spread(code, element, ast.copy_location(part, node), item, node)
    return statements


def _assign_one(code: Code, target: ast.expr, value: ast.expr, type_: t.Type, node: ast.stmt) -> ast.stmt:
    match target:
        case ast.Name(id=name):
            made = convert(code, value, type_, code.instance.bindings[target].type, node)
            return ast.copy_location(ast.Assign([ast.copy_location(ast.Name(name, ast.Store()), target)], made), node)
        case ast.Attribute() | ast.Subscript():
            return assign(code, target, convert(code, value, type_, _value_type(code, target), node))
    raise AssertionError(f"unchecked target {ast.unparse(target)}")


def _value_type(code: Code, target: ast.expr) -> t.Type:
    type_ = code.info(target).type
    if isinstance(type_, t.Vector):
        return values.widened(type_)
    assert isinstance(type_, t.Type)
    return type_


def _augmented(code: Code, node: ast.AugAssign) -> ast.stmt:
    operation = code.instance.augmented[node]
    target = node.target
    if isinstance(target, ast.Name):
        made = rewrite_expression(code, operation)
        return _assign_one(code, target, made, code.type_of(operation), node)
    code.substitutes[operation.left] = ast.copy_location(ast.Name("_ox_old", ast.Load()), node)
    made = convert(code, rewrite_expression(code, operation), code.type_of(operation), _value_type(code, target), node)
    return augment(code, target, made)


def _for(code: Code, node: ast.For) -> ast.stmt:
    assert isinstance(node.iter, ast.Call) and isinstance(node.target, ast.Name)
    bounds = [rewrite_expression(code, bound) for bound in node.iter.args]
    made = ast.For(ast.Name(node.target.id, ast.Store()), code.call(counted, bounds, node.iter, "range_"), _body(code, node.body), [])
    return ast.copy_location(made, node)


def counted(*bounds: int) -> range:
    """`range`, empty where the step is 0."""
    return range(0) if len(bounds) == 3 and bounds[2] == 0 else range(*bounds)


def _match(code: Code, node: ast.Match) -> list[ast.stmt]:
    subject = ast.Name("_ox_subject", ast.Load())
    first = ast.Assign([ast.Name("_ox_subject", ast.Store())], rewrite_expression(code, node.subject))
    return [ast.copy_location(first, node), *_cases(code, node, subject, 0)]


def _cases(code: Code, node: ast.Match, subject: ast.expr, position: int) -> list[ast.stmt]:
    if position == len(node.cases):
        return []
    case = node.cases[position]
    test = _pattern(code, case.pattern, subject)
    if case.guard is not None:
        guard = rewrite_expression(code, case.guard)
        test = guard if test is None else ast.BoolOp(ast.And(), [test, guard])
    body = _body(code, case.body)
    if test is None:
        return body
    return [ast.copy_location(ast.If(test, body, _cases(code, node, subject, position + 1)), case.pattern)]


def _pattern(code: Code, pattern: ast.pattern, subject: ast.expr) -> ast.expr | None:
    """The condition under which a pattern fits; None for always."""
    match pattern:
        case ast.MatchValue(value=value):
            return ast.Compare(subject, [ast.Eq()], [rewrite_expression(code, value)])
        case ast.MatchSingleton(value=value):
            return ast.Compare(subject, [ast.Eq()], [ast.Constant(value)])
        case ast.MatchOr(patterns=patterns):
            tests = [_pattern(code, inner, subject) for inner in patterns]
            known = [test for test in tests if test is not None]
            return ast.BoolOp(ast.Or(), known) if len(known) == len(tests) else None
        case _:
            return None
