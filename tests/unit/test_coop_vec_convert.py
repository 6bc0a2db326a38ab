"""Matrices of cooperative vectors on the host: layouts, element types, several networks, and what is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import optixc as ox
from optixc import CoopVecElemType as Element
from optixc import CoopVecMatrixDescription as Matrix
from optixc import CoopVecMatrixLayout as Layout

OPTIMAL = (Layout.INFERENCING_OPTIMAL, Layout.TRAINING_OPTIMAL)


@pytest.fixture(scope="module")
def context() -> Any:
    return ox.DeviceContext()


def test_rows_and_columns_are_numpys(context: Any) -> None:
    given = np.arange(15, dtype=np.float32).reshape(3, 5)
    columns = context.coop_vec_matrix_convert(
        [Matrix(3, 5, 0, Element.FLOAT32)], given, [Matrix(3, 5, 64, Element.FLOAT32, Layout.COLUMN_MAJOR, 16)]
    )
    assert columns.nbytes == 64 + 128 and columns.ctypes.data % 64 == 0
    assert np.array_equal(columns[64:144].view(np.float32).reshape(5, 4)[:, :3], given.T)


@pytest.mark.parametrize("layout", OPTIMAL)
@pytest.mark.parametrize(("element", "dtype"), [(Element.FLOAT16, np.float16), (Element.FLOAT32, np.float32), (Element.INT8, np.int8),
                                                (Element.UINT8, np.uint8)])
@pytest.mark.parametrize(("n", "k"), [(1, 1), (16, 16), (17, 5), (3, 40)])
def test_there_and_back(context: Any, layout: Layout, element: Element, dtype: Any, n: int, k: int) -> None:
    given = np.random.default_rng(1).integers(0, 127, (n, k)).astype(dtype)
    rows, optimal = [Matrix(n, k, 0, element)], [Matrix(n, k, 0, element, layout)]
    there = context.coop_vec_matrix_convert(rows, given, optimal)
    assert there.nbytes == context.coop_vec_matrix_compute_size(n, k, element, layout) and there.nbytes % 64 == 0
    back = context.coop_vec_matrix_convert(optimal, there, rows)
    assert np.array_equal(back.view(dtype)[: n * k].reshape(n, k), given)


def test_numbers_are_rounded_to_the_type(context: Any) -> None:
    values = np.array([[1.0 + 2.0**-11, 70000.0, -0.0625 - 0.004, 500.0, np.nan, 2.0**-10]], np.float32)
    rows = Matrix(1, 6, 0, Element.FLOAT32)

    def through(element: Element) -> list[float]:
        there = context.coop_vec_matrix_convert([rows], values, [Matrix(1, 6, 0, element, Layout.INFERENCING_OPTIMAL)])
        back = context.coop_vec_matrix_convert([Matrix(1, 6, 0, element, Layout.INFERENCING_OPTIMAL)], there, [rows])
        numbers: list[float] = back.view(np.float32)[:6].tolist()
        return numbers

    halves = through(Element.FLOAT16)
    assert halves[:2] == [1.0, np.inf] and halves[3] == 500.0
    assert through(Element.FLOAT8_E4M3)[:4] == [1.0, 448.0, -0.0703125, 448.0]
    assert through(Element.FLOAT8_E5M2)[:4] == [1.0, 57344.0, -0.0625, 512.0]
    assert np.isnan(through(Element.FLOAT8_E4M3)[4]) and through(Element.FLOAT8_E4M3)[5] == 0.0


def test_networks_in_one_buffer(context: Any) -> None:
    shapes = [(8, 3), (5, 8)]
    before = ox.NetworkDescription([Matrix(8, 3, 0), Matrix(5, 8, 64)])
    after = ox.NetworkDescription([Matrix(8, 3, 0, layout=Layout.COLUMN_MAJOR), Matrix(5, 8, 128, layout=Layout.COLUMN_MAJOR)])
    given = np.zeros((3, 96), np.float16)
    random = np.random.default_rng(2)
    for network in range(3):
        for (n, k), start in zip(shapes, (0, 32), strict=True):
            given[network, start : start + n * k] = random.normal(size=n * k)
    out = np.full(3 * 256, 7, np.uint8)
    result = context.coop_vec_matrix_convert(before, given, after, out, num_networks=3, input_stride=192, output_stride=256)
    assert result is out
    for network in range(3):
        for (n, k), old, new in zip(shapes, (0, 32), (0, 128), strict=True):
            wanted = given[network, old : old + n * k].reshape(n, k)
            found = out[256 * network + new :][: 2 * n * k].view(np.float16).reshape(k, n)
            assert np.array_equal(found.T, wanted)
    assert (out[48:64] == 7).all(), "what no matrix has is left alone"


BAD: list[tuple[dict[str, Any], str]] = [
    ({"before": [Matrix(4, 4, 32)]}, "matrix 0 of the input is at offset 32, which is no multiple of 64"),
    ({"after": [Matrix(4, 5)]}, "differ in the number or shape"),
    ({"before": []}, "the input network has no matrix"),
    ({"before": [Matrix(0, 4)]}, "at least one row"),
    ({"before": [Matrix(4, 4, 0, Element.UNKNOWN)]}, "a known element type"),
    ({"before": [Matrix(4, 4, 0, 5)]}, "take one of ox.CoopVecElemType"),  # type: ignore[arg-type]
    ({"after": [Matrix(4, 4, 0, Element.FLOAT8_E4M3)]}, "a matrix of FLOAT8_E4M3 has an optimal layout, not ROW_MAJOR"),
    ({"after": [Matrix(4, 4, 0, Element.INT8)]}, "FLOAT16 is not converted to INT8"),
    ({"after": [Matrix(4, 4, 0, row_column_stride_in_bytes=4)]}, "a stride of 4 bytes is less than the 8 bytes of one row"),
    ({"after": [Matrix(4, 4, 0, row_column_stride_in_bytes=24)]}, "no multiple of 16"),
    ({"before": [Matrix(4, 4, 0, size_in_bytes=32)]}, "says 32 bytes, it takes 64"),
    ({"given": np.zeros(15, np.float16)}, "the input has 30 bytes, the matrices end at 32"),
    ({"output": np.zeros(31, np.uint8)}, "the output has 31 bytes, the matrices end at 32"),
    ({"given": np.zeros((16, 2), np.float16)[:, 0]}, "C-contiguous"),
    ({"num_networks": 0}, "must be 1 or more"),
    ({"num_networks": 2, "output_stride": 64}, "input_stride is 0"),
    ({"num_networks": 2, "input_stride": 64, "output_stride": 64}, "the matrices end at 96"),
]


@pytest.mark.parametrize(("changed", "text"), BAD, ids=[text for _, text in BAD])
def test_bad_input_is_named(context: Any, changed: dict[str, Any], text: str) -> None:
    call: dict[str, Any] = {"before": [Matrix(4, 4)], "given": np.zeros(16, np.float16), "after": [Matrix(4, 4)], "output": None, **changed}
    before, given, after, output = (call.pop(name) for name in ("before", "given", "after", "output"))
    with pytest.raises(ox.InvalidValueError, match=text.replace(".", r"\.")):
        context.coop_vec_matrix_convert(before, given, after, output, **call)


def test_read_only_output_is_refused(context: Any) -> None:
    output = np.zeros(64, np.uint8)
    output.flags.writeable = False
    with pytest.raises(ox.InvalidValueError, match="read-only"):
        context.coop_vec_matrix_convert([Matrix(4, 4)], np.zeros(16, np.float16), [Matrix(4, 4)], output)


def test_the_device_has_cooperative_vectors(context: Any) -> None:
    assert context.get_property(ox.DeviceProperty.COOP_VEC) == ox.DevicePropertyCoopVecFlags.STANDARD


def test_a_struct_cannot_hold_one() -> None:
    with pytest.raises(TypeError, match="read them with coop_vec_load"):

        @ox.struct
        class Holds:
            v: ox.CoopVec[ox.float16, 4]
