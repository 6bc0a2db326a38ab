"""Example 05 against an independent renderer, pixel by pixel."""

from __future__ import annotations

import importlib
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from whitted_reference import Renderer

import optixc as ox

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "05_whitted_spheres"
SIZE = 40


@pytest.fixture
def reference(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The example's scene in the reference renderer."""
    monkeypatch.syspath_prepend(str(EXAMPLE))
    for name in ("shader", "host"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    shader, host = importlib.import_module("shader"), importlib.import_module("host")
    yield Renderer(host, shader)
    for name in ("shader", "host"):
        sys.modules.pop(name, None)


def test_T288_whitted_spheres_match_an_independent_renderer(library: Any, reference: Any, tmp_path: Path) -> None:
    command = [sys.executable, EXAMPLE / "host.py", "--size", str(SIZE), "--samples", "1", "--output", tmp_path / "a.exr"]
    subprocess.run(command, check=True, capture_output=True)
    image = ox.read_image(tmp_path / "a.exr")[:, :, :3]

    # The same point of each pixel: sample 0 of the sequence with the pixel's number as seed
    seeds = np.column_stack([np.zeros(SIZE * SIZE), np.arange(SIZE * SIZE)])
    jitter = library.run("sobol", seeds)[:, :2].reshape(SIZE, SIZE, 2).astype(np.float64)
    camera = reference.host.pinhole(reference.host.EYE, reference.host.TARGET, reference.host.VERTICAL_FOV, 1.0)
    eye, u, v, w = (np.array(value, np.float64) for value in (camera.eye, camera.u, camera.v, camera.w))
    expected = np.empty_like(image, np.float64)
    for row in range(SIZE):
        for column in range(SIZE):
            x = 2.0 * (column + jitter[row, column, 0]) / SIZE - 1.0
            y = 1.0 - 2.0 * (row + jitter[row, column, 1]) / SIZE
            direction = x * u + y * v + w
            expected[row, column] = reference.radiance(eye, direction / np.linalg.norm(direction))

    # Binary32 loses about eight bits over a chain of bounces off curved surfaces; a ray beside an edge may take the other side of it
    error = np.abs(image - expected).max(axis=2)
    assert np.median(error) < 1e-5
    assert np.count_nonzero(error > 2e-3) <= 0.01 * error.size


def test_T288_the_shadow_of_glass_is_lighter_than_that_of_metal(reference: Any) -> None:
    floor_points = {}
    for row in (0, 1):
        x, y, z, _ = reference.spheres[row]
        center = np.array([x, y, z])
        along = center - reference.light
        floor_points[row] = center + along * (y / (reference.light[1] - y))
    metal, glass = (reference.through(floor_points[row]) for row in (0, 1))
    assert (metal == 0.0).all()
    assert (glass > 0.5).all()
    assert (glass < 1.0).all()
