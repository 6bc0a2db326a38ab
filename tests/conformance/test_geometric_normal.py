"""The normal that the traversal found: along the vertices' cross product, outward on spheres, nothing on custom primitives."""

from __future__ import annotations

import numpy as np
from harness import Harness
from shaders import geometric_normal as shader

import optixc as ox

COUNT = 96


def scene_of(context: ox.DeviceContext, random: np.random.Generator) -> ox.Accel:
    """Triangles, spheres and boxes side by side under turned and stretched instances."""
    corners = random.uniform(-1, 1, (40, 3, 3)).astype(np.float32)
    triangles = context.accel_build([ox.BuildInputTriangles(corners.reshape(-1, 3))])
    spheres = context.accel_build([ox.BuildInputSpheres(random.uniform(-1, 1, (6, 3)).astype(np.float32), np.full(6, 0.4, np.float32))])
    boxes = context.accel_build([ox.BuildInputCustomPrimitives(np.array([[-1, -1, -0.01, 1, 1, 0.01]], np.float32))])
    turn = np.array([[0.8, -0.6, 0, -3], [0.6, 0.8, 0, 0], [0, 0, 1.5, 0]], np.float32)
    shift = np.array([[1, 0, 0, 3], [0, 1, 0, 0], [0, 0, 1, 0]], np.float32)
    children = [ox.Instance(triangles, transform=turn, sbt_offset=0), ox.Instance(spheres, sbt_offset=1),
                ox.Instance(boxes, transform=shift, sbt_offset=2)]
    return context.accel_build([ox.BuildInputInstances(children)])


def shoot(harness: Harness) -> np.ndarray:
    random = np.random.default_rng(11)
    context, module = harness.context, harness.module("geometric_normal.py")
    programs = {"closesthit": module["__closesthit__note"], "anyhit": module["__anyhit__note"]}
    raygen, miss = context.program_group_create(raygen=module["__raygen__shoot"]), context.program_group_create(miss=None)
    builtin = context.program_group_create(**programs)
    custom = context.program_group_create(**programs, intersection=module["__intersection__box"])
    pipeline = harness.pipeline("geometric normal", [raygen, miss, builtin, custom])
    origins = np.column_stack([random.uniform(-4, 4, COUNT), random.uniform(-1, 1, COUNT), np.full(COUNT, 5.0)]).astype(np.float32)
    directions = np.column_stack([random.normal(0, 0.05, (COUNT, 2)), np.full(COUNT, -1.0)]).astype(np.float32)
    found = np.zeros((COUNT, 3, 4), np.float32)
    table = ox.ShaderBindingTable(
        raygen=raygen.record(), miss=[miss.record()], hitgroup=[builtin.record(), builtin.record(), custom.record()]
    )
    params = shader.Params(found=found, origins=origins, directions=directions, scene=scene_of(context, random))
    harness.launch(pipeline, params, table, COUNT)
    return found


def test_the_normal_is_along_what_the_primitive_tells(harness: Harness) -> None:
    found = shoot(harness)
    normal, expected = found[:, 0, :3].astype(np.float64), found[:, 2, :3].astype(np.float64)
    kinds = found[:, 0, 3] - 1
    for kind in (ox.PrimitiveType.TRIANGLE, ox.PrimitiveType.SPHERE):
        chosen = kinds == float(kind)
        assert chosen.sum() >= 5
        lengths = np.linalg.norm(normal[chosen], axis=1) * np.linalg.norm(expected[chosen], axis=1)
        np.testing.assert_allclose((normal[chosen] * expected[chosen]).sum(axis=1) / lengths, 1.0, atol=2e-5)
    triangles = kinds == float(ox.PrimitiveType.TRIANGLE)
    np.testing.assert_allclose(normal[triangles], expected[triangles], rtol=1e-3, atol=1e-5)
    custom = kinds == float(ox.PrimitiveType.CUSTOM)
    assert custom.sum() >= 5
    assert not normal[custom].any()


def test_anyhit_sees_the_same_normal(harness: Harness) -> None:
    found = shoot(harness)
    same = (found[:, 0, 3] > 0) & (found[:, 1, 3] == found[:, 2, 3])  # the last candidate is the closest hit
    assert same.sum() >= 15
    np.testing.assert_array_equal(found[same, 0, :3], found[same, 1, :3])
