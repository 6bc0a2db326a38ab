"""The interpreter's rules for the device functions of the table: how a row is evaluated on given argument types.

Getters and floating-point mathematics are the compiled functions themselves; what is exact in integers is done here. Functions of one
number work on vectors component by component.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any

from optixc.interpret import native, numbers, values
from optixc.ir import types as t
from optixc.ir.intrinsics import Effect, Intrinsic, State

Function = Callable[..., Any]

WHOLE_VECTOR = frozenset({"dot", "cross", "length", "length_squared", "distance", "normalize", "reflect", "refract", "faceforward"})
_MATRIX = frozenset({"transpose", "determinant", "inverse"})
_NATIVE_NAMES = {"rint": "round"}


def function(machine: Any, row: Intrinsic, types: tuple[t.Type, ...], result: t.Type) -> Function:
    """What evaluates the row; `machine` knows the ray, the hit object and the thread."""
    if row.effect is not Effect.PURE:
        effect: Function = machine.effect(row)
        return effect
    if row.name.startswith("get_payload_"):
        index = int(row.name.removeprefix("get_payload_"))
        return lambda: machine.payload_word(index)
    if row.state is not State.NONE:
        bound = native.bind(row.name, types, result)
        state_of = {State.RAY: machine.ray_state, State.THREAD: machine.thread_state, State.HIT_OBJECT: machine.hit_object_state}[row.state]
        return lambda *arguments: bound(state_of(), *arguments)
    return mathematics(row.name, types, result)


def mathematics(name: str, types: tuple[t.Type, ...], result: t.Type) -> Function:
    """A function without state."""
    if name in _EXACT:
        return _EXACT[name]
    if name in WHOLE_VECTOR or name in _MATRIX:
        bound = native.bind(f"{name}:{types[0]}", types, result)
        return lambda *arguments: bound(None, *arguments)
    if name in ("get_primitive_type_of_kind", "is_front_face_hit_of_kind", "is_back_face_hit_of_kind"):
        bound = native.bind(name, types, result)
        return lambda *arguments: bound(None, *arguments)
    scalar = next(found for found in map(t.scalar_of, types) if found is not None)
    one = _of_scalars(name, scalar, len(types))
    return one if not any(isinstance(type_, t.Vector) for type_ in types) else _by_component(one, types, result)


def _by_component(one: Function, types: tuple[t.Type, ...], result: t.Type) -> Function:
    size = next(type_.size for type_ in types if isinstance(type_, t.Vector))
    element = t.scalar_of(result)
    assert element is not None
    vector = t.Vector(element, size)

    def evaluate(*arguments: Any) -> Any:
        spread = [argument if isinstance(type_, t.Vector) else (argument,) * size for argument, type_ in zip(arguments, types, strict=True)]
        return values.make_vector(vector, tuple(one(*parts) for parts in zip(*spread, strict=True)))

    return evaluate


def _of_scalars(name: str, scalar: t.Scalar, arity: int) -> Function:
    if scalar.kind is t.ScalarKind.FLOAT:
        return native.pure(_NATIVE_NAMES.get(name, name), arity, scalar)
    wrapped, bits = numbers.wrap(scalar), scalar.bits
    rules: dict[str, Function] = {
        "abs": lambda x: wrapped(abs(x)),
        "sign": lambda x: (x > 0) - (x < 0),
        "min": min,
        "max": max,
        "clamp": lambda x, low, high: max(low, min(x, high)),
        "popcount": lambda x: (x & ((1 << bits) - 1)).bit_count(),
        "clz": lambda x: bits - (x & ((1 << bits) - 1)).bit_length(),
        "ctz": lambda x: ((x & -x).bit_length() - 1) if x else bits,
    }
    return rules[name]


def _bits(source: str, target: str) -> Function:
    return lambda value: struct.unpack(target, struct.pack(source, value))[0]


_EXACT: dict[str, Function] = {
    "undefined_value": lambda: 0,
    "float_as_uint": _bits("<f", "<I"),
    "float_as_int": _bits("<f", "<i"),
    "uint_as_float": _bits("<I", "<f"),
    "int_as_float": _bits("<i", "<f"),
    "reverse_bits": lambda x: int(f"{x:032b}"[::-1], 2),
    "mul_hi": lambda a, b: (a * b) >> 32,
}
