"""Types that exist only while a program is checked: literals without a type of their own, and the type of an error.

A weak literal takes the type of the other side; where there is none, int32 or float32. INVALID stands for an expression that
already has a diagnostic, so that one mistake is told once.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TypeGuard, cast

from optixc.ir import types as t


@dataclass(frozen=True)
class WeakInt:
    """An integer literal, or operators on such.

    `flag_bits` are all bits of an `IntFlag` class whose member this is, 0 otherwise: flags become uint32 where nothing else gives them a
    type, and `~` stays within the bits of the class, as in Python.
    """

    flag_bits: int = 0

    def __str__(self) -> str:
        return "int literal"


@dataclass(frozen=True)
class WeakFloat:
    """A floating-point literal, or operators on literals with one."""

    def __str__(self) -> str:
        return "float literal"


@dataclass(frozen=True)
class Invalid:
    """The type of an expression that has an error."""

    def __str__(self) -> str:
        return "invalid"


WEAK_INT = WeakInt()
WEAK_FLOAT = WeakFloat()
INVALID = Invalid()

Weak = WeakInt | WeakFloat
CheckType = t.Type | WeakInt | WeakFloat | Invalid
ConstantValue = bool | int | float


def member_type(is_flag: bool, members: Mapping[str, int]) -> WeakInt:
    """The type of an enum's members."""
    highest = max((value.bit_length() for value in members.values()), default=0)
    fits = is_flag and highest <= 32 and all(value >= 0 for value in members.values())
    return WeakInt((1 << max(highest, 1)) - 1) if fits else WEAK_INT


def is_weak(type_: CheckType) -> TypeGuard[Weak]:
    """Whether it is the type of a literal."""
    return isinstance(type_, WeakInt | WeakFloat)


def is_number(type_: CheckType) -> bool:
    """Whether it is a scalar that can be calculated with, or a literal."""
    return is_weak(type_) or (isinstance(type_, t.Scalar) and type_.kind is not t.ScalarKind.BOOL)


def is_integer(type_: CheckType) -> bool:
    """Whether it is an integer scalar or an integer literal."""
    return isinstance(type_, WeakInt) or (isinstance(type_, t.Scalar) and type_.kind in (t.ScalarKind.INT, t.ScalarKind.UINT))


def is_float(type_: CheckType) -> bool:
    """Whether it is a floating-point scalar or literal."""
    return isinstance(type_, WeakFloat) or (isinstance(type_, t.Scalar) and type_.kind is t.ScalarKind.FLOAT)


def default_type(type_: CheckType) -> t.Type:
    """The type that a value gets where nothing else says one: int32 and float32 for literals, uint32 for flags, also inside tuples."""
    if isinstance(type_, WeakInt):
        return t.UINT32 if type_.flag_bits else t.INT32
    if isinstance(type_, WeakFloat):
        return t.FLOAT32
    if isinstance(type_, Invalid):
        return t.VOID
    if isinstance(type_, t.Tuple):
        return t.Tuple(tuple(default_type(item) for item in type_.items))
    return type_


def widened(type_: t.Type) -> t.Type:
    """What reading a place of this type gives: 8 and 16 bit numbers widen to 32 bits, everything else is itself."""
    if isinstance(type_, t.Scalar) and type_.kind is not t.ScalarKind.BOOL and type_.bits < 32:
        return t.Scalar(type_.kind, 32)
    if isinstance(type_, t.Vector):
        element = widened(type_.element)
        return t.Vector(element, type_.size) if isinstance(element, t.Scalar) else type_
    if isinstance(type_, t.Tuple):
        return t.Tuple(tuple(widened(item) for item in type_.items))
    return type_


def tuple_of(items: Iterable[CheckType]) -> t.Tuple:
    """A tuple type whose items may still be literals; `default_type` makes an ordinary one of it."""
    return t.Tuple(cast("tuple[t.Type, ...]", tuple(items)))
