"""One compiled pipeline of the shader library's test programs, for all numerical tests."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import optixc as ox

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE))

import stdlib_shader  # noqa: E402 - the structs of the shader file are classes of the Python module of that name

Run = Callable[..., np.ndarray]


class Library:
    """Runs one function of the shader library over an array."""

    def __init__(self) -> None:
        self.context = ox.DeviceContext(validation=True)
        self.module = self.context.module_create(HERE / "stdlib_shader.py")
        names = [name for name in vars(stdlib_shader) if name.startswith("__raygen__")]
        self.groups = {name.removeprefix("__raygen__"): self.context.program_group_create(raygen=self.module[name]) for name in names}
        self.pipeline = self.context.pipeline_create(list(self.groups.values()), max_trace_depth=0)

    def run(self, name: str, inputs: np.ndarray, a: tuple[float, ...] = (), b: tuple[float, ...] = (), record: object = None) -> np.ndarray:
        """Row i of the result is what the program made of row i of `inputs`; short rows and parameters are filled up with zeros."""
        rows = np.zeros((len(inputs), 4), np.float32)
        rows[:, : inputs.shape[1]] = inputs
        outputs = np.zeros((len(inputs), 4), np.float32)
        params = stdlib_shader.Params(inputs=rows, outputs=outputs, a=(*a, 0, 0, 0, 0)[:4], b=(*b, 0, 0, 0, 0)[:4])
        group = self.groups[name]
        table = ox.ShaderBindingTable(raygen=group.record() if record is None else group.record(record))
        self.pipeline.launch(params, table, width=len(inputs))
        return outputs

    def run_words(self, name: str, inputs: np.ndarray, count: int) -> np.ndarray:
        """The same for the programs on integers."""
        outputs = np.zeros((count, 4), np.uint32)
        nothing = np.zeros((1, 4), np.float32)
        params = stdlib_shader.Params(inputs=nothing, outputs=nothing, a=(0, 0, 0, 0), b=(0, 0, 0, 0))
        record = self.groups[name].record(stdlib_shader.Words(inputs=np.ascontiguousarray(inputs, np.uint32), outputs=outputs))
        self.pipeline.launch(params, ox.ShaderBindingTable(raygen=record), width=count)
        return outputs


@pytest.fixture(scope="session")
def library() -> Library:
    """The compiled shader library."""
    return Library()
