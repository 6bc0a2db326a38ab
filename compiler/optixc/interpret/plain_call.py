"""Calling a shader helper from plain Python: checked for the arguments' types, run with the arithmetic of shaders.

Numbers and vectors go in and come out as they are (a Python float counts as float32, a whole number as int32, unless the parameter
says otherwise); a struct goes in by reference, so that what the helper changes is seen afterwards.
"""

from __future__ import annotations

import ctypes
import inspect
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from optixc.errors import InvalidOperationError
from optixc.frontend.checked import FunctionInstance
from optixc.frontend.compile import check_helper
from optixc.host.matrices import Matrix
from optixc.host.structs import layout_of
from optixc.host.vectors import Vector
from optixc.interpret import operations, values
from optixc.interpret.rewrite import Functions
from optixc.ir import types as t

_SCALARS = {
    "bool": t.BOOL,
    "int8": t.INT8,
    "uint8": t.UINT8,
    "int16": t.INT16,
    "uint16": t.UINT16,
    "int32": t.INT32,
    "uint32": t.UINT32,
    "int64": t.INT64,
    "uint64": t.UINT64,
    "float16": t.FLOAT16,
    "float32": t.FLOAT32,
    "float64": t.FLOAT64,
}


class HostMachine:
    """What a helper that Python called finds around it: no ray, no launch, no record."""

    def __init__(self) -> None:
        self.params: Any = None
        self.helper = Functions(self).helper

    def print(self, text: str) -> None:
        """print()."""
        print(text, end="")

    def __getattr__(self, name: str) -> Any:
        def refuse(*_: Any) -> Any:
            raise InvalidOperationError(
                "this helper asks for the launch, the ray or a record, which exist only inside a program; "
                "optixc.interpret runs a program in Python"
            )

        return refuse


def call_helper(function: Callable[..., Any], arguments: tuple[Any, ...], keywords: dict[str, Any]) -> Any:
    """The result of a helper for Python's arguments. Raises CompileError for a helper with errors, TypeError for wrong arguments."""
    bound = inspect.signature(function).bind(*arguments, **keywords)
    bound.apply_defaults()
    given = list(bound.arguments.values())
    for name, value in bound.arguments.items():
        if bound.signature.parameters[name].annotation is inspect.Parameter.empty and _type_of(value) is None:
            raise TypeError(f"argument {name} of {function.__name__} takes a number, vector or matrix, not {value!r:.60}")
    instance, run = _compiled(function, tuple(map(_type_of, given)))
    types = [parameter.local.type for parameter in instance.parameters]
    inner = [_into(type_, value, name) for type_, value, name in zip(types, given, bound.arguments, strict=True)]
    result = run(*inner)
    for outer, value in zip(given, inner, strict=True):
        if layout_of(outer) is not None:
            _write_back(outer, value)
    return _out_of(result, function)


@cache
def _compiled(function: Callable[..., Any], types: tuple[t.Type | None, ...]) -> tuple[FunctionInstance, Callable[..., Any]]:
    instance = check_helper(function, types)
    return instance, HostMachine().helper(instance)


def _type_of(value: Any) -> t.Type | None:
    """The type of an argument whose parameter has no annotation; None where only an annotation can tell."""
    name = type(value).__name__
    if isinstance(value, bool | np.bool_):
        return t.BOOL
    if name in _SCALARS:
        return _SCALARS[name]
    if isinstance(value, Vector):
        element = next(scalar for scalar in _SCALARS.values() if str(t.Vector(scalar, 2))[:-1] == value.family)
        return values.widened(t.Vector(element, value.size))
    if isinstance(value, Matrix):
        return t.Matrix(value.rows, value.columns)
    return {int: t.INT32, float: t.FLOAT32}.get(type(value))


def _into(type_: t.Type, value: Any, name: str) -> Any:
    """A Python value as the interpreter holds it."""
    source = _type_of(value)
    match type_:
        case t.Struct():
            layout = layout_of(value)
            if layout is None or isinstance(value, type):
                raise TypeError(f"argument {name} takes a {type_}, not {type(value).__name__}")
            packed = bytes(value.packed())
            held = ctypes.create_string_buffer(packed, len(packed))
            return values.load(type_, ctypes.addressof(held))
        case t.Array() if isinstance(value, np.ndarray):
            return values.ArrayValue(type_, value.ctypes.data, value.shape[: type_.rank])
        case t.Scalar() | t.Vector() | t.Matrix() if source is not None and t.scalar_of(source) is not None:
            if isinstance(value, Matrix) or source == type_:
                return value if not isinstance(value, np.generic) else value.item()
            try:
                conversion = operations.convert(source if not isinstance(value, float) else t.FLOAT64, type_)
            except AssertionError:
                raise TypeError(f"argument {name} takes a {type_}, not {value!r}") from None
            return value if conversion is None else conversion(value.item() if isinstance(value, np.generic) else value)
        case t.Vector(element=element, size=size) if isinstance(value, tuple | list | np.ndarray) and len(value) == size:
            numbers = [one.item() if isinstance(one, np.generic) else one for one in value]
            return values.make_vector(type_, tuple(_into(element, one, name) for one in numbers))
        case t.Tuple(items=items) if isinstance(value, tuple) and len(value) == len(items):
            return tuple(_into(item, one, name) for item, one in zip(items, value, strict=True))
        case t.CoopVec(element=element, size=size) if isinstance(value, tuple | list | np.ndarray) and len(value) == size:
            narrow = values.narrow(element)
            return values.CoopVecValue(type_, tuple(narrow(_into(element, np.asarray(one).item(), name)) for one in value))
        case t.Traversable() | t.Texture():
            return int(getattr(value, "handle", value))
        case _:
            raise TypeError(f"argument {name} takes a {type_}, not {value!r:.60}")


def _write_back(outer: Any, inner: values.StructValue) -> None:
    """What a helper changed in a struct."""
    for field in inner.TYPE.fields:
        new, old = getattr(inner, field.name), getattr(outer, field.name)
        if isinstance(new, values.StructValue):
            _write_back(old, new)
        elif not isinstance(new, values.ArrayValue) and new != old:
            setattr(outer, field.name, list(new.items) if isinstance(new, values.FixedArrayValue) else new)


def _out_of(value: Any, function: Callable[..., Any]) -> Any:
    """A result as plain Python has it: structs as instances of the author's class, where the helper's module knows it."""
    match value:
        case values.StructValue():
            kind = function.__globals__.get(value.TYPE.name)
            fields = {field.name: _out_of(getattr(value, field.name), function) for field in value.TYPE.fields}
            return kind(**fields) if isinstance(kind, type) and layout_of(kind) is not None else value
        case tuple():
            return tuple(_out_of(item, function) for item in value)
        case values.FixedArrayValue() | values.CoopVecValue():
            return [_out_of(item, function) for item in value.items]
        case _:
            return value
