"""Area M: motion of vertices, boxes, radii and transforms."""

from __future__ import annotations

import math
from typing import Any

import brute_force
import numpy as np
import pytest
from harness import Harness
from scenes import CORNER, IDENTITY, boxes, calls, closest, gas, hitgroup, ias, instance, missed, ray, reported, trace, triangles

import optixc as ox

START_VANISH, END_VANISH = 1, 2
STILL = (1.0, 0, 0, 0, 1.0, 0, 0, 1.0, 0, 0, 0, 0, 1.0, 0, 0, 0)
EVERYWHERE = [[-100, -100, -100, 100, 100, 100]]


def motion(keys: int = 2, begin: float = 0.0, end: float = 1.0, flags: int = 0) -> dict[str, Any]:
    """Motion options."""
    return {"numKeys": keys, "flags": flags, "timeBegin": begin, "timeEnd": end}


def moving_triangle(*heights: float, flags: int = 0, begin: float = 0.0, end: float = 1.0) -> dict[str, Any]:
    """The corner triangle at one height per key."""
    keys = [[coordinate for x, y, _ in CORNER for coordinate in (x, y, z)] for z in heights]
    return {**gas({**triangles(CORNER), "vertices": keys}), "motion": motion(len(heights), begin, end, flags)}


def transform(kind: str, data: Any, child: str = "gas", name: str = "moving", **options: Any) -> dict[str, Any]:
    """A motion transform; the number of keys is that of the data."""
    rows = np.asarray(data, np.float64).reshape(-1, 12 if kind == "matrixMotion" else 16)
    return {"name": name, "kind": kind, "child": child, "data": rows.ravel().tolist(), "motion": motion(len(rows), **options)}


def srt(angle: float = 0.0, **fields: float) -> list[float]:
    """SRT data: a turn about z by degrees, and named fields."""
    names = ("sx", "a", "b", "pvx", "sy", "c", "pvy", "sz", "pvz", "qx", "qy", "qz", "qw", "tx", "ty", "tz")
    values = dict(zip(names, STILL, strict=True)) | {"qz": math.sin(math.radians(angle) / 2), "qw": math.cos(math.radians(angle) / 2)}
    return [float((values | fields)[name]) for name in names]


def heights(harness: Harness, scene: list[dict[str, Any]], times: list[float], root: str = "gas") -> list[float | None]:
    """Where rays straight down from z = 10 hit at each time."""
    results = trace(harness, scene, [ray((0.25, 0.25, 10.0), root=root, time=time) for time in times], motion=True)
    return [None if missed(result) else 10.0 - closest(result)["tmax"] for result in results]


def to_world(harness: Harness, node: dict[str, Any], time: float) -> np.ndarray:
    """The object-to-world matrix that a program sees at a time."""
    scene = [gas(boxes(EVERYWHERE)), node, ias(instance(node["name"]))]
    (result,) = trace(harness, scene, [ray((0, 0, 0), root="ias", time=time)], [hitgroup(kind="custom", reports=[reported(1.0)])],
                      motion=True)
    return np.array(calls(result, "IS")[0]["o2w"]).reshape(3, 4)


def test_T166_without_motion_the_time_is_zero(harness: Harness) -> None:
    (result,) = trace(harness, [gas(triangles(CORNER))], [ray((0.25, 0.25, 1.0), time=0.7)])
    assert {event["time"] for event in result.events} == {0.0}


def test_T167_T168_vertices_move_and_clamp(harness: Harness) -> None:
    assert heights(harness, [moving_triangle(0.0, 1.0)], [0.25, -5.0, 7.0, 0.0, 1.0]) == [0.25, 0.0, 1.0, 0.0, 1.0]


def test_T169_vanishing_outside_the_range(harness: Harness) -> None:
    scene = [moving_triangle(0.0, 1.0, flags=START_VANISH | END_VANISH)]
    assert heights(harness, scene, [-0.01, 0.0, 1.0, 1.01]) == [None, 0.0, 1.0, None]


def test_T170_keys_and_fractions(harness: Harness) -> None:
    found = heights(harness, [moving_triangle(0.0, 1.0, 3.0, begin=-1.0, end=1.5)], [-2, -1, -0.5, 0.25, 1, 1.5, 3])
    assert found == pytest.approx([0.0, 0.0, 0.4, 1.0, 2.2, 3.0, 3.0], abs=1e-5)


def test_X11_as_many_keys_as_embree_takes(harness: Harness) -> None:
    # one more is refused by name: "more keys than Embree takes" of the impossible scenes
    steps = [float(key % 5) for key in range(129)]
    found = heights(harness, [moving_triangle(*steps)], [0.0, 1 / 128, 2.5 / 128, 64.25 / 128, 1.0])
    assert found == pytest.approx([0.0, 1.0, 2.5, 4.0 - 0.25 * 4.0, 3.0], abs=1e-4)


def test_T171_every_traversable_has_its_own_range(harness: Harness) -> None:
    lift = [IDENTITY, [*IDENTITY[:11], 4.0]]
    scene = [moving_triangle(0.0, 1.0), transform("matrixMotion", lift, begin=10.0, end=20.0), ias(instance("moving"))]
    assert heights(harness, scene, [15.0, 0.5], "ias") == [3.0, 0.5]


def test_T172_matrices_are_blended_by_element(harness: Harness) -> None:
    turned = [0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0]
    matrix = to_world(harness, transform("matrixMotion", [IDENTITY, turned]), 0.5)
    assert np.linalg.norm(matrix[:2, 0]) == pytest.approx(math.sqrt(0.5), rel=1e-5)


@pytest.mark.parametrize(("angle", "time", "expected"), [
    (60.0, 1.0, 60.0), (60.0, 0.25, 14.738520), (60.0, 0.5, 30.0), (90.0, 0.25, 21.598161), (90.0, 0.5, 45.0)])
def test_T173_rotations_are_nlerped(harness: Harness, angle: float, time: float, expected: float) -> None:
    matrix = to_world(harness, transform("srtMotion", [srt(), srt(angle)]), time)
    assert math.degrees(math.atan2(matrix[1, 0], matrix[0, 0])) == pytest.approx(expected, abs=1e-4)


def test_T174_T175_scale_shear_pivot_rotation_translation(harness: Harness) -> None:
    key = srt(90.0, sx=2, a=0.5, b=0.25, pvx=1, sy=3, c=0.75, pvy=2, sz=4, pvz=3, tx=10, ty=20, tz=30)
    matrix = to_world(harness, transform("srtMotion", [key, key]), 0.5)
    assert np.allclose(matrix, [[0, -3, -0.75, 8], [2, 0.5, 0.25, 21], [0, 0, 4, 33]], atol=1e-5)
    key = srt(90.0, pvx=-2, tx=2)
    matrix = to_world(harness, transform("srtMotion", [key, key]), 0.5)
    assert np.allclose(matrix, [[0, -1, 0, 2], [1, 0, 0, -2], [0, 0, 1, 0]], atol=1e-6)


def test_T176_quaternions_need_not_be_unit(harness: Harness) -> None:
    key = srt(60.0)
    longer = [*key[:9], *(3 * value for value in key[9:13]), *key[13:]]
    assert np.allclose(to_world(harness, transform("srtMotion", [longer, longer]), 0.5),
                       to_world(harness, transform("srtMotion", [key, key]), 0.5), atol=1e-6)


def test_T177_hits_and_matrices_agree(harness: Harness) -> None:
    random = np.random.default_rng(177)
    for _ in range(20):
        keys = [srt(sx=random.uniform(0.5, 2), a=random.normal(0, 0.2), sy=random.uniform(0.5, 2), sz=random.uniform(0.5, 2),
                    qx=random.normal(), qy=random.normal(), qz=random.normal(), qw=1.5, tx=random.normal(), ty=random.normal())
                for _ in range(2)]
        node, time = transform("srtMotion", keys), float(random.random())
        scene = [gas(triangles(CORNER)), node, ias(instance("moving"))]
        matrix = brute_force.transform_at(node, time)
        target = matrix[:, :3] @ (0.25, 0.25, 0.0) + matrix[:, 3]
        origin = target + random.normal(0, 3, 3)
        (result,) = trace(harness, scene, [ray(origin, target - origin, root="ias", time=time)], motion=True)
        hit = closest(result)
        assert (hit["tmax"], hit["u"], hit["v"]) == pytest.approx((1.0, 0.25, 0.25), abs=1e-4)
        assert np.allclose(np.array(hit["o2w"]).reshape(3, 4), matrix, atol=1e-5)


def test_T178_moving_boxes_lose_no_hit(harness: Harness) -> None:
    scene = [{**gas({**boxes([[0, 0, 0, 1, 1, 1]]), "aabbs": [[0, 0, 0, 1, 1, 1], [0, 0, 10, 1, 1, 11]]}), "motion": motion()}]
    rays = [ray((0.5, -5.0, 10.0 * time + 0.5), (0, 1, 0), time=time) for time in np.linspace(0, 1, 21)]
    assert all(calls(result, "IS") for result in trace(harness, scene, rays, [hitgroup(kind="custom")], motion=True))


def test_T180_instance_bounds_cover_the_motion(harness: Harness) -> None:
    far = [IDENTITY, [*IDENTITY[:3], 100.0, *IDENTITY[4:]]]
    scene = [gas(triangles(CORNER)), transform("matrixMotion", far), ias(instance("moving"))]
    rays = [ray((100.0 * time + 0.25, 0.25, 1.0), root="ias", time=time) for time in np.linspace(0, 1, 21)]
    assert not any(missed(result) for result in trace(harness, scene, rays, motion=True))


@pytest.mark.parametrize(("keys", "begin", "end"), [(1, 0.0, 1.0), (2, 1.0, 0.0), (2, 0.5, 0.5)])
def test_T182_transforms_need_two_keys_in_order(harness: Harness, keys: int, begin: float, end: float) -> None:
    child = harness.context.accel_build([ox.BuildInputTriangles(np.array(CORNER, np.float32))])
    matrices = np.array([IDENTITY] * keys, np.float32).reshape(-1, 3, 4)
    with pytest.raises(ox.InvalidValueError):
        harness.context.matrix_motion_transform(child, matrices, ox.MotionOptions(keys, begin, end))


def test_T186_static_below_motion(harness: Harness) -> None:
    lift = [IDENTITY, [*IDENTITY[:11], 4.0]]
    double = [2.0, 0, 0, 0, 0, 2.0, 0, 0, 0, 0, 2.0, 1.0]
    scene = [gas(triangles(CORNER)), {"name": "static", "kind": "static", "child": "gas", "data": double},
             transform("matrixMotion", lift, child="static"), ias(instance("moving"))]
    assert heights(harness, scene, [0.5], "ias") == [3.0]


def test_motion_transforms_are_missed_without_motion_in_the_pipeline(harness: Harness) -> None:
    # Recorded: 06_motion-matrix_motion_in_pipeline_without_motion.
    scene = [gas(triangles(CORNER)), transform("matrixMotion", [IDENTITY, IDENTITY]), ias(instance("moving"))]
    (result,) = trace(harness, scene, [ray((0.25, 0.25, 1.0), root="ias")])
    assert missed(result)


@pytest.mark.parametrize("uses_motion_blur", [False, True])
def test_a_pipeline_without_motion_says_so(uses_motion_blur: bool) -> None:
    """Once, at the first launch: the missing object is otherwise hard to explain."""

    @ox.struct
    class Params:
        scene: ox.Traversable

    params = ox.launch_params(Params)

    @ox.program
    def __raygen__looks() -> None:
        ox.trace(params.scene, ox.float3(0.25, 0.25, 1.0), ox.float3(0.0, 0.0, -1.0))

    told: list[str] = []
    context = ox.DeviceContext(log_callback=lambda level, tag, text: told.append(text) if level == 3 else None)
    group = context.program_group_create(raygen=context.module_create([__raygen__looks])["__raygen__looks"])
    options = ox.PipelineCompileOptions(uses_motion_blur=uses_motion_blur)
    pipeline = context.pipeline_create([group], options=options, simd=1)
    triangle = context.accel_build([ox.BuildInputTriangles(np.array(CORNER, np.float32))])
    moving = context.matrix_motion_transform(triangle, np.tile(np.eye(3, 4), (2, 1, 1)), ox.MotionOptions(2))
    above = context.static_transform(context.accel_build([ox.BuildInputInstances([moving] * 2)]), np.eye(3, 4))
    for scene in (triangle, above, above):
        table = ox.ShaderBindingTable(group.record(), miss=[context.program_group_create(miss=None).record()])
        pipeline.launch(Params(scene), table, 1)
    assert len(told) == (0 if uses_motion_blur else 1)
    assert uses_motion_blur or "`scene` of the launch parameters holds motion transforms" in told[0]
