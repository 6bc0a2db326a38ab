"""What the function that traces may read of its payload afterwards: words without `caller="r"` are lost in the call.

Works on a checked body, statement by statement, along all ways. A word is known again when the whole field is assigned. Programs see
what the caller passes only in words with `caller="w"`, so passing a lost word on is an error just where some program may look at it.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

from optixc.frontend.checked import ExprInfo, FieldUse, FunctionInstance, HelperUse, LocalUse, TraceUse
from optixc.frontend.context import Context
from optixc.ir import types as t
from optixc.ir.payload_semantics import is_passed, is_returned

Lost = frozenset[tuple[str, str]]
"""Locals and fields whose words a trace has not brought back."""


def check_payload_flow(c: Context, body: list[ast.stmt]) -> None:
    """Report reads of words that a trace does not bring back."""
    infos = [info for info in c.instance.info.values() if isinstance(info.use, TraceUse)]
    if any(_loses(info) for info in infos):
        _Flow(c).block(body, frozenset())


def _loses(info: ExprInfo) -> bool:
    use = info.use
    return isinstance(use, TraceUse) and use.payload_type is not None and any(not is_returned(f, use.name) for f in use.payload_type.fields)


class _Flow:
    """Walks one body; `None` as a state says that control does not get there."""

    def __init__(self, c: Context) -> None:
        self.c = c
        self.instance: FunctionInstance = c.instance
        self.jumps: list[list[Lost]] = []
        self.reported: set[ast.AST] = set()

    def block(self, body: list[ast.stmt], lost: Lost | None) -> Lost | None:
        """What is lost behind the statements."""
        for statement in body:
            if lost is None:
                return None
            lost = self._statement(statement, lost)
        return lost

    def _statement(self, node: ast.stmt, lost: Lost) -> Lost | None:
        match node:
            case ast.If(test=test, body=body, orelse=orelse):
                lost = self._expression(test, lost)
                return _joined(self.block(body, lost), self.block(orelse, lost))
            case ast.While(test=test, body=body):
                return self._loop([test], body, lost)
            case ast.For(iter=turns, body=body):
                return self._loop([], body, self._expression(turns, lost))
            case ast.Match(subject=subject, cases=cases):
                lost = self._expression(subject, lost)
                result: Lost | None = lost
                for case in cases:
                    inner = self._expression(case.guard, lost) if case.guard is not None else lost
                    result = _joined(result, self.block(case.body, inner))
                return result
            case ast.Break() | ast.Continue():
                self.jumps[-1].append(lost)
                return None
            case ast.Return():
                self._expressions(node, lost)
                return None
            case _:
                return self._assigned(node, self._expressions(node, lost))

    def _loop(self, tests: list[ast.expr], body: list[ast.stmt], lost: Lost) -> Lost:
        """The first turn, and one that follows another; what is lost can only grow."""
        for _ in range(2):
            self.jumps.append([])
            inner = lost
            for test in tests:
                inner = self._expression(test, inner)
            end = self.block(body, inner)
            for state in (end, *self.jumps.pop()):
                lost = lost | state if state is not None else lost
        return lost

    def _assigned(self, node: ast.stmt, lost: Lost) -> Lost:
        """A field or local that is given a value is known again."""
        for target in _targets(node):
            if isinstance(target, ast.Name):
                lost = frozenset(item for item in lost if item[0] != target.id)
            elif isinstance(target, ast.Attribute) and isinstance(target.value, ast.Name):
                lost = lost - {(target.value.id, target.attr)}
        return lost

    def _expressions(self, node: ast.stmt, lost: Lost) -> Lost:
        """The values of a statement, and what its targets read: indices, and an augmented target itself."""
        targets = _targets(node)
        for child in _children(node):
            if not targets or child is getattr(node, "value", None):
                lost = self._expression(child, lost)
        for target in targets:
            while isinstance(target, ast.Attribute | ast.Subscript):
                if isinstance(target, ast.Subscript):
                    lost = self._expression(target.slice, lost)
                elif isinstance(node, ast.AugAssign):
                    self._read(target.value, target.attr, target, lost)
                target = target.value
        return lost

    def _expression(self, node: ast.expr, lost: Lost) -> Lost:
        """Reads, then what the calls in an expression lose and find, innermost first."""
        info = self.instance.info.get(node)
        use = info.use if info is not None else None
        match node, use:
            case _, TraceUse(payload=payload, payload_type=struct) if struct is not None and payload is not None:
                for child in _children(node):
                    lost = lost if child is payload else self._expression(child, lost)
                return self._traced(use, payload, struct, lost)
            case _, HelperUse():
                return self._called(node, use, lost)
            case ast.Attribute(value=base), FieldUse(name=name):
                self._read(base, name, node, lost)
                return lost if isinstance(base, ast.Name) else self._expression(base, lost)
            case ast.Name(), LocalUse():
                self._whole(node, lost)
                return lost
        for child in _children(node):
            lost = self._expression(child, lost)
        return lost

    def _traced(self, use: TraceUse, payload: ast.expr, struct: t.Struct, lost: Lost) -> Lost:
        name = self._local(payload)
        if name is None:
            return lost
        for field in struct.fields:
            if (name, field.name) in lost and is_passed(field, use.name):
                self._report(payload, struct, field.name, "is passed to another trace")
        known = {(name, field.name) for field in struct.fields if is_returned(field, use.name)}
        return lost - known | {(name, field.name) for field in struct.fields} - known

    def _called(self, node: ast.expr, use: HelperUse, lost: Lost) -> Lost:
        """A helper reads and writes the payload that it is given as its own body does."""
        for argument, parameter in zip(use.arguments, use.instance.parameters, strict=False):
            name = self._local(argument) if isinstance(argument, ast.expr) else None
            if name is None or not parameter.local.by_reference:
                lost = self._expression(argument, lost) if isinstance(argument, ast.expr) else lost
                continue
            accesses = use.instance.payload_accesses.get(parameter.local.name, [])
            for access in accesses:
                if not access.is_write and (name, access.field) in lost:
                    assert isinstance(parameter.local.type, t.Struct)
                    self._report(node, parameter.local.type, access.field, f"is read by `{use.instance.name}`")
            lost = lost - {(name, access.field) for access in accesses if access.is_write}
        return lost

    def _local(self, node: ast.expr) -> str | None:
        info = self.instance.info.get(node)
        return node.id if isinstance(node, ast.Name) and info is not None and isinstance(info.use, LocalUse) else None

    def _read(self, base: ast.expr, field: str, node: ast.AST, lost: Lost) -> None:
        name = self._local(base)
        if name is not None and (name, field) in lost:
            self._report(node, self.instance.info[base].type, field, "is read")

    def _whole(self, node: ast.Name, lost: Lost) -> None:
        """A use of the whole struct reads all fields."""
        for name, field in sorted(lost):
            if name == node.id:
                self._report(node, self.instance.info[node].type, field, "is read")
                return

    def _report(self, node: ast.AST, struct: object, field: str, what: str) -> None:
        if node in self.reported:
            return
        self.reported.add(node)
        message = f"`{struct}.{field}` {what} after a trace that does not bring it back"
        self.c.error("OX317", node, message, 'its payload_word() needs caller="r", or give it a value before')


def _targets(node: ast.stmt) -> list[ast.expr]:
    """What a statement assigns to, tuples taken apart."""
    match node:
        case ast.Assign(targets=targets):
            return [one for target in targets for one in (target.elts if isinstance(target, ast.Tuple | ast.List) else [target])]
        case ast.AnnAssign(target=target) | ast.AugAssign(target=target):
            return [target]
    return []


def _children(node: ast.AST) -> Iterator[ast.expr]:
    """Expressions below a node, keywords' values included."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.keyword):
            yield child.value
        elif isinstance(child, ast.expr):
            yield child


def _joined(first: Lost | None, second: Lost | None) -> Lost | None:
    if first is None or second is None:
        return first if second is None else second
    return first | second
