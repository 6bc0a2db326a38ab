"""Helpers with the prefix `__optix_enabled__`: functions of their own in the machine code, with the results of any other."""

from __future__ import annotations

import numpy as np
import pytest
from harness import SHADERS, Harness
from shaders import not_inlined as shader

import optixc as ox
from optixc.cli import main

COUNT = 40


def test_results(harness: Harness) -> None:
    module, create = harness.module("not_inlined.py"), harness.context.program_group_create
    raygen, hit, miss = (create(**{name.split("__")[1]: module[name]}) for name in ("__raygen__r", "__closesthit__c", "__miss__m"))
    pipeline = harness.pipeline("not inlined", [raygen, hit, miss])
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
    scene = harness.context.accel_build([ox.BuildInputTriangles(corners)])
    out, hits = np.zeros(COUNT, np.float32), np.zeros(1, np.uint32)
    table = ox.ShaderBindingTable(raygen.record(), [miss.record()], [hit.record()])
    harness.launch(pipeline, shader.Params(scene, out, hits), table, COUNT)
    for i in range(COUNT):
        steps, is_hit = i % 5, 0.0 < 0.05 * i < 0.8
        if abs(0.05 * i - 0.8) < 1e-6 or i == 0:
            continue  # on an edge
        traced = 4.0 + i if is_hit else 9.0
        assert out[i] == sum(step * step for step in range(steps)) + 100.0 * steps + 1000.0 * traced + (0.5 if is_hit else 0.0)
    assert hits[0] == np.count_nonzero(out % 1.0)


@pytest.mark.parametrize("simd", ["1", "8", "16"])
def test_they_are_functions_of_their_own(capsys: pytest.CaptureFixture[str], simd: str) -> None:
    assert main([str(SHADERS / "not_inlined.py"), "--emit", "cpp", "--simd", simd]) == 0
    text = capsys.readouterr().out
    for name in ("square", "add", "column", "blocked"):
        lines = [line for line in text.splitlines() if f" optix_enabled_{name}" in line and not line.startswith(" ")]
        assert lines
        assert all("__attribute__((noinline))" in line for line in lines)
