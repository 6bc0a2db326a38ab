"""Matrix types as Python values: float32 numbers stored row by row; `m[i]` is row i as a vector, `@` multiplies."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from optixc.host.vectors import Vector, float3, float4, vector_class


class Matrix:
    """What matrix types share; construct from all numbers in order, from rows, or from an array of the right shape."""

    __slots__ = ("_array",)
    rows: ClassVar[int]
    columns: ClassVar[int]
    _array: np.ndarray[Any, np.dtype[np.float32]]

    def __init__(self, *parts: Any) -> None:
        numbers = np.concatenate([np.ravel(np.asarray(part, np.float32)) for part in parts]) if parts else np.zeros(0, np.float32)
        if numbers.size != self.rows * self.columns:
            raise TypeError(
                f"{type(self).__name__} takes {self.rows * self.columns} numbers or {self.rows} rows, not {numbers.size} numbers"
            )
        array = numbers.reshape(self.rows, self.columns)
        array.flags.writeable = False
        object.__setattr__(self, "_array", array)

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"matrices are values: build a new {type(self).__name__} instead of setting .{name}")

    def __getitem__(self, row: int) -> Vector:
        if isinstance(row, tuple | slice):
            raise TypeError(f"{type(self).__name__} takes one index, a row: index row and column one after the other, m[row][column]")
        return vector_class("float", self.columns)(*self._array[row].tolist())

    def __iter__(self) -> Iterator[Vector]:
        return (self[row] for row in range(self.rows))

    def __len__(self) -> int:
        return self.rows

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray[Any, Any]:
        return np.array(self._array, dtype or np.float32)

    def __eq__(self, other: object) -> bool:
        return (
            bool(np.array_equal(self._array, other._array)) if type(other) is type(self) and isinstance(other, Matrix) else NotImplemented
        )

    def __hash__(self) -> int:
        return hash((type(self).__name__, self._array.tobytes()))

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(str(tuple(row)) for row in self._array.tolist())})"

    def __matmul__(self, other: Any) -> Any:
        if isinstance(other, Vector) and other.size == self.columns:
            return vector_class("float", self.rows)(*[_dot(row, other.__array__()) for row in self._array])
        if isinstance(other, Matrix) and other.rows == self.columns:
            kind = _CLASSES.get((self.rows, other.columns))
            if kind is not None:
                return kind(*[_dot(row, column) for row in self._array for column in other._array.T])
        return NotImplemented

    def __add__(self, other: Self) -> Self:
        return type(self)(self._array + other._array) if type(other) is type(self) else NotImplemented

    def __sub__(self, other: Self) -> Self:
        return type(self)(self._array - other._array) if type(other) is type(self) else NotImplemented

    def __mul__(self, factor: float) -> Self:
        """By a number; `@` is the product of matrices."""
        return type(self)(self._array * np.float32(factor)) if isinstance(factor, int | float | np.number) else NotImplemented

    __rmul__ = __mul__

    def __neg__(self) -> Self:
        return type(self)(-self._array)


def _dot(left: np.ndarray[Any, Any], right: np.ndarray[Any, Any]) -> float:
    """The sum of products from left to right, each step in binary32."""
    total = left[0] * right[0]
    for index in range(1, len(left)):
        total = total + left[index] * right[index]
    return float(total)


class float3x3(Matrix):
    __slots__ = ()
    rows, columns = 3, 3

    if TYPE_CHECKING:

        def __getitem__(self, row: int) -> float3: ...
        def __setitem__(self, row: int, value: float3) -> None: ...
        def __iter__(self) -> Iterator[float3]: ...
        def __get__(self, instance: Any, owner: Any = ...) -> Self: ...
        def __set__(self, instance: Any, value: Any) -> None:
            """A field takes anything that numpy makes an array of this shape."""


class float3x4(Matrix):
    __slots__ = ()
    rows, columns = 3, 4

    if TYPE_CHECKING:

        def __getitem__(self, row: int) -> float4: ...
        def __setitem__(self, row: int, value: float4) -> None: ...
        def __iter__(self) -> Iterator[float4]: ...
        def __get__(self, instance: Any, owner: Any = ...) -> Self: ...
        def __set__(self, instance: Any, value: Any) -> None:
            """A field takes anything that numpy makes an array of this shape."""


class float4x4(Matrix):
    __slots__ = ()
    rows, columns = 4, 4

    if TYPE_CHECKING:

        def __getitem__(self, row: int) -> float4: ...
        def __setitem__(self, row: int, value: float4) -> None: ...
        def __iter__(self) -> Iterator[float4]: ...
        def __get__(self, instance: Any, owner: Any = ...) -> Self: ...
        def __set__(self, instance: Any, value: Any) -> None:
            """A field takes anything that numpy makes an array of this shape."""


_CLASSES: dict[tuple[int, int], type[Matrix]] = {(kind.rows, kind.columns): kind for kind in (float3x3, float3x4, float4x4)}
