"""Cooperative vectors (X38, X39, X41): functions of elements, values, accumulators, and what checked builds say of bad offsets."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from harness import Harness
from shaders import coop_vec as shader

import optixc as ox
from optixc import CoopVecElemType as Element
from optixc import CoopVecMatrixLayout as Layout

SHADER = "coop_vec.py"
ROWS, LINES = 21, 60
N = shader.N
STORED = {"float32": np.float32, "float16": np.float16, "int8": np.int8, "uint8": np.uint8, "int32": np.int32}
Table = np.ndarray[Any, Any]
Params = shader.Params


def params(**changed: Any) -> Params:
    random = np.random.default_rng(5)
    tables = {name: random.normal(0.0, 2.0, (ROWS, N)).astype(np.float32) for name in "abc"}
    given: dict[str, Any] = {**tables, "out": np.zeros((LINES, ROWS, N)), "memory": np.zeros(8192, np.uint8),
                             "halves": np.zeros(64, np.float16), "floats": np.arange(512, dtype=np.float32), "offset": 32}
    return Params(**(given | changed))


def run(harness: Harness, name: str, given: Params, width: int, height: int = 1) -> None:
    module = harness.module(SHADER)
    create = harness.context.program_group_create
    raygen = create(raygen=module[f"__raygen__{name}"])
    weighted = create(direct_callable=module["__direct_callable__weighted"])
    pipeline = harness.pipeline(("coop vec", name), [raygen, weighted])
    harness.launch(pipeline, given, ox.ShaderBindingTable(raygen=raygen.record(), callables=[weighted.record()]), width, height)


def elements(given: Params, of: str) -> tuple[Table, Table, Table]:
    """The vectors of the shader, as numpy converts the numbers that they are made of."""
    found = []
    for table in (given.a, given.b, given.c):
        numbers = np.asarray(table)
        match of:
            case "int8":
                numbers = np.trunc(numbers * np.float32(40)).astype(np.int64)
            case "uint8":
                numbers = np.trunc(np.abs(numbers) * np.float32(40)).astype(np.int64)
            case "int32":
                numbers = np.clip((numbers * np.float32(1e9)).astype(np.float64), -(2**31), 2**31 - 1).astype(np.int64)
        found.append(numbers.astype(STORED[of]))
    return found[0], found[1], found[2]


def expected(of: str, a: Table, b: Table, c: Table) -> list[Table]:
    """What a function of each element gives in exact arithmetic, rounded to float32 and then to the type, or wrapped."""
    dtype = STORED[of]
    number = dtype(0.1) if of.startswith("float") else dtype(7)
    wide = np.float64 if of.startswith("float") else np.int64
    x, y, z = (one.astype(wide) for one in (a, b, c))
    results = [np.minimum(x, y), np.maximum(x, y), x * y, x + y, x - y, (y >= x).astype(wide), x * y + z,
               np.minimum(x, wide(number)), np.maximum(x, wide(number))]
    if wide is np.int64:
        return [one.astype(dtype) for one in results]
    return [one.astype(np.float32).astype(dtype) for one in results]


@pytest.mark.parametrize(("of", "line"), [("float32", 0), ("float16", 9), ("int8", 18), ("uint8", 27), ("int32", 36)])
def test_functions_of_elements(harness: Harness, of: str, line: int) -> None:
    """X38."""
    given = results(harness)
    wanted = expected(of, *elements(given, of))
    for number, one in enumerate(wanted):
        assert np.array_equal(np.asarray(given.out)[line + number], one.astype(np.float64)), number


def results(harness: Harness) -> Params:
    """The launch of all functions, once in each mode."""
    if "elements" not in harness.kept:
        harness.kept["elements"] = params()
        run(harness, "elements", harness.kept["elements"], ROWS)
    kept: Params = harness.kept["elements"]
    return kept


@pytest.mark.parametrize(("line", "of", "function"), [(45, "float32", np.exp2), (46, "float32", np.log2), (47, "float32", np.tanh),
                                                      (48, "float16", np.exp2), (49, "float16", np.log2), (50, "float16", np.tanh)])
def test_mathematics_of_elements(harness: Harness, line: int, of: str, function: Any) -> None:
    """X38: within 0.501 ulp of the type, as mathematics of float32 is."""
    given = results(harness)
    with np.errstate(invalid="ignore"):
        wanted = function(elements(given, of)[0].astype(np.float64))
    found = np.asarray(given.out)[line]
    assert np.array_equal(np.isnan(found), np.isnan(wanted))
    is_number = ~np.isnan(wanted)
    ulp = np.spacing(np.abs(wanted[is_number]).astype(STORED[of])).astype(np.float64)
    assert (np.abs(found - wanted)[is_number] <= 0.501 * ulp).all()


@pytest.mark.parametrize(("line", "of", "to"), [(51, "int8", "float16"), (52, "uint8", "float32"), (53, "int32", "float16"),
                                                (54, "float32", "float16"), (55, "float16", "float32")])
def test_conversions(harness: Harness, line: int, of: str, to: str) -> None:
    given = results(harness)
    with np.errstate(over="ignore"):
        wanted = elements(given, of)[0].astype(STORED[to]).astype(np.float64)
    assert np.array_equal(np.asarray(given.out)[line], wanted)


def test_vectors_are_values(harness: Harness) -> None:
    given = params()
    run(harness, "values", given, ROWS)
    out, a, floats = np.asarray(given.out), np.asarray(given.a).astype(np.float64), np.asarray(given.floats).astype(np.float64)
    rows = np.arange(ROWS)
    changed = a.copy()
    changed[rows, rows % N] = 7.0
    assert np.array_equal(out[0], a)
    assert np.array_equal(out[1], changed)
    assert np.array_equal(out[2][:, 1:], 2.0 * a[:, 1:]) and (out[2][:, 0] == 200.0).all()
    assert np.array_equal(out[3], np.where(rows[:, None] % 2 == 0, a, changed))
    for row in rows:
        wanted = np.ones(N, np.float32)
        if row % 3 == 0:
            wanted = floats[4 * row : 4 * row + N]
        elif row % 3 == 1:
            for k in range(row):
                wanted = wanted + np.asarray(given.a)[row]
                wanted[k % N] += np.float32(1)
        assert np.array_equal(out[4, row], wanted), row
    assert np.array_equal(out[5], (np.asarray(given.a) * rows[:, None].astype(np.float32)).astype(np.float64))
    assert np.array_equal(out[6], 2.0 * a)
    assert np.array_equal(out[7], np.broadcast_to(floats[8 : 8 + N], (ROWS, N)))


def test_sizes_of_matrices(harness: Harness) -> None:
    """X39: 16 x 16 float16 is 512 bytes, 3 x 5 float32 is rounded to 64; the host says the same."""
    given = params()
    run(harness, "values", given, 1)
    size = harness.context.coop_vec_matrix_compute_size
    wanted = [size(16, 16, Element.FLOAT16, Layout.ROW_MAJOR), size(3, 5, Element.FLOAT32, Layout.ROW_MAJOR),
              size(17, 5, Element.FLOAT16, Layout.INFERENCING_OPTIMAL), size(17, 5, Element.INT8, Layout.COLUMN_MAJOR, 32)]
    assert wanted[:2] == [512, 64]
    assert np.asarray(given.out)[8, 0, :4].tolist() == wanted


@pytest.mark.parametrize("offset", [0, 4, 64])
def test_accumulators(harness: Harness, offset: int) -> None:
    """X41: sums of small whole numbers over many launch indices are exact, whatever the alignment of the first number."""
    width, height = (40, 8) if harness.mode == "interpreter" else (200, 50)
    given = params(offset=offset, floats=np.zeros(64, np.float32))
    run(harness, "accumulates", given, width, height)
    a, b, rows = np.zeros(N), np.zeros((2, N)), [row for row in range(width * height) if row % 5 != 4]
    product = np.zeros((N, 10))
    for row in rows:
        left, right = np.ones(N), np.ones(10)
        left[row % N], right[row % 10] = 2.0, 3.0
        product += np.outer(left, right)
        a += left
        b[row % 2] += left
    read = ox.CoopVecMatrixDescription(N, 10, 0, Element.FLOAT32, Layout.TRAINING_OPTIMAL)
    memory = np.ascontiguousarray(np.asarray(given.memory)[offset:])
    rows_of = harness.context.coop_vec_matrix_convert([read], memory, [ox.CoopVecMatrixDescription(N, 10, 0, Element.FLOAT32)])
    assert np.array_equal(rows_of.view(np.float32)[: N * 10].reshape(N, 10), product)
    assert np.array_equal(np.asarray(given.floats)[:N], a)
    halves = np.asarray(given.halves)[: 2 * N].reshape(2, N).astype(np.float64)
    if harness.mode == "interpreter":
        assert np.array_equal(halves, b)
    else:
        # Beyond 2048 a float16 does not hold every whole number: each addition rounds by half of a step of 2 to 4 at most.
        assert (np.abs(halves - b) <= 2.0 * len(rows)).all() and (halves > 2000.0).all()


def test_sums_are_those_of_one_thread(tmp_path: Path) -> None:
    """Float sums of many threads differ from those of one by the rounding of each addition at most."""
    found = []
    for threads in (1, 4):
        harness = Harness("simd16", ox.DeviceContext(threads=threads))
        given = params(offset=0, floats=np.zeros(64, np.float32))
        run(harness, "accumulates", given, 200, 50)
        found.append((np.asarray(given.memory).view(np.float32).copy(), np.asarray(given.floats).copy()))
    for one, many in zip(*found, strict=True):
        assert np.array_equal(one, many)


@ox.struct
class Layer:
    matrix: ox.Array[ox.float32]
    bias: ox.Array[ox.float32]
    sums: ox.Array[ox.uint8]


def test_each_record_has_its_matrix(harness: Harness) -> None:
    """Launch indices of a packet multiply with the matrices of their own records, and add to their accumulators."""
    module, create = harness.module(SHADER), harness.context.program_group_create
    raygen, layer = create(raygen=module["__raygen__layers"]), create(direct_callable=module["__direct_callable__layer"])
    size = harness.context.coop_vec_matrix_compute_size(5, N, Element.FLOAT32, Layout.TRAINING_OPTIMAL)
    random = np.random.default_rng(3)
    whole = [random.integers(-9, 9, (3, count)).astype(np.float32) for count in (5 * N, 5)]
    layers = [Layer(matrix, bias, np.zeros(size, np.uint8)) for matrix, bias in zip(*whole, strict=True)]
    table = ox.ShaderBindingTable(raygen=raygen.record(), callables=[layer.record(one) for one in layers])
    given = params()
    harness.launch(harness.pipeline("coop vec layers", [raygen, layer]), given, table, ROWS)
    sums = [np.zeros((5, N)) for _ in layers]
    for row in range(ROWS):
        one, v = layers[row % 3], np.asarray(given.floats)[4 * row : 4 * row + N].astype(np.float64)
        matrix, bias = np.asarray(one.matrix).reshape(5, N), np.asarray(one.bias)
        assert np.array_equal(np.asarray(given.out)[0, row, :5], matrix @ v + bias), row
        sums[row % 3] += np.outer(bias, v)
    optimal = ox.CoopVecMatrixDescription(5, N, 0, Element.FLOAT32, Layout.TRAINING_OPTIMAL)
    rows = ox.CoopVecMatrixDescription(5, N, 0, Element.FLOAT32)
    for one, wanted in zip(layers, sums, strict=True):
        found = harness.context.coop_vec_matrix_convert([optimal], np.asarray(one.sums), [rows]).view(np.float32)
        assert np.array_equal(found[: 5 * N].reshape(5, N), wanted)


def test_gradients_of_a_network_are_those_of_numpy(harness: Harness) -> None:
    """Whole numbers, so that sums are exact in any order: products, transposed products and accumulators as training uses them."""
    random, convert = np.random.default_rng(9), harness.context.coop_vec_matrix_convert
    shapes, starts, gradients = ((18, N), (5, 18)), (0, 3072), (4224, 7296)
    weights = [random.integers(-2, 3, shape).astype(np.float32) for shape in shapes]
    memory = np.zeros(8448, np.uint8)

    def described(layout: Layout, number: int, start: int) -> list[ox.CoopVecMatrixDescription]:
        return [ox.CoopVecMatrixDescription(*shapes[number], start, Element.FLOAT32, layout)]

    for number, matrix in enumerate(weights):
        convert(described(Layout.ROW_MAJOR, number, 0), matrix, described(Layout.TRAINING_OPTIMAL, number, starts[number]), memory)
    inputs, wanted = (random.integers(-3, 4, (ROWS, N)).astype(np.float32) for _ in range(2))
    run(harness, "gradients", params(a=inputs, b=wanted, memory=memory), ROWS)

    hidden = np.maximum(inputs @ weights[0].T, 0.0)
    delta = hidden @ weights[1].T - wanted[:, :5]
    back = (delta @ weights[1]) * (hidden > 0.0)
    for number, expected_sum in enumerate((back.T @ inputs, delta.T @ hidden)):
        found = convert(described(Layout.TRAINING_OPTIMAL, number, gradients[number]), memory, described(Layout.ROW_MAJOR, number, 0))
        assert np.array_equal(found.view(np.float32)[: expected_sum.size].reshape(shapes[number]), expected_sum)


FAULTS = [
    ("past_the_end", {"offset": 8064}, "192 bytes from offset 8064 end behind the array, which has 8192 bytes", "past the end"),
    ("past_the_end", {"offset": 32}, "offset 32 is no multiple of 64", "past the end"),
    ("bias_past_the_end", {}, "8 bytes from offset 128 end behind the array, which has 128 bytes", "bias"),
    ("load_past_the_end", {"offset": 48}, "48 bytes from offset 96 end behind the array, which has 128 bytes", "load"),
    ("load_past_the_end", {"offset": 8}, "offset 8 is no multiple of 16", "load"),
    ("sum_past_the_end", {"offset": 84}, "48 bytes from offset 84 end behind the array, which has 128 bytes", "sum"),
    ("sum_past_the_end", {"offset": 2}, "offset 2 is no multiple of 4", "sum"),
    ("element_past_the_end", {"offset": 10}, "index out of range (24), there are 24 items", "element"),
    ("shared_element_past_the_end", {"offset": 30}, "index out of range (30), there are 24 items", "shared element"),
    ("product_past_the_end", {"offset": 5504}, "3072 bytes from offset 5504 end behind the array, which has 8192 bytes", "product"),
]


def test_accumulators_begin_at_words(tmp_path: Path) -> None:
    """Exchanges of numbers that straddle words would stop all other threads."""
    harness = Harness("simd16", ox.DeviceContext(validation=True))
    memory = np.zeros(8196, np.uint8)
    odd = memory[4 - memory.ctypes.data % 4 + 1 :][:8000]
    with pytest.raises(ox.OptixError, match="begins at an address that is no multiple of 4"):
        run(harness, "accumulates", params(memory=odd, offset=0), 4)


@pytest.mark.parametrize(("name", "changed", "text", "place"), FAULTS)
@pytest.mark.parametrize("lanes", [1, 8, 16])
def test_checked_builds_name_bad_offsets(lanes: int, name: str, changed: dict[str, int], text: str, place: str) -> None:
    context = ox.DeviceContext()
    source = Path(__file__).parent / "shaders" / SHADER
    module = context.module_create(source)
    raygen = context.program_group_create(raygen=module[f"__raygen__{name}"])
    pipeline = context.pipeline_create([raygen], simd=lanes, debug=True)
    line = next(n for n, one in enumerate(source.read_text().splitlines(), 1) if one.endswith(f"# {place}"))
    with pytest.raises(ox.OptixError, match=rf"coop_vec\.py:{line}.*{re.escape(text)}"):
        pipeline.launch(params(**changed), ox.ShaderBindingTable(raygen=raygen.record()), width=ROWS)


def test_read_only_arrays_are_not_accumulated_to(harness: Harness) -> None:
    floats = np.zeros(64, np.float32)
    floats.flags.writeable = False
    with pytest.raises(ox.InvalidValueError, match="floats"):
        run(harness, "accumulates", params(floats=floats), 4)
