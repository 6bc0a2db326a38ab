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


def parts_of(inputs: Sequence[Any]) -> tuple[Geometry | Child, ...]:
    """What an accel is made of, from its build inputs."""
    parts: list[Geometry | Child] = []
    for one in inputs:
        if hasattr(one, "num_sbt_records"):
            parts.append(Geometry(_kind(one), int(one.num_sbt_records)))
            continue
        given = getattr(one, "sbt_offsets", None)
        offsets = np.broadcast_to(0 if given is None else np.asarray(given).reshape(-1), len(one.instances))
        for instance, offset in zip(one.instances, offsets.tolist(), strict=True):
            is_instance = hasattr(instance, "traversable")
            parts.append(Child(instance.traversable, int(instance.sbt_offset)) if is_instance else Child(instance, offset))
    return tuple(parts)


def below(parts: Sequence[Geometry | Child], traversables: Sequence[Any]) -> tuple[Geometry | Child, ...]:
    """The parts of an IAS with other traversables, one for each instance."""
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
