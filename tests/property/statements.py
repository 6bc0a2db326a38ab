"""Random statements: assignments of every kind, branches, loops that end, early exits, writes to memory."""

from __future__ import annotations

from expressions import INPUT_COLUMNS, Callee, Expressions, Scope
from types_of_programs import INTEGERS, MATRICES, NUMBERS, SCALARS, STORAGE, VECTORS, StructType, literal

OUTPUT_COLUMNS = 12
OUTPUT_TYPES = NUMBERS


class Body:
    """The lines of one function; names are bound once with one type, those of a block are forgotten at its end."""

    def __init__(self, scope: Scope, structs: tuple[StructType, ...], prefix: str) -> None:
        self.scope = scope
        self.random = scope.random
        self.structs = structs
        self.prefix = prefix
        self.make = Expressions(scope)
        self.lines: list[str] = []
        self.level = 1
        self.loops = 0
        self.count = 0
        self.result: str | None = None
        self.budget = 0

    def add(self, text: str) -> None:
        """One line at the current indentation."""
        self.lines.append("    " * self.level + text)

    def fresh(self) -> str:
        """A name that nobody has yet."""
        self.count += 1
        return f"{self.prefix}{self.count}"

    def statements(self, number: int) -> None:
        """A block of about that many statements; it is never empty."""
        self.add("pass")
        for _ in range(number):
            if self.budget <= 0:
                return
            self.budget -= 1
            self._statement()

    def _statement(self) -> None:
        random = self.random.random()
        features = self.scope.features
        if random < 0.3:
            self._new_name()
        elif random < 0.5:
            self._assign()
        elif random < 0.6:
            self._augment()
        elif random < 0.66 and self._numbers():
            self._swap()
        elif random < 0.72 and "memory" in features and self.scope.in_program:
            self._write()
        elif random < 0.82:
            self._if()
        elif random < 0.87 and "loops" in features and self.loops < 2:
            self._for()
        elif random < 0.91 and "loops" in features and self.loops < 2:
            self._while()
        elif random < 0.95 and "match" in features:
            self._match()
        elif "exits" in features:
            self._exit()

    def _new_name(self) -> None:
        random = self.random.random()
        name = self.fresh()
        if random < 0.12 and "structs" in self.scope.features:
            self.new_struct(name)
            return
        if random < 0.2 and "arrays" in self.scope.features:
            self.new_array(name)
            return
        types = [*SCALARS, *NUMBERS, *VECTORS] + (list(MATRICES) if "matrices" in self.scope.features else [])
        type_ = self.random.choice(types)
        annotation = f": {type_}" if self.random.random() < 0.4 else ""
        self.add(f"{name}{annotation} = {self.make.expression(type_, 3)}")
        self.scope.names[name] = type_

    def new_struct(self, name: str) -> None:
        """A struct with all of its fields as places."""
        struct = self.random.choice(self.structs)
        self.add(f"{name} = {self._struct_value(struct)}")
        self._struct_places(name, struct)

    def _struct_value(self, struct: StructType) -> str:
        arguments = []
        by_name = False
        for field, type_ in struct.fields:
            nested = next((one for one in self.structs if one.name == type_), None)
            if nested is not None:
                text = self._struct_value(nested)
            elif type_.startswith("ox.FixedArray"):
                text = f"{type_}()"
            else:
                text = self.make.expression(STORAGE.get(type_, type_), 2)
                text = f"{type_}({text})" if type_ in STORAGE and self.random.random() < 0.5 else text
            by_name = by_name or self.random.random() < 0.2
            arguments.append(f"{field}={text}" if by_name else text)
        return f"{struct.name}({', '.join(arguments)})"

    def _struct_places(self, name: str, struct: StructType) -> None:
        for field, type_ in struct.fields:
            nested = next((one for one in self.structs if one.name == type_), None)
            if nested is not None:
                self._struct_places(f"{name}.{field}", nested)
            elif type_.startswith("ox.FixedArray"):
                self._array_places(f"{name}.{field}", type_)
            else:
                self.scope.places.append((f"{name}.{field}", STORAGE.get(type_, type_)))

    def new_array(self, name: str) -> None:
        """A fixed array; elements at constant and at computed places."""
        element = self.random.choice((*NUMBERS, *VECTORS))
        type_ = f"ox.FixedArray[{element}, {self.random.choice((2, 4, 8))}]"
        self.add(f"{name} = {type_}()")
        self._array_places(name, type_)

    def _array_places(self, name: str, type_: str) -> None:
        element, size = type_.removeprefix("ox.FixedArray[").removesuffix("]").split(", ")
        element = STORAGE.get(element, element)
        self.scope.places.append((f"{name}[{self.random.randrange(int(size))}]", element))
        index = self.make.expression(self.random.choice(("int32", "uint32")), 1)
        self.scope.places.append((f"{name}[{index} & {int(size) - 1}]", element))

    def _assign(self) -> None:
        target, type_ = self._target()
        self.add(f"{target} = {self.make.expression(type_, 3)}")

    def _target(self) -> tuple[str, str]:
        """Something that can be assigned: a name, a place, a component of either."""
        choices = [*self.scope.names.items(), *self.scope.places]
        if not choices:
            name = self.fresh()
            self.add(f"{name} = {self.make.expression('float32', 1)}")
            self.scope.names[name] = "float32"
            return name, "float32"
        text, type_ = self.random.choice(choices)
        if type_ in VECTORS and self.random.random() < 0.5:
            element, size = VECTORS[type_]
            return f"{text}.{self.random.choice('xyzw'[:size])}", element
        return text, type_

    def _augment(self) -> None:
        target, type_ = self._target()
        element = VECTORS[type_][0] if type_ in VECTORS else type_
        if element not in NUMBERS:
            self.add(f"{target} = {self.make.expression(type_, 2)}")
            return
        operators = ["+", "-", "*", "//", "%"] + (["&", "|", "^"] if element in INTEGERS else ["/"])
        operator = self.random.choice(operators)
        value = self.make.expression(type_, 2)
        if self.random.random() < 0.3:
            value = literal(self.random, element, nonzero=True)
        self.add(f"{target} {operator}= {value}")

    def _numbers(self) -> list[str]:
        return [name for name, type_ in self.scope.names.items() if type_ in SCALARS]

    def _swap(self) -> None:
        """Two or three targets at once: all values are taken before any is written."""
        of = self.scope.names[self.random.choice(self._numbers())]
        names = [name for name, type_ in self.scope.names.items() if type_ == of]
        targets = self.random.sample(names, min(len(names), self.random.choice((2, 3))))
        values = [self.make.expression(of, 2) if self.random.random() < 0.4 else self.random.choice(names) for _ in targets]
        if len(targets) == 1:
            self.add(f"{targets[0]} = {values[0]}")
        else:
            self.add(f"{', '.join(targets)} = {', '.join(values)}")

    def _write(self) -> None:
        type_ = self.random.choice(OUTPUT_TYPES)
        column = str(self.random.randrange(OUTPUT_COLUMNS))
        if self.random.random() < 0.4:
            column = f"({self.make.expression(self.random.choice(('int32', 'uint32')), 2)} & {7})"
        operator = self.random.choice(("=", "=", "+=", "-="))
        self.add(f"params.out_{type_}[i, {column}] {operator} {self.make.expression(type_, 2)}")

    def block(self, number: int) -> None:
        """An indented block; the names and places that it makes end with it."""
        names, places = dict(self.scope.names), list(self.scope.places)
        self.level += 1
        self.statements(number)
        self.level -= 1
        self.scope.names.clear()
        self.scope.names.update(names)
        self.scope.places[:] = places

    def _if(self) -> None:
        self.add(f"if {self.make.condition(3)}:")
        self.block(self.random.randint(1, 3))
        if self.random.random() < 0.3:
            self.add(f"elif {self.make.condition(2)}:")
            self.block(2)
        if self.random.random() < 0.5:
            self.add("else:")
            self.block(self.random.randint(1, 3))

    def _for(self) -> None:
        counter = self.fresh()
        of = self.random.choice(("int32", "uint32"))
        bounds = self.random.choice(("stop", "both", "step", "down", "constant"))
        small = f"({self.make.expression(of, 1)} & {self.random.choice((3, 7))})"
        match bounds:
            case "stop":
                text = small
            case "both":
                text = f"{self.random.randrange(3)}, {small}"
            case "step":
                text = f"{small}, {self.random.randint(4, 12)}, {self.random.randint(1, 3)}"
            case "down":
                of = "int32"
                text = f"{self.make.expression('int32', 1)} & 7, {self.random.randint(-3, 2)}, {self.random.choice((-1, -2))}"
            case _:
                of = "int32"
                text = str(self.random.randint(1, 5))
        self.add(f"for {counter} in range({text}):")
        self.scope.names[counter] = of
        self._loop_body()
        if bounds != "constant":
            del self.scope.names[counter]

    def _while(self) -> None:
        counter = self.fresh()
        self.add(f"{counter} = 0")
        self.add(f"while {counter} < {self.random.randint(1, 6)} and {self.make.condition(2)}:")
        self.level += 1
        self.add(f"{counter} += 1")
        self.level -= 1
        self._loop_body()
        self.scope.names[counter] = "int32"

    def _loop_body(self) -> None:
        self.loops += 1
        self.block(self.random.randint(1, 4))
        self.loops -= 1

    def _match(self) -> None:
        of = self.random.choice(("int32", "uint32"))
        self.add(f"match {self.make.expression(of, 2)} & 3:")
        self.level += 1
        cases = self.random.sample(("0", "1", "2", "1 | 3", "Mode.SECOND"), self.random.randint(1, 3))
        for case in cases:
            guard = f" if {self.make.condition(1)}" if self.random.random() < 0.2 else ""
            self.add(f"case {case}{guard}:")
            self.block(2)
        if self.random.random() < 0.5:
            self.add("case _:")
            self.block(1)
        self.level -= 1

    def _exit(self) -> None:
        """A jump under a condition."""
        words = ["break", "continue"] if self.loops else []
        if self.result is not None or self.scope.in_program:
            words.append("return")
        if not words:
            return
        word = self.random.choice(words)
        self.add(f"if {self.make.condition(2)}:")
        value = f" {self.returned()}" if word == "return" and self.result is not None else ""
        self.level += 1
        self.add(word + value)
        self.level -= 1

    def returned(self) -> str:
        """A value of the function's result type."""
        assert self.result is not None
        if self.result.startswith("tuple["):
            items = self.result.removeprefix("tuple[").removesuffix("]").split(", ")
            return ", ".join(self.make.expression(item, 2) for item in items)
        return self.make.expression(self.result, 3)


__all__ = ["INPUT_COLUMNS", "OUTPUT_COLUMNS", "OUTPUT_TYPES", "Body", "Callee"]
