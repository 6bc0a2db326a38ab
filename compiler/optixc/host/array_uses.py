"""Arrays that a pipeline uses, looked at before a launch: None where elements are read or written would end the process, and so may a
write to a read-only array, or it changes what its owner keeps constant.

Arrays of launch parameters are looked at in every launch, those of records when their table is packed. Parameters remember the pipeline
that found all their arrays there, until a field is set.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

from optixc.errors import InvalidValueError

ELEMENT = "[]"
_PARAMS = "params"

_Use = tuple[tuple[str, ...], str, str | None]
"""Fields below a root, the place that uses the array, the place that writes it."""


class ArrayUses:
    """What the compiler says about a pipeline: rows of a path (`params`, `record PROGRAM` or `struct NAME`, then fields) and places."""

    def __init__(self, rows: Iterable[Mapping[str, Any]]) -> None:
        self._of_params: list[_Use] = []
        self._of_records: dict[str, list[_Use]] = {}
        for row in rows:
            root, *fields = row["path"]
            uses = self._of_params if root == _PARAMS else self._of_records.setdefault(root, [])
            uses.append((tuple(fields), row["used"], row["written"]))
        written = [use for use in self._of_params if use[2] is not None]
        self._written_fields = [(use[0][-1], use[0][:-1]) for use in written if ELEMENT not in use[0]]
        self._written_elements = [use for use in written if ELEMENT in use[0]]

    def check_params(self, params: Any, also: Callable[[Any], None]) -> None:
        """Raises if a launch with these parameters would use an array that is not there, or write a read-only one; asks `also` of
        parameters that have changed."""
        values = params.__dict__
        if values["_complete_for"] is not self:
            _check_params(params, self._of_params)
            also(params)
            values["_complete_for"] = self
            return
        for name, structs in self._written_fields:
            inner = values
            for field in structs:
                inner = inner[field].__dict__
            if not inner[name].flags.writeable:
                _check_params(params, self._of_params)
        if self._written_elements:
            _check_params(params, self._written_elements)

    def check_record(self, programs: Iterable[str], data: Any) -> None:
        """Raises if these programs, or whoever reads their record, would use an array of its data that is not there, or write a
        read-only one."""
        if not self._of_records or data is None:
            return
        for root in (*(f"record {name}" for name in programs), f"struct {type(data).__name__}"):
            for use in self._of_records.get(root, ()):
                _check((data,), (), use, f"field of a {type(data).__name__} record")


def _check_params(params: Any, uses: Iterable[_Use]) -> None:
    for use in uses:
        _check((params,), (), use, f"launch parameter of {type(params).__name__}")


def _check(values: Sequence[Any], done: tuple[str, ...], use: _Use, what: str) -> None:
    """Follows the fields of a use; the values at their end are arrays."""
    rest = use[0][len(done) :]
    if rest:
        _check([one for value in values for one in _step(value, rest[0])], (*done, rest[0]), use, what)
        return
    name = ".".join(done).replace(f".{ELEMENT}", ELEMENT)
    _, used, written = use
    for value in values:
        if value is None:
            raise InvalidValueError(
                f"{what} `{name}` is None, and the pipeline uses it at {used}; pass an array, or an empty one where the programs find "
                "by its shape that they have nothing to look at"
            )
        if written is not None and not value.flags.writeable:
            raise InvalidValueError(
                f"{what} `{name}` is a read-only array, and the pipeline writes it at {written}; pass a copy (array.copy()), or an array "
                "whose flags.writeable is True"
            )


def _step(value: Any, field: str) -> Iterator[Any]:
    """A field of a struct; the structs that an array was copied from. Those of other arrays hold addresses only."""
    if field == ELEMENT:
        yield from getattr(value, "sources", ())
    elif field in getattr(value, "__dict__", {}):
        yield value.__dict__[field]
