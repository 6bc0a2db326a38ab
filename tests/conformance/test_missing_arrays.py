"""Arrays and handles that are not there, or not any more: a named error before the launch or a launch that ends, never a crash."""

from __future__ import annotations

import threading
from typing import Any

import numpy as np
import pytest
from harness import Harness
from shaders import missing_arrays as shader

import optixc as ox

COUNT = 20
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
ONES = np.ones(COUNT, np.float32)


class Scene:
    """The programs, and parameters with everything there: each index gives 1 * 2 + 3 + 4 + 5 + 6."""

    def __init__(self, harness: Harness) -> None:
        module, self.harness = harness.module("missing_arrays.py"), harness
        if "missing arrays" not in harness.kept:
            create = harness.context.program_group_create
            harness.kept["missing arrays"] = {
                "read": create(raygen=module["__raygen__read"]), "trace": create(raygen=module["__raygen__trace"]),
                "miss": create(miss=module["__miss__missed"]), "hit": create(closesthit=module["__closesthit__hit"])}
        self.groups = harness.kept["missing arrays"]

    def params(self) -> Any:
        materials = [shader.Material(3.0 * ONES, 1.0), shader.Material(3.0 * ONES, 1.0)]
        pair = [shader.Material(4.0 * ONES, 1.0), shader.Material(4.0 * ONES, 1.0)]
        inner = shader.Inner(2.0 * ONES, None)
        return shader.Params(np.zeros(COUNT, np.float32), ONES.reshape(1, COUNT).copy(), inner, materials, pair, 6.0 * ONES[:1], 0)

    def table(self, data: Any = None) -> ox.ShaderBindingTable:
        return ox.ShaderBindingTable(raygen=self.groups["read"].record(data or shader.Data(5.0 * ONES, None)))

    def launch(self, params: Any, table: Any = None) -> None:
        pipeline = self.harness.pipeline("missing arrays", [self.groups["read"]])
        self.harness.launch(pipeline, params, table or self.table(), COUNT)

    def trace(self, params: Any, data: Any) -> float:
        groups = self.groups
        pipeline = self.harness.pipeline("missing arrays traced", [groups["trace"], groups["miss"], groups["hit"]])
        table = ox.ShaderBindingTable(groups["trace"].record(), [groups["miss"].record()], [groups["hit"].record(data)])
        self.harness.launch(pipeline, params, table, COUNT)
        assert len(set(params.out)) == 1
        return float(params.out[0])


@pytest.fixture
def scene(harness: Harness) -> Scene:
    return Scene(harness)


def without(params: Any, field: str) -> None:
    """Takes one array out."""
    match field:
        case "inner.weights":
            params.inner.weights = None
        case "inner":
            params.inner = shader.Inner(None, None)
        case "materials[].texels":
            params.materials = [shader.Material(ONES, 1.0), shader.Material(None, 1.0)]
        case "pair[].texels":
            params.pair = [shader.Material(None, 1.0), shader.Material(ONES, 1.0)]
        case _:
            setattr(params, field, None)


FIELDS = ("out", "source", "inner", "inner.weights", "materials", "materials[].texels", "pair[].texels", "optional")


@pytest.mark.parametrize("field", FIELDS)
def test_none_where_the_pipeline_uses_an_array(scene: Scene, field: str) -> None:
    params = scene.params()
    scene.launch(params)
    assert params.out.tolist() == [20.0] * COUNT
    out = params.out
    without(params, field)
    name = (field if field != "inner" else "inner.weights").replace("[", r"\[").replace("]", r"\]").replace(".", r"\.")
    # Twice: nothing is remembered of a refused launch.
    for _ in range(2):
        expected = rf"launch parameter of Params `{name}` is None, and the pipeline uses it at .*missing_arrays\.py:\d+; pass"
        with pytest.raises(ox.InvalidValueError, match=expected):
            scene.launch(params)
    assert out.tolist() == [20.0] * COUNT


def test_empty_arrays_and_unused_ones(scene: Scene) -> None:
    params = scene.params()
    params.optional = np.zeros(0, np.float32)
    scene.launch(params)
    assert params.out.tolist() == [14.0] * COUNT
    assert params.inner.unused is None


def test_none_in_a_record(scene: Scene) -> None:
    data = shader.Data(5.0 * ONES, None)
    table = scene.table(data)
    params = scene.params()
    scene.launch(params, table)
    data.table = None
    for _ in range(2):
        with pytest.raises(ox.InvalidValueError, match="field of a Data record `table` is None, and the pipeline uses it at"):
            scene.launch(params, table)
    data.table = 6.0 * ONES
    scene.launch(params, table)
    assert params.out.tolist() == [21.0] * COUNT
    with pytest.raises(ox.InvalidValueError, match="field of a Data record `table` is None"):
        scene.trace(params, shader.Data(None, None))


def test_handles_of_nothing_and_of_what_is_gone(scene: Scene) -> None:
    """They miss, as a handle of zero does."""
    params, data = scene.params(), shader.Data(5.0 * ONES, None)
    accel = scene.harness.context.accel_build([ox.BuildInputTriangles(CORNERS)])
    params.scene = accel
    assert scene.trace(params, data) == 5.0
    accel.destroy()
    assert scene.trace(params, data) == -1.0
    for handle in (0, 12345, (1 << 64) - 1):
        params.scene = handle
        assert scene.trace(params, data) == -1.0
    with pytest.raises(ox.InvalidValueError, match=r"scene takes a Traversable: an object with \.handle, or a handle, not NoneType"):
        params.scene = None
    del accel
    assert scene.trace(params, data) == -1.0


def test_numpy_moves_no_memory_that_a_struct_points_to(scene: Scene) -> None:
    params = scene.params()
    params.out = array = np.zeros(COUNT, np.float32)
    with pytest.raises(ValueError, match="resize"):
        array.resize(1000000, refcheck=False)
    params.out = np.zeros(COUNT, np.float32)
    array.resize(1000000, refcheck=False)
    scene.launch(params)
    assert params.out.tolist() == [20.0] * COUNT


def test_structs_in_an_array_keep_what_they_had(scene: Scene) -> None:
    """The array is a copy of its structs: what they hold later does not reach it, and what they held stays."""
    params = scene.params()
    material = shader.Material(np.full(COUNT, 3.0, np.float32), 1.0)
    params.materials, params.pair = [material, material], [material, material]
    material.texels = None
    filling = [np.full(COUNT, 99.0, np.float32) for _ in range(1000)]
    scene.launch(params)
    assert params.out.tolist() == [19.0] * COUNT
    assert len(filling) == 1000


WRONG = {
    "another type": (np.zeros(COUNT), r"out takes Array1\[float32\].*not an array of float64.*astype"),
    "byte order": (np.zeros(COUNT, ">f4"), "not an array of >f4"),
    "integers": (np.zeros(COUNT, np.int32), "not an array of int32"),
    "objects": (np.zeros(COUNT, object), "not an array of object"),
    "two axes": (np.zeros((COUNT, 2), np.float32), r"shape \(20, 2\)"),
    "no axis": (np.zeros((), np.float32), r"shape \(\)"),
    "a step": (np.zeros(2 * COUNT, np.float32)[::2], "C-contiguous"),
    "backwards": (np.zeros(COUNT, np.float32)[::-1], "C-contiguous"),
    "spread": (np.broadcast_to(np.float32(1.0), COUNT), "C-contiguous"),
    "odd addresses": (np.zeros(4 * COUNT + 1, np.uint8)[1:].view(np.float32), "aligned"),
    "a list": ([0.0] * COUNT, "numpy array"),
    "a number": (1.0, "numpy array"),
    "bytes": (b"0000", "numpy array"),
}


@pytest.mark.parametrize("name", WRONG)
def test_arrays_of_another_kind(scene: Scene, name: str) -> None:
    value, text = WRONG[name]
    params = scene.params()
    with pytest.raises(ox.InvalidValueError, match=text):
        params.out = value
    scene.launch(params)
    assert params.out.tolist() == [20.0] * COUNT


def test_what_a_launch_reads_stays_until_it_ends(harness: Harness) -> None:
    """Another thread takes arrays out of parameters and records while launches run."""
    if harness.mode == "interpreter":
        pytest.skip("the interpreter runs in Python")
    scene = Scene(harness)
    size, launches = 200000, 30
    params, data = scene.params(), shader.Data(np.full(size, 5.0, np.float32), None)
    table = scene.table(data)
    ended = threading.Event()

    def replace() -> None:
        params.out = np.zeros(size, np.float32)
        params.source = np.ones((1, size), np.float32)
        params.inner.weights = np.full(size, 2.0, np.float32)
        params.materials = [shader.Material(np.full(size, 3.0, np.float32), 1.0) for _ in range(2)]
        params.pair = [shader.Material(np.full(size, 4.0, np.float32), 1.0) for _ in range(2)]
        data.table = np.full(size, 5.0, np.float32)
        table.raygen.data = data

    def replace_often() -> None:
        while not ended.is_set():
            replace()

    replace()
    pipeline = harness.pipeline("missing arrays", [scene.groups["read"]])
    other = threading.Thread(target=replace_often)
    other.start()
    try:
        for _ in range(launches):
            pipeline.launch(params, table, width=size)
    finally:
        ended.set()
        other.join()
    pipeline.launch(params, table, width=size)
    assert (params.out == 20.0).all()
