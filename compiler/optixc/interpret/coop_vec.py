"""The interpreter's rules for cooperative vectors: element by element on Python numbers, products of matrices with numpy.

Written apart from the C++ of kernels, so that each tests the other; both add products in the same order and round each time once.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optixc import coop_vec_layout as layouts
from optixc import float8
from optixc.enums_extensions import CoopVecElemType as Element
from optixc.enums_extensions import CoopVecMatrixLayout as Layout
from optixc.frontend.checked import CoopVecUse
from optixc.frontend.weak import widened
from optixc.interpret import native, numbers, values
from optixc.interpret.values import ArrayValue, CoopVecValue
from optixc.ir import layout
from optixc.ir import types as t
from optixc.ir.nodes import BinaryOp

Function = Callable[..., Any]

_OPERATORS = {
    "coop_vec_mul": BinaryOp.MULTIPLY,
    "coop_vec_add": BinaryOp.ADD,
    "coop_vec_sub": BinaryOp.SUBTRACT,
}
_MATHEMATICS = {"coop_vec_exp2": "exp2", "coop_vec_log2": "log2", "coop_vec_tanh": "tanh"}
_BYTE_RANGES = {Element.INT8: (-128, 127), Element.UINT8: (0, 255)}


def function(use: CoopVecUse, result: t.Type) -> Function:
    """What evaluates a call of a row on its arguments."""
    match use.row.name:
        case "coop_vec_load":
            assert isinstance(result, t.CoopVec)
            type_ = result
            return lambda array, offset: values.load(type_, _place(array, offset, layout.size_of(type_)))
        case "coop_vec_mat_mul":
            assert isinstance(result, t.CoopVec)
            return _mat_mul(use, result)
        case "coop_vec_reduce_sum_accumulate":
            return _reduce_sum
        case "coop_vec_outer_product_accumulate":
            return _outer_product
    assert isinstance(result, t.CoopVec)
    return _elements(use.row.name, result)


def _elements(name: str, type_: t.CoopVec) -> Function:
    """A function of one element of each argument; a number beside a vector is rounded as an element."""
    narrow = values.narrow(type_.element)

    def evaluate(first: CoopVecValue, *rest: Any) -> CoopVecValue:
        one = _of_one(name, first.type.element, type_.element)
        columns = (other.items if isinstance(other, CoopVecValue) else (narrow(other),) * type_.size for other in rest)
        return CoopVecValue(type_, tuple(narrow(one(*parts)) for parts in zip(first.items, *columns, strict=True)))

    return evaluate


def _of_one(name: str, source: t.Scalar, target: t.Scalar) -> Function:
    wide = widened(source)
    assert isinstance(wide, t.Scalar)
    if name in _OPERATORS:
        return numbers.binary(_OPERATORS[name], wide, native.binary_float)
    if name in _MATHEMATICS:
        return native.pure(_MATHEMATICS[name], 1, wide)
    match name:
        case "coop_vec_min":
            return lambda a, b: a if a < b else b
        case "coop_vec_max":
            return lambda a, b: a if a > b else b
        case "coop_vec_step":
            return lambda a, b: 0 if b < a else 1
        case "coop_vec_cvt":
            return numbers.convert(wide, t.FLOAT32)
        case "coop_vec_ffma" if wide.kind is t.ScalarKind.FLOAT:
            return native.pure("fma", 3, wide)
        case "coop_vec_ffma":
            wrapped = numbers.wrap(wide)
            return lambda a, b, c: wrapped(a * b + c)
    raise AssertionError(f"no rule for {name} to {target}")


# ---- memory -------------------------------------------------------------------------------------------------------------------


def _place(array: ArrayValue, offset: int, size: int) -> int:
    """The address of bytes of an array. Raises IndexError where they are not all inside of it."""
    held = int(np.prod(array.shape, dtype=np.int64)) * layout.size_of(array.type.element)
    if offset + size > held:
        raise IndexError(f"{size} bytes from offset {offset} end behind the array, which has {held} bytes")
    return array.address + offset


def _bytes_at(address: int, size: int) -> NDArray[np.uint8]:
    """Memory as numpy sees it, to read and write."""
    return np.ctypeslib.as_array((ctypes.c_uint8 * size).from_address(address))


def _matrix(array: ArrayValue, offset: int, shape: tuple[int, int], element: Element, kind: Layout, stride: int) -> NDArray[Any]:
    """The elements of a matrix in memory, as its layout keeps them."""
    size = layouts.matrix_extent(*shape, element, kind, stride)
    return layouts.read_elements(_bytes_at(_place(array, offset, size), size), *shape, element, kind, stride)


# ---- products -----------------------------------------------------------------------------------------------------------------


def _mat_mul(use: CoopVecUse, result: t.CoopVec) -> Function:
    inner, element, kind = Element(use.settings[0]), Element(use.settings[1]), Layout(use.settings[2])
    is_transposed = bool(use.settings[3])

    def evaluate(vector: CoopVecValue, matrix: ArrayValue, offset: int, stride: int, *bias: Any) -> CoopVecValue:
        n, k = result.size, len(vector)
        if is_transposed:
            weights = _matrix(matrix, offset, (k, n), element, kind, stride).T
        else:
            weights = _matrix(matrix, offset, (n, k), element, kind, stride)
        start = values.load(result, _place(bias[0], bias[1], layout.size_of(result))).items if bias else (0,) * n
        if element in layouts.BYTES:
            return CoopVecValue(result, _integer_product(weights, interpreted(vector, inner), start, result.element))
        sums = np.array(start, np.float32)
        for column, factor in enumerate(interpreted(vector, inner)):
            sums = fused(weights[:, column].astype(np.float32), np.float32(factor), sums)
        with np.errstate(over="ignore"):
            return CoopVecValue(result, tuple(float(one) for one in sums.astype(f"f{result.element.bits // 8}")))

    return evaluate


def interpreted(vector: CoopVecValue, inner: Element) -> NDArray[Any]:
    """The items as the matrix takes them: limited to 8 bits, fractions to the nearest, ties to even, NaN to 0."""
    if inner in layouts.FLOAT8:
        return float8.rounded(np.array(vector.items, np.float32), inner)
    if inner not in layouts.BYTES:
        return np.array(vector.items, np.float32)
    low, high = _BYTE_RANGES[inner]
    items = np.nan_to_num(np.array(vector.items, np.float64), nan=0.0, posinf=high, neginf=low)
    return np.clip(np.rint(items), low, high).astype(np.int64)


def _integer_product(weights: NDArray[Any], factors: NDArray[Any], start: tuple[int, ...], element: t.Scalar) -> tuple[int, ...]:
    wrapped = numbers.wrap(element)
    sums = weights.astype(np.int64) @ factors
    return tuple(wrapped(int(product) + first) for product, first in zip(sums, start, strict=True))


def fused(a: NDArray[np.float32], b: np.float32, c: NDArray[np.float32]) -> NDArray[np.float32]:
    """a * b + c, rounded once: the sum in binary64 is rounded to odd, so that the second rounding cannot go wrong (Boldo and
    Melquiond, "Emulation of a FMA and correctly rounded sums", 2008)."""
    with np.errstate(all="ignore"):
        product, other = a.astype(np.float64) * np.float64(b), c.astype(np.float64)
        total = product + other
        back = total - product
        error = (product - (total - back)) + (other - back)
        bits = total.view(np.int64)
        away = np.where((error > 0) == (total > 0), 1, -1)
        is_even = (bits & 1 == 0) & (error != 0) & np.isfinite(total)
        odd = np.where(is_even, bits + away, bits).view(np.float64)
        return odd.astype(np.float32)


# ---- accumulators -------------------------------------------------------------------------------------------------------------


def _reduce_sum(vector: CoopVecValue, array: ArrayValue, offset: int) -> None:
    size = layout.size_of(vector.type)
    dtype = np.dtype(f"f{vector.type.element.bits // 8}")
    memory = _bytes_at(_place(array, offset, size), size).view(dtype)
    memory[:] = (memory.astype(np.float32) + np.array(vector.items, np.float32)).astype(dtype)


def _outer_product(a: CoopVecValue, b: CoopVecValue, matrix: ArrayValue, offset: int) -> None:
    shape = (len(a), len(b))
    size = layouts.matrix_extent(*shape, Element.FLOAT32, Layout.TRAINING_OPTIMAL)
    memory = _bytes_at(_place(matrix, offset, size), size).view(np.float32)
    places = layouts.element_offsets(*shape, Element.FLOAT32, Layout.TRAINING_OPTIMAL) // 4
    memory[places] += np.outer(np.array(a.items, np.float32), np.array(b.items, np.float32))
