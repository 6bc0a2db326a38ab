"""Areas I, N, O and R: what the getters of vertex data give, of every primitive type and vertex format, at rest and moving."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from harness import Harness
from scenes import CORNER, calls, closest, gas, hitgroup, missed, ray, trace, triangles
from test_curves import BEZIER, CATMULL_ROM, CUBIC, LINEAR, QUADRATIC, RIBBON, curves
from test_spheres import spheres

import optixc as ox

MOVING = {"numKeys": 2, "flags": 0, "timeBegin": 0.0, "timeEnd": 1.0}
POINTS = ((0, 0, 0), (1, 0.5, 0), (2, 0, 0), (3, 0.5, 0))


@pytest.mark.parametrize(("dtype", "width"), [(np.float32, 3), (np.float32, 2), (np.float16, 3), (np.float16, 2), (np.int16, 3),
                                              (np.int16, 2)])
def test_T100_vertices_of_every_format_are_read_back(harness: Harness, dtype: Any, width: int) -> None:
    if dtype is np.int16:
        given = np.array([[-32768, -32767, 16384], [32767, -32767, 0], [-32767, 32767, 0]], np.int16)[:, :width]
        expected = np.maximum(given.astype(np.float32) / np.float32(32767), -1)
    else:
        given = np.array([[0, 0, 0.25], [2, 0, 0.25], [0, 2, 0.25]], dtype)[:, :width]
        expected = given.astype(np.float32)
    accel = harness.context.accel_build([ox.BuildInputTriangles(np.ascontiguousarray(given))])
    (result,) = trace(harness, [], [ray((-0.2, -0.2, 5) if dtype is np.int16 else (0.5, 0.5, 5), root="it")], made={"it": accel})
    found = np.reshape(closest(result)["vertexData"], (3, 3))
    assert found[:, :width].tolist() == expected.tolist()
    assert width == 3 or (found[:, 2] == 0).all()


def test_T113_memory_is_told(harness: Harness) -> None:
    accel = harness.context.accel_build([ox.BuildInputTriangles(np.float32(CORNER))])
    assert accel.memory_usage > np.float32(CORNER).nbytes


@pytest.mark.parametrize(("kind", "count"), [(LINEAR, 2), (QUADRATIC, 3), (CUBIC, 4), (CATMULL_ROM, 4), (BEZIER, 4), (RIBBON, 3)])
def test_T253_control_points_with_radii(harness: Harness, kind: int, count: int) -> None:
    radii = (0.3, 0.35, 0.4, 0.45)
    item = curves(kind, POINTS, radii)
    direction = (0, 1, 0) if kind == RIBBON else (0, 0, -1)
    origins = [(x, -5.0, 0.0) if kind == RIBBON else (x, 0.25, 5.0) for x in (0.7, 1.2, 1.6)]
    normals = {"normals": [[0.0, 1.0, 0.0] * 4]} if kind == RIBBON else {}
    results = trace(harness, [gas({**item, **normals})], [ray(origin, direction) for origin in origins], [hitgroup(kind="curve")])
    expected = np.float32([(*point, radius) for point, radius in zip(POINTS, radii, strict=True)][:count]).ravel().tolist()
    hits = [closest(result) for result in results if not missed(result)]
    assert hits
    assert all(hit["vertexData"] == expected for hit in hits)


def test_T249_moving_triangles(harness: Harness) -> None:
    item = triangles(CORNER, preTransform=[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 5])
    later = np.float32(CORNER) + np.float32([0, 0, 2])
    item["vertices"] = [item["vertices"][0], later.ravel().tolist()]
    (result,) = trace(harness, [{**gas(item), "motion": MOVING}], [ray((0.25, 0.25, 20), time=0.5)], motion=True)
    assert np.reshape(closest(result)["vertexData"], (3, 3)).tolist() == (np.float32(CORNER) + np.float32([0, 0, 6])).tolist()
    assert closest(result)["tmax"] == 14.0


def test_T179_a_growing_sphere(harness: Harness) -> None:
    item = spheres([(0, 0, 0)], [1])
    item.update(vertices=item["vertices"] * 2, radii=[[1.0], [2.0]])
    (result,) = trace(harness, [{**gas(item), "motion": MOVING}], [ray((0, 0, 5), time=0.5)], [hitgroup(kind="sphere")], motion=True)
    assert (closest(result)["tmax"], closest(result)["vertexData"]) == (3.5, [0, 0, 0, 1.5])


def test_T183_motion_options_of_a_structure(harness: Harness) -> None:
    item = triangles(CORNER)
    item["vertices"] = item["vertices"] * 3
    motion = {"numKeys": 3, "flags": 0, "timeBegin": -1.0, "timeEnd": 3.0}
    (result,) = trace(harness, [{**gas(item), "motion": motion}], [ray((0.25, 0.25, 1))], motion=True)
    assert closest(result)["gasMotion"] == [-1.0, 3.0, 3]


@pytest.mark.parametrize("kind", [LINEAR, QUADRATIC, CUBIC, CATMULL_ROM, BEZIER, RIBBON, 0x2508, 0x2509, 0x250A, 0x250B])
def test_T204_curves_between_two_keys(harness: Harness, kind: int) -> None:
    line = [(float(x), 0.0, 0.0) for x in range(4)]
    item = curves(kind, line, 0.1)
    item["vertices"].append((np.float32(line) + np.float32([0, 0, 2])).ravel().tolist())
    item["radii"].append([0.3] * 4)
    rays = [ray((x, 0, 5), time=0.5) for x in (0.9, 1.2, 1.4)]
    results = trace(harness, [{**gas(item), "motion": MOVING}], rays, [hitgroup(kind="curve")], motion=True)
    depth = 1.0 if kind == RIBBON else 1.2  # the middle, and the surface above it
    hits = [closest(result) for result in results if not missed(result)]
    assert hits
    for hit in hits:
        assert hit["tmax"] == pytest.approx(5.0 - depth, abs=1e-3)
        assert hit["vertexData"][2:4] == pytest.approx([1.0, 0.2])


def test_T204_points_and_radii_from_one_array(harness: Harness) -> None:
    # x, y, z and radius side by side, as they lie in memory of many programs
    table = np.float32([(*point, radius) for point, radius in zip(POINTS, (0.1, 0.2, 0.3, 0.4), strict=True)])
    line = ox.BuildInputCurves(ox.PrimitiveType.ROUND_LINEAR, table[:, :3], table[:, 3], np.uint32([0, 9, 1, 9, 2, 9])[::2])
    balls = ox.BuildInputSpheres(table[:, :3], table[:, 3])
    for item, kind, expected in ((line, "curve", table[1:3].ravel().tolist()), (balls, "sphere", table[2].tolist())):
        accel = harness.context.accel_build([item])
        (result,) = trace(harness, [], [ray((1.9, 0.05, 5), root="it")], [hitgroup(kind=kind)], made={"it": accel})
        assert closest(result)["vertexData"] == expected


@pytest.mark.parametrize(("kind", "begin"), [(QUADRATIC, 0.5), (CUBIC, 1.0), (CATMULL_ROM, 1.0)])
def test_T195_a_phantom_point_pins_the_beginning(harness: Harness, kind: int, begin: float) -> None:
    # p0 = 2 p1 - p2: cubic B-splines begin at p1 then, as Catmull-Rom curves always do; quadratic ones in the middle of p0 and p1.
    points = [(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 1, 0), (4, 0, 0)]
    item = curves(kind, points, 0.05, range(len(points) - (2 if kind == QUADRATIC else 3)))
    before, after = trace(harness, [gas(item)], [ray((begin + x, 0, 5)) for x in (-0.01, 0.01)], [hitgroup(kind="curve")])
    assert missed(before)
    assert closest(after)["prim"] == 0


@pytest.mark.parametrize("kind", [LINEAR, QUADRATIC, CUBIC, CATMULL_ROM, 0x2509])
def test_T200_one_ray_through_three_segments(harness: Harness, kind: int) -> None:
    height = 4.0
    points = [(0, -height, 0), (0, height, 0), (1, -height, 0), (2, height, 0), (3, -height, 0), (4, height, 0), (5, -height, 0)]
    segments = len(points) - {LINEAR: 1, QUADRATIC: 2}.get(kind, 3)
    item = curves(kind, points, 0.05, range(segments), flags=2)
    (result,) = trace(harness, [gas(item)], [ray((-3, 0, 0), (1, 0, 0))], [hitgroup(kind="curve", anyhit_mode=1)])
    met = {event["prim"] for event in calls(result)}
    assert len(met) >= 3
    assert missed(result)
