"""C++ names of types, and definitions of the author's structs.

Plain structs have the natural C layout of `ir.layout`. Payload and attributes structs are laid out as 32-bit words: fields of other
sizes are wrapped into `oxrt::Word`, so that a register index is an offset of 4 bytes. Decides no types.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import assert_never

from optixc.codegen.names import Scope, identifier
from optixc.codegen.writer import Writer
from optixc.ir.types import (
    Array,
    CoopVec,
    FixedArray,
    Matrix,
    Scalar,
    ScalarKind,
    Struct,
    StructKind,
    Texture,
    Traversable,
    Tuple,
    Type,
    Vector,
    Void,
)

_SCALAR_WORD = {ScalarKind.INT: "int{}_t", ScalarKind.UINT: "uint{}_t"}


def scalar_name(scalar: Scalar) -> str:
    """The C++ type of one number."""
    match scalar.kind:
        case ScalarKind.BOOL:
            return "bool"
        case ScalarKind.FLOAT:
            return {16: "oxrt::half", 32: "float", 64: "double"}[scalar.bits]
        case ScalarKind.INT | ScalarKind.UINT:
            return _SCALAR_WORD[scalar.kind].format(scalar.bits)
    assert_never(scalar.kind)


class TypeNames:
    """Names of types in one generated file; `struct` names are made unique against everything else in it."""

    def __init__(self, structs: Iterable[Struct], scope: Scope) -> None:
        self._structs: dict[Struct, str] = {struct: scope.name(struct.name) for struct in structs}

    def struct(self, struct: Struct) -> str:
        return self._structs[struct]

    def name(self, type_: Type) -> str:
        """The C++ type of a value."""
        match type_:
            case Scalar():
                return scalar_name(type_)
            case Vector() | Matrix():
                return f"oxrt::{type_}"
            case Struct():
                return self._structs[type_]
            case FixedArray():
                return f"oxrt::FixedArray<{self.name(type_.element)}, {type_.size}>"
            case CoopVec():
                return f"oxrt::CoopVec<{scalar_name(type_.element)}, {type_.size}>"
            case Array():
                return f"oxrt::Array<{self.name(type_.element)}, {type_.rank}>"
            case Tuple():
                return f"oxrt::Tuple<{', '.join(self.name(item) for item in type_.items)}>"
            case Traversable() | Texture():
                return "uint64_t"
            case Void():
                return "void"
        assert_never(type_)

    def field(self, struct: Struct, type_: Type) -> str:
        """The C++ type of a field of `struct`."""
        return f"oxrt::Word<{self.name(type_)}>" if is_wrapped(struct, type_) else self.name(type_)

    def definitions(self, writer: Writer) -> None:
        """Writes every struct, each after those that it contains."""
        for struct, name in self._structs.items():
            with writer.block(f"struct {name}", tail="};"):
                members = field_names(struct)
                for field in struct.fields:
                    writer.line(f"{self.field(struct, field.type)} {members[field.name]};")
            writer.line()


def is_wrapped(struct: Struct, type_: Type) -> bool:
    """Whether a field is held as whole 32-bit words, because its own size or alignment is another."""
    if struct.kind is StructKind.PLAIN:
        return False
    match type_:
        case Scalar():
            return type_.bits != 32
        case Vector():
            return type_.element.bits != 32
        case Traversable() | Texture():
            return True
        case _:
            return False


def field_names(struct: Struct) -> Mapping[str, str]:
    """C++ names of a struct's fields, by the author's."""
    scope = Scope()
    return {field.name: scope.name(field.name) for field in struct.fields}


def field_name(struct: Struct, name: str) -> str:
    """The C++ name of one field."""
    plain = identifier(name)
    return plain if plain == name else field_names(struct)[name]


def payload_words(type_: Type) -> Iterator[Scalar]:
    """What the words of a payload hold, in order: equal sequences can stand for each other."""
    match type_:
        case Scalar():
            yield type_
        case Vector():
            yield from [type_.element] * type_.size
        case Matrix():
            yield from [Scalar(ScalarKind.FLOAT, 32)] * (type_.rows * type_.columns)
        case FixedArray():
            for _ in range(type_.size):
                yield from payload_words(type_.element)
        case Struct():
            for field in type_.fields:
                yield from payload_words(field.type)
        case Traversable() | Texture():
            yield Scalar(ScalarKind.UINT, 64)
        case Array() | CoopVec() | Tuple() | Void():
            raise AssertionError(f"{type_} has no payload words")
        case _:
            assert_never(type_)


def word_count(type_: Type) -> int:
    """32-bit words of a payload."""
    return sum(2 if scalar.bits == 64 else 1 for scalar in payload_words(type_))


def structs_within(type_: Type) -> Iterator[Struct]:
    """The structs that a type contains, inner ones first, itself last."""
    match type_:
        case Struct():
            for field in type_.fields:
                yield from structs_within(field.type)
            yield type_
        case FixedArray() | Array():
            yield from structs_within(type_.element)
        case Tuple():
            for item in type_.items:
                yield from structs_within(item)
        case _:
            return
