"""Who walks through the graphs that a launch traces: Embree by itself, or the kernels."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from optixc.errors import InvalidValueError
from optixc.host.accel import Accel, TraversableHandle
from optixc.host.structs import layout_of


def traversables(params: Any, where: str = "") -> Iterator[tuple[str, Any]]:
    """The traversables in launch parameters with the names of their fields; handles that do not know what they name are left out."""
    layout = layout_of(params)
    for field in layout.fields if layout is not None else ():
        value = getattr(params, field.name)
        if isinstance(value, TraversableHandle) and value.accel is not None:
            yield where + field.name, value.accel
        elif layout_of(value) is not None:
            yield from traversables(value, f"{where}{field.name}.")


def graph_forms(params: Any) -> dict[str, bool]:
    """For each traversable in launch parameters, by the name of its field: whether Embree walks through it without the kernels.

    True for geometry and for one level of instances over static geometry (`Accel.has_native_instances`), False for deeper and moving
    graphs and for transforms.
    """
    return {name: isinstance(one, Accel) and one.is_native for name, one in traversables(params)}


def check_contexts(params: Any, context: Any) -> None:
    """Raises if a traversable in launch parameters is of another context, where its handle names something else or nothing."""
    for name, one in traversables(params):
        if one._context is not context:
            raise InvalidValueError(
                f"launch parameter `{name}` of {type(params).__name__} is of another context than the pipeline; build it with the "
                "pipeline's DeviceContext"
            )
