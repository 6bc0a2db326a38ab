"""Any-hit programs run as often as geometry says: by the formula of Cauchy and Crofton, lines through a sphere of radius R meet a surface
of area A inside of it A / (2 pi R^2) times on average. The bound is five standard errors of the mean, from the counts themselves."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from harness import Harness
from shaders import crossings as shader

import optixc as ox

LINES = 60_000
SCENES = Path(os.environ.get("OXRT_SCENES_DIR", Path(__file__).resolve().parents[2] / ".." / "shared" / "scenes"))
SINGLE = ox.GeometryFlags.REQUIRE_SINGLE_ANYHIT_CALL
Count = Callable[[list[Any], np.ndarray, float], np.ndarray]


@pytest.fixture
def count(harness: Harness) -> Count:
    """Crossings of each of many lines through a sphere about a point with the build inputs, in one mode."""
    if harness.mode == "interpreter":
        pytest.skip("interpreting this many lines takes minutes")
    context, module = harness.context, harness.module("crossings.py")
    groups = [
        context.program_group_create(raygen=module["__raygen__lines"]),
        context.program_group_create(miss=None),
        context.program_group_create(anyhit=module["__anyhit__count"]),
    ]
    pipeline = harness.pipeline("crossings", groups)
    raygen, miss, hit = groups
    table = ox.ShaderBindingTable(raygen=raygen.record(), miss=[miss.record()], hitgroup=[hit.record()])

    def run(inputs: list[Any], center: np.ndarray, radius: float) -> np.ndarray:
        origins, directions = lines(center, radius)
        counts = np.zeros(LINES, np.uint32)
        params = shader.Params(
            origins=origins, directions=directions, counts=counts, scene=context.accel_build(inputs), length=3.0 * radius
        )
        pipeline.launch(params, table, width=LINES)
        return counts

    return run


def lines(center: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Lines by the measure that motions leave alone: uniform directions, uniform places on the disc across them."""
    random = np.random.default_rng(12)
    direction = random.normal(size=(LINES, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    side = np.cross(direction, np.eye(3)[np.abs(direction).argmin(axis=1)])
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    distance, angle = radius * np.sqrt(random.random((LINES, 1))), random.uniform(0.0, 2.0 * np.pi, (LINES, 1))
    aside = distance * (np.cos(angle) * side + np.sin(angle) * np.cross(direction, side))
    return (center + aside - 1.5 * radius * direction).astype(np.float32), direction.astype(np.float32)


def agree(counts: np.ndarray, area: float, radius: float) -> bool:
    """Whether the mean is that of the formula."""
    error = counts.std() / np.sqrt(len(counts))
    return abs(counts.mean() - area / (2.0 * np.pi * radius**2)) < 5.0 * error


def mesh_area(vertices: np.ndarray, triangles: np.ndarray) -> float:
    corners = vertices[triangles].astype(np.float64)
    return float(0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum())


def around(vertices: np.ndarray) -> tuple[np.ndarray, float]:
    """A sphere that holds all vertices."""
    center = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0)).astype(np.float64)
    return center, float(np.linalg.norm(vertices - center, axis=1).max()) * 1.001


def test_crossings_of_a_made_mesh(count: Count) -> None:
    # Sheets, folded and through each other: the formula knows no inside
    random = np.random.default_rng(3)
    u, v = np.meshgrid(np.linspace(-1.0, 1.0, 40), np.linspace(-1.0, 1.0, 40))
    waves = random.uniform((0.2, 3.0, 3.0), (0.5, 9.0, 9.0), (5, 3))
    sheets = [np.stack([u, v, height * np.sin(a * u + b * v)], -1) for height, a, b in waves]
    vertices = np.concatenate([sheet.reshape(-1, 3) for sheet in sheets]).astype(np.float32)
    row, column = np.meshgrid(np.arange(39), np.arange(39), indexing="ij")
    corner = (40 * row + column).reshape(-1, 1)
    cells = np.concatenate([corner + np.array(offsets) for offsets in ([0, 1, 41], [0, 41, 40])])
    triangles = np.concatenate([cells + 1600 * number for number in range(5)]).astype(np.uint32)
    center, radius = around(vertices)
    counts = count([ox.BuildInputTriangles(vertices, triangles, flags=SINGLE)], center, radius)
    assert counts.max() > 4
    assert agree(counts, mesh_area(vertices, triangles), radius)


def test_crossings_of_a_sphere_of_lines(count: Count) -> None:
    # Only where a line enters, which is half of its crossings
    random = np.random.default_rng(5)
    centers = random.uniform(-1.0, 1.0, (60, 3)).astype(np.float32)
    radii = random.uniform(0.05, 0.3, 60).astype(np.float32)
    counts = count([ox.BuildInputSpheres(centers, radii, flags=SINGLE)], np.zeros(3), 2.1)
    assert agree(counts, float(2.0 * np.pi * (radii.astype(np.float64) ** 2).sum()), 2.1)


def test_crossings_of_a_tube(count: Count) -> None:
    # A closed ring of a cubic B-spline of constant radius has no ends: its area is its length times the circumference (Pappus)
    points, radius = 64, 0.04
    angle = 2.0 * np.pi * np.arange(points + 3) / points
    vertices = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1).astype(np.float32)
    firsts = np.arange(points, dtype=np.uint32)
    tube = ox.BuildInputCurves(
        ox.PrimitiveType.ROUND_CUBIC_BSPLINE, vertices, np.full(points + 3, radius, np.float32), firsts, flags=SINGLE
    )
    # The mean of three neighbours with weights 1, 4, 1 pulls the circle in by this much
    inner = (4.0 + 2.0 * np.cos(2.0 * np.pi / points)) / 6.0
    area = 2.0 * np.pi * inner * 2.0 * np.pi * radius
    assert agree(count([tube], np.zeros(3), 1.2), 0.5 * area, 1.2)


@pytest.mark.parametrize("name", ["bunny", "dragon_res2", "sponza", "sibenik"])
def test_crossings_of_real_meshes(count: Count, name: str) -> None:
    path = SCENES / f"{name}.npz"
    if not path.is_file():
        pytest.skip(f"no {path}: set OXRT_SCENES_DIR to the folder of the benchmark scenes")
    with np.load(path) as arrays:
        vertices = np.ascontiguousarray(arrays["vertices"], np.float32)
        triangles = np.ascontiguousarray(arrays["triangles"], np.uint32)
    center, radius = around(vertices[np.unique(triangles)])
    counts = count([ox.BuildInputTriangles(vertices, triangles, flags=SINGLE)], center, radius)
    assert agree(counts, mesh_area(vertices, triangles), radius)
