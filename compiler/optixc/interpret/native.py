"""Compiled device functions for the interpreter: mathematics and getters with the very code of compiled programs.

A function is found by its row's name, with the type of its first argument where it exists for several (`sin:float32`).
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from functools import cache
from typing import Any

from optixc.host import library
from optixc.interpret import values
from optixc.ir import layout
from optixc.ir import types as t

Native = Callable[..., Any]


def exists(name: str) -> bool:
    """Whether the runtime has a function of this name."""
    return bool(_find(name))


@cache
def _find(name: str) -> Any:
    return library.lib().oxrtFindDeviceFunction(name.encode())


def bind(name: str, parameters: tuple[t.Type, ...], result: t.Type) -> Native:
    """`f(state, *arguments)` that calls a compiled function; `state` is an address of the runtime or None.

    Raises NotImplementedError for a name that the runtime does not have.
    """
    function = _find(name)
    if not function:
        raise NotImplementedError(f"the runtime has no device function {name}")
    ffi = library.ffi()
    sizes = [layout.size_of(parameter) for parameter in parameters]
    result_size = _result_size(result)

    def call(state: Any, *arguments: Any) -> Any:
        held = [ctypes.create_string_buffer(size) for size in sizes]
        for buffer, parameter, argument in zip(held, parameters, arguments, strict=True):
            values.store(parameter, ctypes.addressof(buffer), argument)
        pointers = ffi.new("const void*[]", [ffi.cast("void*", ctypes.addressof(buffer)) for buffer in held] or [ffi.NULL])
        output = ctypes.create_string_buffer(result_size)
        function(ffi.NULL if state is None else state, pointers, ffi.cast("void*", ctypes.addressof(output)))
        return values.load(result, ctypes.addressof(output))

    return call


def _result_size(result: t.Type) -> int:
    """Bytes of a result; nothing takes one, so that there is an address."""
    match result:
        case t.Tuple(items=items):
            return sum(layout.size_of(item) for item in items)
        case t.Void():
            return 1
        case _:
            return layout.size_of(result)


@cache
def pure(name: str, arity: int, type_: t.Scalar) -> Native:
    """A function of `arity` numbers of one type that gives one (a bool for the tests of floats)."""
    result = t.BOOL if name in ("isnan", "isinf", "isfinite") else type_
    bound = bind(f"{name}:{type_}", (type_,) * arity, result)
    return lambda *arguments: bound(None, *arguments)


def binary_float(name: str) -> Native:
    """A function of two floats by its full name, `power:float32`."""
    base, _, type_name = name.partition(":")
    return pure(base, 2, {"float32": t.FLOAT32, "float64": t.FLOAT64}[type_name])
