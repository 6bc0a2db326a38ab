"""The form of the one table of device functions, and how to look one up.

The rows stand in `intrinsic_rows` by subject; checker, lowering, emitters, interpreter and manual read them and nothing else. A row
is data: adding a device function is adding a row, a C++ function in `oxrt/device.h` or `oxrt/math.h`, and an interpreter rule.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from optixc.ir.programs import ALL_PROGRAMS, ProgramKind
from optixc.ir.types import Type


class Effect(Enum):
    """What calling it does besides giving a value. What READS much memory is a statement, so that it is done once and in its place."""

    PURE = "pure"
    READS = "reads memory"
    WRITES = "writes"
    ENDS_PROGRAM = "ends program"
    ENDS_LAUNCH_INDEX = "ends launch index"


class State(Enum):
    """Which hidden argument the C++ function takes first: nothing, the thread (launch index, SBT), or the ray in flight."""

    NONE = "none"
    THREAD = "thread"
    RAY = "ray"
    HIT_OBJECT = "hit object"


class Generic(Enum):
    """Parameter and result types that depend on the call's first argument of that form."""

    FLOATS = "a float32 or float64 scalar or vector"
    NUMBERS = "a number or vector of numbers"
    INTEGERS = "an integer or vector of integers"
    FLOAT_VECTOR = "a vector of floats"
    ELEMENT = "the scalar of the first argument"
    SAME = "the type of the first argument"
    ARRAY = "an array of 32 or 64 bit numbers"
    RECORD_STRUCT = "a struct class, given by name"
    HANDLES = "a fixed array of traversables"
    COOP_VEC = "a cooperative vector"
    COOP_VEC_OR_NUMBER = "a cooperative vector or a number"
    COOP_VEC_TYPE = "a type CoopVec[T, N]"
    MEMORY = "an array of numbers"


ParameterType = Type | Generic


@dataclass(frozen=True)
class IntrinsicParameter:
    """A parameter; `default` is a Python number or None for required. An `optional` one may be left out or be None."""

    name: str
    type: ParameterType
    default: bool | int | float | None = None
    optional: bool = False


@dataclass(frozen=True)
class Intrinsic:
    """One device function. `cpp` is the C++ name; `since_interpreter` rules are keyed by `name`.

    `optix` is OptiX's own name ("" for maths), so that a search for it finds the row. A function with two parameter lists has two
    rows: authors write `overload_of` where it is set, the IR names the row.
    """

    name: str
    optix: str
    parameters: tuple[IntrinsicParameter, ...]
    result: ParameterType
    cpp: str
    doc: str
    effect: Effect = Effect.PURE
    state: State = State.NONE
    allowed: frozenset[ProgramKind] = ALL_PROGRAMS
    overload_of: str = ""
