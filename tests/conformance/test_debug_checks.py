"""Checks of debug builds: what a failing one names, in scalar code and in packets; breakpoints in the interpreter."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import optixc as ox

SHADER = '''import optixc as ox
from optixc import float3


@ox.struct
class Params:
    out: ox.Array[float3]
    table: ox.Array2[ox.int32]
    scene: ox.Traversable
    n: int


@ox.payload
class Ray:
    color: float3


params = ox.launch_params(Params)


@ox.device
def ratio(a: float, b: float) -> float:
    return a / b  # helper


@ox.program
def __raygen__compares():
    k = int(ox.get_launch_index().x) * 3
    low = 2 * k - 1
    assert k < 15 and low + 1 < params.n, "k is too large"  # compares


@ox.program
def __raygen__vectors():
    v = float3(float(ox.get_launch_index().x), 2.0, 3.0)
    assert v != float3(7.0, 2.0, 3.0)  # vectors


@ox.program
def __raygen__index():
    k = int(ox.get_launch_index().x)
    params.table[k, k + 1] = 1  # index


@ox.program
def __raygen__names():
    x = float(ox.get_launch_index().x) - 9.0
    if x < 0.0:
        x = -x
    else:
        y = ox.sqrt(x - 1.0)  # names
        x = y


@ox.program
def __raygen__fields():
    ray = Ray(float3(0.0))
    x = float(ox.get_launch_index().x)
    ray.color.y = (x - 4.0) / (x - 4.0)  # fields


@ox.program
def __raygen__stores():
    i = ox.get_launch_index().x
    x = float(i)
    params.out[i] = float3(1.0, 2.0, (x - 7.0) / (x - 7.0))  # stores


@ox.program
def __raygen__results():
    x = float(ox.get_launch_index().x)
    y = 1.0 + ratio(x - 2.0, x * 0.0)


@ox.program
def __raygen__rays():
    x = float(ox.get_launch_index().x)
    ray = Ray(float3(0.0))
    ox.trace(params.scene, float3(0.0), ox.normalize(float3(0.0, x, x * ox.inf)), payload=ray)  # rays


@ox.program
def __raygen__branches():
    x = float(ox.get_launch_index().x)
    if x > 100.0 or (x - 6.0) / (x - 6.0) > 3.0:
        params.out[0] = float3(x)
    if not (x - 5.0) / (x - 5.0) > 3.0 and x > 200.0:  # branches
        params.out[0] = float3(x)


@ox.program
def __raygen__loops():
    x = float(ox.get_launch_index().x)
    y = 0.0
    while (x - 3.0) / (x - 3.0) > y:  # loops
        y += 1.0


@ox.program
def __raygen__stops():
    k = int(ox.get_launch_index().x) + 40
    breakpoint()  # stops
    params.out[0] = float3(float(k))
'''
HELPER = """import optixc as ox


@ox.device
def f(a: float) -> float:
    b = a * 2.0
    breakpoint()
    return b


print("result", f(4.0))
"""
FAILURES = {
    "compares": ("k is too large (k = 15, low + 1 = 30, params.n = 99)", 5),
    "vectors": ("v != float3(7.0, 2.0, 3.0) (v.x = 7, v.y = 2, v.z = 3)", 7),
    "index": ("index out of range (4, 5), the shape is (4, 9)", 4),
    "names": ("y is NaN (x = 0)", 9),
    "fields": ("ray.color.y is NaN (x = 4)", 4),
    "stores": ("an element of params.out is NaN (x = 7)", 7),
    "helper": ("the result of ratio is NaN (a = 0, b = 0)", 2),
    "branches": ("(x - 5.0) / (x - 5.0) in a condition is NaN (x = 5)", 5),
    "loops": ("(x - 3.0) / (x - 3.0) in a condition is NaN (x = 3)", 3),
    "rays": ("direction of trace is NaN (x = 0)", 0),
}
PROGRAM_OF = {"helper": "results"}


@ox.struct
class Params:
    out: ox.Array[ox.float3]
    table: ox.Array2[ox.int32]
    scene: ox.Traversable
    n: int


class Shaders:
    """All programs in one pipeline for each choice of options, and launch parameters for them."""

    def __init__(self, folder: Path) -> None:
        self.path = folder / "checked.py"
        self.path.write_text(SHADER)
        self.context = ox.DeviceContext(threads=1)
        self.module = self.context.module_create(self.path)
        self.out = np.zeros((16, 3), np.float32)
        self.params = Params(out=self.out, table=np.zeros((4, 9), np.int32), scene=0, n=99)
        names = re.findall(r"def (__raygen__\w+)", SHADER)
        self.groups = {name: self.context.program_group_create(raygen=self.module[name]) for name in names}
        self.pipelines: dict[str, Any] = {}

    def line(self, name: str) -> int:
        """The line that ends with this comment."""
        return next(number for number, line in enumerate(SHADER.splitlines(), 1) if line.endswith(f"  # {name}"))

    def pipeline(self, name: str, **options: Any) -> tuple[Any, Any]:
        key = repr(options)
        if key not in self.pipelines:
            self.pipelines[key] = self.context.pipeline_create(list(self.groups.values()), **options)
        return self.pipelines[key], ox.ShaderBindingTable(raygen=self.groups[f"__raygen__{name}"].record())


@pytest.fixture(scope="module")
def shaders(tmp_path_factory: pytest.TempPathFactory) -> Shaders:
    return Shaders(tmp_path_factory.mktemp("checked"))


@pytest.mark.parametrize("lanes", [1, 8, 16])
@pytest.mark.parametrize("name", FAILURES)
def test_failing_check_names_place_index_and_values(shaders: Shaders, name: str, lanes: int) -> None:
    message, index = FAILURES[name]
    pipeline, table = shaders.pipeline(PROGRAM_OF.get(name, name), debug=True, trap_nan=True, simd=lanes)
    with pytest.raises(ox.LaunchFailureError) as caught:
        pipeline.launch(shaders.params, table, width=index + 1)
    assert message in str(caught.value)
    assert f"{shaders.path}:{shaders.line(name)}: " in str(caught.value)
    assert f"launch index ({index}, 0, 0)" in str(caught.value)
    if index:
        pipeline.launch(shaders.params, table, width=index)


@pytest.mark.parametrize("name", ["names", "fields", "stores", "results", "rays"])
def test_nans_are_values_unless_asked(shaders: Shaders, name: str) -> None:
    pipeline, table = shaders.pipeline(name, debug=True)
    pipeline.launch(shaders.params, table, width=16)


def test_traps_are_for_debug_builds(shaders: Shaders) -> None:
    with pytest.raises(ox.InvalidValueError, match="debug=True"):
        shaders.pipeline("names", trap_nan=True)


@pytest.mark.parametrize("lanes", [1, 8])
def test_breakpoint_is_nothing_in_compiled_code(shaders: Shaders, lanes: int) -> None:
    pipeline, table = shaders.pipeline("stops", debug=True, simd=lanes)
    pipeline.launch(shaders.params, table, width=1)
    assert shaders.out[0, 0] == 40.0


def test_breakpoint_stops_the_interpreter(shaders: Shaders, monkeypatch: pytest.MonkeyPatch) -> None:
    """The author's file, line and locals are seen where it stops."""
    seen: list[tuple[str, int, int]] = []

    def stop() -> None:
        frame = sys._getframe(1)
        seen.append((frame.f_code.co_filename, frame.f_lineno, int(frame.f_locals["k"])))

    monkeypatch.setattr(sys, "breakpointhook", stop)
    pipeline, table = shaders.pipeline("stops")
    ox.interpret(pipeline, shaders.params, table, (5, 1, 1), (3, 0, 0))
    assert seen == [(str(shaders.path), shaders.line("stops"), 43)]
    assert shaders.out[0, 0] == 43.0


def test_breakpoint_under_pdb(tmp_path: Path) -> None:
    """Plain `breakpoint()`, as a user at a terminal has it."""
    path = tmp_path / "helper.py"
    path.write_text(HELPER)
    result = subprocess.run([sys.executable, str(path)], input="p b\nc\n", capture_output=True, text=True, check=True)
    assert "8.0" in result.stdout.split("result")[0]
    assert f"{path}(8)f()" in result.stdout or f"{path}(7)f()" in result.stdout
    assert "result 8.0" in result.stdout
