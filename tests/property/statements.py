"""Random statements: assignments of every kind, branches, loops that end, early exits, writes to memory."""

from __future__ import annotations

from aggregates import Aggregates, operators_of
from expressions import INPUT_COLUMNS, Callee, Scope
from types_of_programs import INTEGERS, MATRICES, NUMBERS, SCALARS, VECTORS, StructType, literal

OUTPUT_COLUMNS = 12
OUTPUT_TYPES = NUMBERS


class Body(Aggregates):
    """The lines of one function; names are bound once with one type, those of a block are forgotten at its end."""

    def __init__(self, scope: Scope, structs: tuple[StructType, ...], prefix: str) -> None:
        super().__init__(scope, structs, prefix)
        self.loops = 0
        self.result: str | None = None
        self.budget = 0

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
        elif random < 0.66:
            self._several()
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
        if random < 0.26 and "tuples" in self.scope.features:
            self.new_tuple(name)
            return
        types = [*SCALARS, *NUMBERS, *VECTORS] + (list(MATRICES) if "matrices" in self.scope.features else [])
        type_ = self.random.choice(types)
        annotation = f": {type_}" if self.random.random() < 0.4 else ""
        self.add(f"{name}{annotation} = {self.make.expression(type_, 3)}")
        self.scope.names[name] = type_
        if type_ in MATRICES:
            self.matrix_places(name, type_)
        elif type_ in VECTORS and self.random.random() < 0.5:
            self.vector_place(name, type_)

    def _assign(self) -> None:
        random = self.random.random()
        if random < 0.15 and self.scope.references:
            self.assign_struct()
            return
        if random < 0.25 and self.scope.tuples:
            self.assign_tuple()
            return
        target, type_ = self._target()
        others = [text for text, of in (*self.scope.names.items(), *self.scope.places) if of == type_]
        if others and self.random.random() < 0.15:
            target = f"{target} = {self.random.choice(others)}"
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
        operator = self.random.choice(operators_of(element))
        value = self.make.expression(type_, 2)
        if self.random.random() < 0.3:
            value = literal(self.random, element, nonzero=True)
        if element in INTEGERS and self.random.random() < 0.25:
            operator, value = self.random.choice((("<<", "{}"), (">>", "{}"), ("**", "({} & 3)")))
            value = value.format(self.random.randrange(6) if operator != "**" or type_ in VECTORS else self.make.expression(type_, 1))
        self.add(f"{target} {operator}= {value}")

    def _several(self) -> None:
        """Two or three targets at once, perhaps nested: all values are taken before any is written."""
        targets = [self._target() for _ in range(self.random.choice((2, 2, 3)))]
        if self.random.random() < 0.6:
            # Mostly of one type, so that they change places.
            of = targets[0][1]
            same = [text for text, type_ in (*self.scope.names.items(), *self.scope.places) if type_ == of]
            targets = [targets[0], *((self.random.choice(same), of) for _ in targets[1:] if same)]
        values = [self._taken(targets, of) for _, of in targets]
        texts = [text for text, _ in targets]
        if len(texts) == 3 and self.random.random() < 0.3:
            self.add(f"({texts[0]}, {texts[1]}), {texts[2]} = ({values[0]}, {values[1]}), {values[2]}")
        else:
            self.add(f"{', '.join(texts)} = {', '.join(values)}")

    def _taken(self, targets: list[tuple[str, str]], of: str) -> str:
        """A value for one of several targets, often another of them."""
        same = [text for text, type_ in targets if type_ == of]
        return self.random.choice(same) if self.random.random() < 0.6 else self.make.expression(of, 2)

    def _write(self) -> None:
        type_ = self.random.choice(OUTPUT_TYPES)
        column = str(self.random.randrange(OUTPUT_COLUMNS))
        if self.random.random() < 0.4:
            column = f"({self.make.expression(self.random.choice(('int32', 'uint32')), 2)} & {7})"
        operator = self.random.choice(("=", "=", "+=", "-="))
        self.add(f"params.out_{type_}[i, {column}] {operator} {self.make.expression(type_, 2)}")

    def block(self, number: int) -> None:
        """An indented block; the names and places that it makes end with it."""
        names, tuples = dict(self.scope.names), dict(self.scope.tuples)
        lists = (self.scope.places, self.scope.read_only, self.scope.references)
        lengths = [len(one) for one in lists]
        self.level += 1
        self.statements(number)
        self.level -= 1
        self.scope.names.clear()
        self.scope.names.update(names)
        self.scope.tuples.clear()
        self.scope.tuples.update(tuples)
        for one, length in zip(lists, lengths, strict=True):
            del one[length:]

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
        bounds = self.random.choice(("stop", "both", "step", "down", "any step", "constant"))
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
            case "any step":
                of = "int32"
                steps = self.make.expression("int32", 1)
                text = f"{self.make.expression('int32', 1)} & 7, {self.make.expression('int32', 1)} & 15, {steps} & 3 | 1"
                if self.random.random() < 0.5:
                    text = f"{self.make.expression('int32', 1)} & 15, -3, -({steps} & 3) - 1"
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
        limit = self.random.randint(1, 6)
        is_endless = self.random.random() < 0.3
        self.add(f"{counter} = 0")
        self.add("while True:" if is_endless else f"while {counter} < {limit} and {self.make.condition(2)}:")
        self.level += 1
        self.add(f"{counter} += 1")
        if is_endless:
            self.add(f"if {counter} > {limit} or {self.make.condition(1)}:")
            self.add("    break")
        self.level -= 1
        self._loop_body()
        self.scope.names[counter] = "int32"

    def _loop_body(self) -> None:
        self.loops += 1
        self.block(self.random.randint(1, 4))
        self.loops -= 1

    def _match(self) -> None:
        of = self.random.choice(("int32", "uint32", "int64", "uint64", "bool"))
        if of == "bool":
            self.add(f"match {self.make.expression(of, 2)}:")
            cases = self.random.sample(("True", "False", "True | False"), self.random.randint(1, 2))
        else:
            shift = " - 2" if of.startswith("i") and self.random.random() < 0.3 else ""
            self.add(f"match ({self.make.expression(of, 2)} & 3){shift}:")
            cases = self.random.sample(("0", "1", "2", "1 | 3", "Mode.SECOND", "Bits.A | Bits.BOTH"), self.random.randint(1, 3))
            cases += ["-1", "-2 | 1"] if shift else []
        self.level += 1
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
