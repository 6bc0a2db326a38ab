"""Statements in IR."""

from __future__ import annotations

import ast
from dataclasses import replace
from functools import partial

from optixc.frontend.check_print import print_parts
from optixc.frontend.checked import BreakpointUse, LocalUse, returned_value
from optixc.frontend.lower_block import Block, FunctionLowering, is_stable, literal
from optixc.frontend.lower_call import NOTHING, tuple_item
from optixc.frontend.lower_convert import component, convert, is_simple, read
from optixc.frontend.lower_expr import lower_expression, lower_logical, lower_place
from optixc.frontend.weak import widened
from optixc.ir import types as t
from optixc.ir.nodes import (
    Assert,
    Assign,
    Binary,
    BinaryOp,
    Break,
    CallCallable,
    CallHelper,
    CallIntrinsic,
    ComponentRef,
    Construct,
    Continue,
    ElementRef,
    Expr,
    FieldRef,
    ForRange,
    HelperCall,
    If,
    IndexRef,
    Literal,
    Local,
    LocalRef,
    Logical,
    Print,
    Return,
    Stmt,
    While,
)
from optixc.ir.walk import subexpressions


def lower_body(low: FunctionLowering, body: list[ast.stmt], block: Block) -> None:
    """Lower statements in order; those that control never reaches are left out."""
    for statement in body:
        if statement not in low.instance.dead:
            _lower_statement(low, statement, block)


def _body(low: FunctionLowering, body: list[ast.stmt]) -> tuple[Stmt, ...]:
    inner = Block()
    lower_body(low, body, inner)
    return tuple(inner.statements)


def _lower_statement(low: FunctionLowering, node: ast.stmt, block: Block) -> None:
    span = low.span(node)
    match node:
        case ast.Expr():
            _lower_expression_statement(low, node, block)
        case ast.Assign(targets=targets, value=value):
            _lower_assign(low, targets, value, block)
        case ast.AnnAssign(target=target, value=value):
            if value is not None:
                _lower_assign(low, [target], value, block)
        case ast.AugAssign():
            _lower_augmented(low, node, block)
        case ast.If(test=test, body=body, orelse=orelse):
            condition = lower_expression(low, test, block)
            block.emit(If(condition, _body(low, body), _body(low, orelse), low.instance.source.header_span(node)))
        case ast.While(test=test, body=body):
            inner = Block()
            condition = lower_expression(low, test, inner)
            statements = _body(low, body)
            block.emit(While(tuple(inner.statements), condition, statements, False, low.instance.source.header_span(node)))
        case ast.For():
            _lower_for(low, node, block)
        case ast.Match():
            _lower_match(low, node, block)
        case ast.Break():
            block.emit(Break(span))
        case ast.Continue():
            block.emit(Continue(span))
        case ast.Return():
            _lower_return(low, node, returned_value(node), block)
        case ast.Assert(test=test, msg=message):
            condition = lower_expression(low, test, block)
            text = message.value if isinstance(message, ast.Constant) and isinstance(message.value, str) else ""
            block.emit(Assert(condition, text or ast.unparse(test), span))
        case ast.Pass():
            pass
        case _:
            raise AssertionError(f"unchecked statement {type(node).__name__}")


def _lower_return(low: FunctionLowering, node: ast.Return, value: ast.expr | None, block: Block) -> None:
    if value is None:
        block.emit(Return(None, low.span(node)))
        return
    result = lower_expression(low, value, block)
    block.emit(Return(None if result is NOTHING else result, low.span(node)))


def _lower_expression_statement(low: FunctionLowering, node: ast.Expr, block: Block) -> None:
    value = node.value
    if isinstance(value, ast.Constant):
        return
    if value not in low.instance.info:
        assert isinstance(value, ast.Call)
        _lower_print(low, value, block)
        return
    if isinstance(low.instance.info[value].use, BreakpointUse):
        return
    before = len(block.statements)
    result = lower_expression(low, value, block)
    if isinstance(result, HelperCall):
        block.emit(CallHelper(None, result.function, result.arguments, low.span(node)))
    _drop_unused_target(low, block, before, result)


def _drop_unused_target(low: FunctionLowering, block: Block, before: int, result: Expr) -> None:
    """A call whose result nobody takes needs no temporary for it."""
    last = block.statements[-1] if len(block.statements) > before else None
    call = _call_into(low, last, result)
    if call is not None:
        block.statements[-1] = replace(call, target=None)


def _call_into(low: FunctionLowering, last: Stmt | None, result: Expr) -> CallHelper | CallIntrinsic | CallCallable | None:
    """The call just emitted if `result` is its temporary, which is then forgotten."""
    if isinstance(last, CallHelper | CallIntrinsic | CallCallable) and isinstance(result, LocalRef) and last.target == result.local:
        if result.local not in low.temporaries:
            return None
        low.temporaries.remove(result.local)
        return last
    return None


def _lower_print(low: FunctionLowering, node: ast.Call, block: Block) -> None:
    options = {keyword.arg: keyword.value.value for keyword in node.keywords if isinstance(keyword.value, ast.Constant)}
    separator, end = str(options.get("sep", " ")), str(options.get("end", "\n"))
    pieces: list[list[str | ast.expr]] = []
    for argument in node.args:
        piece: list[str | ast.expr] = []
        for part in print_parts(argument):
            inner = part.value if isinstance(part, ast.FormattedValue) else part
            piece.append(inner.value if isinstance(inner, ast.Constant) and isinstance(inner.value, str) else inner)
        pieces.append(piece)
    if any(len(piece) != 1 for piece in pieces):
        # Parts of an f-string stand without separator: write the separators out.
        flat: list[str | ast.expr] = []
        for position, piece in enumerate(pieces):
            flat += [separator, *piece] if position and separator else piece
        separator = ""
    else:
        flat = [piece[0] for piece in pieces]
    nodes = [item for item in flat if isinstance(item, ast.expr)]
    values = iter(low.in_order(nodes, block))
    items = tuple(item if isinstance(item, str) else next(values) for item in flat)
    block.emit(Print(items, separator, end, low.span(node)))


def _lower_assign(low: FunctionLowering, targets: list[ast.expr], value: ast.expr, block: Block) -> None:
    if len(targets) == 1 and isinstance(targets[0], ast.Name):
        before = len(block.statements)
        _assign_name(low, targets[0], lower_expression(low, value, block), block, before)
        return
    if len(targets) == 1 and isinstance(targets[0], ast.Attribute | ast.Subscript):
        parts = [partial(lower_expression, low, value), partial(_target_place, low, targets[0])]
        result, place = low.in_order_by(parts, block, [value, targets[0]], places=(1,))
        _store(low, place, result, targets[0], block)
        return
    if len(targets) == 1 and isinstance(value, ast.Tuple) and isinstance(targets[0], ast.Tuple | ast.List):
        _assign_pairs(low, targets[0].elts, low.in_order(value.elts, block), block)
        return
    result = lower_expression(low, value, block)
    if len(targets) > 1 and not is_simple(result):
        result = low.keep(result, block, low.span(value))
    for target in targets:
        _assign_value(low, target, result, block)


def _store(low: FunctionLowering, place: Expr, value: Expr, node: ast.AST, block: Block) -> None:
    """Write a place; numbers of 8 and 16 bits are narrowed by the store."""
    assert isinstance(place, LocalRef | FieldRef | ComponentRef | IndexRef | ElementRef)
    block.emit(Assign(place, convert(value, widened(place.type), low.span(node)), low.span(node)))


def _target_place(low: FunctionLowering, target: ast.expr, block: Block) -> Expr:
    return lower_place(low, target, block, keep_indices=False, is_target=True)


def _assign_name(low: FunctionLowering, target: ast.Name, value: Expr, block: Block, before: int) -> None:
    local = low.instance.bindings[target]
    last = block.statements[-1] if len(block.statements) > before else None
    call = _call_into(low, last, value) if local.type == value.type else None
    if call is not None:
        # The call writes the author's local itself.
        block.statements[-1] = replace(call, target=local)
        return
    is_copy = isinstance(value, LocalRef) and value.local in low.temporaries and local.type == value.type
    if is_copy and isinstance(last, Assign) and isinstance(value, LocalRef) and last.target == value:
        low.temporaries.remove(value.local)
        block.statements[-1] = Assign(LocalRef(local), last.value, low.span(target))
        return
    block.emit(Assign(LocalRef(local), convert(value, local.type, low.span(target)), low.span(target)))


def _assign_value(low: FunctionLowering, target: ast.expr, value: Expr, block: Block) -> None:
    """Assign a value that later statements may read again: a literal, a local, or an item of one."""
    match target:
        case ast.Name():
            local = low.instance.bindings[target]
            block.emit(Assign(LocalRef(local), convert(value, local.type, low.span(target)), low.span(target)))
        case ast.Attribute() | ast.Subscript():
            place = lower_place(low, target, block, keep_indices=False, is_target=True)
            _store(low, place, value, target, block)
        case ast.Tuple(elts=elements) | ast.List(elts=elements):
            if isinstance(value.type, t.Vector):
                kept: Expr = value if is_simple(value) else low.keep(value, block, low.span(target), "items")
                items: list[Expr] = [component(kept, index) for index in range(len(elements))]
            else:
                needs_name = not isinstance(value, LocalRef | Construct)
                kept = low.keep(value, block, low.span(target), "items") if needs_name else value
                items = [tuple_item(kept, index) for index in range(len(elements))]
            _assign_pairs(low, elements, items, block)


def _assign_pairs(low: FunctionLowering, targets: list[ast.expr], values: list[Expr], block: Block) -> None:
    """All values are taken before the first target changes, as in Python: `a, b = b, a`."""
    written: set[Local] = set()
    writes_memory = False
    ready = []
    for target, value in zip(targets, values, strict=True):
        reads = {part.local for part in subexpressions(value) if isinstance(part, LocalRef)}
        if reads & written or (writes_memory and not is_stable(value)):
            value = low.keep(value, block, low.span(target))
        ready.append(value)
        for name in ast.walk(target):
            if isinstance(name, ast.Name) and name in low.instance.bindings:
                written.add(low.instance.bindings[name])
            elif isinstance(name, ast.Attribute | ast.Subscript):
                writes_memory = True
            elif isinstance(name, ast.Name) and (info := low.instance.info.get(name)) is not None and isinstance(info.use, LocalUse):
                # The root of a component or field; modules and enums in an index have no info.
                written.add(info.use.local)
    for target, value in zip(targets, ready, strict=True):
        _assign_value(low, target, value, block)


def _lower_augmented(low: FunctionLowering, node: ast.AugAssign, block: Block) -> None:
    operation = low.instance.augmented[node]
    if isinstance(node.target, ast.Name):
        before = len(block.statements)
        _assign_name(low, node.target, lower_expression(low, operation, block), block, before)
        return
    place = lower_place(low, node.target, block, keep_indices=True)
    low.substitutes[operation.left] = read(place)
    value = lower_expression(low, operation, block)
    _store(low, place, value, node, block)


def _lower_for(low: FunctionLowering, node: ast.For, block: Block) -> None:
    assert isinstance(node.iter, ast.Call) and isinstance(node.target, ast.Name)
    local = low.instance.bindings[node.target]
    assert isinstance(local.type, t.Scalar)
    bounds = low.in_order(node.iter.args, block)
    zero, one = literal(0, local.type), literal(1, local.type)
    start, stop, step = [(zero, *bounds, one), (*bounds, one), tuple(bounds)][len(bounds) - 1]
    body = _body(low, node.body)
    header = low.instance.source.header_span(node)
    if _rebinds(low, node.body, local):
        # The body changes the name, but not how the loop counts.
        counter = low.temporary("counter", local.type)
        body = (Assign(LocalRef(local), LocalRef(counter), low.span(node.target)), *body)
        local = counter
    block.emit(ForRange(local, start, stop, step, body, header))


def _rebinds(low: FunctionLowering, body: list[ast.stmt], local: Local) -> bool:
    return any(
        isinstance(name, ast.Name) and low.instance.bindings.get(name) == local for statement in body for name in ast.walk(statement)
    )


def _lower_match(low: FunctionLowering, node: ast.Match, block: Block) -> None:
    subject = lower_expression(low, node.subject, block)
    if not is_simple(subject):
        subject = low.keep(subject, block, low.span(node.subject), "subject")
    _lower_cases(low, node, subject, 0, block)


def _lower_cases(low: FunctionLowering, node: ast.Match, subject: Expr, position: int, block: Block) -> None:
    """The cases from `position` on, as if and else."""
    if position == len(node.cases):
        return
    case = node.cases[position]
    fits = _pattern(low, case.pattern, subject)
    condition: Expr | None = fits
    if case.guard is not None:
        guard = partial(lower_expression, low, case.guard)
        condition = guard(block) if fits is None else lower_logical(low, True, [lambda _: fits, guard], block, case.guard)
    body = _body(low, case.body)
    if condition is None:
        block.statements.extend(body)
        return
    rest = Block()
    _lower_cases(low, node, subject, position + 1, rest)
    block.emit(If(condition, body, tuple(rest.statements), low.span(case.pattern)))


def _pattern(low: FunctionLowering, pattern: ast.pattern, subject: Expr) -> Expr | None:
    """The condition under which a pattern fits; None for always."""
    span = low.span(pattern)
    match pattern:
        case ast.MatchValue(value=value):
            return Binary(BinaryOp.EQUAL, subject, lower_expression(low, value, Block()), t.BOOL, span)
        case ast.MatchSingleton(value=value):
            return Binary(BinaryOp.EQUAL, subject, Literal(bool(value), t.BOOL), t.BOOL, span)
        case ast.MatchOr(patterns=patterns):
            conditions = [_pattern(low, inner, subject) for inner in patterns]
            known = [condition for condition in conditions if condition is not None]
            if len(known) != len(conditions):
                return None
            result = known[0]
            for condition in known[1:]:
                result = Logical(False, result, condition, t.BOOL)
            return result
    return None
