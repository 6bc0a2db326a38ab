"""Optional tests (X...) of areas that have no file of their own for them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from harness import Harness
from shaders import optional as shader

import optixc as ox

COUNT = 20
ENTRIES = ("recursive", "kept", "save", "restore")


class Launches:
    """One pipeline with several entries, over two triangles that lie in line."""

    def __init__(self, harness: Harness) -> None:
        self.harness = harness
        if "optional" not in harness.kept:
            module, create = harness.module("optional.py"), harness.context.program_group_create
            groups = {name: create(raygen=module[f"__raygen__{name}"]) for name in ENTRIES}
            groups |= {"hit": create(closesthit=module["__closesthit__tells"]), "miss": create(miss=module["__miss__tells"])}
            harness.kept["optional"] = groups
        self.groups = harness.kept["optional"]
        self.pipeline = harness.pipeline("optional", self.groups.values())
        corners = np.float32([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1.15, 0, 0], [2.15, 0, 0], [1.15, 1, 0]])
        scene = harness.context.accel_build([ox.BuildInputTriangles(corners)])
        self.params = shader.Params(scene=scene, out=np.zeros(COUNT, np.uint32), saved=np.zeros((COUNT, 20), np.uint32))

    def run(self, entry: str, width: int = COUNT) -> list[int]:
        table = ox.ShaderBindingTable(raygen=self.groups[entry].record(), miss=[self.groups["miss"].record()],
                                      hitgroup=[self.groups["hit"].record()])
        self.harness.launch(self.pipeline, self.params, table, width)
        return [int(value) for value in self.params.out]


@pytest.fixture
def launches(harness: Harness) -> Launches:
    return Launches(harness)


def seen_by_hand(index: int) -> int | None:
    """What the closest-hit program tells of a ray; None for a miss. Rays stand 0.1 apart."""
    for primitive, start in enumerate((0.0, 1.15)):
        u = 0.1 * index - start
        if 0.0 <= u <= 0.9:
            return 1000 * primitive + round(100.0 * u)
    return None


def test_X02_a_helper_calls_itself(launches: Launches) -> None:
    expected = [0, 1]
    while len(expected) < COUNT:
        expected.append(expected[-1] + expected[-2])
    assert launches.run("recursive") == expected


def test_X05_a_word_that_only_miss_programs_read_survives_a_traversal(launches: Launches) -> None:
    found = [seen_by_hand(index) for index in range(COUNT)]
    assert None in found and found.count(None) < COUNT
    assert launches.run("kept") == [10000 * index + (1001 + index if seen is None else seen) for index, seen in enumerate(found)]


def test_X06_a_launch_of_width_zero_is_refused(launches: Launches) -> None:
    if launches.harness.mode == "interpreter":
        pytest.skip("the interpreter runs single launch indices")
    with pytest.raises(ox.InvalidValueError, match="the launch size 0 x 1 x 1 has a zero"):
        launches.run("save", width=0)
    assert not launches.params.out.any()


def test_X07_launch_parameters_are_not_written(tmp_path: Path) -> None:
    text = Path(shader.__file__).read_text().replace("params.out[index] = ray.seen\n", "params.scene = params.scene\n")
    (tmp_path / "writes.py").write_text(text)
    with pytest.raises(ox.CompileError, match="launch parameters"):
        ox.DeviceContext().module_create(tmp_path / "writes.py")


def test_X18_a_hit_is_made_again_in_a_later_launch(launches: Launches) -> None:
    found = [seen_by_hand(index) for index in range(COUNT)]
    assert launches.run("save") == [int(seen is not None) for seen in found]
    assert launches.run("restore") == [seen or 0 for seen in found]


def test_X49_each_entry_runs_its_own_program(launches: Launches) -> None:
    assert launches.run("recursive")[:3] == [0, 1, 1]
    assert launches.run("kept")[:3] == [0, 10010, 20020]
    record: Any = launches.groups["miss"].record()
    with pytest.raises(ox.OptixError, match="raygen"):
        launches.harness.launch(launches.pipeline, launches.params, ox.ShaderBindingTable(raygen=record), COUNT)
