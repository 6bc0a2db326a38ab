"""Indices out of range, in builds without debug or validation: they read zero, write nothing, and the launch names the place."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import optixc as ox

COUNT = 40
CASES = {
    "int32": "params.out[i] = params.table[int(i) + SHIFT]",
    "uint32": "params.out[i] = params.table[i + uint32(SHIFT)]",
    "int64": "params.out[i] = params.table[int64(i) + SHIFT]",
    "uint64": "params.out[i] = params.table[uint64(i) + uint64(SHIFT)]",
    "uint8": "params.out[i] = params.table[params.bytes[i]]",
    "negative": "params.out[i] = params.table[31 - int(i)]",
    "very_negative": "params.out[i] = params.table[int(i) if i < 32 else -2147483648]",
    "largest": "params.out[i] = params.table[i if i < 32 else uint32(4294967295)]",
    "beyond_words": "params.out[i] = params.table[int64(i) if i < 32 else int64(1) << 33]",
    "second_axis": "params.out[i] = params.grid[0, i]",
    "record": "params.out[i] = data.table[i]",
    "helper": "params.out[i] = item(int(i))",
    "field": "params.out[i] = params.pairs[i].b",
}
STORES = {
    "store": "params.table[i] = 5.0",
    "store_part": "params.pairs[i].b = 5.0",
    "store_record": "data.table[i] = 5.0",
    "atomic": "ox.atomic_add(params.table, i, 4.0)",
}
SHADER = """import optixc as ox
from optixc import int64, uint32, uint64

SHIFT = 0

@ox.struct
class Pair:
    a: float
    b: float

@ox.struct
class Params:
    out: ox.Array[float]
    table: ox.Array[float]
    grid: ox.Array2[float]
    bytes: ox.Array[ox.uint8]
    pairs: ox.Array[Pair]

@ox.struct
class Data:
    table: ox.Array[float]

params = ox.launch_params(Params)

@ox.device
def item(k: int) -> float:
    return params.table[k]
"""
PROGRAM = """
@ox.program
def __raygen__{name}(data: Data):
    i = ox.get_launch_index().x
    {body}
"""


@pytest.fixture(scope="module")
def shader(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    path = tmp_path_factory.mktemp("index_checks") / "index_checks_shader.py"
    path.write_text(SHADER + "".join(PROGRAM.format(name=name, body=body) for name, body in (CASES | STORES).items()))
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class Run:
    """A pipeline of all programs at one width, and the arrays of the last launch: 32 elements for 40 launch indices."""

    def __init__(self, shader: ModuleType, lanes: int, **options: Any) -> None:
        self.shader = shader
        self.context = ox.DeviceContext(threads=1)
        module = self.context.module_create(shader)
        self.groups = {name: self.context.program_group_create(raygen=module[name]) for name in module}
        self.pipeline = self.context.pipeline_create(list(self.groups.values()), simd=lanes, **options)

    def launch(self, name: str, count: int = COUNT) -> None:
        self.out = np.full(COUNT, -1, np.float32)
        # What lies behind the tables must stay as it is.
        self.memory = np.full(64, 7, np.float32)
        self.memory[:32] = np.arange(32) + 1
        self.pairs = np.zeros(64, self.shader.Pair.dtype)
        self.pairs["b"] = self.memory
        table = self.memory[:32]
        params = self.shader.Params(self.out, table, table.reshape(1, 32), np.arange(COUNT, dtype=np.uint8), self.pairs[:32])
        record = self.groups[f"__raygen__{name}"].record(self.shader.Data(table))
        self.pipeline.launch(params, ox.ShaderBindingTable(raygen=record), count)


@pytest.fixture(scope="module", params=[1, 8, 16])
def run(request: pytest.FixtureRequest, shader: ModuleType) -> Run:
    return Run(shader, request.param)


def line_of(name: str) -> str:
    return next(body for key, body in (CASES | STORES).items() if key == name)


@pytest.mark.parametrize("name", list(CASES))
def test_reads_give_zero_and_a_named_error(run: Run, name: str) -> None:
    with pytest.raises(ox.LaunchFailureError, match="index out of range") as caught:
        run.launch(name)
    text = Path(str(caught.value.path)).read_text().splitlines()[int(caught.value.line or 0) - 1]
    assert text.strip() in (line_of(name), "return params.table[k]")
    assert caught.value.launch_index is not None
    assert caught.value.launch_index[0] >= 32
    done = run.out[run.out != -1]
    assert set(done[np.isin(done, np.arange(32) + 1, invert=True)]) <= {0.0}


@pytest.mark.parametrize("name", list(STORES))
def test_stores_outside_are_dropped(run: Run, name: str) -> None:
    with pytest.raises(ox.LaunchFailureError, match=r"index out of range \(3\d\), the shape is \(32\)|outside|out of range"):
        run.launch(name)
    assert (run.memory[32:] == 7).all()
    assert (run.pairs["b"][32:] == 7).all()


@pytest.mark.parametrize("name", list(CASES))
def test_indices_inside_are_no_news(run: Run, name: str) -> None:
    run.launch(name, 32)
    expected = np.arange(32) + 1
    assert run.out[:32].tolist() == (expected[::-1] if name == "negative" else expected).tolist()


@pytest.mark.parametrize("lanes", [1, 16])
def test_the_look_can_be_left_out(shader: ModuleType, lanes: int) -> None:
    plain, unchecked = Run(shader, lanes), Run(shader, lanes, checks_bounds=False)
    assert "array bounds checks: not compiled in" not in str(plain.pipeline.report())
    assert "array bounds checks: not compiled in" in str(unchecked.pipeline.report())
    unchecked.launch("second_axis")
    assert unchecked.out.tolist() == unchecked.memory[:COUNT].tolist()
