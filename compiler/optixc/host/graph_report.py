"""Who walks through the graphs that a launch traces: Embree by itself, or the kernels."""

from __future__ import annotations

from typing import Any

from optixc.host.accel import Accel, TraversableHandle, moves_by_transform
from optixc.host.structs import layout_of


def graph_forms(params: Any) -> dict[str, bool]:
    """For each traversable in launch parameters, by the name of its field: whether Embree walks through it without the kernels.

    True for geometry and for one level of instances over static geometry (`Accel.has_native_instances`), False for deeper and moving
    graphs and for transforms. Handles that do not know their accel are left out.
    """
    found: dict[str, bool] = {}
    layout = layout_of(params)
    for field in layout.fields if layout is not None else ():
        value = getattr(params, field.name)
        if isinstance(value, TraversableHandle) and value.accel is not None:
            found[field.name] = isinstance(value.accel, Accel) and value.accel.is_native
        elif layout_of(value) is not None:
            found.update({f"{field.name}.{name}": form for name, form in graph_forms(value).items()})
    return found


def moving_fields(params: Any) -> list[str]:
    """The traversables in launch parameters that are moved by transforms, by the names of their fields."""
    found: list[str] = []
    layout = layout_of(params)
    for field in layout.fields if layout is not None else ():
        value = getattr(params, field.name)
        if isinstance(value, TraversableHandle) and moves_by_transform(value):
            found.append(field.name)
        found += [f"{field.name}.{name}" for name in moving_fields(value)]
    return found
