"""The mechanical names of device functions, and the short form in which the rows are written.

`optixGetGASTraversableHandle` is `get_gas_traversable_handle` in shaders and `oxrt::getGASTraversableHandle` in C++.
"""

from __future__ import annotations

import re

from optixc.ir.intrinsics import Effect, Intrinsic, IntrinsicParameter, ParameterType, State
from optixc.ir.programs import ALL_PROGRAMS, ProgramKind

_WORDS = {"BSpline": "Bspline", "GAS": "Gas", "IAS": "Ias", "SRT": "Srt", "2D": "2d"}

Parameters = tuple[tuple[str, ParameterType] | tuple[str, ParameterType, bool | int | float], ...]


def snake_name(optix: str) -> str:
    """The shader's name of an OptiX function: without `optix`, in snake case."""
    text = optix.removeprefix("optix")
    for word, replacement in _WORDS.items():
        text = text.replace(word, replacement)
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", text).lower()


def cpp_name(optix: str) -> str:
    """The C++ name of an OptiX function: in namespace oxrt, without `optix`, its first letter small."""
    text = optix.removeprefix("optix")
    return f"oxrt::{text[0].lower()}{text[1:]}"


def parameters_of(parameters: Parameters) -> tuple[IntrinsicParameter, ...]:
    """Parameters from pairs (name, type) and triples (name, type, default)."""
    return tuple(IntrinsicParameter(*parameter) for parameter in parameters)


def device(
    optix: str,
    parameters: Parameters,
    result: ParameterType,
    doc: str,
    *,
    effect: Effect = Effect.PURE,
    state: State = State.RAY,
    allowed: frozenset[ProgramKind] = ALL_PROGRAMS,
    name: str = "",
    overload_of: str = "",
    cpp: str = "",
) -> Intrinsic:
    """A row of an OptiX function, named by the rule unless `name` and `cpp` say otherwise."""
    return Intrinsic(
        name=name or snake_name(optix),
        optix=optix,
        parameters=parameters_of(parameters),
        result=result,
        cpp=cpp or cpp_name(optix),
        doc=doc,
        effect=effect,
        state=state,
        allowed=allowed,
        overload_of=overload_of,
    )


def maths(name: str, parameters: Parameters, result: ParameterType, doc: str, cpp: str = "") -> Intrinsic:
    """A row of a pure function without hidden arguments; its C++ name is its own in lower camel case."""
    camel = re.sub(r"_([a-z0-9])", lambda match: match.group(1).upper(), name)
    return Intrinsic(name, "", parameters_of(parameters), result, cpp or f"oxrt::{camel}", doc)
