"""Workloads of the OptiX paper with known results: a white furnace, photons that are conserved, lines of sight against brute force."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import workloads_shader as shader

import optixc as ox

OBJECTS = 4096
NOTHING = {
    "radiance": np.zeros((0, 0), np.float32), "bounces": np.zeros((0, 0), np.uint32), "deposits": np.zeros(0, shader.Deposit.dtype),
    "count": np.zeros(1, np.uint32), "fates": np.zeros(3, np.uint32), "points": np.zeros((0, 3), np.float32),
    "sight": np.zeros((0, 0), np.uint8), "reverse": False, "albedo": 1.0}


@pytest.fixture(scope="module")
def context() -> ox.DeviceContext:
    return ox.DeviceContext()


@pytest.fixture(scope="module")
def groups(context: ox.DeviceContext) -> dict[str, Any]:
    module = context.module_create(shader)
    create = context.program_group_create
    made = {name: create(**{name.split("__")[1]: module[name]}) for name in module}
    return made | {"empty": create(miss=None)}


def pipeline_of(context: ox.DeviceContext, groups: list[Any], simd: Any, depth: int) -> Any:
    try:
        return context.pipeline_create(groups, simd=simd, max_trace_depth=depth)
    except ox.NotSupportedError as reason:
        pytest.skip(str(reason))


def box(low: float, high: float, shift: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> np.ndarray:
    """The twelve triangles of a cube."""
    faces = []
    for axis in range(3):
        for side in (low, high):
            corners = np.zeros((4, 3))
            corners[:, axis] = side
            corners[:, (axis + 1) % 3] = [low, high, high, low]
            corners[:, (axis + 2) % 3] = [low, low, high, high]
            faces += [corners[[0, 1, 2]], corners[[0, 2, 3]]]
    return (np.concatenate(faces) + shift).astype(np.float32)


@pytest.mark.parametrize("simd", [1, 8, 16])
def test_T289_a_white_furnace_is_as_bright_as_its_walls(context: ox.DeviceContext, groups: dict[str, Any], simd: int) -> None:
    """Where everything reflects all light and all light around is 1, each point sees 1; no program traces from a hit."""
    used = [groups[name] for name in ("__raygen__furnace", "__closesthit__scatter", "__miss__white")]
    pipeline = pipeline_of(context, used, simd, depth=1)
    floor = np.array([[-4, 0, -4], [4, 0, -4], [4, 0, 4], [-4, 0, -4], [4, 0, 4], [-4, 0, 4]], np.float32)
    boxes = [box(0.0, 1.0), box(0.0, 1.0, (1.3, 0.0, 0.2)), box(0.0, 0.8, (-1.2, 0.0, 0.3))]
    accel = context.accel_build([ox.BuildInputTriangles(mesh) for mesh in (floor, *boxes)])
    records = [used[1].record(shader.Surface(mirror)) for mirror in (False, False, True, False)]
    table = ox.ShaderBindingTable(used[0].record(), [used[2].record()], records)
    size = 200
    image, bounces = np.zeros((size, size), np.float32), np.zeros((size, size), np.uint32)
    params = shader.Params(scene=accel, **{**NOTHING, "radiance": image, "bounces": bounces})
    pipeline.launch(params, table, size, size)
    assert bounces.max() < shader.MAX_BOUNCES
    hit = image[bounces > 1].astype(np.float64)
    assert len(hit) > 0.4 * image.size
    assert (bounces > 2).mean() > 0.1
    assert hit.std() > 0.1
    assert abs(hit.mean() - 1.0) <= 4.0 * hit.std() / np.sqrt(len(hit))
    np.testing.assert_allclose(image[bounces == 1], 1.0)

    # The same with less: darker wherever something was hit.
    params.albedo = 0.5
    pipeline.launch(params, table, size, size)
    np.testing.assert_allclose(image[bounces > 1], hit * 0.5 ** (bounces[bounces > 1] - 1.0), rtol=1e-5)


@pytest.mark.parametrize("simd", [1, 8, 16])
def test_T290_photons_are_conserved(context: ox.DeviceContext, groups: dict[str, Any], simd: int) -> None:
    """In a closed box each photon is absorbed or cut off, slots are given once, and iteration stores what recursion stores."""
    names = ("photons_recursive", "photons_iterative")
    raygens = {name: groups[f"__raygen__{name}"] for name in names}
    hits = [groups["__closesthit__photon"], groups["__closesthit__surface"]]
    misses = [groups["__miss__photon"], groups["empty"]]
    pipeline = pipeline_of(context, [*raygens.values(), *hits, *misses], simd, depth=shader.PHOTON_DEPTH)
    accel = context.accel_build([ox.BuildInputTriangles(box(-1.0, 1.0))])
    photons, albedo = 30000, 0.6
    stored = {}
    for name, raygen in raygens.items():
        deposits = np.zeros(4 * photons, shader.Deposit.dtype)
        count, fates = np.zeros(1, np.uint32), np.zeros(3, np.uint32)
        params = shader.Params(scene=accel, **{**NOTHING, "deposits": deposits, "count": count, "fates": fates, "albedo": albedo})
        table = ox.ShaderBindingTable(raygen.record(), [one.record() for one in misses], [one.record() for one in hits])
        pipeline.launch(params, table, photons)
        assert fates.sum() == photons
        assert fates[shader.ESCAPED] == 0
        assert count[0] < len(deposits)
        assert not deposits[count[0] :]["position"].any()
        keys = deposits["photon"][: count[0]].astype(np.int64) * shader.PHOTON_DEPTH + deposits["bounce"][: count[0]]
        assert len(np.unique(keys)) == count[0]
        stored[name] = deposits[: count[0]][np.argsort(keys)]
        # Power kept at each scattering: a geometric series, cut at the depth; what a photon leaves is its number of scatterings.
        visits = np.bincount(deposits["photon"][: count[0]], minlength=photons)
        expected = (1.0 - albedo**shader.PHOTON_DEPTH) / (1.0 - albedo)
        assert abs(visits.mean() - expected) <= 4.0 * visits.std() / np.sqrt(photons)
        assert visits.min() == 1
        assert abs(fates[shader.CUT] / photons - albedo**shader.PHOTON_DEPTH) <= 4.0 * np.sqrt(albedo**shader.PHOTON_DEPTH / photons)
    assert stored[names[0]].tobytes() == stored[names[1]].tobytes()


def nearest_edge(origin: np.ndarray, target: np.ndarray, triangles: np.ndarray) -> tuple[bool, float]:
    """Whether a triangle stands between two points, and how near the segment came to an edge, an end or a plane seen edge-on."""
    direction = target - origin
    edges = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    p = np.cross(direction, edges[1])
    determinant = np.einsum("ij,ij->i", p, edges[0])
    s = origin - triangles[:, 0]
    u = np.einsum("ij,ij->i", s, p) / determinant
    q = np.cross(s, edges[0])
    v = q @ direction / determinant
    t = np.einsum("ij,ij->i", q, edges[1]) / determinant
    inside = np.minimum.reduce([u, v, 1.0 - u - v, t, 1.0 - t])
    return bool((inside > 0.0).any()), float(np.abs(inside).min())


def test_T291_lines_of_sight_between_all_pairs(context: ox.DeviceContext, groups: dict[str, Any]) -> None:
    """Every pair of 4096 points, 8,388,608 rays: the same from both ends, and as brute force has it."""
    random = np.random.default_rng(291)
    triangles = random.uniform(-1, 1, (300, 1, 3)) + random.uniform(-0.12, 0.12, (300, 3, 3))
    points = random.uniform(-1, 1, (OBJECTS, 3)).astype(np.float32)
    raygen, hit, miss = (groups[name] for name in ("__raygen__sight", "__anyhit__block", "empty"))
    pipeline = pipeline_of(context, [raygen, hit, miss], "auto", depth=1)
    accel = context.accel_build([ox.BuildInputTriangles(triangles.reshape(-1, 3).astype(np.float32))])
    table = ox.ShaderBindingTable(raygen.record(), [miss.record()], [hit.record()])
    sight = np.zeros((OBJECTS // 2, OBJECTS), np.uint8)
    params = shader.Params(scene=accel, **{**NOTHING, "points": points, "sight": sight})
    pipeline.launch(params, table, OBJECTS, OBJECTS // 2)
    assert sight.size == 8388608
    assert 0.2 < sight.mean() < 0.9

    exact = triangles.astype(np.float32).astype(np.float64)

    def judge(row: int, column: int) -> tuple[bool, float]:
        return nearest_edge(points[column].astype(np.float64), points[(column + 1 + row) % OBJECTS].astype(np.float64), exact)

    # The last row pairs each point with the one opposite, so it holds every pair from both ends.
    forth = sight.copy()
    params.reverse = True
    pipeline.launch(params, table, OBJECTS, OBJECTS // 2)
    unlike = [(row, column) for row, column in np.argwhere(forth != sight)]
    unlike += [(OBJECTS // 2 - 1, column) for column in np.flatnonzero(forth[-1] != np.roll(forth[-1], OBJECTS // 2))]
    assert len(unlike) < 100
    # binary32 knows coordinates of this size to 1e-7, and barycentrics of triangles a tenth as large to about 1e-5
    assert all(judge(row, column)[1] < 1e-5 for row, column in unlike)
    for row, column in random.integers(0, (OBJECTS // 2, OBJECTS), (2000, 2)):
        blocked, margin = judge(row, column)
        assert bool(forth[row, column]) != blocked or margin < 1e-5
