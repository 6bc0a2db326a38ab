"""One scene said in several ways: lists for arrays, numbers for arrays of one number, stacked motion keys, numpy's scalars."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import optixc as ox

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
MATRICES = np.tile(np.eye(3, 4, dtype=np.float32), (2, 1, 1))
MATRICES[1, :, 3] = (5, 6, 7)
MOVING: dict[str, Any] = {"motion_options": ox.MotionOptions(2)}


@pytest.fixture(scope="module")
def context() -> ox.DeviceContext:
    return ox.DeviceContext(threads=1)


@pytest.mark.parametrize("value", [[1], (1,), np.array([1]), np.array([1], np.uint64), np.array([1], np.uint8)])
def test_record_offsets(context: ox.DeviceContext, value: Any) -> None:
    made = context.accel_build([ox.BuildInputTriangles(CORNERS, num_sbt_records=2, sbt_index_offsets=value)])
    assert made.primitive_count == 1


@pytest.mark.parametrize("value", [[-1], np.array([1 << 32]), [0.5], ["x"]])
def test_record_offsets_that_are_none(context: ox.DeviceContext, value: Any) -> None:
    with pytest.raises(ox.InvalidValueError, match="sbt_index_offsets"):
        context.accel_build([ox.BuildInputTriangles(CORNERS, num_sbt_records=2, sbt_index_offsets=value)])


@pytest.mark.parametrize("value", [MATRICES, MATRICES.astype(np.float64), MATRICES.tolist(), list(MATRICES), MATRICES.reshape(2, 12)])
def test_transforms_of_many_instances(context: ox.DeviceContext, value: Any) -> None:
    child = context.accel_build([ox.BuildInputTriangles(CORNERS)])
    made = context.accel_build([ox.BuildInputInstances([child, child], transforms=value)])
    assert made.aabb.tolist() == [[0, 0, 0], [6, 7, 7]]


@pytest.mark.parametrize("value", [MATRICES[:1], np.zeros((2, 4, 4)), "x", 1.0, [[1, 2], [3]]])
def test_transforms_that_are_none(context: ox.DeviceContext, value: Any) -> None:
    child = context.accel_build([ox.BuildInputTriangles(CORNERS)])
    with pytest.raises(ox.InvalidValueError, match="transforms"):
        context.accel_build([ox.BuildInputInstances([child, child], transforms=value)])


@pytest.mark.parametrize("value", [2, 2.0, np.float32(2), np.int64(2), np.full(1, 2, np.float32), np.full(3, 2, np.float32)])
def test_one_radius_for_all_spheres(context: ox.DeviceContext, value: Any) -> None:
    made = context.accel_build([ox.BuildInputSpheres(CORNERS, value)])
    assert np.allclose(made.aabb, [[-2, -2, -2], [3, 3, 2]], atol=1e-5)


def test_one_radius_at_all_keys_and_along_a_curve(context: ox.DeviceContext) -> None:
    moving = context.accel_build([ox.BuildInputSpheres([CORNERS, CORNERS + 1], 2)], **MOVING)
    assert np.allclose(moving.aabb, [[-2, -2, -2], [4, 4, 3]], atol=1e-5)
    line = context.accel_build([ox.BuildInputCurves(ox.PrimitiveType.ROUND_LINEAR, CORNERS, 0.5, np.array([0], np.uint32))])
    assert np.allclose(line.aabb, [[-0.5, -0.5, -0.5], [1.5, 0.5, 0.5]], atol=1e-5)


@pytest.mark.parametrize("value", [True, "x", None, 1j])
def test_a_radius_that_is_none(context: ox.DeviceContext, value: Any) -> None:
    with pytest.raises(ox.InvalidValueError, match="radii"):
        context.accel_build([ox.BuildInputSpheres(CORNERS, value)])


@pytest.mark.parametrize("corners", [CORNERS, CORNERS.astype(np.float16), np.ascontiguousarray(CORNERS[:, :2])])
def test_motion_keys_in_one_array(context: ox.DeviceContext, corners: Any) -> None:
    keys = np.stack([corners, corners + 1])
    stacked, listed = (context.accel_build([ox.BuildInputTriangles(one)], **MOVING) for one in (keys, list(keys)))
    property_type = ox.AccelPropertyType.AABBS
    assert stacked.emit_property(property_type).tolist() == listed.emit_property(property_type).tolist()


@pytest.mark.parametrize("value", [3, np.int64(3), ox.BuildFlags.ALLOW_UPDATE | ox.BuildFlags.ALLOW_COMPACTION])
def test_build_flags(context: ox.DeviceContext, value: Any) -> None:
    made = context.accel_build([ox.BuildInputTriangles(CORNERS)], value)
    assert made.update([ox.BuildInputTriangles(CORNERS + 1)]).compact().aabb.tolist() == [[1, 1, 1], [2, 2, 1]]


def test_an_instance_changes_between_builds(context: ox.DeviceContext) -> None:
    instance = ox.Instance(context.accel_build([ox.BuildInputTriangles(CORNERS)]))
    top = context.accel_build([ox.BuildInputInstances([instance])], ox.BuildFlags.ALLOW_UPDATE)
    instance.transform = MATRICES[1]
    assert top.aabb.tolist() == [[0, 0, 0], [1, 1, 0]]
    assert top.update([ox.BuildInputInstances([instance])]).aabb.tolist() == [[5, 6, 7], [6, 7, 7]]
