"""Who reads and writes a payload word, as the bits of `payload_word()` say (OptiX guide, 8.4.2.1 and 14)."""

from __future__ import annotations

from optixc.ir.types import StructField

READ, WRITE = 1, 2
CALLER, CLOSESTHIT, MISS, ANYHIT = 0, 2, 4, 6


def is_passed(field: StructField, name: str) -> bool:
    """Whether programs that a trace, traverse or invoke runs may see the caller's value; a field without semantics allows all."""
    semantics = field.semantics
    if semantics is None:
        return True
    return bool(semantics >> CALLER & WRITE) or (name == "invoke" and bool(semantics >> ANYHIT & WRITE))


def is_returned(field: StructField, name: str) -> bool:
    """Whether the caller may use the word after the call."""
    semantics = field.semantics
    if semantics is None or semantics >> CALLER & READ:
        return True
    return name == "traverse" and bool((semantics >> CLOSESTHIT | semantics >> MISS) & READ)
