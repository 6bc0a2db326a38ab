"""Programs whose lanes part in many ways at once: long matches, chains of conditions, many hit groups and callables, loops left in many
places. Masks that exclude each other are what clang 19 was seen never to end on."""

from __future__ import annotations

import importlib.util
import shutil
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import optixc as ox

ARMS = 24
COUNT = 8 * ARMS


def source() -> str:
    """The shader file: arm n of everything gives a result of its own."""
    arms = range(ARMS)
    match = "".join(f"        case {n}:\n            result = {n * n}\n" for n in arms)
    chain = "".join(f"    {'if' if n == 0 else 'elif'} x < {n + 0.5}:\n        result = {3 * n + 1}\n" for n in arms)
    leave = "".join(f"        if i + step == {7 * n}:\n            {('break', 'continue', f'return {n}')[n % 3]}\n" for n in arms)
    traces = "".join(f"    {'if' if n == 0 else 'elif'} ray.kind == {n}:\n        ray.total += {n}\n        ray.kind = {(n * 5) % ARMS}\n"
                     for n in arms)
    hits = "".join(f"@ox.program\ndef __closesthit__c{n}(ray: Ray):\n    ray.total += {n + 100}\n    ray.kind = {(n * 7) % ARMS}\n\n\n"
                   for n in arms)
    misses = "".join(f"@ox.program\ndef __miss__m{n}(ray: Ray):\n    ray.total += {n + 1000}\n\n\n" for n in arms)
    calls = "".join(f"@ox.program\ndef __direct_callable__d{n}(x: int) -> int:\n    return x * {n} + {n}\n\n\n" for n in arms)
    return f"""import optixc as ox
from optixc import Array, float3, int32, uint32


@ox.struct
class Params:
    scene: ox.Traversable
    out: Array[int32]
    keys: Array[int32]


@ox.payload
class Ray:
    total: int32
    kind: int32


params = ox.launch_params(Params)


@ox.device
def by_match(i: int) -> int:
    result = -1
    match i:
{match}        case _:
            result = -2
    return result


@ox.device
def by_chain(x: float) -> int:
    result = -1
{chain}    else:
        result = -3
    return result


@ox.device
def by_leaving(i: int) -> int:
    count = 0
    for step in range(40):
{leave}        count += 1
    return -count


@ox.program
def __raygen__r():
    i = int(ox.get_launch_index().x)
    key = params.keys[i]
    ray = Ray(0, key)
    origin, direction = float3(float(key) + 0.25, 0.25, 1.0), float3(0.0, 0.0, -1.0 if i % 3 != 0 else 1.0)
    ox.traverse(params.scene, origin, direction, miss_sbt_index=uint32(key), payload=ray)
    if ox.hit_object_is_hit():
        ray.total += 10000
    elif ox.hit_object_is_miss():
        ray.total += 20000
    elif ox.hit_object_is_nop():
        ray.total += 30000
    ox.invoke(payload=ray)
{traces}    called = ox.direct_call(uint32((key * 5) % {ARMS}), i, result=int32)
    params.out[4 * i] = by_match(key)
    params.out[4 * i + 1] = by_chain(float(key))
    params.out[4 * i + 2] = by_leaving(i)
    params.out[4 * i + 3] = ray.total + 7 * called


{hits}{misses}{calls}"""


def left(i: int) -> int:
    """`by_leaving` in Python."""
    count = 0
    for step in range(40):
        arm, rest = divmod(i + step, 7)
        if rest == 0 and arm < ARMS:
            if arm % 3 == 0:
                break
            if arm % 3 == 1:
                continue
            return arm
        count += 1
    return -count


def expected(i: int, key: int) -> list[int]:
    is_hit = i % 3 != 0
    total = 10000 + key + 100 if is_hit else 20000 + key + 1000
    kind = (key * 7) % ARMS if is_hit else key
    call = (key * 5) % ARMS
    return [key * key, 3 * key + 1, left(i), total + kind + 7 * (i * call + call)]


def load(path: Path) -> Any:
    spec = importlib.util.spec_from_file_location("many_arms_shader", path)
    assert spec is not None and spec.loader is not None
    module = sys.modules["many_arms_shader"] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("compiler", ["clang++", "g++"])
@pytest.mark.parametrize("simd", [1, 8, 16])
def test_many_arms(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, simd: int, compiler: str) -> None:
    monkeypatch.setenv("OPTIXC_CXX", newest(compiler))
    path = tmp_path / "many_arms_shader.py"
    path.write_text(source())
    shader = load(path)
    context = ox.DeviceContext()
    module, create = context.module_create(path), context.program_group_create
    of_kind = {kind: [create(**{kind: module[name]}) for name in module if name.startswith(f"__{kind}__")]
               for kind in ("raygen", "closesthit", "miss", "direct_callable")}
    pipeline = context.pipeline_create([group for groups in of_kind.values() for group in groups], simd=simd)
    corners = np.array([[[n, 0, 0], [n + 0.9, 0, 0], [n, 0.9, 0]] for n in range(ARMS)], np.float32)
    scene = context.accel_build([ox.BuildInputTriangles(one) for one in corners])
    random = np.random.default_rng(19)
    table = ox.ShaderBindingTable(of_kind["raygen"][0].record(), [one.record() for one in of_kind["miss"]],
                                  [one.record() for one in of_kind["closesthit"]], [one.record() for one in of_kind["direct_callable"]])
    for keys in (random.integers(0, ARMS, COUNT), np.arange(COUNT) % ARMS, np.arange(COUNT) // 8):
        out = np.zeros(4 * COUNT, np.int32)
        pipeline.launch(shader.Params(scene, out, keys.astype(np.int32)), table, COUNT)
        assert out.reshape(COUNT, 4).tolist() == [expected(i, int(key)) for i, key in enumerate(keys)]


def newest(compiler: str) -> str:
    """The newest compiler of that name, or a skip."""
    found = [name for name in (f"{compiler}-19", compiler, f"{compiler}-16", f"{compiler}-12") if shutil.which(name)]
    if not found:
        pytest.skip(f"no {compiler}")
    return found[0]
