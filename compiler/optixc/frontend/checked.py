"""What checking leaves: for every function instance the type of each expression, what each name and call means, and each conversion.

`lower` and the interpreter read this and derive nothing anew. A helper whose parameters have no annotation has one instance per
list of argument types; each has its own `info`, keyed by the nodes of the one tree that they share.
"""

from __future__ import annotations

import ast
from dataclasses import dataclass, field

from optixc.frontend.source_file import SourceFile
from optixc.frontend.symbols import ConstantSymbol, FunctionSymbol
from optixc.frontend.weak import CheckType, ConstantValue
from optixc.ir import types as t
from optixc.ir.intrinsics import Intrinsic
from optixc.ir.nodes import Local, ParameterRole
from optixc.ir.programs import ProgramKind
from optixc.source import Span


@dataclass(frozen=True)
class LocalUse:
    """A name that is a local or parameter."""

    local: Local


@dataclass(frozen=True)
class ParamsUse:
    """A name that is the launch parameters."""

    struct: t.Struct


@dataclass(frozen=True, eq=False)
class ConstantUse:
    """A name that is a constant expression of the module, checked in an instance of its own."""

    symbol: ConstantSymbol
    body: FunctionInstance


@dataclass(frozen=True)
class VectorUse:
    """A name that is a captured vector."""

    values: tuple[ConstantValue, ...]


@dataclass(frozen=True)
class FieldUse:
    """`base.name` of a struct; `stored` is the field's type, which reading may widen."""

    name: str
    stored: t.Type


@dataclass(frozen=True)
class SwizzleUse:
    """`base.xyz` of a vector."""

    components: tuple[int, ...]


@dataclass(frozen=True)
class ShapeUse:
    """`array.shape`, a tuple; with `axis`, `array.shape[axis]` or `len(array)`."""

    array: ast.expr
    axis: int | None = None


@dataclass(frozen=True)
class ElementUse:
    """`array[i, j]`; `stored` is the element's type."""

    indices: tuple[ast.expr, ...]
    stored: t.Type


@dataclass(frozen=True)
class IndexUse:
    """`base[i]` of a fixed array, vector or matrix."""

    index: ast.expr
    stored: t.Type


@dataclass(frozen=True)
class TupleUse:
    """`base[i]` of a tuple, i known."""

    index: int


@dataclass(frozen=True)
class DefaultArgument:
    """An argument that the call leaves out: a constant of the parameter's type."""

    value: ConstantValue
    type: t.Type


@dataclass(frozen=True, eq=False)
class DefaultExpression:
    """An argument or field that is left out, with the default written in the definition."""

    node: ast.expr
    body: FunctionInstance


Argument = ast.expr | DefaultArgument | DefaultExpression


@dataclass(frozen=True)
class ConvertUse:
    """`float(x)`, `uint32(x)`, `uint8(x)`: a scalar constructor; `target` is the named type, which the result may widen."""

    argument: Argument
    target: t.Scalar


@dataclass(frozen=True)
class ConstructUse:
    """A constructor of a vector, matrix, struct or fixed array; arguments in the order of the fields.

    `spread` marks one number for all components of a vector, or one vector of another type converted.
    """

    target: t.Type
    arguments: tuple[Argument, ...]
    spread: bool = False


@dataclass(frozen=True)
class IntrinsicUse:
    """A device function with its arguments in the order of the row."""

    row: Intrinsic
    arguments: tuple[Argument, ...]


@dataclass(frozen=True)
class CoopVecUse:
    """A function of cooperative vectors: its values, and for a product the constants input interpretation, element type, layout and
    transpose."""

    row: Intrinsic
    arguments: tuple[Argument, ...]
    settings: tuple[int, ...] = ()


@dataclass(frozen=True)
class AtomicUse:
    """An atomic operation on `array[indices]`, then its values."""

    row: Intrinsic
    array: ast.expr
    indices: tuple[ast.expr, ...]
    values: tuple[ast.expr, ...]


@dataclass(frozen=True)
class SbtDataUse:
    """`get_sbt_data(T)`: the current record's data; for the hit object's record `row` is set."""

    struct: t.Struct
    row: Intrinsic | None = None


@dataclass(frozen=True)
class CopyUse:
    """`ox.copy(x)`."""

    argument: ast.expr


@dataclass(frozen=True)
class TraceUse:
    """trace, traverse or invoke; `payload` is a place, or a tuple of scalars of `words`."""

    name: str
    arguments: tuple[Argument, ...]
    payload: ast.expr | None
    payload_type: t.Struct | None
    words: tuple[t.Type, ...] | None = None


@dataclass(frozen=True)
class BreakpointUse:
    """`breakpoint()`: the interpreter stops there, compiled code runs on."""


@dataclass(frozen=True)
class ReportUse:
    """report_intersection or throw_exception: fixed arguments, then one attributes struct or scalars of 32 bits."""

    row: Intrinsic
    arguments: tuple[ast.expr, ...]


@dataclass(frozen=True)
class CallableUse:
    """direct_call or continuation_call."""

    is_direct: bool
    index: ast.expr
    arguments: tuple[ast.expr, ...]
    result: t.Type


@dataclass(frozen=True, eq=False)
class HelperUse:
    """A call of a helper's instance; arguments in the order of its parameters."""

    instance: FunctionInstance
    arguments: tuple[Argument, ...]


Use = (
    LocalUse
    | ParamsUse
    | ConstantUse
    | VectorUse
    | FieldUse
    | SwizzleUse
    | ShapeUse
    | ElementUse
    | IndexUse
    | TupleUse
    | ConvertUse
    | ConstructUse
    | IntrinsicUse
    | CoopVecUse
    | AtomicUse
    | SbtDataUse
    | CopyUse
    | TraceUse
    | BreakpointUse
    | ReportUse
    | CallableUse
    | HelperUse
)


@dataclass(eq=False, slots=True)
class ExprInfo:
    """What is known of one expression. `converted` is the type that the place where it stands makes of it, if another.

    `constant` is its value if it is a scalar known now. `writes` tells whether evaluating it can change anything. `fresh` tells
    that a struct or fixed array is new, so that nothing else names it.
    """

    type: CheckType
    constant: ConstantValue | None = None
    converted: t.Type | None = None
    writes: bool = False
    fresh: bool = False
    use: Use | None = None


@dataclass(eq=False)
class InstanceParameter:
    """A parameter of an instance; `written` is about parameters by reference, through helpers too."""

    local: Local
    role: ParameterRole = ParameterRole.VALUE
    written: bool = False


@dataclass(frozen=True)
class Requirement:
    """Something that only some kinds of programs may do, and where it is done."""

    what: str
    allowed: frozenset[ProgramKind]
    span: Span
    code: str = "OX304"


@dataclass(frozen=True, eq=False)
class CallSite:
    """A call of a helper instance, for call chains; `payloads` pairs the caller's structs with the parameters they are passed for."""

    instance: FunctionInstance
    span: Span
    payloads: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True)
class PayloadAccess:
    """A read or write of a field of a payload parameter, for the check of payload word semantics."""

    field: str
    is_write: bool
    span: Span


@dataclass(eq=False)
class FunctionInstance:
    """One program, or one helper for one list of argument types."""

    symbol: FunctionSymbol | None
    name: str
    source: SourceFile
    kind: ProgramKind | None
    parameters: list[InstanceParameter] = field(default_factory=list)
    result: t.Type = t.VOID
    info: dict[ast.expr, ExprInfo] = field(default_factory=dict)
    bindings: dict[ast.AST, Local] = field(default_factory=dict)
    locals: dict[str, dict[t.Type, Local]] = field(default_factory=dict)
    local_names: set[str] = field(default_factory=set)
    dead: set[ast.stmt] = field(default_factory=set)
    augmented: dict[ast.AugAssign, ast.BinOp] = field(default_factory=dict)
    requirements: list[Requirement] = field(default_factory=list)
    calls: list[CallSite] = field(default_factory=list)
    payload_accesses: dict[str, list[PayloadAccess]] = field(default_factory=dict)
    writes: bool = False
    is_complete: bool = False
    is_recursive: bool = False

    def local_of(self, name: str, type_: t.Type) -> Local:
        """The local that the author's `name` means with this type; the second type of a name gets a number."""
        by_type = self.locals.setdefault(name, {})
        found = by_type.get(type_)
        if found is None:
            if not self.local_names:
                self.local_names.update(parameter.local.name for parameter in self.parameters)
            unique, number = name, 2
            while unique in self.local_names:
                unique, number = f"{name}_{number}", number + 1
            self.local_names.add(unique)
            found = by_type[type_] = Local(unique, type_)
        return found

    def types_of(self, name: str) -> list[t.Type]:
        """The types that locals of this name have so far."""
        return list(self.locals.get(name, ()))

    def all_locals(self) -> list[Local]:
        """Every local that is no parameter, in order of first binding of its name."""
        return [local for by_type in self.locals.values() for local in by_type.values()]


def returned_value(node: ast.Return) -> ast.expr | None:
    """The expression that a return statement gives; `return None` gives nothing, like `return`."""
    if isinstance(node.value, ast.Constant) and node.value.value is None:
        return None
    return node.value


@dataclass(eq=False)
class Checked:
    """A checked compilation: programs in order of definition, helper instances in order of first completion."""

    name: str
    path: str
    structs: tuple[t.Struct, ...]
    params: t.Struct | None
    programs: list[FunctionInstance]
    helpers: list[FunctionInstance]
    dependencies: tuple[str, ...] = ()
