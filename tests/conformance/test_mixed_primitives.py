"""Hits of unlike primitives side by side in one packet: each getter gives its own primitive's data, and zeros for the others."""

from __future__ import annotations

import numpy as np
from harness import Harness
from shaders import mixed_primitives as shader

import optixc as ox

COUNT = 48
TRIANGLE, SPHERE, LINEAR, CUBIC = range(4)
TYPES = {TRIANGLE: ox.PrimitiveType.TRIANGLE, SPHERE: ox.PrimitiveType.SPHERE, LINEAR: ox.PrimitiveType.ROUND_LINEAR,
         CUBIC: ox.PrimitiveType.ROUND_CUBIC_BSPLINE}


def kinds() -> np.ndarray:
    """What stands at x = 0, 1, ...; long runs of one kind as well as changes in every place."""
    random = np.random.default_rng(3)
    return np.concatenate([np.full(COUNT // 3, SPHERE), random.integers(0, 4, COUNT - COUNT // 3)])


def points(x: int) -> np.ndarray:
    """Four points on a line through (x, 0, 0) along y."""
    return np.array([[x, y, 0.0] for y in (-1.5, -0.5, 0.5, 1.5)], np.float32)


def accels(context: ox.DeviceContext, placed: np.ndarray) -> list[ox.Accel]:
    """An acceleration structure for each kind; curves and spheres with many vertices, so that a mistaken index would leave the arrays."""
    triangles = np.concatenate([[[x - 0.4, -0.4, 0], [x + 0.4, -0.4, 0], [x, 0.6, 0]] for x in np.flatnonzero(placed == TRIANGLE)])
    spheres = np.array([[x, 0, 0] for x in np.flatnonzero(placed == SPHERE)], np.float32)
    made = [ox.BuildInputTriangles(triangles.astype(np.float32)), ox.BuildInputSpheres(spheres, np.full(len(spheres), 0.25, np.float32))]
    for kind, first, step in ((LINEAR, 1, 4), (CUBIC, 0, 4)):
        vertices = np.concatenate([points(x) for x in np.flatnonzero(placed == kind)])
        indices = np.arange(first, len(vertices), step, dtype=np.uint32)
        made.append(ox.BuildInputCurves(TYPES[kind], vertices, np.full(len(vertices), 0.25, np.float32), indices))
    return [context.accel_build([one]) for one in made]


def test_getters_of_other_primitives_give_zeros(harness: Harness) -> None:
    placed = kinds()
    context, module = harness.context, harness.module("mixed_primitives.py")
    raygen = context.program_group_create(raygen=module["__raygen__down"])
    miss = context.program_group_create(miss=None)
    hit = context.program_group_create(closesthit=module["__closesthit__everything"])
    pipeline = harness.pipeline("mixed primitives", [raygen, miss, hit])
    scene = context.accel_build([ox.BuildInputInstances([ox.Instance(one) for one in accels(context, placed)])])
    found = np.full((COUNT, 7, 4), -1.0, np.float32)
    table = ox.ShaderBindingTable(raygen=raygen.record(), miss=[miss.record()], hitgroup=[hit.record()])
    harness.launch(pipeline, shader.Params(found=found, scene=scene), table, COUNT)

    expected = np.zeros((COUNT, 7, 4), np.float32)
    for x, kind in enumerate(placed):
        expected[x, 0, 0] = TYPES[kind]
        if kind == TRIANGLE:
            expected[x, 1:4, :3] = [[x - 0.4, -0.4, 0], [x + 0.4, -0.4, 0], [x, 0.6, 0]]
        elif kind == SPHERE:
            expected[x, 4] = (x, 0, 0, 0.25)
        elif kind == LINEAR:
            expected[x, 5] = (*points(x)[1], 0.25)
        else:
            expected[x, 6] = (*points(x)[0], 0.25)
    np.testing.assert_allclose(found, expected, atol=1e-6)
