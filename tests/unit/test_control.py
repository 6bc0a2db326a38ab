"""Which loops look whether the launch is to stop: those of which nobody knows that they have few turns."""

from __future__ import annotations

from pathlib import Path

import pytest

from optixc import passes
from optixc.frontend.compile import compile_file
from optixc.ir.control import ends_in_loop, polls
from optixc.ir.nodes import ForRange, PipelineOptions, While
from optixc.ir.walk import statements
from optixc.passes.pipeline import link

SHADER = """import optixc as ox
from optixc import float32, int32

@ox.struct
class Params:
    out: ox.Array[int32]
    n: int32

params = ox.launch_params(Params)

@ox.device
def half(i: int32) -> int32:
    return i // 2

@ox.device
def endless(i: int32) -> int32:
    while True:
        if i > params.out[0]:
            return i

@ox.program
def __raygen__main():
    i = int32(ox.get_launch_index().x)
    k = 0
{loop}
    params.out[i] = i + k + endless(i)
"""
LOOPS = {
    "few turns": ("for j in range(100):\n    k += j", [False]),
    "few turns downwards": ("for j in range(100, 0, -3):\n    k += j", [False]),
    "many turns": ("for j in range(100000):\n    k += j", [True]),
    "from a parameter": ("for j in range(params.n):\n    k += j", [True]),
    "of a lane": ("for j in range(i):\n    k += j", [True]),
    "many together": ("for a in range(1000):\n    for b in range(1000):\n        k += a * b", [True, False]),
    "many in a branch": ("for a in range(1000):\n    if k > 3:\n        for b in range(1000):\n            k += b", [True, False]),
    "inner one polls": ("for a in range(1000):\n    for b in range(params.n):\n        k += a * b", [False, True]),
    "many calls": ("for a in range(10000):\n    k += half(a)", [True]),
    "few calls": ("for a in range(100):\n    k += half(a)", [False]),
    "while that counts": ("while k < 100:\n    k += 1", [False]),
    "while that counts far": ("while k < 1000000:\n    k += 1", [True]),
    "while that counts to a parameter": ("while k < params.n:\n    k += 1", [True]),
    "while of two conditions": ("while i < 7 and k < params.n:\n    k += 1", [True]),
    "while without a bound": ("while k != 7:\n    k = params.out[k]", [True]),
}


@pytest.mark.parametrize(("loop", "expected"), LOOPS.values(), ids=LOOPS)
def test_loops_that_poll(tmp_path: Path, loop: str, expected: list[bool]) -> None:
    path = tmp_path / "shader.py"
    path.write_text(SHADER.replace("{loop}", "\n".join("    " + line for line in loop.split("\n"))))
    pipeline = passes.run(link([compile_file(str(path)).module], ["__raygen__main"], PipelineOptions()))
    found = [polls(one) for one in statements(pipeline.programs[0].body) if isinstance(one, While | ForRange)]
    assert found == expected
    assert [ends_in_loop(helper.body) for helper in pipeline.helpers if helper.name == "endless"] == [True]
    assert not any(ends_in_loop(helper.body) for helper in pipeline.helpers if helper.name == "half")
