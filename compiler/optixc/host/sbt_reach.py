"""Which hit group records a traversable can ask for: every build input's SBT indices, with the offsets of the instances above."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from optixc.errors import InvalidValueError

_MOST_PLACES = 200_000


@dataclass(frozen=True)
class Geometry:
    """One build input of a GAS."""

    kind: str
    records: int


@dataclass(frozen=True)
class Child:
    """One instance of an IAS."""

    traversable: Any
    sbt_offset: int


@dataclass(frozen=True)
class Place:
    """A build input's record as rays reach it: `offset` of all instances above and `gas_index` go into the formula of the guide, 7.3."""

    offset: int
    gas_index: int
    kind: str
    path: str

    def index(self, sbt_offset: int, sbt_stride: int) -> int:
        """The hit group record that a trace with these arguments runs."""
        return self.offset + self.gas_index * (sbt_stride & 15) + (sbt_offset & 15 | sbt_stride >> 4 & 15)


class Children:
    """The instances of an IAS that were given as arrays. Each is made when it is asked for, since there may be millions."""

    def __init__(self, traversables: Any, sbt_offsets: np.ndarray[Any, Any]) -> None:
        self._traversables = traversables
        self.sbt_offsets = sbt_offsets

    def __len__(self) -> int:
        return len(self._traversables)

    def __getitem__(self, number: int) -> Child:
        return Child(self._traversables[number], int(self.sbt_offsets[number]))

    def __iter__(self) -> Iterator[Child]:
        return (self[number] for number in range(len(self)))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Children) and list(self) == list(other)

    __hash__ = None  # type: ignore[assignment]


Parts = tuple[Geometry | Child, ...] | Children


def parts_of(inputs: Sequence[Any]) -> Parts:
    """What an accel is made of, from its build inputs."""
    if all(hasattr(one, "num_sbt_records") for one in inputs):
        return tuple(Geometry(_kind(one), int(one.num_sbt_records)) for one in inputs)
    (given,) = inputs
    if len(given.instances) and hasattr(given.instances[0], "traversable"):
        return tuple(Child(one.traversable, int(one.sbt_offset)) for one in given.instances)
    offsets = np.array(0 if given.sbt_offsets is None else given.sbt_offsets).reshape(-1)
    traversables = given.instances.copy() if isinstance(given.instances, np.ndarray) else tuple(given.instances)
    return Children(traversables, np.broadcast_to(offsets, len(traversables)))


def below(parts: Parts, traversables: Sequence[Any]) -> Parts:
    """The parts of an IAS with other traversables, one for each instance."""
    if isinstance(parts, Children):
        return Children(tuple(traversables), parts.sbt_offsets)
    return tuple(Child(one, part.sbt_offset) if isinstance(part, Child) else part for part, one in zip(parts, traversables, strict=True))


def places(traversable: Any) -> Iterator[Place]:
    """Every record place below a traversable, each different (offset, index, kind) once, with the first path that leads to it."""
    seen: set[tuple[int, int, str]] = set()
    visited: set[tuple[int, int]] = set()
    pending: list[tuple[Any, int, str]] = [(traversable, 0, "")]
    while pending:
        above, offset, path = pending.pop()
        part = _take(above)
        if (id(part), offset) in visited:
            continue
        visited.add((id(part), offset))
        gas_index, inner = 0, []
        for number, one in enumerate(part.parts):
            if isinstance(one, Child):
                inner.append((one.traversable, offset + one.sbt_offset, f"{path}instance {number} (sbt_offset {one.sbt_offset}), "))
                continue
            for record in range(one.records):
                key = (offset, gas_index, one.kind)
                if key not in seen and len(seen) < _MOST_PLACES:
                    seen.add(key)
                    yield Place(offset, gas_index, one.kind, f"{path}build input {number} ({one.kind}), record {record}")
                gas_index += 1
        pending.extend(reversed(inner))


def _take(traversable: Any) -> Any:
    """The accel behind a handle or below transforms."""
    while not hasattr(traversable, "parts"):
        below = getattr(traversable, "accel", None) or getattr(traversable, "_child", None)
        if below is None:
            raise InvalidValueError(f"the records of {traversable!r:.60} are not known; give the accel or transform itself")
        traversable = below
    return traversable


def _kind(one: Any) -> str:
    name = type(one).__name__.removeprefix("BuildInput")
    return {"CustomPrimitives": "custom primitives"}.get(name, name.lower())
