"""Atomic operations on elements of the host's arrays; one launch index runs at a time, so that plain reads and writes are atomic."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from optixc.interpret import native, numbers
from optixc.ir import types as t
from optixc.ir.nodes import BinaryOp

Change = Callable[..., Any]


def atomic(name: str, element: t.Scalar, rank: int) -> Callable[..., Any]:
    """`f(array, *indices, *values)` that changes the element and gives its old value."""
    change = _change(name, element)

    def perform(array: Any, *arguments: Any) -> Any:
        indices, given = arguments[:rank], arguments[rank:]
        old = array.load(*indices)
        array.store(change(old, *given), *indices)
        return old

    return perform


def _change(name: str, element: t.Scalar) -> Change:
    def operator(op: BinaryOp) -> Change:
        return numbers.binary(op, element, native.binary_float)

    match name:
        case "atomic_add":
            return operator(BinaryOp.ADD)
        case "atomic_sub":
            return operator(BinaryOp.SUBTRACT)
        case "atomic_and":
            return operator(BinaryOp.BIT_AND)
        case "atomic_or":
            return operator(BinaryOp.BIT_OR)
        case "atomic_xor":
            return operator(BinaryOp.BIT_XOR)
        case "atomic_exch":
            return lambda _, value: value
        case "atomic_min":
            return lambda old, value: value if value < old else old
        case "atomic_max":
            return lambda old, value: value if old < value else old
        case "atomic_inc":
            return lambda old, value: 0 if old >= value else old + 1
        case "atomic_dec":
            return lambda old, value: value if old == 0 or old > value else old - 1
        case "atomic_cas":
            return lambda old, expected, value: value if old == expected else old
    raise AssertionError(f"no rule for {name}")
