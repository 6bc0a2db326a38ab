"""Live functions: captured values become constants, definitions are found in files, in functions and in notebook cells."""

from __future__ import annotations

import enum
import linecache
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


@pytest.mark.parametrize("function", [len, 3])
def test_functions_without_source(function: Any) -> None:
    with pytest.raises(CompileError, match=r"OX104.*cannot be found"):
        compile_functions([function])


def test_function_made_from_text() -> None:
    namespace: dict[str, Any] = {}
    exec("def __raygen__text():\n    pass\n", namespace)
    with pytest.raises(CompileError, match="OX104"):
        compile_functions([namespace["__raygen__text"]])


def test_host_value_is_told_at_its_use() -> None:
    table = {"a": 1}

    @ox.program
    def __raygen__uses_dict():
        print(table["a"])

    with pytest.raises(CompileError) as caught:
        compile_functions([__raygen__uses_dict])
    assert "`table`" in str(caught.value)
