"""C++ names of types, and definitions of the author's structs.

Plain structs have the natural C layout of `ir.layout`. Payload and attributes structs are laid out as 32-bit words: fields of other
sizes are wrapped into `oxrt::Word`, so that a register index is an offset of 4 bytes. Decides no types.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from types import MappingProxyType
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
    StructField,
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
    """Names of types in one generated file; `struct` names are made unique against everything else in it.

    `left_out`: fields that the C++ structs do not have, because nobody reads them.
    """

    def __init__(self, structs: Iterable[Struct], scope: Scope, left_out: Mapping[Struct, frozenset[str]] = MappingProxyType({})) -> None:
        self._structs: dict[Struct, str] = {struct: scope.name(struct.name) for struct in structs}
        self._left_out = left_out

    def struct(self, struct: Struct) -> str:
        return self._structs[struct]

    def carries(self, struct: Struct, field: str) -> bool:
        """Whether the C++ struct has the field."""
        return field not in self._left_out.get(struct, ())

    def members(self, struct: Struct) -> list[tuple[StructField, str]]:
        """The fields that the C++ struct has, with their names there."""
        names = field_names(struct)
        return [(field, names[field.name]) for field in struct.fields if self.carries(struct, field.name)]

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
                for field, name_ in self.members(struct):
                    writer.line(f"{self.field(struct, field.type)} {name_};")
                unread = [field.name for field in struct.fields if not self.carries(struct, field.name)]
                if unread:
                    writer.line(f"/* Nobody reads {', '.join(unread)}. */")
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
