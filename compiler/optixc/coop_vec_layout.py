"""Where the elements of a cooperative vector's matrix stand in memory: sizes, and the offset of every element in each layout.

Rows and columns are as numpy has them, with a stride. The two optimal layouts are one: rows in tiles of 16, and in a tile the columns
one after the other, so that 16 results are computed from neighbours. Floating-point numbers of every size are kept there as float32,
which multiplies without conversion and adds without rounding to less; 8-bit integers are kept as int16, two columns side by side. The
C++ of `oxrt/coop_vec_matrix.h` reads the same places.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from optixc.enums_extensions import CoopVecElemType as Element
from optixc.enums_extensions import CoopVecMatrixLayout as Layout

TILE_ROWS = 16
SIZE_MULTIPLE = 64
STRIDE_MULTIPLE = 16

OPTIMAL = frozenset({Layout.INFERENCING_OPTIMAL, Layout.TRAINING_OPTIMAL})
FLOAT8 = frozenset({Element.FLOAT8_E4M3, Element.FLOAT8_E5M2})
FLOATS = frozenset({Element.FLOAT16, Element.FLOAT32}) | FLOAT8
BYTES = frozenset({Element.INT8, Element.UINT8})

_SIZES = {
    Element.FLOAT16: 2,
    Element.FLOAT32: 4,
    Element.UINT8: 1,
    Element.INT8: 1,
    Element.UINT32: 4,
    Element.INT32: 4,
    Element.FLOAT8_E4M3: 1,
    Element.FLOAT8_E5M2: 1,
}
_DTYPES: dict[Element, np.dtype[Any]] = {
    Element.FLOAT16: np.dtype(np.float16),
    Element.FLOAT32: np.dtype(np.float32),
    Element.UINT8: np.dtype(np.uint8),
    Element.INT8: np.dtype(np.int8),
    Element.UINT32: np.dtype(np.uint32),
    Element.INT32: np.dtype(np.int32),
}


def element_size(element: Element) -> int:
    """Bytes of one number as the element type names it."""
    return _SIZES[element]


def stored_dtype(element: Element, layout: Layout) -> np.dtype[Any]:
    """What one element is kept as in memory."""
    if layout not in OPTIMAL:
        return _DTYPES[element]
    if element in FLOATS:
        return np.dtype(np.float32)
    return np.dtype(np.int16) if element in BYTES else _DTYPES[element]


def stride_of(n: int, k: int, element: Element, layout: Layout, stride: int) -> int:
    """Bytes from one row (or column) to the next; 0 stands for rows without gaps."""
    return stride or (k if layout is Layout.ROW_MAJOR else n) * _SIZES[element]


def matrix_size(n: int, k: int, element: Element, layout: Layout, stride: int = 0) -> int:
    """Bytes of a matrix of n rows and k columns with the gaps behind all of them, rounded up to a multiple of 64."""
    size = matrix_extent(n, k, element, layout, stride)
    if layout not in OPTIMAL:
        size = (n if layout is Layout.ROW_MAJOR else k) * stride_of(n, k, element, layout, stride)
    return -(-size // SIZE_MULTIPLE) * SIZE_MULTIPLE


def matrix_extent(n: int, k: int, element: Element, layout: Layout, stride: int = 0) -> int:
    """Bytes up to the end of the last element; tiles of optimal layouts are whole."""
    if layout in OPTIMAL:
        columns = k + k % 2 if element in BYTES else k
        return -(-n // TILE_ROWS) * TILE_ROWS * columns * stored_dtype(element, layout).itemsize
    lines, length = (n, k) if layout is Layout.ROW_MAJOR else (k, n)
    return (lines - 1) * stride_of(n, k, element, layout, stride) + length * _SIZES[element]


def element_offsets(n: int, k: int, element: Element, layout: Layout, stride: int = 0) -> NDArray[np.int64]:
    """The offset in bytes of every element, as an array of shape (n, k)."""
    rows, columns = np.arange(n, dtype=np.int64)[:, None], np.arange(k, dtype=np.int64)[None, :]
    step = stride_of(n, k, element, layout, stride)
    if layout is Layout.ROW_MAJOR:
        return rows * step + columns * _SIZES[element]
    if layout is Layout.COLUMN_MAJOR:
        return columns * step + rows * _SIZES[element]
    tile, row = rows // TILE_ROWS, rows % TILE_ROWS
    if element in BYTES:
        pairs = (k + 1) // 2
        return (((tile * pairs + columns // 2) * TILE_ROWS + row) * 2 + columns % 2) * 2
    return ((tile * k + columns) * TILE_ROWS + row) * stored_dtype(element, layout).itemsize


def element_places(n: int, k: int, element: Element, layout: Layout, stride: int = 0) -> NDArray[np.int64]:
    """The offsets of every byte of every element, as an array of shape (n, k, bytes of an element)."""
    width = stored_dtype(element, layout).itemsize
    return element_offsets(n, k, element, layout, stride)[..., None] + np.arange(width)


def read_elements(memory: NDArray[np.uint8], n: int, k: int, element: Element, layout: Layout, stride: int = 0) -> NDArray[Any]:
    """The elements of a matrix that begins at the first byte of `memory`, of shape (n, k), as the layout keeps them."""
    picked = np.ascontiguousarray(memory[element_places(n, k, element, layout, stride)])
    return picked.view(stored_dtype(element, layout))[..., 0]


def stride_problem(n: int, k: int, element: Element, layout: Layout, stride: int) -> str | None:
    """What is wrong with a stride, None if nothing is; optimal layouts have none."""
    if layout in OPTIMAL or stride == 0:
        return None
    least = stride_of(n, k, element, layout, 0)
    if stride < least:
        return f"a stride of {stride} bytes is less than the {least} bytes of one {'row' if layout is Layout.ROW_MAJOR else 'column'}"
    return f"a stride of {stride} bytes is no multiple of {STRIDE_MULTIPLE}" if stride % STRIDE_MULTIPLE else None
