"""The scalar types by their shader names: annotations in shaders and structs, conversions in plain Python.

Integers wrap, `float32` and `float16` round to nearest; arithmetic on them in plain Python is Python's own. To type checkers they are
`int` and `float`, since in shaders a number of one width takes literals and results of Python's operators.
"""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, SupportsFloat, SupportsInt


def round_to(code: str, value: float) -> float:
    """`value` rounded to the floating type with this `struct` code; beyond its range infinite."""
    try:
        rounded: float = struct.unpack(code, struct.pack(code, value))[0]
    except OverflowError:
        return float("inf") if value > 0 else float("-inf")
    return rounded


if TYPE_CHECKING:
    int8 = int
    uint8 = int
    int16 = int
    uint16 = int
    int32 = int
    uint32 = int
    int64 = int
    uint64 = int
    float16 = float
    float32 = float
    float64 = float
else:

    class _Integer(int):
        """An integer of fixed width; converting wraps as C does."""

        bits = 32
        signed = True

        def __new__(cls, value: SupportsInt = 0) -> _Integer:
            number = int(value) & ((1 << cls.bits) - 1)
            if cls.signed and number >> (cls.bits - 1):
                number -= 1 << cls.bits
            return super().__new__(cls, number)

    class int8(_Integer):
        bits = 8

    class uint8(_Integer):
        bits = 8
        signed = False

    class int16(_Integer):
        bits = 16

    class uint16(_Integer):
        bits = 16
        signed = False

    class int32(_Integer):
        """32-bit signed; `int` in shaders means this."""

    class uint32(_Integer):
        """32-bit unsigned."""

        signed = False

    class int64(_Integer):
        bits = 64

    class uint64(_Integer):
        bits = 64
        signed = False

    class float64(float):
        """IEEE binary64; Python's own float."""

    class float32(float):
        """IEEE binary32; `float` in shaders means this."""

        def __new__(cls, value: SupportsFloat = 0.0) -> float32:
            return super().__new__(cls, round_to("<f", float(value)))

    class float16(float):
        """IEEE binary16, storage only."""

        def __new__(cls, value: SupportsFloat = 0.0) -> float16:
            return super().__new__(cls, round_to("<e", float(value)))
