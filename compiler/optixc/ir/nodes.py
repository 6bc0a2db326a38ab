"""The intermediate representation: structured, typed, without SSA.

Expressions are pure: they read locals, parameters and memory and change nothing, so that they may be printed in any order that
C++ likes. Statements act. A source expression that can write (a trace, a call that stores, an atomic) is hoisted by `lower` into
a statement before its use, with Python's left-to-right order kept. Every node's docstring is its typing rule; `verify` checks it.
Nodes are frozen; passes build new ones.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum

from optixc.ir.expressions import (
    ArrayShape,
    Binary,
    BinaryOp,
    ComponentRef,
    Construct,
    Convert,
    ElementRef,
    Expr,
    FieldRef,
    HelperCall,
    IndexRef,
    IntrinsicCall,
    Literal,
    Local,
    LocalRef,
    Logical,
    ParamsRef,
    Place,
    Select,
    TupleItem,
    Unary,
    UnaryOp,
    Uniformity,
)
from optixc.ir.programs import ProgramKind
from optixc.ir.types import FixedArray, Struct, Type
from optixc.source import Span

__all__ = [
    "ArrayShape",
    "Assert",
    "Assign",
    "Binary",
    "BinaryOp",
    "Break",
    "CallCallable",
    "CallHelper",
    "CallIntrinsic",
    "ComponentRef",
    "Construct",
    "Continue",
    "Convert",
    "ElementRef",
    "Expr",
    "FieldRef",
    "ForRange",
    "Function",
    "HelperCall",
    "If",
    "IndexRef",
    "IntrinsicCall",
    "Literal",
    "Local",
    "LocalRef",
    "Logical",
    "Module",
    "Parameter",
    "ParameterRole",
    "ParamsRef",
    "Pipeline",
    "PipelineOptions",
    "Place",
    "Print",
    "Return",
    "Select",
    "Stmt",
    "Trace",
    "TupleItem",
    "Unary",
    "UnaryOp",
    "Uniformity",
    "While",
    "is_reference_type",
]


@dataclass(frozen=True)
class Assign:
    """`target = value`; equal types, except that a storage scalar takes its 32-bit type and converts as C does."""

    target: Place
    value: Expr
    span: Span


@dataclass(frozen=True)
class If:
    """`if condition: then_body else: else_body`; condition is bool."""

    condition: Expr
    then_body: tuple[Stmt, ...]
    else_body: tuple[Stmt, ...]
    span: Span


@dataclass(frozen=True)
class While:
    """Evaluate `condition_body`, stop unless `condition`; then run `body`. `bounded` if a pass proved that the turns are finite.

    `condition_body` holds what `lower` hoisted from the condition; `continue` goes to it.
    """

    condition_body: tuple[Stmt, ...]
    condition: Expr
    body: tuple[Stmt, ...]
    bounded: bool
    span: Span


@dataclass(frozen=True)
class ForRange:
    """`for target in range(start, stop, step)`; int32 or uint32 alike, bounds evaluated once before; target keeps its last value."""

    target: Local
    start: Expr
    stop: Expr
    step: Expr
    body: tuple[Stmt, ...]
    span: Span


@dataclass(frozen=True)
class Break:
    span: Span


@dataclass(frozen=True)
class Continue:
    span: Span


@dataclass(frozen=True)
class Return:
    """Leave the function; value has the function's result type, None in a function without one."""

    value: Expr | None
    span: Span


@dataclass(frozen=True)
class CallHelper:
    """A helper call that can write or whose result is unused; `target` is a local of the result's type or None.

    Arguments of by-reference parameters are places (or read-only struct expressions where the helper does not write).
    """

    target: Local | None
    function: str
    arguments: tuple[Expr, ...]
    span: Span


@dataclass(frozen=True)
class CallIntrinsic:
    """A device function with an effect (atomics, set_payload, report_intersection, throw_exception ...); see its table row.

    `report_intersection` takes t, kind and then either one attributes struct or up to 8 scalars of 32 bits; target is bool.
    """

    target: Local | None
    name: str
    arguments: tuple[Expr, ...]
    span: Span


@dataclass(frozen=True)
class Trace:
    """trace, traverse (`name` says which) or invoke; `arguments` in the order handle, origin, direction, tmin, tmax, ray_time,
    visibility_mask, ray_flags, sbt_offset, sbt_stride, miss_sbt_index, none for invoke. `payload` is the place of a payload struct,
    or None for a trace without payload. The tuple form is lowered to a local of a made struct `PayloadWords...`."""

    name: str
    arguments: tuple[Expr, ...]
    payload: Expr | None
    payload_type: Struct | None
    span: Span


@dataclass(frozen=True)
class CallCallable:
    """direct_call or continuation_call of callables record `index`; arguments are values; target has the result type."""

    target: Local | None
    is_direct: bool
    index: Expr
    arguments: tuple[Expr, ...]
    result: Type
    span: Span


@dataclass(frozen=True)
class Assert:
    """`assert condition, message`: a fault with the source line if condition is false; compiled in debug and validation only.

    `values` are scalars that the fault shows by name; passes of checked builds find them.
    """

    condition: Expr
    message: str
    span: Span
    values: tuple[Expr, ...] = ()


@dataclass(frozen=True)
class Print:
    """`print(...)`: strings and expressions in order, one line written at once; `separator` and `end` as in Python."""

    items: tuple[Expr | str, ...]
    separator: str
    end: str
    span: Span


Stmt = Assign | If | While | ForRange | Break | Continue | Return | CallHelper | CallIntrinsic | Trace | CallCallable | Assert | Print


class ParameterRole(Enum):
    """What an entry parameter of a program is; parameters of helpers and the ordinary ones of callables are VALUE."""

    VALUE = "value"
    PAYLOAD = "payload"
    ATTRIBUTES = "attributes"
    RECORD = "record"


@dataclass(frozen=True)
class Parameter:
    """A parameter; PAYLOAD is by reference and writable, ATTRIBUTES a value, RECORD read-only by reference.

    `hidden` if the author did not write it: a record that get_sbt_data() reads.
    """

    local: Local
    role: ParameterRole = ParameterRole.VALUE
    written: bool = False
    hidden: bool = False


@dataclass(frozen=True)
class Function:
    """A program (`kind` set, name with its prefix) or a helper (one per call signature; `name` is unique in the module).

    `locals` holds every local that is not a parameter, in order of first assignment. `doc` is the author's docstring.
    """

    name: str
    source_name: str
    kind: ProgramKind | None
    parameters: tuple[Parameter, ...]
    result: Type
    locals: tuple[Local, ...]
    body: tuple[Stmt, ...]
    span: Span
    doc: str = ""


@dataclass(frozen=True)
class Module:
    """What one shader file or list of functions became. `structs` in order of definition, each after those that it contains."""

    name: str
    path: str
    structs: tuple[Struct, ...]
    params: Struct | None
    helpers: tuple[Function, ...]
    programs: tuple[Function, ...]


@dataclass(frozen=True)
class Pipeline:
    """The unit of code generation: the programs that the pipeline's groups name, from all its modules, and their helpers.

    Names are unique in it (`passes.pipeline` renames helpers and structs that differ but share a name).
    """

    structs: tuple[Struct, ...]
    params: Struct | None
    helpers: tuple[Function, ...]
    programs: tuple[Function, ...]
    options: PipelineOptions


@dataclass(frozen=True)
class PipelineOptions:
    """What of the pipeline's options reaches passes and emitters. `lanes` is 1 (scalar), 8 or 16."""

    max_trace_depth: int = 1
    lanes: int = 1
    fast_math: bool = False
    debug: bool = False
    trap_nan: bool = False
    checks_bounds: bool = True
    validation: bool = False
    uses_motion_blur: bool = False
    allow_opacity_micromaps: bool = False
    traversable_graph_flags: int = 0
    primitive_type_flags: int = 0
    exception_flags: int = 0
    bound_values: tuple[tuple[str, Literal], ...] = field(default=())


def is_reference_type(type_: Type) -> bool:
    """Whether helpers take this type by reference: structs and fixed arrays do, as in Python."""
    return isinstance(type_, Struct | FixedArray)
