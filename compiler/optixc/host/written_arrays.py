"""Read-only arrays where a pipeline writes: refused by name before a launch, because a write to them would change what its owner keeps
constant, or end the process where the memory is mapped read-only.

Arrays of launch parameters are looked at in every launch, those of records when their table is packed.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from optixc.errors import InvalidValueError

ELEMENT = "[]"
_PARAMS = "params"


class WrittenArrays:
    """What the compiler says about a pipeline: rows of a path (`params`, `record PROGRAM` or `struct NAME`, then fields) and a place."""

    def __init__(self, rows: Iterable[Mapping[str, Any]]) -> None:
        self._of_params: list[tuple[str, tuple[str, ...], str]] = []
        self._of_records: dict[str, list[tuple[tuple[str, ...], str]]] = {}
        for row in rows:
            root, *fields = row["path"]
            if root == _PARAMS:
                self._of_params.append((fields[0], tuple(fields[1:]), row["place"]))
            else:
                self._of_records.setdefault(root, []).append((tuple(fields), row["place"]))

    def check_params(self, params: Any) -> None:
        """Raises if a launch with these parameters would write a read-only array."""
        values = params.__dict__
        for name, rest, place in self._of_params:
            array = values[name]
            if rest or (array is not None and not array.flags.writeable):
                _check((array,), (name,), rest, f"launch parameter of {type(params).__name__}", place)

    def check_record(self, programs: Iterable[str], data: Any) -> None:
        """Raises if these programs, or whoever reads their record, would write a read-only array of its data."""
        if not self._of_records or data is None:
            return
        for root in (*(f"record {name}" for name in programs), f"struct {type(data).__name__}"):
            for fields, place in self._of_records.get(root, ()):
                _check((data,), (), fields, f"field of a {type(data).__name__} record", place)


def _check(values: Sequence[Any], done: tuple[str, ...], rest: tuple[str, ...], what: str, place: str) -> None:
    """Follows the fields of `rest`; the values at their end are arrays."""
    if not rest:
        if any(value is not None and not value.flags.writeable for value in values):
            name = ".".join(done).replace(f".{ELEMENT}", ELEMENT)
            raise InvalidValueError(
                f"{what} `{name}` is a read-only array, and the pipeline writes it at {place}; pass a copy (array.copy()), or an array "
                "whose flags.writeable is True"
            )
        return
    inner = [one for value in values if value is not None for one in _step(value, rest[0])]
    _check(inner, (*done, rest[0]), rest[1:], what, place)


def _step(value: Any, field: str) -> Iterator[Any]:
    """A field of a struct; the structs that an array was copied from. Those of other arrays hold addresses only."""
    if field == ELEMENT:
        yield from getattr(value, "sources", ())
    elif field in getattr(value, "__dict__", {}):
        yield value.__dict__[field]
