"""Read-only arrays: inputs as ever, refused by name where the pipeline writes; the caller's data stays as it is."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from harness import Harness
from shaders import read_only as shader

import optixc as ox

COUNT = 20
FIELDS = ("out", "source", "counts", "tables.weights", "tables.sums")
WRITTEN = {"write": {"out", "tables.sums", "counts"}, "read": {"out"}}


class Scene:
    """The two raygen programs; a launch with some arrays made read-only."""

    def __init__(self, harness: Harness) -> None:
        module, self.harness = harness.module("read_only.py"), harness
        if "read only" not in harness.kept:
            harness.kept["read only"] = {name: harness.context.program_group_create(raygen=module[f"__raygen__{name}"]) for name in WRITTEN}
        self.groups = harness.kept["read only"]

    def params(self) -> Any:
        numbers = np.arange(COUNT, dtype=np.float32)
        tables = shader.Tables(np.full(1, 2.0, np.float32), np.zeros(COUNT, np.float32))
        return shader.Params(np.zeros(COUNT, np.float32), numbers, tables, np.zeros(1, np.uint32))

    def launch(self, program: str, params: Any, data: Any = None) -> None:
        # Each program has a pipeline of its own, because what any program of a pipeline writes counts.
        group = self.groups[program]
        pipeline = self.harness.pipeline(("read only", program), [group])
        record = data or shader.Data(np.full(1, 3.0, np.float32), np.zeros(COUNT, np.float32))
        self.harness.launch(pipeline, params, ox.ShaderBindingTable(raygen=group.record(record)), COUNT)


@pytest.fixture
def scene(harness: Harness) -> Scene:
    return Scene(harness)


def array_of(params: Any, field: str) -> np.ndarray:
    for name in field.split("."):
        params = getattr(params, name)
    return np.asarray(params)


@pytest.mark.parametrize("program", WRITTEN)
@pytest.mark.parametrize("field", FIELDS)
def test_a_read_only_array_of_the_parameters(scene: Scene, program: str, field: str) -> None:
    params = scene.params()
    array = array_of(params, field)
    array.flags.writeable = False
    before = array.copy()
    if field not in WRITTEN[program]:
        scene.launch(program, params)
        assert params.out[1] > 0
    else:
        name = field.replace(".", r"\.")
        with pytest.raises(ox.InvalidValueError, match=rf"launch parameter of Params `{name}` is a read-only array.*read_only\.py:\d+"):
            scene.launch(program, params)
        assert not params.out.any()
        array.flags.writeable = True
        scene.launch(program, params)
        assert params.out[1] > 0
        array.flags.writeable = False
    if field not in WRITTEN[program]:
        np.testing.assert_array_equal(array, before)


@pytest.mark.parametrize("field", ["scale", "notes"])
def test_a_read_only_array_of_a_record(scene: Scene, field: str) -> None:
    data = shader.Data(np.full(1, 3.0, np.float32), np.zeros(COUNT, np.float32))
    getattr(data, field).flags.writeable = False
    scene.launch("read", scene.params(), data)
    if field == "scale":
        scene.launch("write", scene.params(), data)
        return
    with pytest.raises(ox.InvalidValueError, match=r"field of a Data record `notes` is a read-only array.*array\.copy\(\)"):
        scene.launch("write", scene.params(), data)
    assert not data.notes.any()


def test_memory_that_is_mapped_read_only(scene: Scene, tmp_path: Path) -> None:
    """A write to it would end the process."""
    np.save(tmp_path / "numbers.npy", np.arange(COUNT, dtype=np.float32))
    mapped = np.load(tmp_path / "numbers.npy", mmap_mode="r")
    params = scene.params()
    params.source = mapped
    scene.launch("write", params)
    assert params.out.tolist() == [6.0 * index for index in range(COUNT)]
    params.out = mapped
    with pytest.raises(ox.InvalidValueError, match="`out` is a read-only array"):
        scene.launch("write", params)


def test_views_of_read_only_arrays(scene: Scene) -> None:
    whole = np.zeros(2 * COUNT, np.float32)
    whole.flags.writeable = False
    params = scene.params()
    params.out = whole[:COUNT]
    with pytest.raises(ox.InvalidValueError, match="`out` is a read-only array"):
        scene.launch("read", params)
    broadcast = np.broadcast_to(np.float32(5.0), COUNT)
    with pytest.raises(ox.InvalidValueError, match="C-contiguous"):
        params.out = broadcast
