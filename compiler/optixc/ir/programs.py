"""The eight kinds of programs, their prefixes and the letters that the availability table uses."""

from __future__ import annotations

from enum import Enum


class ProgramKind(Enum):
    """A kind of program; the value is the prefix between the double underscores."""

    RAYGEN = "raygen"
    MISS = "miss"
    CLOSESTHIT = "closesthit"
    ANYHIT = "anyhit"
    INTERSECTION = "intersection"
    EXCEPTION = "exception"
    DIRECT_CALLABLE = "direct_callable"
    CONTINUATION_CALLABLE = "continuation_callable"

    @property
    def prefix(self) -> str:
        """What names of programs of this kind begin with, e.g. `__raygen__`."""
        return f"__{self.value}__"


def program_kind(name: str) -> ProgramKind | None:
    """The kind that the prefix of `name` tells, or None for an ordinary name."""
    return next((kind for kind in ProgramKind if name.startswith(kind.prefix)), None)


NOT_INLINED_PREFIX = "__optix_enabled__"
"""Helpers of this prefix stay functions of their own; they may do what direct callables do, without SBT data."""


def is_inlined(source_name: str) -> bool:
    """Whether the C++ compiler may make a helper part of its callers."""
    return not source_name.startswith(NOT_INLINED_PREFIX)


RG = ProgramKind.RAYGEN
MS = ProgramKind.MISS
CH = ProgramKind.CLOSESTHIT
AH = ProgramKind.ANYHIT
IS = ProgramKind.INTERSECTION
EX = ProgramKind.EXCEPTION
DC = ProgramKind.DIRECT_CALLABLE
CC = ProgramKind.CONTINUATION_CALLABLE
CALLABLES: frozenset[ProgramKind] = frozenset({DC, CC})
ALL_PROGRAMS: frozenset[ProgramKind] = frozenset(ProgramKind)
