"""Live functions: captured values become constants, definitions are found in files, in functions and in notebook cells."""

from __future__ import annotations

import enum
import linecache
import math
import sys
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import optixc as ox
from optixc.diagnostics import CompileError
from optixc.frontend.compile import compile_functions
from optixc.ir.text import print_module

LIVE_COUNT = len("four")


class Mode(enum.IntEnum):
    FLAT = 1


def make_programs(samples: int, scale: np.float32) -> list[Any]:
    n = samples * 2
    tint = ox.float3(1.0, 0.5, 0.25)

    @ox.struct
    class Params:
        image: ox.Array2[ox.float4]

    params = ox.launch_params(Params)

    @ox.device
    def helper(x):
        return x * scale

    @ox.program
    def __raygen__live():
        i = ox.get_launch_index()
        total = 0.0
        for k in range(n):
            total += helper(float(k)) + float(LIVE_COUNT) + float(int(Mode.FLAT))
        params.image[i.y, i.x] = ox.float4(total * tint, 1.0)

    return [__raygen__live]


def text_of(functions: list[Any]) -> str:
    return print_module(compile_functions(functions).module)


def test_captured_values_are_constants() -> None:
    text = text_of(make_programs(4, np.float32(0.5)))
    assert "for k in range(int32(0), int32(8), int32(1)):" in text
    assert "return (x * float32(0.5)):float32" in text
    assert "float3(1.0, 0.5, 0.25)" in text
    assert "float32(4.0)" in text


def test_each_closure_has_its_own_constants() -> None:
    assert "range(int32(0), int32(4), int32(1))" in text_of(make_programs(2, np.float32(1.0)))


def run_cell(number: int, source: str, namespace: dict[str, Any]) -> None:
    """What IPython does with a cell: compile under a made-up name that linecache knows."""
    name = f"<ipython-input-{number}-optixc>"
    linecache.cache[name] = (len(source), None, source.splitlines(keepends=True), name)
    exec(compile(source, name, "exec"), namespace)


def test_notebook_cells() -> None:
    namespace: dict[str, Any] = {"__name__": "__main__"}
    run_cell(1, "import optixc as ox\n@ox.struct\nclass CellParams:\n    out: ox.Array[float]\n", namespace)
    run_cell(2, "cell_params = ox.launch_params(CellParams)\nweight = 2.5\n", namespace)
    run_cell(3, "@ox.program\ndef __raygen__cell():\n    cell_params.out[0] = weight\n", namespace)
    text = text_of([namespace["__raygen__cell"]])
    assert "params.out[int32(0)] = float32(2.5)" in text
    assert "launch_params CellParams" in text


def test_cells_share_their_imports(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each cell is a file of its own to Python: what the others import and define counts in it, in structs and helpers too."""
    module = ModuleType("cells")
    monkeypatch.setitem(sys.modules, "cells", module)
    namespace = vars(module)
    run_cell(11, "import math\nimport optixc as ox\nfrom math import pi\nfrom optixc import Array, float3\nN = 4", namespace)
    run_cell(12, "import optixc.stdlib.frame as frames\nfrom optixc.stdlib import sampling", namespace)
    run_cell(13, "@ox.struct\nclass Item:\n    color: float3\n    size: float = pi\n", namespace)
    run_cell(14, "@ox.struct\nclass Params:\n    out: Array[float]\n    items: Array[Item]\n    f: ox.FixedArray[float, N]", namespace)
    run_cell(15, "params = ox.launch_params(Params)\nTABLE = (1.0, (float3(1, 2, 3), Item(float3(4, 5, 6))), math.inf)\n", namespace)
    run_cell(16, "TURN = ox.float3x3([[0, 1, 0], [-1, 0, 0], [0, 0, 1]])\n", namespace)
    run_cell(17, "@ox.device\ndef helper(item: Item):\n    return item.color.x * math.tau + params.f[1]", namespace)
    lines = [
        "helper(params.items[0])",
        "frames.frame_from_normal(float3(0.0, 0.0, 1.0)).normal.z",
        "TABLE[1][0].y + TABLE[1][1].size + TABLE[2]",
    ]
    lines += ["sampling.cosine_hemisphere(ox.float2(0.5, 0.5)).z", "(TURN @ float3(1.0, 2.0, 3.0)).x"]
    body = "".join(f"    params.out[{place}] = {line}\n" for place, line in enumerate(lines))
    run_cell(18, f"@ox.program\ndef __raygen__cells():\n{body}", namespace)
    text = text_of([namespace["__raygen__cells"]])
    assert "f: FixedArray[float32, 4]" in text
    assert "Item(float3(4.0, 5.0, 6.0), float32(3.14159" in text


def test_struct_made_by_a_function() -> None:
    def make(size: int) -> Any:
        @ox.struct
        class Table:
            values: ox.FixedArray[float, size]  # type: ignore[valid-type]

        return Table

    table = make(7)
    params = ox.launch_params(table)

    @ox.program
    def __raygen__table():
        print(params.values[6])

    assert "values: FixedArray[float32, 7]" in text_of([__raygen__table])


@pytest.mark.parametrize(
    ("value", "reason"),
    [
        ({"a": 1}, "a Python value of type dict"),
        (np.ones(3), "a Python value of type ndarray"),
        ((1, [2]), "a Python value of type tuple"),
        (np, "the module `numpy`, which is host code"),
        (math.sqrt, "a function of Python's math module; write `ox.sqrt`"),
    ],
)
def test_values_that_are_no_constants(value: Any, reason: str) -> None:
    @ox.program
    def __raygen__uses_value():
        print(value)

    with pytest.raises(CompileError, match=f"`value` cannot be used in a shader: it is {reason}"):
        compile_functions([__raygen__uses_value])


@pytest.mark.parametrize("function", [len, 3])
def test_functions_without_source(function: Any) -> None:
    with pytest.raises(CompileError, match=r"OX104.*cannot be found"):
        compile_functions([function])


def test_function_made_from_text() -> None:
    namespace: dict[str, Any] = {}
    exec("def __raygen__text():\n    pass\n", namespace)
    with pytest.raises(CompileError, match="OX104"):
        compile_functions([namespace["__raygen__text"]])
