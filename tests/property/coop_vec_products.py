"""Products of matrices with cooperative vectors: shaders of several of them, their memory, and what numpy makes of the same numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from hypothesis import strategies as st

import optixc as ox
from optixc import CoopVecElemType as Element
from optixc import CoopVecMatrixLayout as Layout

ROWS = 21
"""Launch indices: one packet of 16 lanes and a part of another."""
COPIES = 2
"""Matrices and biases of each product; where the offset varies, launch indices take turns."""
OPTIMAL = (Layout.INFERENCING_OPTIMAL, Layout.TRAINING_OPTIMAL)
FLOAT8 = (Element.FLOAT8_E4M3, Element.FLOAT8_E5M2)
BYTES = (Element.INT8, Element.UINT8)
DTYPES = {Element.FLOAT16: np.float16, Element.FLOAT32: np.float32, Element.INT8: np.int8, Element.UINT8: np.uint8,
          Element.INT32: np.int32, Element.UINT32: np.uint32}
RANGES = {Element.INT8: (-128, 127), Element.UINT8: (0, 255)}

HEAD = '''import optixc as ox
from optixc import CoopVecElemType, CoopVecMatrixLayout
from coop_vec_products import Params

params = ox.launch_params(Params)


@ox.program
def __raygen__products():
    row = ox.get_launch_index().x
    turn = row % 2
'''


@ox.struct
class Params:
    vectors: ox.Array[ox.uint8]
    matrices: ox.Array[ox.uint8]
    biases: ox.Array[ox.uint8]
    out: ox.Array2[ox.float64]


@dataclass(frozen=True)
class Product:
    """One product; `gap` bytes are added to the stride of layouts that have one."""

    n: int
    k: int
    vector: Element
    inner: Element
    matrix: Element
    layout: Layout
    transpose: bool
    has_bias: bool
    gap: int
    varies: bool

    @property
    def result(self) -> Element:
        if self.matrix in BYTES:
            return Element.INT32 if Element.INT8 in (self.inner, self.matrix) else Element.UINT32
        return Element.FLOAT32 if self.matrix is Element.FLOAT32 else Element.FLOAT16

    @property
    def stride(self) -> int:
        if self.layout in OPTIMAL or self.gap == 0:
            return 0
        line = (self.k if self.layout is Layout.ROW_MAJOR else self.n) * np.dtype(DTYPES[self.matrix]).itemsize
        return -(-line // 16) * 16 + self.gap


TYPES = (
    *((Element.FLOAT16, one, one) for one in (Element.FLOAT16, *FLOAT8)),
    (Element.FLOAT32, Element.FLOAT32, Element.FLOAT32),
    *((vector, inner, matrix) for vector in DTYPES for inner in BYTES for matrix in BYTES),
)


def layouts_of(matrix: Element) -> list[tuple[Layout, bool]]:
    """The layouts that a matrix of this type may have, transposed or not."""
    found = [(layout, False) for layout in (OPTIMAL if matrix in FLOAT8 else tuple(Layout))]
    return found + ([(layout, True) for layout in OPTIMAL] if matrix in (Element.FLOAT16, Element.FLOAT32) else [])


@st.composite
def products(draw: st.DrawFn) -> Product:
    vector, inner, matrix = draw(st.sampled_from(TYPES))
    layout, transpose = draw(st.sampled_from(layouts_of(matrix)))
    sizes = st.integers(1, 40)
    return Product(draw(sizes), draw(sizes), vector, inner, matrix, layout, transpose, draw(st.booleans()),
                   draw(st.sampled_from((0, 0, 16, 48))), draw(st.booleans()))


def every_type() -> list[Product]:
    """Each row of types with each layout once, in sizes that fill no tile."""
    found = []
    for number, (vector, inner, matrix) in enumerate(TYPES):
        for layout, transpose in layouts_of(matrix):
            if matrix in BYTES and vector not in (Element.INT8, Element.FLOAT16) and layout is not Layout.INFERENCING_OPTIMAL:
                continue
            found.append(Product(17 + number % 5, 19 - number % 4, vector, inner, matrix, layout, transpose, number % 2 == 0,
                                 16 * (number % 3), number % 4 == 1))
    return found


def _float8(element: Element) -> np.ndarray[Any, Any]:
    """The numbers of all positive codes, decoded bit by bit."""
    mantissa, bias = (3, 7) if element is Element.FLOAT8_E4M3 else (2, 15)
    last = 0x7E if element is Element.FLOAT8_E4M3 else 0x7B
    numbers = []
    for code in range(last + 1):
        exponent, rest = code >> mantissa, code & ((1 << mantissa) - 1)
        one = 0 if exponent == 0 else 1 << mantissa
        numbers.append((one + rest) * 2.0 ** (max(exponent, 1) - bias - mantissa))
    return np.array(numbers)


def to_float8(values: np.ndarray[Any, Any], element: Element) -> np.ndarray[Any, Any]:
    """The nearest number by comparison with all of them; of two equally near the one with the even code."""
    numbers = _float8(element)
    magnitude = np.minimum(np.abs(values.astype(np.float64)), numbers[-1])[..., None]
    distance = np.abs(magnitude - numbers)
    is_nearest = distance == distance.min(axis=-1, keepdims=True)
    near = numbers[np.argmin(np.where(is_nearest, np.arange(len(numbers)) % 2, 2), axis=-1)]
    return np.where(np.isnan(values), np.nan, np.copysign(near, values))


class Memory:
    """The arrays of a list of products, filled with numbers of a seed."""

    def __init__(self, context: Any, wanted: list[Product], seed: int) -> None:
        self.products = wanted
        self._random = np.random.default_rng(seed)
        self._context = context
        self._parts: dict[str, list[np.ndarray[Any, Any]]] = {"vectors": [], "matrices": [], "biases": []}
        self._sizes = dict.fromkeys(self._parts, 0)
        self.offsets: list[dict[str, int]] = []
        self.numbers: list[tuple[np.ndarray[Any, Any], ...]] = []
        for product in wanted:
            self._add(product)
        self.arrays = {name: np.concatenate(parts) for name, parts in self._parts.items()}
        self.columns = sum(product.n for product in wanted)

    def _add(self, product: Product) -> None:
        vectors = self._values(product.vector, (ROWS, product.k), product.inner in BYTES)
        matrices = self._values(product.matrix, (COPIES, product.n, product.k))
        biases = self._values(product.result, (COPIES, product.n))
        self.numbers.append((vectors, matrices, biases))
        shape = (product.k, product.n) if product.transpose else (product.n, product.k)
        plain = Element.FLOAT32 if product.matrix in FLOAT8 else product.matrix
        given = ox.CoopVecMatrixDescription(*shape, element_type=plain)
        wanted = ox.CoopVecMatrixDescription(*shape, 0, product.matrix, product.layout, product.stride)
        stored = []
        for matrix in matrices:
            rows = np.ascontiguousarray(matrix.T if product.transpose else matrix)
            stored.append(self._context.coop_vec_matrix_convert([given], rows, [wanted]))
        offsets = {"matrices": self._put("matrices", stored), "vectors": self._put("vectors", list(vectors), 16),
                   "biases": self._put("biases", list(biases), 16)}
        self.offsets.append(offsets)

    def _values(self, element: Element, shape: tuple[int, ...], wild: bool = False) -> np.ndarray[Any, Any]:
        if element in FLOAT8:
            return self._random.normal(0.0, 1.0, shape).astype(np.float32)
        dtype = np.dtype(DTYPES[element])
        if dtype.kind != "f":
            limits = np.iinfo(dtype)
            return self._random.integers(limits.min, limits.max, shape, dtype, endpoint=True)
        values = self._random.normal(0.0, 90.0 if wild else 1.0, shape).astype(dtype)
        if wild:
            special = np.array([np.nan, np.inf, -np.inf, 0.5, 1.5, -0.5, 127.5, -128.5, 254.5, -0.0], dtype)
            chosen = self._random.random(shape) < 0.3
            values[chosen] = self._random.choice(special, int(chosen.sum()))
        return values

    def _put(self, name: str, lines: list[np.ndarray[Any, Any]], alignment: int = 64) -> int:
        """Appends lines, each at an aligned offset, all of one size; the offset of the first."""
        start = self._sizes[name]
        for line in lines:
            data = np.ascontiguousarray(line).reshape(-1).view(np.uint8)
            padded = np.zeros(-(-data.size // alignment) * alignment, np.uint8)
            padded[: data.size] = data
            self._parts[name].append(padded)
            self._sizes[name] += padded.size
        rest = -self._sizes[name] % 64
        self._parts[name].append(np.zeros(rest, np.uint8))
        self._sizes[name] += rest
        return start

    def text(self) -> str:
        """The shader: each product writes its results behind those of the one before."""
        lines = [HEAD]
        column = 0
        for number, (product, offsets) in enumerate(zip(self.products, self.offsets, strict=True)):
            vector, result = (f"ox.CoopVec[ox.{one.name.lower()}, {size}]" for one, size in
                              ((product.vector, product.k), (product.result, product.n)))
            step = -(-product.k * np.dtype(DTYPES[product.vector]).itemsize // 16) * 16
            shape = (product.k, product.n) if product.transpose else (product.n, product.k)
            size = self._context.coop_vec_matrix_compute_size(*shape, product.matrix, product.layout, product.stride)
            turn = (f" + turn * {size}", f" + turn * {-(-product.n * np.dtype(DTYPES[product.result]).itemsize // 16) * 16}")
            first, second = turn if product.varies else ("", "")
            bias = f", params.biases, {offsets['biases']}{second}" if product.has_bias else ""
            settings = (f"row_column_stride_in_bytes={product.stride}, input_interpretation=CoopVecElemType.{product.inner.name}, "
                        f"matrix_layout=CoopVecMatrixLayout.{product.layout.name}, transpose={product.transpose}, "
                        f"matrix_element_type=CoopVecElemType.{product.matrix.name}")
            lines += [f"    v{number} = ox.coop_vec_load({vector}, params.vectors, {offsets['vectors']} + row * {step})",
                      f"    r{number} = ox.coop_vec_mat_mul({result}, v{number}, params.matrices, {offsets['matrices']}{first}{bias},",
                      f"                             {settings})",
                      f"    for j in range({product.n}):",
                      f"        params.out[row, {column} + j] = ox.float64(r{number}[j])"]
            column += product.n
        return "\n".join(lines) + "\n"

    def check(self, out: np.ndarray[Any, Any]) -> None:
        """Results against numpy: integers are equal, floats within the roundings of their sum."""
        column = 0
        for product, (vectors, matrices, biases) in zip(self.products, self.numbers, strict=True):
            found = out[:, column : column + product.n]
            column += product.n
            turns = np.arange(ROWS) % COPIES if product.varies else np.zeros(ROWS, int)
            bias = biases[turns] if product.has_bias else np.zeros((ROWS, product.n), biases.dtype)
            inner = interpreted(vectors, product.inner)
            if product.matrix in BYTES:
                sums = np.einsum("rnk,rk->rn", matrices[turns].astype(np.int64), inner.astype(np.int64)) + bias.astype(np.int64)
                wanted = sums.astype(np.uint32).astype(DTYPES[product.result]).astype(np.float64)
                assert (found == wanted).all(), product
                continue
            weights = matrices[turns].astype(np.float64)
            if product.matrix in FLOAT8:
                weights = to_float8(matrices[turns], product.matrix)
            sums = np.einsum("rnk,rk->rn", weights, inner) + bias
            sizes = np.einsum("rnk,rk->rn", np.abs(weights), np.abs(inner)) + np.abs(bias)
            # One rounding of a binary32 sum for each product, and one more to the result.
            bound = (product.k + 1) * 2.0**-24 * sizes
            if product.result is Element.FLOAT16:
                bound = bound * 1.001 + np.abs(sums) * 2.0**-11 + 2.0**-25
            assert (np.abs(found - sums) <= bound).all(), product


def interpreted(vectors: np.ndarray[Any, Any], inner: Element) -> np.ndarray[Any, Any]:
    """The vectors as the matrix takes them."""
    if inner in FLOAT8:
        return to_float8(vectors, inner)
    if inner not in BYTES:
        return vectors.astype(np.float64)
    low, high = RANGES[inner]
    values = vectors.astype(np.float64)
    return np.where(np.isnan(values), 0.0, np.clip(np.rint(values), low, high))
