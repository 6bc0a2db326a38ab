"""Runs generated programs in every way that exists and compares the bits of everything that they wrote."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from statements import INPUT_COLUMNS, OUTPUT_COLUMNS
from types_of_programs import FLOATS, NUMBERS

import optixc as ox
from optixc import api
from optixc.frontend.compile import compile_file
from optixc.ir.verify import verify
from optixc.options import CompileOptions

ROWS = 21
"""Launch indices: one packet of 16 lanes and a part of another."""

Outputs = dict[str, np.ndarray[Any, Any]]


def inputs() -> Outputs:
    """The same numbers for every program: small ones, and those at the ends of each type."""
    random = np.random.default_rng(7)
    tables: Outputs = {}
    for of in NUMBERS:
        dtype = np.dtype(of)
        if of in FLOATS:
            edges = [0.0, -0.0, 1.0, -1.0, np.inf, -np.inf, np.nan, 1e-40, 3e38, 0.5, 2.5, -2.5, 1e9, 2.0**31, 2.0**63, -1e20]
            special = np.array(edges, dtype)
            table = random.normal(0.0, 10.0, (ROWS, INPUT_COLUMNS)).astype(dtype)
            chosen = random.random(table.shape) < 0.2
        else:
            limits = np.iinfo(dtype)
            special = np.array([0, 1, 2, limits.max, limits.max - 1, limits.min, limits.min + 1, 31, 32, 33], dtype)
            table = random.integers(0, 20, (ROWS, INPUT_COLUMNS)).astype(dtype)
            if limits.min < 0:
                table -= dtype.type(6)
            chosen = random.random(table.shape) < 0.25
        table[chosen] = random.choice(special, int(chosen.sum()))
        tables[of] = table
    return tables


class Ways:
    """One context; `compile` makes a module's pipelines, `run` runs one of its programs. `optimization` is the C++ compiler's level."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.folder = folder
        self.optimization = 0
        # Nothing is compiled twice, so nothing is kept.
        monkeypatch.setenv("OPTIXC_CACHE_MAXSIZE", "0")
        self.context = ox.DeviceContext(threads=1)
        monkeypatch.setattr(api, "CompileOptions", self._options)
        self.inputs = inputs()
        self.count = 0
        self.lanes = {"lanes8": 8, "lanes16": 16}

    def write(self, text: str) -> Path:
        """The module as a file of its own."""
        self.count += 1
        path = self.folder / f"programs_{self.count}.py"
        path.write_text(text)
        return path

    def _options(self, **options: Any) -> CompileOptions:
        return CompileOptions(**options, optimization=self.optimization)

    def compile(self, path: Path, names: list[str]) -> tuple[Any, dict[str, Any], list[Any]]:
        """Scalar pipeline, table of each program, and the program groups."""
        module = self.context.module_create(path)
        assert verify(compile_file(str(path)).module) == []
        groups = {name: self.context.program_group_create(raygen=module[name]) for name in names}
        tables = {name: ox.ShaderBindingTable(raygen=group.record()) for name, group in groups.items()}
        return self.pipeline(list(groups.values()), 1), tables, list(groups.values())

    def pipeline(self, groups: list[Any], lanes: int) -> Any:
        """The same programs in another width."""
        return self.context.pipeline_create(groups, simd=lanes)

    def run(self, pipeline: Any, table: Any, params_class: type[Any], launch: Callable[..., None] | None = None) -> Outputs:
        """What one program writes."""
        outputs: Outputs = {of: np.zeros((ROWS, OUTPUT_COLUMNS), of) for of in NUMBERS}
        values = {f"in_{of}": self.inputs[of] for of in NUMBERS} | {f"out_{of}": outputs[of] for of in NUMBERS}
        params = params_class(**values)
        if launch is not None:
            launch(pipeline, params, table)
        else:
            pipeline.launch(params, table, width=ROWS)
        return outputs


def interpret(pipeline: Any, params: Any, table: Any) -> None:
    """All launch indices in CPython."""
    for index in range(ROWS):
        ox.interpret(pipeline, params, table, (ROWS, 1, 1), (index, 0, 0))


def difference(first: Outputs, second: Outputs) -> str:
    """Where the bits differ, "" if nowhere; one NaN is as good as another."""
    for of in NUMBERS:
        a, b = first[of], second[of]
        same = a.view(f"u{a.itemsize}") == b.view(f"u{b.itemsize}")
        if of in FLOATS:
            same |= np.isnan(a) & np.isnan(b)
        if not same.all():
            row, column = (int(number) for number in np.argwhere(~same)[0])
            return f"out_{of}[{row}, {column}]: {a[row, column]!r} and {b[row, column]!r}"
    return ""


def params_class() -> type[Any]:
    """The launch parameters of every generated module, for the host."""
    annotations: dict[str, Any] = {}
    for of in NUMBERS:
        annotations[f"in_{of}"] = annotations[f"out_{of}"] = ox.Array2[getattr(ox, of)]
    return ox.struct(type("Params", (), {"__annotations__": annotations}))
