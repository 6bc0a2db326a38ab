"""Random locals that hold several values: structs, fixed arrays, tuples, matrices, and the places inside of them."""

from __future__ import annotations

from expressions import Expressions, Scope
from types_of_programs import INTEGERS, MATRICES, NUMBERS, STORAGE, VECTOR_OF, VECTORS, StructType


class Aggregates:
    """The lines of one function, and what its aggregates need. Whatever is made is noted in the scope: places, references, tuples."""

    def __init__(self, scope: Scope, structs: tuple[StructType, ...], prefix: str) -> None:
        self.scope = scope
        self.random = scope.random
        self.structs = {struct.name: struct for struct in structs}
        self.prefix = prefix
        self.make = Expressions(scope)
        self.lines: list[str] = []
        self.level = 1
        self.count = 0

    def add(self, text: str) -> None:
        """One line at the current indentation."""
        self.lines.append("    " * self.level + text)

    def fresh(self) -> str:
        """A name that nobody has yet."""
        self.count += 1
        return f"{self.prefix}{self.count}"

    def new_struct(self, name: str) -> None:
        """A struct, new or a copy of another, with all of its fields as places."""
        known = [(text, of) for text, of in self.scope.references if of in self.structs]
        if known and self.random.random() < 0.25:
            source, type_ = self.random.choice(known)
            value = f"ox.copy({source})"
        else:
            type_ = self.random.choice(list(self.structs))
            value = self._value(type_)
            if self.random.random() < 0.15:
                value = f"{value} if {self.make.condition(2)} else {self._value(type_)}"
        self.add(f"{name} = {value}")
        self._note(name, type_)

    def new_array(self, name: str) -> None:
        """A fixed array, empty or of given items."""
        element = self.random.choice((*NUMBERS, *VECTORS, "Small", "float3x3"))
        type_ = f"ox.FixedArray[{element}, {self.random.choice((2, 4, 8))}]"
        self.add(f"{name} = {self._value(type_)}")
        self._note(name, type_)

    def new_tuple(self, name: str) -> None:
        """A tuple of several values, which is taken as a whole, by item or apart."""
        types = [self.random.choice((*NUMBERS, "bool", *VECTORS)) for _ in range(self.random.randint(2, 4))]
        self.add(f"{name} = {', '.join(self.make.expression(of, 2) for of in types)}")
        self.scope.tuples[name] = tuple(types)
        self.scope.read_only += [(f"{name}[{position}]", of) for position, of in enumerate(types)]

    def assign_tuple(self) -> None:
        """Another value of a tuple's types, made with its own items."""
        name = self.random.choice(list(self.scope.tuples))
        self.add(f"{name} = ({', '.join(self.make.expression(of, 1) for of in self.scope.tuples[name])})")

    def assign_struct(self) -> None:
        """A whole struct or array in place of another: a new value or a copy."""
        name, type_ = self.random.choice(self.scope.references)
        if type_ == "State" and not self.scope.in_program:
            # A parameter keeps naming what the caller gave.
            return
        source = self.random.choice([text for text, of in self.scope.references if of == type_])
        value = f"ox.copy({source})" if self.random.random() < 0.4 or type_ == "State" else self._value(type_)
        self.add(f"{name} = {value}")

    def matrix_places(self, name: str, type_: str) -> None:
        """Rows and elements of a matrix that is a local."""
        rows, columns = MATRICES[type_]
        row = self.random.randrange(rows)
        self.scope.places += [
            (f"{name}[{row}]", VECTOR_OF["float32", columns]),
            (f"{name}[{row}][{self.random.randrange(columns)}]", "float32"),
        ]
        if rows == 4:
            self.scope.places.append((f"{name}[{self._index(4)}]", VECTOR_OF["float32", columns]))

    def vector_place(self, name: str, type_: str) -> None:
        """The component of a vector at a computed place."""
        element, size = VECTORS[type_]
        if size != 3:
            self.scope.places.append((f"{name}[{self._index(size)}]", element))

    def _index(self, size: int) -> str:
        index = f"{self.make.expression(self.random.choice(('int32', 'uint32')), 1)} & {size - 1}"
        if self.random.random() < 0.4:
            # A name that nothing else assigns, so that it stays in range.
            name = self.fresh()
            self.add(f"{name} = {index}")
            return name
        return index

    def _value(self, type_: str) -> str:
        """A new struct or fixed array."""
        if type_.startswith("ox.FixedArray"):
            element, size = _parts(type_)
            if self.random.random() < 0.6 or size > 4:
                return f"{type_}()"
            return f"{type_}({', '.join(self._item(element) for _ in range(size))})"
        if type_ == "Small" and "helpers" in self.scope.features and self.random.random() < 0.2:
            return f"small_of({self.make.expression('int32', 1)}, {self.make.expression('float32', 1)})"
        arguments = []
        by_name = False
        for field, of in self.structs[type_].fields:
            by_name = by_name or self.random.random() < 0.2
            arguments.append(f"{field}={self._item(of)}" if by_name else self._item(of))
        return f"{type_}({', '.join(arguments)})"

    def _item(self, type_: str) -> str:
        if type_ in self.structs or type_.startswith("ox.FixedArray"):
            return self._value(type_)
        text = self.make.expression(STORAGE.get(type_, type_), 2)
        return f"{type_}({text})" if type_ in STORAGE and self.random.random() < 0.5 else text

    def _note(self, name: str, type_: str) -> None:
        """What a place of this type offers, field by field."""
        if type_ in self.structs:
            self.scope.references.append((name, type_))
            for field, of in self.structs[type_].fields:
                self._note(f"{name}.{field}", of)
        elif type_.startswith("ox.FixedArray"):
            self.scope.references.append((name, type_))
            element, size = _parts(type_)
            self._note(f"{name}[{self.random.randrange(size)}]", element)
            self._note(f"{name}[{self._index(size)}]", element)
        elif type_ in MATRICES:
            self.matrix_places(name, type_)
        else:
            self.scope.places.append((name, STORAGE.get(type_, type_)))


def _parts(array: str) -> tuple[str, int]:
    """Element and size of a fixed array's text."""
    element, _, size = array.removeprefix("ox.FixedArray[").removesuffix("]").rpartition(", ")
    return element, int(size)


def operators_of(element: str) -> list[str]:
    """What may stand before `=` in an augmented assignment, for values that any operand of the type suits."""
    return ["+", "-", "*", "//", "%"] + (["&", "|", "^"] if element in INTEGERS else ["/"])
