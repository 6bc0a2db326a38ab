"""Words of payloads that nobody reads cost nothing, and leaving them out changes no result."""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import optixc as ox

GOLDEN = Path(__file__).parents[1] / "golden" / "payload_liveness" / "shader.py"
COUNT = 40

TEXT = """import optixc as ox
from optixc import float3


@ox.struct
class Params:
    out: ox.Array[float3]
    scene: ox.Traversable


@ox.payload
class Ray:
    color: float3
{fields}

params = ox.launch_params(Params)


@ox.program
def __raygen__r():
    i = ox.get_launch_index().x
    ray = Ray(float3(float(i)){values})
    ox.trace(params.scene, float3(0.25, 0.25, 0.1 * float(i)), float3(0.0, 0.0, 1.0), payload=ray)
    params.out[i] = ray.color


@ox.program
def __closesthit__c(ray: Ray):
    ray.color = float3(ox.get_ray_tmax())
{stores}

@ox.program
def __anyhit__a(ray: Ray):
    ray.color.x += 1.0
{stores}

@ox.program
def __miss__m(ray: Ray):
    ray.color += 2.0
{stores}
"""
DEAD = "    rest: ox.FixedArray[float, 20]\n    count: int\n", ", ox.FixedArray[float, 20](), int(i) * 7", "    ray.count += 3\n"


def launched(folder: Path, dead: tuple[str, str, str], simd: int, **options: Any) -> tuple[Any, np.ndarray]:
    folder.mkdir()
    path = folder / "shader.py"
    # Equal lines, so that constants of lines do not tell the programs apart.
    path.write_text(TEXT.format(fields=dead[0] or "\n\n", values=dead[1], stores=dead[2] or "\n"))
    context = ox.DeviceContext(threads=1)
    module, create = context.module_create(path), context.program_group_create
    start, miss = create(raygen=module["__raygen__r"]), create(miss=module["__miss__m"])
    hit = create(closesthit=module["__closesthit__c"], anyhit=module["__anyhit__a"])
    pipeline = context.pipeline_create([start, miss, hit], simd=simd, **options)
    table = ox.ShaderBindingTable(start.record(), [miss.record()], [hit.record()])
    mesh = np.array([[0, 0, 2], [1, 0, 2], [0, 1, 2]], np.float32)
    out = np.zeros((COUNT, 3), np.float32)
    pipeline.launch(Params(out=out, scene=context.accel_build([ox.BuildInputTriangles(mesh)])), table, COUNT)
    return pipeline, out


@ox.struct
class Params:
    out: ox.Array[ox.float3]
    scene: ox.Traversable


def code(pipeline: Any, folder: Path) -> bytes:
    text = folder / "text"
    subprocess.run(["objcopy", "-O", "binary", "--only-section=.text", str(pipeline.report().library), str(text)], check=True)
    return text.read_bytes()


@pytest.mark.parametrize("simd", [1, 8, 16])
def test_dead_words_leave_no_code(tmp_path: Path, simd: int) -> None:
    wide, out = launched(tmp_path / "wide", DEAD, simd, checks_bounds=False)
    narrow, expected = launched(tmp_path / "thin", ("", "", ""), simd, checks_bounds=False)
    assert (out == expected).all() and expected[:, 1].max() == 41.0
    assert code(wide, tmp_path) == code(narrow, tmp_path)
    assert "payload Ray of 24 words, 3 of them carried" in wide.report().traces[0]


def test_debug_builds_hold_them(tmp_path: Path) -> None:
    _, out = launched(tmp_path / "wide", DEAD, 1, debug=True)
    _, expected = launched(tmp_path / "narrow", DEAD, 1)
    assert (out == expected).all()


def test_all_ways_agree(tmp_path: Path) -> None:
    results = {}
    for simd in (1, 8, 16, 0):
        context = ox.DeviceContext()
        module, create = context.module_create(GOLDEN), context.program_group_create
        start = create(raygen=module["__raygen__main"])
        misses = [create(miss=module[f"__miss__{name}"]) for name in ("sky", "count")]
        hits = [create(closesthit=module["__closesthit__next"]), create(anyhit=module["__anyhit__count"])]
        pipeline = context.pipeline_create([start, *misses, *hits], max_trace_depth=4, simd=simd or 1)
        table = ox.ShaderBindingTable(start.record(), [miss.record() for miss in misses], [hit.record() for hit in hits])
        walls = [[-9, -9, 2], [9, -9, 2], [0, 9, 2], [2, -9, -9], [2, 9, -9], [2, 0, 9]]
        scene = context.accel_build([ox.BuildInputTriangles(np.array(walls, np.float32))])
        out = np.arange(3 * COUNT, dtype=np.float32).reshape(COUNT, 3)
        params = Params(out=out, scene=scene)
        if simd:
            pipeline.launch(params, table, COUNT)
        else:
            for index in range(COUNT):
                ox.interpret(pipeline, params, table, (COUNT, 1, 1), (index, 0, 0))
        results[simd] = out
    assert results[1].any() and all((result == results[1]).all() for result in results.values())
