"""What is known while one program runs: the ray, the record, the payload in flight, the outgoing hit object."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from optixc.host import library
from optixc.interpret import values
from optixc.ir import types as t

PAYLOAD_WORDS = 32


class EndProgram(BaseException):
    """A program called something that does not return; caught where the program was started."""


class Thrown(BaseException):
    """throw_exception() ended the launch index; caught where the index was started."""


@dataclass(eq=False)
class Frame:
    """One running program. `words` are the payload registers of the trace, `payload` the struct that the program sees of them."""

    ray: Any = None
    record: int = 0
    words: Any = None
    payload: Any = None
    hit_object: Any = None

    def write_words(self) -> None:
        """Bring the registers up to what the program's payload struct holds."""
        if self.payload is not None:
            fill(self.words, values.to_words(self.payload.TYPE, self.payload))

    def read_words(self) -> None:
        """Bring the program's payload struct, in place, up to the registers."""
        if self.payload is not None:
            update(self.payload, self.words)


def registers() -> Any:
    """Fresh payload registers, all zero."""
    return library.ffi().new(f"uint32_t[{PAYLOAD_WORDS}]")


def fill(words: Any, given: list[int]) -> None:
    """Write registers from the first on."""
    for index, word in enumerate(given):
        words[index] = word


def update(payload: Any, words: Any) -> None:
    """Set the fields of a payload struct from registers, so that everybody who names it sees them."""
    fresh = values.from_words(payload.TYPE, list(words))
    for field in payload.TYPE.fields:
        setattr(payload, field.name, getattr(fresh, field.name))


def word_types(type_: t.Type) -> tuple[t.Scalar, ...]:
    """What the words of a payload hold; structs with equal lists can stand for each other."""
    match type_:
        case t.Scalar():
            return (type_,)
        case t.Vector(element=element, size=size):
            return (element,) * size
        case t.Matrix(rows=rows, columns=columns):
            return (t.FLOAT32,) * (rows * columns)
        case t.Struct(fields=fields):
            return tuple(word for field in fields for word in word_types(field.type))
        case t.FixedArray(element=inner, size=size):
            return word_types(inner) * size
        case _:
            return (t.UINT64,)
