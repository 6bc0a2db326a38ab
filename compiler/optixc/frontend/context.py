"""What the checker knows while it checks one function: names, environment, results so far, and the way to report.

The parts of the checker are modules of functions that take a `Context`; they reach each other through `Context.check`, so that no
two modules import each other.
"""

from __future__ import annotations

import ast
from collections.abc import Callable
from dataclasses import dataclass, field

from optixc.diagnostics import ChainLink
from optixc.frontend.checked import CallSite, ConstantUse, ExprInfo, FunctionInstance, PayloadAccess, Requirement
from optixc.frontend.conversions import can_convert, fits
from optixc.frontend.declarations import Declarations
from optixc.frontend.environment import Environment, Way
from optixc.frontend.source_file import Diagnostics, SourceFile
from optixc.frontend.symbols import ConstantSymbol, FunctionSymbol
from optixc.frontend.weak import INVALID, CheckType, Invalid, default_type, is_integer, is_weak, widened
from optixc.ir import types as t
from optixc.ir.nodes import Local
from optixc.ir.programs import ProgramKind
from optixc.source import Span


@dataclass(eq=False)
class Loop:
    """The loop around the current statement: the ways that leave it by break and that go round by continue."""

    base: Environment
    breaks: list[Way] = field(default_factory=list)
    continues: list[Way] = field(default_factory=list)


@dataclass(eq=False)
class Hooks:
    """Parts of the checker that others call: expressions, instances of helpers, module constants; and what functions bind."""

    expression: Callable[[Context, ast.expr], ExprInfo]
    helper: Callable[[Context, FunctionSymbol, list[t.Type | None], ast.expr], FunctionInstance | None]
    constant: Callable[[Context, ConstantSymbol], ConstantUse | None]
    host_constant: Callable[[ConstantSymbol], str]
    params: Callable[[Context, t.Struct, ast.expr], None]
    expression_of: Callable[[Declarations, ast.expr], FunctionInstance]
    bound_names: dict[ast.FunctionDef, frozenset[str]] = field(default_factory=dict)


def place_text(what: str | ast.expr) -> str:
    """What a message calls a place. Its text is made only for a message: making it takes longer than checking it."""
    return what if isinstance(what, str) else f"`{ast.unparse(what)}`"


@dataclass(eq=False)
class Context:
    """The state of checking one function instance. `scope` is the module scope of its definition."""

    scope: Declarations
    instance: FunctionInstance
    diagnostics: Diagnostics
    hooks: Hooks
    chain: tuple[ChainLink, ...] = ()
    environment: Environment = field(default_factory=Environment)
    loops: list[Loop] = field(default_factory=list)
    returns: list[ast.Return] = field(default_factory=list)
    declared: dict[str, t.Type] = field(default_factory=dict)
    poisoned: set[str] = field(default_factory=set)
    stored: ast.expr | None = None
    """The innermost field of the place that is being assigned: `ray.color` of `ray.color.x = 1.0`, which does not read it."""

    @property
    def source(self) -> SourceFile:
        """The file of the function."""
        return self.scope.file.source

    @property
    def kind(self) -> ProgramKind | None:
        """The program's kind, None in a helper."""
        return self.instance.kind

    def span(self, node: ast.AST) -> Span:
        """The place of a node."""
        return self.source.span(node)

    def error(self, code: str, node: ast.AST | Span, message: str, note: str = "") -> ExprInfo:
        """Report, with the call chain of this instance, and give the info of a bad expression."""
        self.diagnostics.add(self.source, code, node, message, note, self.chain)
        return ExprInfo(INVALID)

    def check(self, node: ast.expr) -> ExprInfo:
        """Check an expression and keep what was found."""
        found = self.instance.info[node] = self.hooks.expression(self, node)
        return found

    def info(self, node: ast.expr) -> ExprInfo:
        """What was found for an expression checked before."""
        return self.instance.info[node]

    def require(self, what: str, allowed: frozenset[ProgramKind], node: ast.AST, code: str = "OX304") -> None:
        """Note that only some program kinds may do this."""
        self.instance.requirements.append(Requirement(what, allowed, self.span(node), code))

    def note_call(self, callee: FunctionInstance, node: ast.AST, payloads: tuple[tuple[str, str], ...]) -> None:
        """Note a call of a helper; `payloads` pairs our locals with its parameters that name the same struct."""
        self.instance.calls.append(CallSite(callee, self.span(node), payloads))
        if callee.writes:
            self.instance.writes = True

    def note_payload_access(self, local: Local, access: PayloadAccess) -> None:
        """Note a read or write of a payload parameter's field."""
        self.instance.payload_accesses.setdefault(local.name, []).append(access)

    def coerce(self, node: ast.expr, target: t.Type, what: str | ast.expr) -> bool:
        """Make an expression checked before a value of `target`, or report; `what` is or names the place ("argument `tmin`")."""
        info = self.info(node)
        value_type = widened(target)
        if isinstance(info.type, Invalid) or info.type == value_type:
            return True
        if not can_convert(info.type, target):
            self.error("OX302", node, f"{place_text(what)} must be {target}, this is {describe(info.type)}", remedy(info.type, target))
            return False
        if is_weak(info.type) and info.constant is None and isinstance(node, ast.IfExp):
            return (
                self.coerce(node.body, value_type, what) and self.coerce(node.orelse, value_type, what) and self._convert(info, value_type)
            )
        if is_weak(info.type) and info.constant is None and isinstance(node, ast.BinOp | ast.UnaryOp):
            return self._coerce_operation(node, info, value_type, what)
        if isinstance(node, ast.Tuple) and isinstance(value_type, t.Tuple | t.Vector):
            items = value_type.items if isinstance(value_type, t.Tuple) else (value_type.element,) * value_type.size
            fits_all = [self.coerce(item, target_item, what) for item, target_item in zip(node.elts, items, strict=True)]
            if not all(fits_all):
                return False
        if info.constant is not None and isinstance(target, t.Scalar) and not self._constant_fits(node, info, target, what):
            return False
        return self._convert(info, value_type)

    def _coerce_operation(self, node: ast.BinOp | ast.UnaryOp, info: ExprInfo, target: t.Type, what: str | ast.expr) -> bool:
        """Operators on literals, such as `1 << n`: calculated in the integer type that is wanted, for all others in their own."""
        type_ = target if is_integer(target) else default_type(info.type)
        operands = [node.operand] if isinstance(node, ast.UnaryOp) else [node.left]
        if isinstance(node, ast.BinOp) and not isinstance(node.op, ast.LShift | ast.RShift):
            operands.append(node.right)
        if not all(self.coerce(operand, type_, what) for operand in operands):
            return False
        info.type = type_
        return type_ == target or self._convert(info, target)

    def _convert(self, info: ExprInfo, target: t.Type) -> bool:
        info.converted = target
        return True

    def _constant_fits(self, node: ast.expr, info: ExprInfo, target: t.Scalar, what: str | ast.expr) -> bool:
        if is_weak(info.type) and isinstance(info.constant, int) and not fits(info.constant, target):
            wider = next((wide for wide in (t.UINT32, t.INT64, t.UINT64) if fits(info.constant, wide)), None)
            note = f"expected {range_of(target)}"
            if what == "this" and wider is not None:
                note = f"write {wider}({info.constant})"
            self.error("OX313", node, f"{place_text(what)} is {target}, which does not hold {info.constant}", note)
            return False
        return True

    def settle(self, node: ast.expr) -> t.Type:
        """Give a value that nothing else types its own type: literals become int32 or float32."""
        info = self.info(node)
        target = default_type(info.type)
        if target != info.type and not isinstance(info.type, Invalid):
            self.coerce(node, target, "this")
        return info.converted or target

    def type_of(self, node: ast.expr) -> CheckType:
        """The type of an expression after the conversion of its place."""
        info = self.info(node)
        return info.converted or info.type


def describe(type_: CheckType) -> str:
    """A type in the author's words."""
    if isinstance(type_, t.Void):
        return "nothing (the call gives no value)"
    return f"an {type_}" if str(type_)[0] in "aeiou" and is_weak(type_) else f"a {type_}" if is_weak(type_) else str(type_)


def range_of(type_: t.Scalar) -> str:
    """The values of an integer type."""
    if type_.kind is t.ScalarKind.UINT:
        return f"0 to {(1 << type_.bits) - 1}"
    return f"-{1 << (type_.bits - 1)} to {(1 << (type_.bits - 1)) - 1}"


def remedy(source: CheckType, target: CheckType) -> str:
    """How the author writes the conversion out, where one exists."""
    if isinstance(target, t.Scalar) and (is_weak(source) or isinstance(source, t.Scalar)):
        if target.kind is t.ScalarKind.BOOL:
            return "write a comparison, e.g. `!= 0`"
        return f"write {target}(...)" if target.bits >= 32 else f"write {widened(target)}(...)"
    if isinstance(target, t.Vector) and isinstance(source, t.Vector) and source.size == target.size:
        return f"write {target}(...)"
    if isinstance(target, t.Vector) and (is_weak(source) or isinstance(source, t.Scalar)):
        return f"write {target}(x) to spread a number over all components"
    return f"expected {target}"
