"""Locals as 32-bit words: how many a value has, and which of them a place names.

Sets of words are the bits of an int, the first word lowest. What a liveness analysis knows at one point of a function is a `State`: the
words of each local that somebody may still read.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cache
from typing import NamedTuple

from optixc.ir.layout import payload_words
from optixc.ir.nodes import ComponentRef, Expr, FieldRef, IndexRef, Literal, LocalRef, TupleItem
from optixc.ir.types import Array, CoopVec, FixedArray, Matrix, Struct, Tuple, Type, Vector, Void

State = Mapping[str, int]

_POINTER_WORDS = 2


class Words(NamedTuple):
    """Words `first` to `first + size` of a local; `is_exact` unless an index that is no constant picks some of them."""

    local: str
    first: int
    size: int
    is_exact: bool = True

    @property
    def mask(self) -> int:
        return full(self.size) << self.first


def full(count: int) -> int:
    """That many words."""
    return (1 << count) - 1


@cache
def words_of(type_: Type) -> int:
    """Words of a value of any type; views of memory are a pointer and a shape."""
    match type_:
        case Array(rank=rank):
            return _POINTER_WORDS * (1 + rank)
        case CoopVec(element=element, size=size):
            return words_of(element) * size
        case FixedArray(element=element, size=size):
            return words_of(element) * size
        case Struct(fields=fields):
            return sum(words_of(field.type) for field in fields)
        case Tuple(items=items):
            return sum(map(words_of, items))
        case Void():
            return 0
        case _:
            return payload_words(type_)


def place_words(place: Expr) -> Words | None:
    """The words of a chain of fields, components, items and indices that starts from a local; None for what starts elsewhere."""
    if isinstance(place, LocalRef):
        return Words(place.local.name, 0, words_of(place.local.type))
    if not isinstance(place, FieldRef | ComponentRef | IndexRef | TupleItem):
        return None
    base = place_words(place.base)
    if base is None:
        return None
    match place:
        case FieldRef(base=inner, name=name):
            assert isinstance(inner.type, Struct)
            return _part(base, *_field(inner.type, name))
        case TupleItem(base=inner, index=index):
            assert isinstance(inner.type, Tuple)
            return _part(base, sum(map(words_of, inner.type.items[:index])), words_of(inner.type.items[index]))
        case ComponentRef(base=inner, components=components):
            size = _item_words(inner.type)
            if len(components) == 1:
                return _part(base, components[0] * size, size)
            return base._replace(is_exact=False)
        case IndexRef(base=inner, index=Literal(value=int(index))) if (index + 1) * _item_words(inner.type) <= base.size and index >= 0:
            return _part(base, index * _item_words(inner.type), _item_words(inner.type))
        case _:
            return base._replace(is_exact=False)


def _part(base: Words, offset: int, count: int) -> Words:
    return Words(base.local, base.first + offset, count) if base.is_exact else base


def _field(struct: Struct, name: str) -> tuple[int, int]:
    offset = 0
    for field in struct.fields:
        if field.name == name:
            return offset, words_of(field.type)
        offset += words_of(field.type)
    raise AssertionError(f"{struct} has no field {name}")


def _item_words(type_: Type) -> int:
    """Words of one item of a vector, matrix, fixed array or cooperative vector."""
    match type_:
        case Vector(element=element) | CoopVec(element=element):
            return words_of(element)
        case FixedArray(element=item):
            return words_of(item)
        case Matrix(columns=columns):
            return columns
        case _:
            raise AssertionError(f"{type_} has no items")


def joined(*states: State) -> State:
    """What is live in any of them."""
    result: dict[str, int] = {}
    for state in states:
        for name, mask in state.items():
            if mask:
                result[name] = result.get(name, 0) | mask
    return result


def with_words(state: State, name: str, mask: int) -> State:
    """The state in which these words are live too."""
    return {**state, name: state.get(name, 0) | mask} if mask else state


def without_words(state: State, name: str, mask: int) -> State:
    """The state in which these words are not."""
    left = state.get(name, 0) & ~mask
    return {**{key: old for key, old in state.items() if key != name}, **({name: left} if left else {})}


def numbers(mask: int) -> list[int]:
    """The numbers of the words, ascending."""
    return [number for number in range(mask.bit_length()) if mask >> number & 1]


def names_of(struct: Struct, mask: int) -> Iterable[str]:
    """Fields that have some of the words; where it is not all of a field, with how many."""
    for field in struct.fields:
        offset, count = _field(struct, field.name)
        own = (mask >> offset & full(count)).bit_count()
        if own:
            yield field.name if own == count else f"{field.name} ({own} of {count})"
