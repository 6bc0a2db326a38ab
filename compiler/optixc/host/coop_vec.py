"""Matrices of cooperative vectors on the host: their sizes, and conversion between layouts and element types.

A network is a list of matrices in one buffer, described one by one. Buffers are numpy arrays; what they hold is told by the
descriptions alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optixc import coop_vec_layout as layouts
from optixc import float8
from optixc.enums_extensions import CoopVecElemType as Element
from optixc.enums_extensions import CoopVecMatrixLayout as Layout
from optixc.errors import InvalidValueError

_ALIGNMENT = 64
_HIGHER = frozenset({Element.FLOAT16, Element.FLOAT32})


@dataclass(frozen=True)
class CoopVecMatrixDescription:
    """OptiX's `OptixCoopVecMatrixDescription`: n rows and k columns at an offset. A size of 0 means the size that the rest gives."""

    n: int
    k: int
    offset_in_bytes: int = 0
    element_type: Element = Element.FLOAT16
    layout: Layout = Layout.ROW_MAJOR
    row_column_stride_in_bytes: int = 0
    size_in_bytes: int = 0


@dataclass(frozen=True)
class NetworkDescription:
    """OptiX's `OptixNetworkDescription`: the matrices of one network."""

    layers: Sequence[CoopVecMatrixDescription]


def compute_size(n: int, k: int, element_type: Element, layout: Layout, stride: int) -> int:
    """Bytes of a matrix, a multiple of 64. Raises InvalidValueError for what is no matrix."""
    try:
        element, kind = Element(element_type), Layout(layout)
    except ValueError as error:
        raise InvalidValueError(f"{error}; take one of ox.CoopVecElemType and one of ox.CoopVecMatrixLayout") from None
    if n < 1 or k < 1 or element is Element.UNKNOWN:
        raise InvalidValueError(f"a matrix has at least one row, one column and a known element type, this is {n} x {k} {element.name}")
    if element in layouts.FLOAT8 and kind not in layouts.OPTIMAL:
        raise InvalidValueError(f"a matrix of {element.name} has an optimal layout, not {kind.name}")
    problem = layouts.stride_problem(n, k, element, kind, stride)
    if problem is not None:
        raise InvalidValueError(f"{problem}; 0 stands for no gaps")
    return layouts.matrix_size(n, k, element, kind, stride)


def convert(
    source: NetworkDescription | Iterable[CoopVecMatrixDescription],
    given: NDArray[Any],
    target: NetworkDescription | Iterable[CoopVecMatrixDescription],
    output: NDArray[Any] | None,
    num_networks: int,
    input_stride: int,
    output_stride: int,
) -> NDArray[Any]:
    """Writes every matrix of every network as the target describes it; without `output` into a new array of bytes, aligned to 64."""
    before, after = _layers(source, "the input"), _layers(target, "the output")
    if [(one.n, one.k) for one in before] != [(one.n, one.k) for one in after]:
        raise InvalidValueError("input and output networks differ in the number or shape of their matrices")
    if num_networks < 1:
        raise InvalidValueError(f"the number of networks must be 1 or more, not {num_networks}")
    strides = (input_stride, output_stride) if num_networks > 1 else (0, 0)
    for one, other in zip(before, after, strict=True):
        _check_types(Element(one.element_type), Element(other.element_type))
    if output is None:
        output = aligned_bytes(strides[1] * (num_networks - 1) + max(one.offset_in_bytes + _size(one) for one in after))
    old = _memory(given, before, strides[0], num_networks, "input")
    new = _memory(output, after, strides[1], num_networks, "output")
    if not output.flags.writeable:
        raise InvalidValueError("the output array is read-only; give one that can be written")
    for network in range(num_networks):
        for one, other in zip(before, after, strict=True):
            elements = layouts.read_elements(old[one.offset_in_bytes + network * strides[0] :], *_told(one))
            _write(new[other.offset_in_bytes + network * strides[1] :], other, elements)
    return output


def aligned_bytes(size: int) -> NDArray[np.uint8]:
    """Zeros at an address that is a multiple of 64."""
    memory = np.zeros(size + _ALIGNMENT, np.uint8)
    start = -memory.ctypes.data % _ALIGNMENT
    return memory[start : start + size]


def _layers(network: NetworkDescription | Iterable[CoopVecMatrixDescription], what: str) -> list[CoopVecMatrixDescription]:
    layers = list(network.layers if isinstance(network, NetworkDescription) else network)
    if not layers:
        raise InvalidValueError(f"{what} network has no matrix")
    for number, one in enumerate(layers):
        size = _size(one)
        if one.offset_in_bytes < 0 or one.offset_in_bytes % _ALIGNMENT:
            raise InvalidValueError(f"matrix {number} of {what} is at offset {one.offset_in_bytes}, which is no multiple of {_ALIGNMENT}")
        if 0 < one.size_in_bytes < size:
            raise InvalidValueError(f"matrix {number} of {what} says {one.size_in_bytes} bytes, it takes {size}; write 0 or that")
    return layers


def _size(one: CoopVecMatrixDescription) -> int:
    return compute_size(one.n, one.k, one.element_type, one.layout, one.row_column_stride_in_bytes)


def _extent(one: CoopVecMatrixDescription) -> int:
    return layouts.matrix_extent(*_told(one))


def _check_types(old: Element, new: Element) -> None:
    if old is new:
        return
    if old not in layouts.FLOATS or new not in layouts.FLOATS or not {old, new} & _HIGHER:
        raise InvalidValueError(
            f"{old.name} is not converted to {new.name}: only FLOAT32 and FLOAT16 and numbers of fewer bits are converted to each other"
        )


def _memory(array: NDArray[Any], layers: list[CoopVecMatrixDescription], stride: int, count: int, what: str) -> NDArray[np.uint8]:
    if not isinstance(array, np.ndarray) or not array.flags.c_contiguous:
        raise InvalidValueError(f"the {what} must be a C-contiguous numpy array")
    memory: NDArray[np.uint8] = array.reshape(-1).view(np.uint8)
    end = max(one.offset_in_bytes + _extent(one) for one in layers)
    if count > 1 and (stride < end or stride % _ALIGNMENT):
        raise InvalidValueError(f"{what}_stride is {stride}; networks of {end} bytes need a multiple of {_ALIGNMENT} that is not below it")
    if stride * (count - 1) + end > memory.size:
        raise InvalidValueError(f"the {what} has {memory.size} bytes, the matrices end at {stride * (count - 1) + end}")
    return memory


def _write(matrix: NDArray[np.uint8], one: CoopVecMatrixDescription, elements: NDArray[Any]) -> None:
    """Keeps elements as the description says; the matrix begins at the first byte."""
    n, k, element, kind, stride = _told(one)
    dtype = layouts.stored_dtype(element, kind)
    with np.errstate(over="ignore"):
        if element in layouts.FLOAT8:
            elements = float8.rounded(elements.astype(np.float32), element)
        elif element is Element.FLOAT16:
            elements = elements.astype(np.float16)
        stored = np.ascontiguousarray(elements.astype(dtype))
    if kind in layouts.OPTIMAL:
        # Rows that fill a tile are multiplied too.
        matrix[: _extent(one)] = 0
    matrix[layouts.element_places(n, k, element, kind, stride)] = stored[..., None].view(np.uint8)


def _told(one: CoopVecMatrixDescription) -> tuple[int, int, Element, Layout, int]:
    return one.n, one.k, Element(one.element_type), Layout(one.layout), one.row_column_stride_in_bytes
