"""Bound values: launch parameters that are constants of a pipeline, as the host gives them, checked against each other and at a launch.

Keys are field names of the launch parameters, dotted inside structs (`light.enabled`); values are numbers, vectors, structs, or a
`BoundValue` that adds an annotation for the log.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from optixc.errors import InvalidValueError
from optixc.host import structs

Plain = bool | int | float | tuple[bool | int | float, ...]
NO_ANNOTATION = "No annotation"


@dataclass(frozen=True)
class BoundValue:
    """A bound value and what the log calls it."""

    value: Any
    annotation: str | None = None


def plain_values(given: Mapping[str, Any] | None) -> dict[str, BoundValue]:
    """The fields that are bound, structs taken apart, each with a plain value. Raises for overlaps and empty values."""
    if given is not None and not isinstance(given, Mapping):
        raise InvalidValueError(f"bound_values takes a dict of field names and values, not {type(given).__name__}")
    for name in given or {}:
        if not isinstance(name, str) or not name or not all(part.isidentifier() for part in name.split(".")):
            raise InvalidValueError(f"bound value {name!r} is no field name; write the field of the launch parameters, e.g. 'light.color'")
        outer = next((other for other in given or {} if name != other and name.startswith(f"{other}.")), None)
        if outer is not None:
            raise InvalidValueError(f"bound values {outer!r} and {name!r} overlap; bind the whole struct or its fields, not both")
    found: dict[str, BoundValue] = {}
    for name, value in (given or {}).items():
        bound = value if isinstance(value, BoundValue) else BoundValue(value)
        found.update((leaf, BoundValue(plain, bound.annotation)) for leaf, plain in _leaves(name, bound.value))
    return found


def merge(named: Iterable[tuple[str, Mapping[str, BoundValue]]]) -> dict[str, BoundValue]:
    """What several modules and the pipeline bind together; the same field may be bound twice to the same value."""
    found: dict[str, BoundValue] = {}
    owners: dict[str, str] = {}
    for owner, values in named:
        for name, bound in values.items():
            known = found.get(name)
            if known is not None and (known.value != bound.value or type(known.value) is not type(bound.value)):
                raise InvalidValueError(
                    f"bound value {name!r} is {known.value!r} in {owners[name]} and {bound.value!r} in {owner}; bind it to one value"
                )
            found.setdefault(name, bound)
            owners.setdefault(name, owner)
    return found


def difference(packed: bytes | bytearray, bound: Iterable[Mapping[str, Any]]) -> str | None:
    """What is wrong with launch parameters that should hold the bound values; None if they do."""
    for one in bound:
        begin, wanted = one["offset"], bytes.fromhex(one["data"])
        if packed[begin : begin + len(wanted)] != wanted:
            return (
                f"launch parameter `{one['name']}` is bound to {one['value']} in this pipeline, and the launch gives another value; "
                "pass the bound value, or make a pipeline without it"
            )
    return None


def _leaves(name: str, value: Any) -> list[tuple[str, Plain]]:
    layout = structs.layout_of(value)
    if layout is not None and not isinstance(value, type):
        return [leaf for field in layout.fields for leaf in _leaves(f"{name}.{field.name}", getattr(value, field.name))]
    if isinstance(value, bool | int | float):
        return [(name, value)]
    try:
        numbers = tuple(getattr(number, "item", lambda number=number: number)() for number in value)
    except (TypeError, ValueError):
        item = getattr(value, "item", None)
        if item is not None and getattr(value, "size", 1) == 1:
            return _leaves(name, item())
        raise InvalidValueError(f"bound value {name!r} takes a number, a vector or a struct of them, not {value!r:.60}") from None
    if not numbers:
        raise InvalidValueError(f"bound value {name!r} has no bytes; bind a number, a vector or a struct")
    if not all(isinstance(number, bool | int | float) for number in numbers):
        raise InvalidValueError(f"bound value {name!r} takes a number, a vector or a struct of them, not {value!r:.60}")
    return [(name, numbers)]
