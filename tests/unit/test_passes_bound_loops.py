"""Which `while` loops are proved to end, and so need not look whether the launch is to stop."""

from __future__ import annotations

from pathlib import Path

import pytest

from optixc import passes
from optixc.frontend.compile import compile_file
from optixc.ir.nodes import PipelineOptions, While
from optixc.ir.walk import statements
from optixc.passes.pipeline import link

SHADER = """import optixc as ox
from optixc import float32, int32, uint32

@ox.struct
class Params:
    out: ox.Array[int32]
    n: int32

params = ox.launch_params(Params)

@ox.program
def __raygen__main():
    i = int32(ox.get_launch_index().x)
    n = params.out[i]
    u = uint32(i)
    x = float32(i)
{loop}
    params.out[i] = i + int32(u) + int32(x) + n
"""
ENDS = {
    "counts up": "while i < n:\n    i += 1",
    "counts up to a parameter": "while i < params.n:\n    i += 1",
    "counts up to a shape": "while i < params.out.shape[0]:\n    i += 1",
    "counts up from the right": "while n > i:\n    i = 1 + i",
    "counts down": "while i > n:\n    i -= 1",
    "counts down by a negative step": "while i > n:\n    i += -1",
    "strides to a constant": "while i < 1000:\n    i += 7",
    "up to a constant and including it": "while i <= 1000:\n    i += 1",
    "unsigned": "while u < 10:\n    u += 3",
    "may end sooner": "while x > 0.5 and i < n:\n    x *= 0.5\n    i += 1",
    "continues behind the step": "while i < n:\n    i += 1\n    if x > 1.0:\n        continue\n    x += 1.0",
    "continue of an inner loop": "while i < n:\n    for k in range(3):\n        if k == 1:\n            continue\n    i += 1",
}
MAY_NOT_END = {
    "without end": "while True:\n    i += 1\n    if i > n:\n        break",
    "bound moves": "while i < n:\n    i += 1\n    n += 1",
    "bound is in memory": "while i < params.out[0]:\n    i += 1",
    "counts away": "while i < n:\n    i -= 1",
    "step may be left out": "while i < n:\n    if x > 0.5:\n        i += 1",
    "continues before the step": "while i < n:\n    if x > 1.0:\n        continue\n    i += 1",
    "also set back": "while i < n:\n    i += 1\n    if x > 1.0:\n        i = 0",
    "wraps past the bound": "while i < n:\n    i += 2",
    "wraps at the end of the type": "while i <= 0x7fffffff:\n    i += 1",
    "bound may be the largest": "while i <= n:\n    i += 1",
    "unsigned is never below zero": "while u >= 0:\n    u -= 1",
    "either suffices": "while i < n or x > 0.5:\n    i += 1",
    "stands still": "while i < n:\n    i += 0",
    "float counter": "while x < 3.0:\n    x += 1.0",
    "not equal": "while i != n:\n    i += 1",
}


def loops(folder: Path, loop: str) -> list[While]:
    """The `while` loops after all passes."""
    path = folder / "shader.py"
    path.write_text(SHADER.replace("{loop}", "\n".join("    " + line for line in loop.split("\n"))))
    module = compile_file(str(path)).module
    pipeline = passes.run(link([module], ["__raygen__main"], PipelineOptions()))
    return [statement for statement in statements(pipeline.programs[0].body) if isinstance(statement, While)]


@pytest.mark.parametrize("loop", ENDS.values(), ids=ENDS.keys())
def test_loops_that_end(loop: str, tmp_path: Path) -> None:
    assert [one.bounded for one in loops(tmp_path, loop)] == [True]


@pytest.mark.parametrize("loop", MAY_NOT_END.values(), ids=MAY_NOT_END.keys())
def test_loops_that_may_not_end(loop: str, tmp_path: Path) -> None:
    assert [one.bounded for one in loops(tmp_path, loop)] == [False]
