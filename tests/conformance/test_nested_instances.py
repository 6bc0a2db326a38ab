"""Area L: instances of instances, transforms in between, and the matrices that hit programs see."""

from __future__ import annotations

import math

import numpy as np
import pytest
from harness import Harness
from scenes import CORNER, closest, gas, ias, instance, missed, ray, trace, translation, triangles

import optixc as ox

ABOVE = (0.25, 0.25, 1.0)


def scaling(x: float, y: float, z: float) -> list[float]:
    """A 3x4 matrix that stretches."""
    return [x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, 0]


def test_T149_every_level_must_be_seen(harness: Harness) -> None:
    for outer, inner, mask, seen in ((1, 2, 1, False), (1, 2, 2, False), (1, 2, 3, True), (3, 1, 1, True)):
        scene = [gas(triangles(CORNER)), ias(instance(mask=inner), name="inner"), ias(instance("inner", mask=outer), name="top")]
        (result,) = trace(harness, scene, [ray(ABOVE, root="top", mask=mask)])
        assert missed(result) != seen, (outer, inner, mask)


def test_T152_matrices_multiply_from_the_root(harness: Harness) -> None:
    scene = [gas(triangles(CORNER)), ias(instance(transform=scaling(2, 2, 2)), name="inner"),
             ias(instance("inner", transform=translation(10, 0, 0)), name="top")]
    (result,) = trace(harness, scene, [ray((10.5, 0.5, 1.0), root="top")])
    assert closest(result)["o2w"] == [2, 0, 0, 10, 0, 2, 0, 0, 0, 0, 2, 0]
    assert closest(result)["w2o"] == [0.5, 0, 0, -5, 0, 0.5, 0, 0, 0, 0, 0.5, 0]


def test_T154_a_turn_inside_of_a_move(harness: Harness) -> None:
    quarter = [0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0]
    scene = [gas(triangles(CORNER)), ias(instance(transform=quarter), name="inner"),
             ias(instance("inner", transform=translation(1, 0, 0)), name="top")]
    (result,) = trace(harness, scene, [ray((0.75, 0.25, 1.0), root="top")])
    matrix = np.reshape(closest(result)["o2w"], (3, 4))
    assert (matrix @ (1, 0, 0, 1)).tolist() == [1, 1, 0]


def test_T162_three_levels_are_hit_like_the_flattened_scene(harness: Harness) -> None:
    random = np.random.default_rng(162)
    levels = [[translation(*random.uniform(-3, 3, 3)) for _ in range(3)] for _ in range(3)]
    nested = [gas(triangles(CORNER))]
    below = "gas"
    for number, moves in enumerate(levels):
        nested.append(ias(*(instance(below, transform=move, instance_id=i) for i, move in enumerate(moves)), name=f"level{number}"))
        below = f"level{number}"
    corners = [np.float32(CORNER) + np.sum([np.reshape(move, (3, 4))[:, 3] for move in moves], axis=0)
               for moves in ((a, b, c) for a in levels[0] for b in levels[1] for c in levels[2])]
    flat = [gas(triangles(np.concatenate(corners)))]
    targets = [corner.mean(axis=0) for corner in corners]
    rays = [[ray((*target[:2], 20.0), root=root) for target in targets] for root in (below, "gas")]
    for ours, theirs in zip(trace(harness, nested, rays[0]), trace(harness, flat, rays[1]), strict=True):
        assert closest(ours)["tmax"] == pytest.approx(closest(theirs)["tmax"], rel=1e-5)
        assert closest(ours)["u"] == pytest.approx(closest(theirs)["u"], abs=1e-4)


def test_T163_a_graph_of_depth_31(harness: Harness) -> None:
    made = [harness.context.accel_build([ox.BuildInputTriangles(np.float32(CORNER))])]
    up = np.reshape(translation(0, 0, 1), (3, 4))
    for _ in range(30):
        made.append(harness.context.accel_build([ox.BuildInputInstances([ox.Instance(made[-1], up)])]))
    (result,) = trace(harness, [], [ray((0.25, 0.25, 50.0), root="it")], made={"it": made[-1]})
    assert closest(result)["tmax"] == 20.0
    with pytest.raises(ox.OptixError, match="32 traversables deep"):
        harness.context.accel_build([ox.BuildInputInstances([made[-1]])])


def test_T160_objects_and_arrays_make_the_same_instances(harness: Harness) -> None:
    accel = harness.context.accel_build([ox.BuildInputTriangles(np.float32(CORNER))])
    moves = np.float32([np.reshape(translation(3 * i, 0, 0), (3, 4)) for i in range(4)])
    objects = [ox.Instance(accel, move, instance_id=10 + i, sbt_offset=0, visibility_mask=1 + i) for i, move in enumerate(moves)]
    arrays = ox.BuildInputInstances([accel] * 4, transforms=moves, instance_ids=np.arange(10, 14, dtype=np.uint32),
                                    visibility_masks=np.arange(1, 5, dtype=np.uint8))
    rays = [ray((3 * i + 0.25, 0.25, 1.0), root="it", mask=mask) for i in range(4) for mask in (1, 2, 4)]
    found = []
    for inputs in (ox.BuildInputInstances(objects), arrays):
        results = trace(harness, [], rays, made={"it": harness.context.accel_build([inputs])})
        found.append([None if missed(result) else (closest(result)["instId"], closest(result)["o2w"]) for result in results])
    assert found[0] == found[1]
    assert None in found[0]
    assert any(found[0])


def test_T181_a_vanishing_level_takes_all_instances_along(harness: Harness) -> None:
    motion = {"motion": {"numKeys": 2, "flags": 2, "timeBegin": 0.0, "timeEnd": 1.0}}
    scene = [gas(triangles(CORNER)), {**ias(instance(), instance(transform=translation(2, 0, 0))), **motion}]
    rays = [ray((x, 0.25, 1.0), root="ias", time=time) for x in (0.25, 2.25) for time in (0.5, 1.0, 1.5)]
    assert [missed(result) for result in trace(harness, scene, rays, motion=True)] == [False, False, True] * 2


def test_T155_normals_take_the_other_matrix(harness: Harness) -> None:
    # scale (2, 1, 1): the normal (1, 1, 0) goes to (0.5, 1, 0), which is the transposed world-to-object matrix
    scene = [gas(triangles(CORNER)), ias(instance(transform=scaling(2, 1, 1)))]
    (result,) = trace(harness, scene, [ray((0.5, 0.25, 1.0), root="ias")])
    to_object = np.reshape(closest(result)["w2o"], (3, 4))[:, :3]
    assert (to_object.T @ (1, 1, 0)).tolist() == [0.5, 1, 0]
    assert math.isclose(np.linalg.det(to_object), 0.5)
