"""Expressions of the intermediate representation: pure, typed, without SSA. See `nodes` for what the whole promises."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from optixc.ir.types import Struct, Type
from optixc.source import Span


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
    """`base[index]`: base is a fixed array or cooperative vector (element), a vector (scalar) or a matrix (row vector); index is int32
    or uint32."""

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

    A fixed array without arguments is all zero, and so is a cooperative vector, which may also have one number for all elements.
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
