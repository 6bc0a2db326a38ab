"""The interpreter's rules for device functions that change the outgoing hit object: the compiled functions, on values of Python."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from optixc.interpret import native, values
from optixc.ir import types as t
from optixc.ir.intrinsics import Generic, Intrinsic

MOST_TRANSFORMS = 31
"""As many as a graph is deep at most; the compiled functions take that many handles."""


def maker(row: Intrinsic, uses_motion: bool) -> Callable[..., Any]:
    """`f(hit object, *arguments)` for a row with an effect on hit objects."""
    handles = t.FixedArray(t.TRAVERSABLE, MOST_TRANSFORMS)
    types: list[t.Type] = []
    for parameter in row.parameters:
        if isinstance(parameter.type, Generic):
            assert parameter.type is Generic.HANDLES
            types.append(handles)
        else:
            types.append(parameter.type)
    bound = native.bind(row.name, tuple(types), t.VOID)
    names = [parameter.name for parameter in row.parameters]

    def make(state: Any, *arguments: Any) -> Any:
        given = dict(zip(names, arguments, strict=True))
        if "ray_time" in given and not uses_motion:
            given["ray_time"] = 0.0
        if "transforms" in given:
            items = given["transforms"].items[:MOST_TRANSFORMS]
            given["num_transforms"] = min(given["num_transforms"], len(items))
            given["transforms"] = values.FixedArrayValue(handles, [*items, *(0 for _ in range(MOST_TRANSFORMS - len(items)))])
        return bound(state, *given.values())

    return make
