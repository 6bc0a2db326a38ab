"""Expressions as C++ text, for the scalar and the SPMD emitter alike.

`Expressions` knows C++ (precedence, which operator or function says what an IR node means); what differs between emitters - names
of locals, types of values that vary, choice, memory access, hidden arguments - it asks of a `Dialect`.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol, assert_never

from optixc.codegen.cpp_literals import number
from optixc.codegen.cpp_types import field_name, is_wrapped
from optixc.ir.nodes import (
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
    Select,
    TupleItem,
    Unary,
    UnaryOp,
)
from optixc.ir.types import CoopVec, FixedArray, Matrix, Scalar, ScalarKind, Struct, Tuple, Type, Vector, scalar_of

PRIMARY, UNARY, MULTIPLY, ADD, SHIFT, COMPARE, EQUAL, BIT_AND, BIT_XOR, BIT_OR, AND, OR, CHOICE = range(16, 3, -1)


class Code(NamedTuple):
    """C++ text and how tightly its outermost operator binds."""

    text: str
    precedence: int = PRIMARY


class Dialect(Protocol):
    """What an emitter says about the pieces that differ; `Expressions` gives it the texts of operands."""

    def local(self, local: Local) -> str:
        """The name of a local or parameter."""

    def params(self) -> str:
        """The launch parameters."""

    def type_name(self, type_: Type, like: Expr) -> str:
        """The C++ type of a value of `type_` that is as uniform as the expression `like`."""

    def element(self, node: ElementRef, array: Code, indices: tuple[Code, ...]) -> Code:
        """An element of an array, read."""

    def index(self, node: IndexRef, base: Code, index: Code) -> Code:
        """An item of a fixed array, vector or matrix, read."""

    def logical(self, node: Logical, left: Code, right: Code) -> Code:
        """`and`, `or`."""

    def select(self, node: Select, condition: Code, if_true: Code, if_false: Code) -> Code:
        """A conditional expression."""

    def intrinsic(self, node: IntrinsicCall, arguments: tuple[str, ...]) -> Code:
        """A pure device function."""

    def helper(self, node: HelperCall, arguments: tuple[str, ...]) -> Code:
        """A helper that writes nothing."""

    def carries(self, struct: Struct, field: str) -> bool:
        """Whether the C++ struct has the field."""


_OPERATORS: dict[BinaryOp, tuple[str, int]] = {
    BinaryOp.ADD: ("+", ADD),
    BinaryOp.SUBTRACT: ("-", ADD),
    BinaryOp.MULTIPLY: ("*", MULTIPLY),
    BinaryOp.DIVIDE: ("/", MULTIPLY),
    BinaryOp.BIT_AND: ("&", BIT_AND),
    BinaryOp.BIT_OR: ("|", BIT_OR),
    BinaryOp.BIT_XOR: ("^", BIT_XOR),
    BinaryOp.EQUAL: ("==", EQUAL),
    BinaryOp.NOT_EQUAL: ("!=", EQUAL),
    BinaryOp.LESS: ("<", COMPARE),
    BinaryOp.LESS_EQUAL: ("<=", COMPARE),
    BinaryOp.GREATER: (">", COMPARE),
    BinaryOp.GREATER_EQUAL: (">=", COMPARE),
}

_FUNCTIONS: dict[BinaryOp, str] = {
    BinaryOp.FLOOR_DIVIDE: "oxrt::floorDivide",
    BinaryOp.MODULO: "oxrt::modulo",
    BinaryOp.POWER: "oxrt::power",
    BinaryOp.MATRIX_MULTIPLY: "oxrt::multiply",
    BinaryOp.SHIFT_LEFT: "oxrt::shiftLeft",
    BinaryOp.SHIFT_RIGHT: "oxrt::shiftRight",
}

_PLAIN_FORM: dict[BinaryOp, tuple[str, int]] = {
    BinaryOp.FLOOR_DIVIDE: ("/", MULTIPLY),
    BinaryOp.MODULO: ("%", MULTIPLY),
    BinaryOp.SHIFT_LEFT: ("<<", SHIFT),
    BinaryOp.SHIFT_RIGHT: (">>", SHIFT),
}
"""The C++ operator of a function, where the right operand is a literal for which both agree."""

_NEEDS_PARENTHESES = frozenset({SHIFT, BIT_AND, BIT_XOR, BIT_OR, COMPARE, EQUAL})
"""Operators whose operands are parenthesised unless they are unary or primary: readers and compilers mistrust the rules there."""


class Expressions:
    """Prints expressions in one dialect."""

    def __init__(self, dialect: Dialect) -> None:
        self._dialect = dialect

    def text(self, expression: Expr) -> str:
        """The expression where anything may stand."""
        return self.code(expression).text

    def at(self, expression: Expr, precedence: int) -> str:
        """The expression as an operand of an operator: in parentheses where it binds less tightly."""
        return within(self.code(expression), precedence)

    def code(self, expression: Expr) -> Code:
        """The expression and its precedence."""
        match expression:
            case Literal():
                return self._literal(expression)
            case LocalRef():
                return Code(self._dialect.local(expression.local))
            case ParamsRef():
                return Code(self._dialect.params())
            case FieldRef():
                return self._field(expression)
            case ComponentRef():
                return self._component(expression)
            case IndexRef():
                return self._dialect.index(expression, self.code(expression.base), self.code(expression.index))
            case TupleItem():
                return Code(f"oxrt::get<{expression.index}>({self.text(expression.base)})")
            case ElementRef():
                indices = tuple(self.code(index) for index in expression.indices)
                return self._dialect.element(expression, self.code(expression.array), indices)
            case ArrayShape():
                return Code(f"int32_t({self.at(expression.array, PRIMARY)}.shape[{expression.axis}])")
            case Unary():
                return self._unary(expression)
            case Binary():
                return self._binary(expression)
            case Logical():
                return self._dialect.logical(expression, self.code(expression.left), self.code(expression.right))
            case Select():
                parts = (self.code(part) for part in (expression.condition, expression.if_true, expression.if_false))
                return self._dialect.select(expression, *parts)
            case Convert():
                return self._convert(expression)
            case Construct():
                return self._construct(expression)
            case IntrinsicCall():
                return self._dialect.intrinsic(expression, tuple(self.text(argument) for argument in expression.arguments))
            case HelperCall():
                return self._dialect.helper(expression, tuple(self.text(argument) for argument in expression.arguments))
        assert_never(expression)

    def place(self, place: Expr) -> str:
        """An expression that is assigned to: wrapped payload fields are not unwrapped."""
        match place:
            case FieldRef(base=base) | ComponentRef(base=base, components=(_,)):
                return part_of(place, self.place(base))
            case IndexRef(base=base, index=index):
                return f"{self.place(base)}[{self.text(index)}]"
            case ElementRef(array=array, indices=indices):
                return f"{self.at(array, PRIMARY)}.at({', '.join(self.text(index) for index in indices)})"
            case _:
                return self.at(place, PRIMARY)

    # ---- kinds of expressions ------------------------------------------------------------------------------------------------

    def _literal(self, node: Literal) -> Code:
        if isinstance(node.value, tuple):
            assert isinstance(node.type, Vector)
            numbers = [number(value, node.type.element) for value in node.value]
            name = self._dialect.type_name(node.type, node)
            return Code(f"{name}({numbers[0] if len(set(numbers)) == 1 else ', '.join(numbers)})")
        scalar = scalar_of(node.type) or Scalar(ScalarKind.UINT, 64)
        text = number(node.value, scalar)
        if isinstance(node.type, Vector):
            return Code(f"{self._dialect.type_name(node.type, node)}({text})")
        return Code(text, UNARY if text.startswith("-") else PRIMARY)

    def _field(self, node: FieldRef) -> Code:
        struct = _struct(node.base.type)
        text = f"{self.at(node.base, PRIMARY)}.{field_name(struct, node.name)}"
        if is_wrapped(struct, node.type):
            return Code(f"{self._dialect.type_name(node.type, node)}({text})")
        return Code(text)

    def _component(self, node: ComponentRef) -> Code:
        if len(node.components) == 1:
            return Code(f"{self.at(node.base, PRIMARY)}.{'xyzw'[node.components[0]]}")
        return Code(f"oxrt::swizzle<{', '.join(map(str, node.components))}>({self.text(node.base)})")

    def _unary(self, node: Unary) -> Code:
        operand = self.at(node.operand, UNARY)
        match node.op:
            case UnaryOp.NEGATE:
                return Code(f"-{f'({operand})' if operand.startswith('-') else operand}", UNARY)
            case UnaryOp.INVERT:
                return Code(f"~{operand}", UNARY)
            case UnaryOp.NOT:
                return Code(f"!{operand}", UNARY)
        assert_never(node.op)

    def _binary(self, node: Binary) -> Code:
        operator = _OPERATORS.get(node.op) or (_PLAIN_FORM[node.op] if _has_plain_form(node) else None)
        if operator is None:
            return Code(f"{_FUNCTIONS[node.op]}({self.text(node.left)}, {self.text(node.right)})")
        symbol, precedence = operator
        if precedence in _NEEDS_PARENTHESES:
            is_chain = isinstance(node.left, Binary) and node.left.op is node.op and precedence in (BIT_AND, BIT_OR, BIT_XOR)
            floor = ADD if precedence in (COMPARE, EQUAL) else UNARY
            text = f"{self.at(node.left, precedence if is_chain else floor)} {symbol} {self.at(node.right, floor)}"
            if precedence in (BIT_AND, BIT_XOR, BIT_OR) and self._dialect.type_name(node.type, node) == "bool":
                # C++ makes an int of them.
                return Code(f"bool({text})")
            return Code(text, precedence)
        return Code(f"{self.at(node.left, precedence)} {symbol} {self.at(node.right, precedence + 1)}", precedence)

    def _convert(self, node: Convert) -> Code:
        source, target = scalar_of(node.operand.type), scalar_of(node.type)
        operand = self.text(node.operand)
        name = self._dialect.type_name(node.type, node)
        if source is None or target is None:
            return Code(f"{name}({operand})")
        if isinstance(node.operand.type, Scalar) and isinstance(node.type, Vector):
            return Code(f"{name}({operand if source == target else self._converted(operand, source, target, node)})")
        if isinstance(node.type, Vector):
            return Code(operand if source == target else f"oxrt::convert<{self._dialect_scalar(target)}>({operand})")
        return Code(self._converted(operand, source, target, node))

    def _converted(self, operand: str, source: Scalar, target: Scalar, node: Convert) -> str:
        saturates = source.kind is ScalarKind.FLOAT and target.kind in (ScalarKind.INT, ScalarKind.UINT)
        name = self._dialect.type_name(target, node)
        if saturates or name != self._dialect_scalar(target):
            return f"oxrt::convert<{self._dialect_scalar(target)}>({operand})"
        return f"{name}({operand})"

    def _dialect_scalar(self, scalar: Scalar) -> str:
        return self._dialect.type_name(scalar, Literal(0, scalar))

    def _construct(self, node: Construct) -> Code:
        arguments = [self.text(argument) for argument in node.arguments]
        name = self._dialect.type_name(node.type, node)
        match node.type:
            case Vector():
                return Code(f"{name}({', '.join(arguments)})")
            case Matrix(columns=columns):
                if node.arguments and isinstance(node.arguments[0].type, Scalar):
                    row_type = self._dialect.type_name(Vector(Scalar(ScalarKind.FLOAT, 32), columns), node)
                    starts = range(0, len(arguments), columns)
                    arguments = [f"{row_type}({', '.join(arguments[i : i + columns])})" for i in starts]
                return Code(f"{name}{{{{{', '.join(arguments)}}}}}")
            case Struct(fields=fields):
                parts = zip(fields, node.arguments, arguments, strict=True)
                kept = [(field.type, value, text) for field, value, text in parts if self._dialect.carries(node.type, field.name)]
                return Code(f"{name}{{{', '.join(self._initialisers(node, kept))}}}")
            case FixedArray(element=element):
                items = self._initialisers(node, [(element, value, text) for value, text in zip(node.arguments, arguments, strict=True)])
                return Code(f"{name}{{{{{', '.join(items)}}}}}" if items else f"{name}{{}}")
            case CoopVec():
                return Code(f"oxrt::coopVecOf<{name}>({', '.join(arguments)})")
            case Tuple():
                return Code(f"oxrt::makeTuple({', '.join(arguments)})")
            case _:
                return Code(f"{name}({', '.join(arguments)})")

    def _initialisers(self, node: Construct, values: list[tuple[Type, Expr, str]]) -> list[str]:
        """Initialisers of a struct's fields or an array's items, with their types; storage types are narrowed as an assignment would."""
        parts = []
        for type_, argument, text in values:
            if isinstance(type_, Scalar) and type_ != argument.type:
                parts.append(f"{self._dialect.type_name(type_, argument)}({text})")
            else:
                parts.append(self.stored(text, argument, type_))
        return parts

    def stored(self, text: str, value: Expr, target: Type) -> str:
        """The text of a value as it is written to a place of type `target`: vectors of storage scalars are converted."""
        if isinstance(target, Vector) and isinstance(value.type, Vector) and target != value.type:
            return f"oxrt::convert<{self._dialect_scalar(target.element)}>({text})"
        return text


def part_of(place: FieldRef | ComponentRef, base: str) -> str:
    """A field of a struct or a component of a vector, as a place; `base` is the text of what it is a part of."""
    if isinstance(place, FieldRef):
        return f"{base}.{field_name(_struct(place.base.type), place.name)}"
    return f"{base}.{'xyzw'[place.components[0]]}"


def within(code: Code, precedence: int) -> str:
    """The text as an operand that must bind at least as tightly as `precedence`."""
    return code.text if code.precedence >= precedence else f"({code.text})"


def _struct(type_: Type) -> Struct:
    assert isinstance(type_, Struct)
    return type_


def _has_plain_form(node: Binary) -> bool:
    """Whether C++'s own operator means the same, because the right operand is a harmless literal."""
    if node.op not in _PLAIN_FORM or not isinstance(node.right, Literal) or isinstance(node.right.value, tuple):
        return False
    left, value = scalar_of(node.left.type), node.right.value
    if left is None or left.kind is ScalarKind.FLOAT or isinstance(node.left.type, Vector):
        return False
    if node.op in (BinaryOp.SHIFT_LEFT, BinaryOp.SHIFT_RIGHT):
        return 0 <= value < left.bits
    return left.kind is ScalarKind.UINT and value > 0
