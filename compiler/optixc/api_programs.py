"""What shader files use when Python itself imports them: decorators, launch parameters, device functions.

A program cannot be called from Python (`ox.interpret` runs one); a helper can. Functions of mathematics work on plain values,
everything that needs a launch or a ray raises.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from inspect import Parameter, Signature
from typing import Any, Generic, ParamSpec, TypeVar, cast

from optixc.errors import InvalidOperationError
from optixc.host import mathematics, structs
from optixc.interpret.plain_call import call_helper
from optixc.ir.intrinsic_rows import INTRINSICS, OVERLOADS
from optixc.ir.programs import program_kind

P = ParamSpec("P")
R = TypeVar("R")
T = TypeVar("T")

SPECIAL_FUNCTIONS = ("trace", "traverse", "invoke", "direct_call", "continuation_call", "get_sbt_data", "hit_object_get_sbt_data")
DEVICE_FUNCTIONS = (*INTRINSICS, *OVERLOADS, *SPECIAL_FUNCTIONS)


class ProgramFunction(Generic[P, R]):
    """A program of a shader file: the pipeline runs it, Python does not."""

    def __init__(self, function: Callable[P, R]) -> None:
        self.__wrapped__ = function
        functools.update_wrapper(self, function)

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R:
        name = self.__wrapped__.__name__
        raise TypeError(f"{name} is a program: it runs in a launch; optixc.interpret(pipeline, params, sbt, size, index) runs it in Python")

    def __repr__(self) -> str:
        return f"<program {self.__wrapped__.__name__}>"

    def __reduce__(self) -> str:
        return self.__wrapped__.__qualname__


class HelperFunction(Generic[P, R]):
    """A helper of a shader file; called from Python it runs with the arithmetic of shaders, float32 and wrapping integers."""

    def __init__(self, function: Callable[P, R]) -> None:
        self.__wrapped__ = function
        functools.update_wrapper(self, function)

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R:
        return cast(R, call_helper(self.__wrapped__, args, kwargs))

    def __repr__(self) -> str:
        return f"<device function {self.__wrapped__.__name__}>"

    def __reduce__(self) -> str:
        return self.__wrapped__.__qualname__


def program(function: Callable[P, R]) -> ProgramFunction[P, R]:
    """Marks a program; its name tells the kind: `__raygen__NAME`, `__miss__NAME`, `__closesthit__NAME` ..."""
    if not callable(function):
        raise TypeError(f"@optixc.program decorates a function, not {function!r}")
    if program_kind(function.__name__) is None:
        raise TypeError(
            f"{function.__name__} is not the name of a program; it begins with __raygen__, __miss__, __closesthit__, __anyhit__ ..."
        )
    return ProgramFunction(function)


def device(function: Callable[P, R]) -> HelperFunction[P, R]:
    """Marks a helper that programs call."""
    if not callable(function):
        raise TypeError(f"@optixc.device decorates a function, not {function!r}")
    return HelperFunction(function)


class LaunchParameters:
    """What `params = launch_params(Params)` is outside of a launch: a promise that programs will find the launch's parameters there."""

    def __init__(self, kind: type[Any]) -> None:
        self.__dict__["__optixc_params__"] = kind

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        kind = self.__dict__["__optixc_params__"]
        raise InvalidOperationError(f"launch parameters have values only inside a launch; {kind.__name__}.{name} cannot be read here")

    def __setattr__(self, name: str, value: object) -> None:
        raise InvalidOperationError("launch parameters are read-only in programs; pass them to pipeline.launch()")


def launch_params(kind: type[T]) -> T:
    """The launch parameters of the programs in this file, one per pipeline: OptiX's `__constant__ params`."""
    if structs.layout_of(kind) is None:
        raise TypeError(f"launch_params takes an @optixc.struct class, not {kind!r}")
    return cast(T, LaunchParameters(kind))


def device_function(name: str) -> Callable[..., Any] | None:
    """The Python face of a device function of the table, None if there is no such name."""
    row = INTRINSICS.get(name) or next(iter(OVERLOADS.get(name, ())), None)
    if row is None and name not in SPECIAL_FUNCTIONS:
        return None

    def call(*args: Any, **kwargs: Any) -> Any:
        try:
            return mathematics.evaluate(name, _in_order(name, args, kwargs))
        except KeyError:
            raise InvalidOperationError(f"{name}() works inside a program only; optixc.interpret runs a program in Python") from None

    call.__name__ = call.__qualname__ = name
    call.__doc__ = row.doc if row is not None else None
    return call


def _in_order(name: str, args: tuple[Any, ...], kwargs: dict[str, Any]) -> tuple[Any, ...]:
    """All arguments in the order of the function's parameters."""
    if not kwargs or name not in INTRINSICS:
        return args
    parameters = [Parameter(one.name, Parameter.POSITIONAL_OR_KEYWORD) for one in INTRINSICS[name].parameters]
    try:
        return Signature(parameters).bind(*args, **kwargs).args
    except TypeError as error:
        raise TypeError(f"{name}(): {error}") from None
