"""Vector types as Python values: `float3(1.0, 2.0, 3.0)` with the arithmetic of shaders, in the element's own precision.

Vectors are values: nothing changes one in place. Components are x y z w or r g b a, swizzles (`v.zyx`) give vectors, arithmetic is
element by element with scalars spread, `==` compares all components, those of a tuple as well. Memory layout: the elements in order,
aligned as one element.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

_LETTERS = {"x": 0, "y": 1, "z": 2, "w": 3, "r": 0, "g": 1, "b": 2, "a": 3}


class Vector:
    """What all vector types share; construct one of its subclasses from scalars and vectors in order, or spread one scalar."""

    __slots__ = ("_values",)
    element: ClassVar[np.dtype[Any]]
    size: ClassVar[int]
    family: ClassVar[str]
    _values: tuple[Any, ...]

    def __init_subclass__(cls) -> None:
        cls.family, cls.size = cls.__name__[:-1], int(cls.__name__[-1])
        cls.element = np.dtype(_ELEMENTS[cls.family])
        _CLASSES[cls.family, cls.size] = cls

    def __init__(self, *parts: Any) -> None:
        numbers: list[Any] = []
        for part in parts:
            numbers.extend(part) if isinstance(part, Vector | tuple | list | np.ndarray) else numbers.append(part)
        if not parts:
            numbers = [0] * self.size
        elif len(numbers) == 1 and not isinstance(parts[0], Vector):
            numbers *= self.size
        if len(numbers) != self.size:
            raise TypeError(f"{type(self).__name__} takes {self.size} numbers, or one to spread, not {len(numbers)}")
        object.__setattr__(self, "_values", _to_element(numbers, self.element))

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"vectors are values: build a new {type(self).__name__} instead of setting .{name}")

    def __getattr__(self, name: str) -> Any:
        values = self._values
        if all(letter in _LETTERS for letter in name) and 1 <= len(name) <= 4 and max(_LETTERS[letter] for letter in name) < len(values):
            chosen = [values[_LETTERS[letter]] for letter in name]
            return chosen[0] if len(chosen) == 1 else vector_class(self.family, len(chosen))(*chosen)
        raise AttributeError(f"{type(self).__name__} has no component {name!r}")

    def __iter__(self) -> Iterator[Any]:
        return iter(self._values)

    def __len__(self) -> int:
        return self.size

    def __getitem__(self, index: int) -> Any:
        return self._values[operator.index(index)]

    def __eq__(self, other: object) -> bool:
        if isinstance(other, tuple):
            return self._values == other
        return self._values == other._values if type(other) is type(self) and isinstance(other, Vector) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._values)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(map(repr, self._values))})"

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), self._values

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray[Any, Any]:
        return np.array(self._values, dtype or self.element)

    def __add__(self, other: Any) -> Any:
        return self._binary(other, np.add)

    def __sub__(self, other: Any) -> Any:
        return self._binary(other, np.subtract)

    def __mul__(self, other: Any) -> Any:
        return self._binary(other, np.multiply)

    def __truediv__(self, other: Any) -> Any:
        return self._binary(other, np.true_divide)

    def __floordiv__(self, other: Any) -> Any:
        return self._binary(other, np.floor_divide)

    def __mod__(self, other: Any) -> Any:
        return self._binary(other, np.remainder)

    def __and__(self, other: Any) -> Any:
        return self._binary(other, np.bitwise_and)

    def __or__(self, other: Any) -> Any:
        return self._binary(other, np.bitwise_or)

    def __xor__(self, other: Any) -> Any:
        return self._binary(other, np.bitwise_xor)

    def __radd__(self, other: Any) -> Any:
        return self._binary(other, np.add, swapped=True)

    def __rsub__(self, other: Any) -> Any:
        return self._binary(other, np.subtract, swapped=True)

    def __rmul__(self, other: Any) -> Any:
        return self._binary(other, np.multiply, swapped=True)

    def __rtruediv__(self, other: Any) -> Any:
        return self._binary(other, np.true_divide, swapped=True)

    def __rfloordiv__(self, other: Any) -> Any:
        return self._binary(other, np.floor_divide, swapped=True)

    def __rmod__(self, other: Any) -> Any:
        return self._binary(other, np.remainder, swapped=True)

    def __rand__(self, other: Any) -> Any:
        return self._binary(other, np.bitwise_and, swapped=True)

    def __ror__(self, other: Any) -> Any:
        return self._binary(other, np.bitwise_or, swapped=True)

    def __rxor__(self, other: Any) -> Any:
        return self._binary(other, np.bitwise_xor, swapped=True)

    def __neg__(self) -> Self:
        return type(self)(*np.negative(self.__array__()).tolist())

    def __pos__(self) -> Self:
        return self

    def __invert__(self) -> Self:
        return type(self)(*np.invert(self.__array__()).tolist())

    def __abs__(self) -> Self:
        return type(self)(*np.abs(self.__array__()).tolist())

    def _binary(self, other: Any, function: Callable[..., Any], swapped: bool = False) -> Any:
        if isinstance(other, Vector):
            if type(other) is not type(self):
                return NotImplemented
            right = other.__array__()
        elif isinstance(other, int | float | np.number):
            right = np.array(_to_element([other], self.element), self.element)
        else:
            return NotImplemented
        left = self.__array__()
        kind: type[Vector] = type(self)
        if function is np.true_divide and self.element.kind in "iu":
            # True division of integers is division in float32, as in shaders.
            left, right, kind = left.astype(np.float32), right.astype(np.float32), vector_class("float", self.size)
        with np.errstate(all="ignore"):
            result = function(right, left) if swapped else function(left, right)
        return kind(*result.tolist())


def _to_element(numbers: list[Any], element: np.dtype[Any]) -> tuple[Any, ...]:
    """Numbers as the element type holds them: floats rounded, integers wrapped, floats made integer truncated and saturated."""
    if element.kind == "f":
        with np.errstate(all="ignore"):
            return tuple(np.array([float(number) for number in numbers], np.float64).astype(element).tolist())
    if element.kind == "b":
        return tuple(bool(number) for number in numbers)
    return tuple(_to_integer(number, element) for number in numbers)


def _to_integer(number: Any, element: np.dtype[Any]) -> int:
    limits = np.iinfo(element)
    if isinstance(number, float | np.floating):
        value = float(number)
        if value != value:
            return 0
        return (
            int(max(min(value, float(limits.max)), float(limits.min)))
            if abs(value) < 2.0**63
            else int(limits.max if value > 0 else limits.min)
        )
    wrapped = int(number) & ((1 << limits.bits) - 1)
    return wrapped - (1 << limits.bits) if limits.min < 0 and wrapped > limits.max else wrapped


_CLASSES: dict[tuple[str, int], type[Vector]] = {}


def vector_class(family: str, size: int) -> type[Vector]:
    """The class of `size` elements of a family: ("float", 3) is float3."""
    return _CLASSES[family, size]


_ELEMENTS: dict[str, Any] = {
    "bool": np.bool_,
    "char": np.int8,
    "uchar": np.uint8,
    "short": np.int16,
    "ushort": np.uint16,
    "int": np.int32,
    "uint": np.uint32,
    "longlong": np.int64,
    "ulonglong": np.uint64,
    "half": np.float16,
    "float": np.float32,
    "double": np.float64,
}


if TYPE_CHECKING:
    from optixc.host.vector_types import *  # noqa: F403
else:
    for _family in _ELEMENTS:
        for _size in (2, 3, 4):
            globals()[f"{_family}{_size}"] = type(f"{_family}{_size}", (Vector,), {"__slots__": (), "__module__": __name__})
