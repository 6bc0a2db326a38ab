"""The intermediate representation: structured, typed, without SSA.

Expressions are pure: they read locals, parameters and memory and change nothing, so that they may be printed in any order that
C++ likes. Statements act. A source expression that can write (a trace, a call that stores, an atomic) is hoisted by `lower` into
a statement before its use, with Python's left-to-right order kept. Every node's docstring is its typing rule; `verify` checks it.
Nodes are frozen; passes build new ones.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum

from optixc.ir.programs import ProgramKind
from optixc.ir.types import FixedArray, Struct, Type
from optixc.source import Span

# ---- names ------------------------------------------------------------------------------------------------------------------


class Uniformity(Enum):
    """Whether all lanes of a packet hold one value; UNKNOWN until the uniformity pass ran."""

    UNKNOWN = "unknown"
    UNIFORM = "uniform"
    VARYING = "varying"


@dataclass(frozen=True)
class Local:
    """A variable of one function. `name` is the author's, unique within the function (lower appends _2, _3 ... where types differ).

    `by_reference` marks a parameter that names the caller's struct or fixed array instead of holding a value.
    """

    name: str
    type: Type
    by_reference: bool = False
    uniformity: Uniformity = Uniformity.UNKNOWN


# ---- expressions ------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Literal:
    """A constant of a scalar, vector or enum's scalar type; `value` is a bool, int, float or a tuple of them (vectors)."""

    value: bool | int | float | tuple[bool | int | float, ...]
    type: Type


@dataclass(frozen=True)
class LocalRef:
    """The value of a local or parameter; has the local's type."""

    local: Local

    @property
    def type(self) -> Type:
        return self.local.type


@dataclass(frozen=True)
class ParamsRef:
    """The launch parameters; a read-only struct."""

    type: Struct


@dataclass(frozen=True)
class FieldRef:
    """`base.name`; base has a struct type, the result the field's type (storage scalars are widened by an outer Convert)."""

    base: Expr
    name: str
    type: Type


@dataclass(frozen=True)
class ComponentRef:
    """`base.x`, `base.zyx`: base is a vector; one index gives its scalar, several a vector of that size."""

    base: Expr
    components: tuple[int, ...]
    type: Type


@dataclass(frozen=True)
class IndexRef:
    """`base[index]`: base is a fixed array (element), a vector (scalar) or a matrix (row vector); index is int32 or uint32."""

    base: Expr
    index: Expr
    type: Type


@dataclass(frozen=True)
class TupleItem:
    """`base[index]` of a tuple, index known."""

    base: Expr
    index: int
    type: Type


@dataclass(frozen=True)
class ElementRef:
    """An element of an array in memory; `indices` are one integer per axis; a value when read, a place when stored to."""

    array: Expr
    indices: tuple[Expr, ...]
    type: Type
    span: Span


@dataclass(frozen=True)
class ArrayShape:
    """`array.shape[axis]`; uint64 in memory, int32 here."""

    array: Expr
    axis: int
    type: Type


class UnaryOp(Enum):
    NEGATE = "-"
    INVERT = "~"
    NOT = "not"


@dataclass(frozen=True)
class Unary:
    """`op operand`; NEGATE of numbers, INVERT of integers, both element-wise, NOT of bool."""

    op: UnaryOp
    operand: Expr
    type: Type


class BinaryOp(Enum):
    ADD = "+"
    SUBTRACT = "-"
    MULTIPLY = "*"
    DIVIDE = "/"
    FLOOR_DIVIDE = "//"
    MODULO = "%"
    POWER = "**"
    MATRIX_MULTIPLY = "@"
    BIT_AND = "&"
    BIT_OR = "|"
    BIT_XOR = "^"
    SHIFT_LEFT = "<<"
    SHIFT_RIGHT = ">>"
    EQUAL = "=="
    NOT_EQUAL = "!="
    LESS = "<"
    LESS_EQUAL = "<="
    GREATER = ">"
    GREATER_EQUAL = ">="


@dataclass(frozen=True)
class Binary:
    """`left op right`; operands have the type of the result, except comparisons (result bool, operands equal scalars, or equal
    vectors for == and != of all components), a vector and its scalar under + - * / // % & | ^ << >>, shifts (count uint32 or
    int32) and @ (matrix by vector or matrix)."""

    op: BinaryOp
    left: Expr
    right: Expr
    type: Type
    span: Span


@dataclass(frozen=True)
class Logical:
    """`left and right` (is_and) or `left or right`, both bool, right evaluated only if it decides."""

    is_and: bool
    left: Expr
    right: Expr
    type: Type


@dataclass(frozen=True)
class Select:
    """`if_true if condition else if_false`; branches have the result's type and only the chosen one is evaluated."""

    condition: Expr
    if_true: Expr
    if_false: Expr
    type: Type


@dataclass(frozen=True)
class Convert:
    """A change of scalar type, element-wise on vectors, or a scalar spread over a vector; uint64 to a handle keeps the bits.

    float to int truncates and saturates; a number to 8 or 16 bits and back is what storing and reading would keep of it.
    """

    operand: Expr
    type: Type


@dataclass(frozen=True)
class Construct:
    """A vector (scalars and vectors in order), matrix (rows or scalars), struct (fields in order), tuple or fixed array (items).

    A fixed array without arguments is all zero.
    """

    type: Type
    arguments: tuple[Expr, ...]


@dataclass(frozen=True)
class IntrinsicCall:
    """A pure device function of the table: maths, getters. `name` is the table's key; arguments follow the row, all given."""

    name: str
    arguments: tuple[Expr, ...]
    type: Type
    span: Span


@dataclass(frozen=True)
class HelperCall:
    """A call of a helper that writes nothing and returns a value; `function` is the helper's unique name."""

    function: str
    arguments: tuple[Expr, ...]
    type: Type
    span: Span


Expr = (
    Literal
    | LocalRef
    | ParamsRef
    | FieldRef
    | ComponentRef
    | IndexRef
    | TupleItem
    | ElementRef
    | ArrayShape
    | Unary
    | Binary
    | Logical
    | Select
    | Convert
    | Construct
    | IntrinsicCall
    | HelperCall
)

Place = LocalRef | FieldRef | ComponentRef | IndexRef | ElementRef
"""What can be assigned to: a chain of FieldRef, ComponentRef (one component), IndexRef that ends in a LocalRef or an ElementRef."""


# ---- statements -------------------------------------------------------------------------------------------------------------


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
    """Evaluate `condition_body`, stop unless `condition`; then run `body`. `bounded` if the number of turns is provably finite.

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
    """`assert condition, message`: a fault with the source line if condition is false; compiled in debug and validation only."""

    condition: Expr
    message: str
    span: Span


@dataclass(frozen=True)
class Print:
    """`print(...)`: strings and expressions in order, one line written at once; `separator` and `end` as in Python."""

    items: tuple[Expr | str, ...]
    separator: str
    end: str
    span: Span


Stmt = (
    Assign
    | If
    | While
    | ForRange
    | Break
    | Continue
    | Return
    | CallHelper
    | CallIntrinsic
    | Trace
    | CallCallable
    | Assert
    | Print
)


# ---- functions and modules --------------------------------------------------------------------------------------------------


class ParameterRole(Enum):
    """What an entry parameter of a program is; parameters of helpers and the ordinary ones of callables are VALUE."""

    VALUE = "value"
    PAYLOAD = "payload"
    ATTRIBUTES = "attributes"
    RECORD = "record"


@dataclass(frozen=True)
class Parameter:
    """A parameter; PAYLOAD is by reference and writable, ATTRIBUTES a value, RECORD read-only by reference."""

    local: Local
    role: ParameterRole = ParameterRole.VALUE
    written: bool = False


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
    validation: bool = False
    uses_motion_blur: bool = False
    allow_opacity_micromaps: bool = False
    traversable_graph_flags: int = 0
    exception_flags: int = 0
    bound_values: tuple[tuple[str, Literal], ...] = field(default=())


def is_reference_type(type_: Type) -> bool:
    """Whether helpers take this type by reference: structs and fixed arrays do, as in Python."""
    return isinstance(type_, Struct | FixedArray)
