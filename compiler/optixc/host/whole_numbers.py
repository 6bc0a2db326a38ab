"""Whole numbers and enumeration members that callers give: checked for type and range."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from optixc.errors import InvalidValueError

WORD_LIMIT = 1 << 32


def take_whole(value: Any, least: int, most: int, where: str) -> int:
    """`value` as an int from `least` to `most`; Python's and numpy's whole numbers are taken, bool is not."""
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or not least <= value <= most:
        raise InvalidValueError(f"{where} must be a whole number from {least} to {most}, not {value!r:.60}")
    return int(value)


def take_member(value: Any, members: Iterable[int], where: str) -> int:
    """`value` as one of the members of an enumeration, given as such or by its number."""
    known = tuple(members)
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or int(value) not in known:
        names = ", ".join(getattr(member, "name", str(member)) for member in known)
        raise InvalidValueError(f"{where} takes one of {names}, not {value!r:.60}")
    return int(value)
