"""Area Q: where builds and updates are to be quick, other structures stand below, and the hits are the same."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from harness import Harness
from shaders import quick_builds as shader

import optixc as ox

UPDATE, FAST_BUILD = ox.BuildFlags.ALLOW_UPDATE, ox.BuildFlags.PREFER_FAST_BUILD
COUNT = 400
RAYS = 3000
ROWS, COLUMNS = 65, 64  # instances enough for structures of our own


def hits(harness: Harness, scene: Any, origins: np.ndarray, directions: np.ndarray) -> Any:
    """The parameters after the rays were traced."""
    module, make = harness.module("quick_builds.py"), harness.context.program_group_create
    if "quick builds" not in harness.kept:
        harness.kept["quick builds"] = [
            make(raygen=module["__raygen__each"]), make(miss=module["__miss__note"]), make(closesthit=module["__closesthit__note"])]
    groups = harness.kept["quick builds"]
    pipeline = harness.pipeline("quick builds", groups)
    sbt = ox.ShaderBindingTable(raygen=groups[0].record(), miss=[groups[1].record()], hitgroup=[groups[2].record()])
    count = len(origins)
    integers = [np.zeros(count, np.int32) for _ in range(2)]
    params = shader.Params(scene=scene, origins=origins, directions=directions, primitives=integers[0], instances=integers[1],
                           distances=np.zeros(count, np.float32))
    harness.launch(pipeline, params, sbt, count)
    return params


def some_rays(random: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """A third from one point, a third along axes, a third from anywhere."""
    origins = random.uniform(-1.5, 1.5, (RAYS, 3)).astype(np.float32)
    directions = random.normal(size=(RAYS, 3)).astype(np.float32)
    third = RAYS // 3
    origins[:third] = (0.1, 0.2, 4.0)
    directions[:third] = random.uniform(-1.0, 1.0, (third, 3)) - origins[:third]
    directions[third:2 * third] = np.float32([[1, 0, 0], [0, -1, 0], [0, 0, 1]])[random.integers(0, 3, third)]
    return origins, directions


def curves(kind: ox.PrimitiveType, shift: float) -> list[Any]:
    """Segments here and there, further along their way with `shift`."""
    random = np.random.default_rng(17)
    points = random.uniform(-1, 1, (COUNT, 1, 3)) + random.normal(0, 0.15, (COUNT, 4, 3)) + shift * random.normal(0, 0.2, (COUNT, 1, 3))
    firsts = np.arange(0, 4 * COUNT, 4, dtype=np.uint32)
    radii = random.uniform(0.01, 0.05, 4 * COUNT).astype(np.float32)
    return [ox.BuildInputCurves(kind, points.reshape(-1, 3).astype(np.float32), radii, firsts)]


def below_instances(context: ox.DeviceContext) -> Any:
    """A tetrahedron below one instance, so that the instances above it are our own."""
    corners = np.float32([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    faces = np.uint32([[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]])
    return context.accel_build([ox.BuildInputInstances([ox.Instance(context.accel_build([ox.BuildInputTriangles(corners, faces)]))])])


def placed(child: Any, shift: float) -> list[Any]:
    """Instances in any place, turned and flattened."""
    random = np.random.default_rng(19)
    places = np.concatenate([random.normal(0, 0.15, (COUNT, 3, 3)), random.uniform(-1, 1, (COUNT, 3, 1))], axis=2)
    places[:, :, 3] += shift * random.normal(0, 0.2, (COUNT, 3))
    places[::50] = 0.0  # never hit
    return [ox.BuildInputInstances([child] * COUNT, transforms=places.astype(np.float32))]


@pytest.mark.parametrize("kind", ["rocaps", "ribbons", "instances"])
def test_T110_T239_quick_builds_and_refits_hit_what_other_builds_hit(harness: Harness, kind: str) -> None:
    context = harness.context
    if kind == "instances":
        child = below_instances(context)

        def inputs(shift: float) -> list[Any]:
            return placed(child, shift)
    else:
        curve = ox.PrimitiveType.ROUND_CUBIC_BSPLINE_ROCAPS if kind == "rocaps" else ox.PrimitiveType.FLAT_QUADRATIC_BSPLINE

        def inputs(shift: float) -> list[Any]:
            return curves(curve, shift)

    rays = some_rays(np.random.default_rng(21))
    wanted = [hits(harness, context.accel_build(inputs(shift)), *rays) for shift in (0.0, 1.0)]
    assert 0.1 < np.mean(wanted[0].primitives >= 0) < 0.9
    for flags in (FAST_BUILD, UPDATE, UPDATE | FAST_BUILD):
        scene = context.accel_build(inputs(0.0), build_flags=flags)
        for shift in (0, 1) if flags & UPDATE else (0,):
            if shift:
                scene.update(inputs(1.0))
            found = hits(harness, scene, *rays)
            for name in ("primitives", "instances", "distances"):
                assert np.array_equal(getattr(found, name), getattr(wanted[shift], name)), (flags, shift, name)


def test_many_instances_are_refitted_where_builds_are_to_be_quick(harness: Harness) -> None:
    context = harness.context
    quad = np.float32([[-0.5, -0.5, 0], [0.5, -0.5, 0], [0.5, 0.5, 0], [-0.5, 0.5, 0]])
    child = context.accel_build([ox.BuildInputTriangles(quad, np.uint32([[0, 1, 2], [0, 2, 3]]))])
    count = ROWS * COLUMNS
    number = np.arange(count)
    places = np.zeros((count, 3, 4), np.float32)
    places[:, range(3), range(3)] = 1.0

    def inputs(height: np.ndarray) -> list[Any]:
        places[:, :, 3] = np.stack([number % COLUMNS, number // COLUMNS, height], axis=1)
        return [ox.BuildInputInstances(np.full(count, child.handle, np.uint64), transforms=places.copy())]

    random = np.random.default_rng(23)
    low, high = random.integers(0, 100, (2, count))
    scene = context.accel_build(inputs(low), build_flags=UPDATE | FAST_BUILD)
    assert not scene.has_native_instances
    assert context.accel_build(inputs(low), build_flags=UPDATE).has_native_instances
    above = places[:, :2, 3] + random.uniform(-0.4, 0.4, (count, 2))
    origins = np.concatenate([above, np.full((count, 1), 200.0)], axis=1).astype(np.float32)
    directions = np.tile(np.float32([0, 0, -1]), (count, 1))
    for height in (low, high):
        scene.update(inputs(height))
        found = hits(harness, scene, origins, directions)
        assert np.array_equal(found.instances, number)
        assert np.array_equal(found.distances, np.float32(200 - height))
