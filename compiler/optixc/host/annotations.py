"""The generic types that annotations in shaders use, and what an annotation of a struct's field means.

`Array[T]`, `Array2[T]`, `Array3[T]` are views of numpy memory, `FixedArray[T, N]` elements by value, `Traversable` and `Texture`
handles. `CoopVec[T, N]` is no type of fields: shaders alone have cooperative vectors.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Generic, Self, TypeVar, overload

import numpy as np

from optixc.host import scalars
from optixc.host.fields import ArrayField, FieldType, FixedArrayField, HandleField, MatrixField, ScalarField, VectorField
from optixc.host.matrices import Matrix
from optixc.host.vectors import Vector


@dataclass(frozen=True)
class ArrayAnnotation:
    """What `Array2[float4]` is at run time."""

    element: Any
    rank: int


@dataclass(frozen=True)
class FixedArrayAnnotation:
    """What `FixedArray[float32, 8]` is at run time."""

    element: Any
    size: int


@dataclass(frozen=True)
class CoopVecAnnotation:
    """What `CoopVec[float16, 32]` is at run time."""

    element: Any
    size: int


if TYPE_CHECKING:
    T = TypeVar("T")

    class Array(np.ndarray[Any, Any], Generic[T]):
        """What a shader may do with an array; the host gives a numpy array."""

        @overload  # type: ignore[override]
        def __getitem__(self, index: int | tuple[int, ...]) -> T: ...
        @overload
        def __getitem__(self, index: Any) -> Any: ...
        def __getitem__(self, index: Any) -> Any: ...
        def __setitem__(self, index: Any, value: T) -> None: ...  # type: ignore[override]
        def __get__(self, instance: Any, owner: Any = ...) -> Self: ...
        def __set__(self, instance: Any, value: np.ndarray[Any, Any] | Sequence[Any] | None) -> None: ...

    class Array2(Array[T]):
        """A 2-D view."""

        def __get__(self, instance: Any, owner: Any = ...) -> Self: ...
        def __set__(self, instance: Any, value: np.ndarray[Any, Any] | Sequence[Any] | None) -> None: ...

    class Array3(Array[T]):
        """A 3-D view."""

        def __get__(self, instance: Any, owner: Any = ...) -> Self: ...
        def __set__(self, instance: Any, value: np.ndarray[Any, Any] | Sequence[Any] | None) -> None: ...

    class Traversable:
        """A 64-bit handle of something rays can be traced against."""

        def __init__(self, handle: int) -> None: ...
        def __int__(self) -> int: ...
        def __get__(self, instance: Any, owner: Any = ...) -> Self: ...
        def __set__(self, instance: Any, value: Any) -> None: ...

    class Texture:
        """A 64-bit handle of a texture."""

        def __int__(self) -> int: ...
        def __get__(self, instance: Any, owner: Any = ...) -> Self: ...
        def __set__(self, instance: Any, value: Any) -> None: ...

    MYPY = False
    if MYPY:
        # A number as a type argument is nothing that mypy knows: what it has no type for is Any.
        FixedArray: Any
        CoopVec: Any
        TraverseData: Any
    else:

        class FixedArray:
            """N elements held by value; checkers do not look into the brackets, so elements have no types for them."""

            def __class_getitem__(cls, arguments: Any) -> type[FixedArray]: ...
            def __init__(self, *items: Any) -> None: ...
            def __getitem__(self, index: int) -> Any: ...
            def __setitem__(self, index: int, value: Any) -> None: ...
            def __len__(self) -> int: ...
            def __get__(self, instance: Any, owner: Any = ...) -> Self: ...
            def __set__(self, instance: Any, value: FixedArray | Sequence[Any] | np.ndarray[Any, Any]) -> None: ...

        class CoopVec:
            """N numbers of a cooperative vector."""

            def __class_getitem__(cls, arguments: Any) -> type[CoopVec]: ...
            def __init__(self, *items: Any) -> None: ...
            def __getitem__(self, index: int) -> Any: ...
            def __setitem__(self, index: int, value: Any) -> None: ...
            def __len__(self) -> int: ...

        class TraverseData(FixedArray):
            """A hit as 20 words."""

else:

    class Array:
        """A 1-D view of host memory."""

        def __class_getitem__(cls, element: Any) -> ArrayAnnotation:
            return ArrayAnnotation(element, 1)

    class Array2:
        """A 2-D view of host memory: `a[y, x]`."""

        def __class_getitem__(cls, element: Any) -> ArrayAnnotation:
            return ArrayAnnotation(element, 2)

    class Array3:
        """A 3-D view of host memory: `a[z, y, x]`."""

        def __class_getitem__(cls, element: Any) -> ArrayAnnotation:
            return ArrayAnnotation(element, 3)

    class FixedArray:
        """N elements held by value."""

        def __class_getitem__(cls, arguments: Any) -> FixedArrayAnnotation:
            element, size = arguments
            if not isinstance(size, int) or size < 1:
                raise TypeError(f"FixedArray takes a type and a positive size, not {size!r}")
            return FixedArrayAnnotation(element, size)

    class CoopVec:
        """N numbers of a cooperative vector."""

        def __class_getitem__(cls, arguments: Any) -> CoopVecAnnotation:
            element, size = arguments
            return CoopVecAnnotation(element, size)

    class Traversable:
        """A 64-bit handle of something rays can be traced against."""

    class Texture:
        """A 64-bit handle of a texture."""

    TraverseData = FixedArray[scalars.uint32, 20]


_PYTHON_SCALARS = {bool: "bool", int: "int32", float: "float32"}
_SCALARS: dict[type, str] = {
    kind: kind.__name__
    for kind in (
        scalars.int8,
        scalars.uint8,
        scalars.int16,
        scalars.uint16,
        scalars.int32,
        scalars.uint32,
        scalars.int64,
        scalars.uint64,
        scalars.float16,
        scalars.float32,
        scalars.float64,
    )
}


def field_type(annotation: Any) -> FieldType:
    """The field type that an annotation names; TypeError for anything that has no layout in memory."""
    if isinstance(annotation, ArrayAnnotation):
        return ArrayField(_element_type(annotation.element), annotation.rank)
    if isinstance(annotation, FixedArrayAnnotation):
        return FixedArrayField(_element_type(annotation.element), annotation.size)
    if isinstance(annotation, CoopVecAnnotation):
        raise TypeError("a struct cannot hold a CoopVec; keep the numbers in an array and read them with coop_vec_load()")
    if isinstance(annotation, type):
        return _class_field_type(annotation)
    raise TypeError(f"{annotation!r} is not a type that a struct can hold")


def _element_type(annotation: Any) -> FieldType:
    element = field_type(annotation)
    if isinstance(element, ArrayField):
        raise TypeError(f"arrays cannot hold {element.text}; hold structs with an array as their field")
    return element


def _class_field_type(kind: type) -> FieldType:
    name = _PYTHON_SCALARS.get(kind) or _SCALARS.get(kind)
    if name is not None:
        return ScalarField(name)
    if issubclass(kind, Vector) and kind is not Vector:
        return VectorField(kind)
    if issubclass(kind, Matrix) and kind is not Matrix:
        return MatrixField(kind)
    if kind.__name__ in ("Traversable", "Texture") and kind.__module__ == __name__:
        return HandleField(kind.__name__)
    made = getattr(kind, "__optixc_field__", None)
    if made is not None:
        nested: FieldType = made
        return nested
    if kind.__module__ == "numpy" and kind.__name__ in {scalar.__name__ for scalar in _SCALARS}:
        raise TypeError(f"numpy's {kind.__name__} is not a type of shaders; write optixc.{kind.__name__}")
    raise TypeError(f"{kind.__name__} is not a type that a struct can hold; decorate a class with @optixc.struct to nest it")
