"""Random expressions of a wanted type over the names in scope."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from random import Random

from types_of_programs import (
    FLOATS,
    INTEGERS,
    MATRICES,
    NUMBERS,
    SCALARS,
    VECTOR_OF,
    VECTORS,
    WIDENS_TO,
    constant,
    is_integer,
    literal,
)

INPUT_COLUMNS = 8

_UNARY_FLOAT = (
    "sqrt rsqrt sin cos tan asin acos atan sinh cosh tanh exp exp2 log log2 log10 floor ceil trunc round rint fract saturate "
    "radians degrees abs sign"
).split()
_BINARY_FLOAT = "atan2 pow fmod hypot min max step".split()
_TERNARY_FLOAT = "fma lerp mix smoothstep clamp".split()
_COMPARISONS = ("<", "<=", ">", ">=", "==", "!=")


@dataclass(frozen=True)
class Callee:
    """A function that programs may call: parameters by name and type, result type."""

    name: str
    parameters: tuple[tuple[str, str], ...]
    result: str
    defaults: int = 0
    """How many of the last parameters have a default."""


@dataclass
class Scope:
    """What expressions may use: locals that have a value on every way, places to read, functions, and which features are on."""

    random: Random
    features: frozenset[str]
    names: dict[str, str] = field(default_factory=dict)
    places: list[tuple[str, str]] = field(default_factory=list)
    """Texts of fields and elements with their types."""
    read_only: list[tuple[str, str]] = field(default_factory=list)
    """What can be read and not written: items of tuples."""
    references: list[tuple[str, str]] = field(default_factory=list)
    """Structs and fixed arrays, which helpers take by reference."""
    tuples: dict[str, tuple[str, ...]] = field(default_factory=dict)
    callees: list[Callee] = field(default_factory=list)
    in_program: bool = True
    """Whether launch parameters can be read by row `i`."""


class Expressions:
    """Makes expressions; every method gives text whose checked type is the wanted one."""

    def __init__(self, scope: Scope) -> None:
        self.scope = scope
        self.random = scope.random

    def expression(self, type_: str, depth: int) -> str:
        """Any expression of the type."""
        if depth <= 0 or self.random.random() < 0.12:
            return self.leaf(type_)
        makers = self._makers(type_)
        return self.random.choice(makers)(type_, depth - 1)

    def leaf(self, type_: str) -> str:
        """A name, a place, an input or a constant."""
        found = [name for name, of in self.scope.names.items() if of == type_]
        found += [text for text, of in (*self.scope.places, *self.scope.read_only) if of == type_]
        if found and self.random.random() < 0.8:
            return self.random.choice(found)
        if type_ in VECTORS:
            element, size = VECTORS[type_]
            return f"{type_}({', '.join(self.leaf(element) for _ in range(size))})"
        if type_ in MATRICES:
            rows, columns = MATRICES[type_]
            return f"{type_}({', '.join(self.leaf(VECTOR_OF['float32', columns]) for _ in range(rows))})"
        if type_ != "bool" and self.scope.in_program and self.random.random() < 0.7:
            return f"params.in_{type_}[i, {self.random.randrange(INPUT_COLUMNS)}]"
        return constant(self.random, type_)

    def operand(self, type_: str, depth: int, nonzero: bool = False) -> str:
        """An operand beside one that has the type: literals are welcome."""
        if type_ in SCALARS and type_ != "bool" and self.random.random() < 0.25:
            return literal(self.random, type_, nonzero)
        if is_integer(type_) and not nonzero and self.random.random() < 0.08:
            return self._weak_shift()
        return self.expression(type_, depth)

    def _weak_shift(self) -> str:
        """Operators on literals whose type comes from the other operand."""
        shift = f"({self.random.choice(('1', '3', 'Bits.BOTH'))} << ({self.leaf(self.random.choice(('int32', 'uint32')))} & 31))"
        return self.random.choice((shift, shift, f"~{shift}", f"({shift} - 1)", f"({shift} | (1 << {self.random.randrange(9)}))"))

    def condition(self, depth: int) -> str:
        """What an `if` may ask."""
        if "truth" in self.scope.features and self.random.random() < 0.1:
            return self.expression(self.random.choice(NUMBERS), depth)
        return self.expression("bool", depth)

    def _makers(self, type_: str) -> list[Callable[[str, int], str]]:
        makers: list[Callable[[str, int], str]] = [self._conditional]
        if self._callees(type_):
            makers += [self._call] * 2
        if type_ == "bool":
            return [*makers, self._comparison, self._comparison, self._logic, self._logic, self._bool_of, self._bool_bits]
        if type_ in MATRICES:
            return [*makers, self._matrix]
        if type_ in VECTORS:
            return [*makers, self._vector_arithmetic, self._vector_arithmetic, self._construct, self._swizzle, self._vector_function]
        makers += [self._arithmetic] * 4 + [self._unary, self._convert, self._component]
        if is_integer(type_):
            return [*makers, self._shift, self._integer_function, self._power]
        return [*makers, self._true_division, self._float_function, self._float_function, self._reduction, self._power]

    def _conditional(self, type_: str, depth: int) -> str:
        return f"({self.expression(type_, depth)} if {self.condition(depth)} else {self.expression(type_, depth)})"

    def _callees(self, type_: str) -> list[Callee]:
        """Functions with this result for whose references there is something."""
        known = {of for _, of in self.scope.references}
        values = {*SCALARS, *VECTORS}
        return [one for one in self.scope.callees if one.result == type_ and all(of in values or of in known for _, of in one.parameters)]

    def _call(self, type_: str, depth: int) -> str:
        callee = self.random.choice(self._callees(type_))
        given = len(callee.parameters) - (self.random.randint(0, callee.defaults) if callee.defaults else 0)
        arguments = []
        by_name = False
        for name, of in callee.parameters[:given]:
            references = [text for text, kind in self.scope.references if kind == of]
            text = self.random.choice(references) if references else self.expression(of, depth - 1)
            by_name = by_name or self.random.random() < 0.15
            arguments.append(f"{name}={text}" if by_name else text)
        return f"{callee.name}({', '.join(arguments)})"

    def _arithmetic(self, type_: str, depth: int) -> str:
        operators = ["+", "-", "*", "+", "-", "*", "//", "%"]
        if is_integer(type_):
            operators += ["&", "|", "^"]
        operator = self.random.choice(operators)
        narrower = [of for of, wider in WIDENS_TO.items() if type_ in wider]
        left = self.expression(type_, depth)
        if narrower and operator in "+-*" and self.random.random() < 0.2:
            right = self.expression(self.random.choice(narrower), depth)
        else:
            right = self.operand(type_, depth, nonzero=operator in ("//", "%"))
        if operator in "+-*&|^" and self.random.random() < 0.3:
            left, right = right, left
        return f"({left} {operator} {right})"

    def _true_division(self, type_: str, depth: int) -> str:
        if self.random.random() < 0.3:
            of = self.random.choice(("int32", "uint32") if type_ == "float32" else ("int64", "uint64"))
            return f"({self.expression(of, depth)} / {self.operand(of, depth, nonzero=True)})"
        return f"({self.expression(type_, depth)} / {self.operand(type_, depth, nonzero=True)})"

    def _unary(self, type_: str, depth: int) -> str:
        operator = self.random.choice(("-", "+", "~") if is_integer(type_) else ("-", "+"))
        return f"({operator}{self.expression(type_, depth)})"

    def _shift(self, type_: str, depth: int) -> str:
        operator = self.random.choice(("<<", ">>"))
        if self.random.random() < 0.4:
            return f"({self.expression(type_, depth)} {operator} {self.random.randrange(70)})"
        of = self.random.choice(("int32", "uint32"))
        count = f"({self.expression(of, depth)} & {self.random.choice((7, 31, 63, 127))})"
        return f"({self.expression(type_, depth)} {operator} {count})"

    def _power(self, type_: str, depth: int) -> str:
        if is_integer(type_):
            exponent = str(self.random.randrange(6)) if self.random.random() < 0.5 else f"({self.expression(type_, depth)} & 7)"
            return f"({self.expression(type_, depth)} ** {exponent})"
        return f"({self.expression(type_, depth)} ** {self.operand(type_, depth)})"

    def _convert(self, type_: str, depth: int) -> str:
        return f"{type_}({self.expression(self.random.choice(SCALARS), depth)})"

    def _component(self, type_: str, depth: int) -> str:
        size = self.random.choice((2, 3, 4))
        vector = VECTOR_OF.get((type_, size))
        if vector is None:
            return self.leaf(type_)
        text = self.expression(vector, depth)
        if self.random.random() < 0.2:
            return f"{text}[{self.random.randrange(size)}]"
        if size != 3 and self.random.random() < 0.2:
            return f"{text}[{self.expression(self.random.choice(('int32', 'uint32')), depth)} & {size - 1}]"
        return f"{text}.{self.random.choice('xyzw'[:size])}"

    def _integer_function(self, type_: str, depth: int) -> str:
        if {"memory", "effects"} <= self.scope.features and self.scope.in_program and self.random.random() < 0.15:
            name = self.random.choice(("add", "sub", "exch", "min", "max", "and", "or", "xor"))
            return f"ox.atomic_{name}(params.out_{type_}, (i, {self.random.randrange(8)}), {self.expression(type_, depth)})"
        if self.random.random() < 0.15:
            return f"{self.random.choice(('min', 'max'))}({self.expression(type_, depth)}, {self.operand(type_, depth)})"
        name = self.random.choice(("min", "max", "clamp", "abs", "sign", "popcount", "clz", "ctz", "bits"))
        if name == "bits":
            return self._bits(type_, depth)
        if name in ("abs", "sign") and type_ in ("uint32", "uint64"):
            name = "popcount"
        count = {"min": 2, "max": 2, "clamp": 3}.get(name, 1)
        arguments = [self.expression(type_, depth), *(self.operand(type_, depth) for _ in range(count - 1))]
        return f"ox.{name}({', '.join(arguments)})"

    def _bits(self, type_: str, depth: int) -> str:
        """Bits of floats, with one form of NaN: which NaN an operation gives is not stated."""
        if type_ == "int32":
            return f"int_bits({self.expression('float32', depth)})"
        if type_ == "uint32":
            if self.random.random() < 0.3:
                return f"ox.reverse_bits({self.expression('uint32', depth)})"
            return f"ox.mul_hi({self.expression('uint32', depth)}, {self.expression('uint32', depth)})"
        return self.leaf(type_)

    def _float_function(self, type_: str, depth: int) -> str:
        kind = self.random.random()
        if kind < 0.1 and type_ == "float32":
            return f"ox.uint_as_float({self.expression('uint32', depth)})"
        names, count = (_UNARY_FLOAT, 1) if kind < 0.6 else (_BINARY_FLOAT, 2) if kind < 0.85 else (_TERNARY_FLOAT, 3)
        arguments = [self.expression(type_, depth), *(self.operand(type_, depth) for _ in range(count - 1))]
        return f"ox.{self.random.choice(names)}({', '.join(arguments)})"

    def _reduction(self, type_: str, depth: int) -> str:
        if self.random.random() < 0.1 and type_ == "float32" and "matrices" in self.scope.features:
            return f"ox.determinant({self.expression('float3x3', depth)})"
        vector = VECTOR_OF[type_, self.random.choice((2, 3, 4))]
        name = self.random.choice(("dot", "length", "length_squared", "distance"))
        arguments = [self.expression(vector, depth) for _ in range(2 if name in ("dot", "distance") else 1)]
        return f"ox.{name}({', '.join(arguments)})"

    def _vector_arithmetic(self, type_: str, depth: int) -> str:
        element, _ = VECTORS[type_]
        operators = ["+", "-", "*", "//", "%"] + (["&", "|", "^"] if is_integer(element) else ["/"])
        operator = self.random.choice(operators)
        left, right = self.expression(type_, depth), self.expression(type_, depth)
        kind = self.random.random()
        if kind < 0.3:
            right = self.operand(element, depth, nonzero=operator in ("//", "%", "/"))
        elif kind < 0.5 and operator in "+-*/&|^":
            left = self.operand(element, depth)
        elif kind < 0.6:
            return f"({self.random.choice('-+~' if is_integer(element) else '-+')}{left})"
        return f"({left} {operator} {right})"

    def _construct(self, type_: str, depth: int) -> str:
        element, size = VECTORS[type_]
        kind = self.random.random()
        if kind < 0.15:
            return f"{type_}({self.expression(element, depth)})"
        if kind < 0.35:
            other = VECTOR_OF[self.random.choice(("float32", "int32", "uint32", "float64")), size]
            return f"{type_}({self.expression(other, depth)})"
        if kind < 0.6 and size > 2:
            head = VECTOR_OF[element, size - 1]
            return f"{type_}({self.expression(head, depth)}, {self.operand(element, depth)})"
        if kind < 0.7 and type_ == "float3" and "matrices" in self.scope.features:
            matrix = self.expression("float3x3", depth)
            if self.random.random() < 0.3:
                return f"{matrix}[{self.random.randrange(3)}]"
            if self.random.random() < 0.2:
                return "AXIS"
            return f"({matrix} @ {self.expression('float3', depth)})"
        return f"{type_}({', '.join(self.operand(element, depth) for _ in range(size))})"

    def _swizzle(self, type_: str, depth: int) -> str:
        element, size = VECTORS[type_]
        source = self.random.choice((2, 3, 4))
        letters = "".join(self.random.choice("xyzw"[:source]) for _ in range(size))
        return f"{self.expression(VECTOR_OF[element, source], depth)}.{letters}"

    def _vector_function(self, type_: str, depth: int) -> str:
        element, _ = VECTORS[type_]
        if is_integer(element):
            name = self.random.choice(("min", "max"))
            return f"ox.{name}({self.expression(type_, depth)}, {self.operand(element, depth)})"
        kind = self.random.random()
        if kind < 0.1 and type_ == "float3":
            return f"ox.cross({self.expression(type_, depth)}, {self.expression(type_, depth)})"
        if kind < 0.3:
            name, count = self.random.choice((("normalize", 1), ("reflect", 2), ("faceforward", 3)))
            return f"ox.{name}({', '.join(self.expression(type_, depth) for _ in range(count))})"
        if kind < 0.35:
            return f"ox.refract({self.expression(type_, depth)}, {self.expression(type_, depth)}, {self.expression(element, depth)})"
        names, count = (_UNARY_FLOAT, 1) if kind < 0.75 else (_BINARY_FLOAT, 2) if kind < 0.9 else (_TERNARY_FLOAT, 3)
        arguments = [self.expression(type_, depth)]
        for _ in range(count - 1):
            arguments.append(self.expression(type_, depth) if self.random.random() < 0.5 else self.operand(element, depth))
        return f"ox.{self.random.choice(names)}({', '.join(arguments)})"

    def _matrix(self, type_: str, depth: int) -> str:
        rows, columns = MATRICES[type_]
        kind = self.random.random()
        if kind < 0.2:
            return f"({self.expression(type_, depth)} {self.random.choice('+-')} {self.expression(type_, depth)})"
        if kind < 0.4:
            return f"({self.expression(type_, depth)} * {self.operand('float32', depth)})"
        if kind < 0.55 and rows == columns:
            return f"({self.expression(type_, depth)} @ {self.expression(type_, depth)})"
        if kind < 0.7 and rows == columns == 3:
            return f"ox.{self.random.choice(('transpose', 'inverse'))}({self.expression(type_, depth)})"
        return f"{type_}({', '.join(self.expression(VECTOR_OF['float32', columns], depth) for _ in range(rows))})"

    def _comparison(self, type_: str, depth: int) -> str:
        kind = self.random.random()
        if kind < 0.15:
            vector = self.random.choice(list(VECTORS))
            return f"({self.expression(vector, depth)} {self.random.choice(('==', '!='))} {self.expression(vector, depth)})"
        if kind < 0.25:
            return f"ox.{self.random.choice(('isnan', 'isinf', 'isfinite'))}({self.expression(self.random.choice(FLOATS), depth)})"
        of = self.random.choice(NUMBERS)
        text = self.expression(of, depth)
        for _ in range(1 if kind < 0.75 else 2):
            text += f" {self.random.choice(_COMPARISONS)} {self.operand(of, depth)}"
        return f"({text})"

    def _logic(self, type_: str, depth: int) -> str:
        if self.random.random() < 0.25:
            return f"(not {self.condition(depth)})"
        word = self.random.choice((" and ", " or "))
        return f"({word.join(self.expression('bool', depth) for _ in range(self.random.choice((2, 2, 3))))})"

    def _bool_of(self, type_: str, depth: int) -> str:
        return f"bool({self.expression(self.random.choice((*INTEGERS, *FLOATS)), depth)})"

    def _bool_bits(self, type_: str, depth: int) -> str:
        return f"({self.expression('bool', depth)} {self.random.choice('&|^')} {self.expression('bool', depth)})"
