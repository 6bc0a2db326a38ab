"""Checks of items in debug builds: fixed arrays, vectors and matrices by an index that is out of range, in scalar code and in packets."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import optixc as ox

SHADER = '''import optixc as ox
from optixc import float3, int32


@ox.struct
class Small:
    a: int32
    v: float3


@ox.struct
class Params:
    out: ox.Array[int32]
    n: int32


params = ox.launch_params(Params)


@ox.device
def bump(s: Small) -> int32:
    s.a += 1
    return s.a


@ox.program
def __raygen__read():
    k = int(ox.get_launch_index().x)
    a = ox.FixedArray[int32, 4](1, 2, 3, 4)
    params.out[k] = a[k]  # read


@ox.program
def __raygen__write():
    k = int(ox.get_launch_index().x)
    a = ox.FixedArray[int32, 4](1, 2, 3, 4)
    a[k] = 9  # write
    params.out[k] = a[0]


@ox.program
def __raygen__shared():
    a = ox.FixedArray[int32, 4](1, 2, 3, 4)
    a[params.n] = 9  # shared
    params.out[int(ox.get_launch_index().x)] = a[0]


@ox.program
def __raygen__vector():
    k = int(ox.get_launch_index().x)
    v = float3(1.0, 2.0, 3.0)
    params.out[k] = int(v[k])  # vector


@ox.program
def __raygen__component():
    k = int(ox.get_launch_index().x)
    v = float3(1.0, 2.0, 3.0)
    v[k] += 1.0  # component
    params.out[k] = int(v.x)


@ox.program
def __raygen__helper():
    k = int(ox.get_launch_index().x)
    a = ox.FixedArray[Small, 3]()
    x = bump(a[k])  # helper
    params.out[k] = x


@ox.program
def __raygen__same():
    a = ox.FixedArray[Small, 3]()
    x = bump(a[params.n])  # same
    params.out[int(ox.get_launch_index().x)] = x + a[0].a


@ox.program
def __raygen__fine():
    k = int(ox.get_launch_index().x)
    a = ox.FixedArray[Small, 3]()
    a[k % 3].v[k % 2] = 2.0
    m = ox.float3x3()
    m[k % 3][params.n % 3] += 1.0
    x = bump(a[k % 3]) + bump(a[params.n % 3])
    params.out[k] = x + int(a[k % 3].v.x + m[k % 3].x) if k % 3 < 2 or a[k % 3].a > 0 else 7
'''
WRONG = {
    "read": (4, 4, 4),
    "write": (4, 4, 4),
    "shared": (0, 7, 4),
    "vector": (3, 3, 3),
    "component": (3, 3, 3),
    "helper": (3, 3, 3),
    "same": (0, 7, 3),
}
"""Program: the launch index that is told, the wrong index, how many items there are."""


@pytest.fixture(scope="module")
def shader(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("items") / "shader.py"
    path.write_text(SHADER)
    return path


@pytest.fixture(scope="module")
def params() -> Any:
    return ox.struct(type("Params", (), {"__annotations__": {"out": ox.Array[ox.int32], "n": ox.int32}}))


def launch(path: Path, params: Any, lanes: int, *names: str) -> dict[str, Any]:
    """What each program wrote, or the error of its launch."""
    context = ox.DeviceContext(threads=1)
    module = context.module_create(path)
    groups = {name: context.program_group_create(raygen=module[f"__raygen__{name}"]) for name in names}
    pipeline = context.pipeline_create(list(groups.values()), simd=lanes, debug=True)
    found: dict[str, Any] = {}
    for name, group in groups.items():
        out = np.zeros(21, np.int32)
        try:
            pipeline.launch(params(out, 7), ox.ShaderBindingTable(raygen=group.record()), width=21)
            found[name] = out.tolist()
        except ox.OptixError as error:
            found[name] = error
    return found


@pytest.mark.parametrize("lanes", [1, 8, 16])
def test_a_wrong_index_is_told(shader: Path, params: Any, lanes: int) -> None:
    found = launch(shader, params, lanes, *WRONG)
    lines = SHADER.splitlines()
    for name, (index, wrong, count) in WRONG.items():
        line = next(number for number, text in enumerate(lines, 1) if text.endswith(f"# {name}"))
        place = f"shader.py:{line}: __raygen__{name}, launch index ({index}, 0, 0)"
        assert f"{place}: index out of range ({wrong}), there are {count} items" in str(found[name])


def test_right_indices_are_as_without_checks(shader: Path, params: Any) -> None:
    expected = [4, 3, 4, 2, 5, 2, 4, 3, 4, 2, 5, 2, 4, 3, 4, 2, 5, 2, 4, 3, 4]
    for lanes in (1, 8, 16):
        assert launch(shader, params, lanes, "fine")["fine"] == expected
