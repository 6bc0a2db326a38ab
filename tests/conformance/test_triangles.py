"""Area I: triangle acceleration structures."""

from __future__ import annotations

import math

import brute_force
import numpy as np
import pytest
from harness import Harness
from scenes import (
    CORNER,
    FAR,
    UP,
    closest,
    gas,
    hitgroup,
    ias,
    kinds,
    missed,
    ray,
    trace,
    translation,
    triangles,
)

import optixc as ox

FRONT, BACK = 0xFE, 0xFF
INVALID_VALUE = 7001


def stacked(count: int) -> list[list[tuple[float, float, float]]]:
    """`count` copies of the corner triangle, one unit apart, the first at z = 0."""
    return [[(x, y, -float(level)) for x, y, _ in CORNER] for level in range(count)]


def test_T094_triangle_from_the_front(harness: Harness) -> None:
    (result,) = trace(harness, [gas(triangles(CORNER))], [ray((0.25, 0.5, 1.0))])
    hit = closest(result)
    assert (hit["tmax"], hit["u"], hit["v"], hit["hitKind"], hit["prim"]) == (1.0, 0.25, 0.5, FRONT, 0)
    assert (hit["front"], hit["back"], hit["ptype"]) == (1, 0, hex(ox.PrimitiveType.TRIANGLE))


def test_T095_triangle_from_behind(harness: Harness) -> None:
    (result,) = trace(harness, [gas(triangles(CORNER))], [ray((0.25, 0.5, -1.0), UP)])
    hit = closest(result)
    assert (hit["hitKind"], hit["front"], hit["back"]) == (BACK, 0, 1)


@pytest.mark.parametrize(("tmin", "tmax", "hits"), [
    (0.0, 1.0, False), (1.0, FAR, False), (0.0, float(np.nextafter(np.float32(1), np.float32(2))), True),
    (float(np.nextafter(np.float32(1), np.float32(0))), FAR, True), (1.0001, FAR, False), (0.0, 0.9999, False),
    (2.0, 1.0, False), (-5.0, 10.0, True)])
def test_T096_the_interval_is_open_for_triangles(harness: Harness, tmin: float, tmax: float, hits: bool) -> None:
    # Recorded: 03_trange-t_edges_tri_gas, both ends open; spec T096 leaves the choice.
    (result,) = trace(harness, [gas(triangles(CORNER))], [ray((0.25, 0.25, 1.0), tmin=tmin, tmax=tmax)])
    assert missed(result) is not hits


def test_T097_the_direction_is_not_normalised(harness: Harness) -> None:
    (result,) = trace(harness, [gas(triangles(CORNER))], [ray((0.25, 0.25, 1.0), (0.0, 0.0, -2.0))])
    assert closest(result)["tmax"] == 0.5


def test_T098_zero_and_nan_directions_miss(harness: Harness) -> None:
    rays = [ray((0.25, 0.25, 1.0), (0.0, 0.0, 0.0)), ray((0.25, 0.25, 1.0), (math.nan, 0.0, -1.0))]
    assert all(missed(result) for result in trace(harness, [gas(triangles(CORNER))], rays))


def test_T099_degenerate_triangles_are_never_hit(harness: Harness) -> None:
    corners = [CORNER, ((5, 0, 0), (5, 0, 0), (5, 1, 0)), ((7, 0, 0), (8, 0, 0), (9, 0, 0)),
               ((math.nan, 0, 0), (11, 0, 0), (10, 1, 0)), ((12, 0, 0), (13, 0, 0), (12, 1, 0))]
    rays = [ray((0.25, 0.25, 1.0)), ray((5.0, 0.5, 1.0)), ray((8.0, 0.0, 1.0)), ray((10.25, 0.25, 1.0)), ray((12.25, 0.25, 1.0))]
    results = trace(harness, [gas(triangles(corners))], rays)
    assert [missed(result) for result in results] == [False, True, True, True, False]
    assert closest(results[4])["prim"] == 4


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.uint32])
def test_T101_index_types_give_the_same_hits(harness: Harness, dtype: type) -> None:
    size = np.dtype(dtype).itemsize
    shared = triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], indices=[0, 1, 2, 1, 3, 2], indexBytes=size)
    results = trace(harness, [gas(shared)], [ray((0.25, 0.25, 1.0)), ray((0.75, 0.75, 1.0)), ray((1.25, 0.25, 1.0))])
    assert [closest(result)["prim"] for result in results[:2]] == [0, 1]
    assert missed(results[2])


def test_T101_rows_of_vertices_and_indices_may_lie_apart(harness: Harness) -> None:
    vertices = np.zeros(4, [("position", np.float32, 3), ("normal", np.float32, 3), ("material", np.uint16)])
    vertices["position"] = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)]
    vertices["normal"] = np.nan
    for dtype in (np.uint8, np.uint16, np.uint32):
        indices = np.full((2, 5), 77, dtype)
        indices[:, :3] = [(0, 1, 2), (1, 3, 2)]
        accel = harness.context.accel_build([ox.BuildInputTriangles(vertices["position"], indices[:, :3])])
        rays = [ray((0.25, 0.25, 1.0), root="it"), ray((0.75, 0.75, 1.0), root="it")]
        assert [closest(result)["prim"] for result in trace(harness, [], rays, made={"it": accel})] == [0, 1]


def test_T102_left_over_vertices_make_no_triangle(harness: Harness) -> None:
    corners = np.array([*stacked(2)[0], *stacked(2)[1], (0, 0, 5)], np.float32)
    (result,) = trace(harness, [gas(triangles(corners))], [ray((0.25, 0.25, 1.0))], [hitgroup(anyhit_mode=1)])
    assert sorted(event["prim"] for event in result.events if event["ev"] == "AH") == [0, 1]


def test_T103_the_pre_transform_is_baked_in(harness: Harness) -> None:
    scene = [gas(triangles(CORNER, preTransform=translation(0.0, 0.0, 5.0)))]
    (result,) = trace(harness, scene, [ray((0.25, 0.25, 10.0))])
    hit = closest(result)
    assert hit["tmax"] == 5.0
    assert hit["vertexData"] == [0, 0, 5, 1, 0, 5, 0, 1, 5]
    assert hit["o2w"] == [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]


def test_T104_primitive_index_offset(harness: Harness) -> None:
    (result,) = trace(harness, [gas(triangles(stacked(3), primitiveIndexOffset=100))], [ray((0.25, 0.25, 1.0))], [hitgroup(anyhit_mode=1)])
    assert sorted(event["prim"] for event in result.events if event["ev"] == "AH") == [100, 101, 102]


def test_T105_every_input_counts_its_primitives_from_zero(harness: Harness) -> None:
    scene = [gas(triangles(stacked(2)), triangles([[(x + 3, y, z) for x, y, z in one] for one in stacked(2)]))]
    results = trace(harness, scene, [ray((0.25, 0.25, 1.0)), ray((3.25, 0.25, 1.0))], [hitgroup(0), hitgroup(1)])
    assert [(closest(result)["prim"], closest(result)["gasIdx"]) for result in results] == [(0, 0), (0, 1)]


def test_T106_inputs_that_do_not_go_together(harness: Harness) -> None:
    corners, bounds = np.array(CORNER, np.float32), np.array([[0, 0, 0, 1, 1, 1]], np.float32)
    accel = harness.context.accel_build([ox.BuildInputTriangles(corners)])
    instances = ox.BuildInputInstances([ox.Instance(accel, np.eye(3, 4, dtype=np.float32))])
    for inputs in ([ox.BuildInputTriangles(corners), ox.BuildInputCustomPrimitives(bounds)], [], [instances, instances],
                   [ox.BuildInputTriangles(corners), instances]):
        with pytest.raises(ox.InvalidValueError):
            harness.context.accel_build(inputs)


def test_T107_empty_structures_always_miss(harness: Harness) -> None:
    scene = [gas(triangles(np.zeros((0, 3)))), ias(name="empty")]
    results = trace(harness, scene, [ray((0.25, 0.25, 1.0)), ray((0.25, 0.25, 1.0), root="empty")])
    assert [kinds(result) for result in results] == [["MS"], ["MS"]]


def test_T109_fast_trace_and_fast_build_together(harness: Harness) -> None:
    flags = ox.BuildFlags.PREFER_FAST_TRACE | ox.BuildFlags.PREFER_FAST_BUILD
    with pytest.raises(ox.InvalidValueError):
        harness.context.accel_build([ox.BuildInputTriangles(np.array(CORNER, np.float32))], build_flags=flags)


def test_T110_build_flags_do_not_change_hits(harness: Harness) -> None:
    random = np.random.default_rng(110)
    corners = (random.random((300, 1, 3)) * 4 + random.normal(0, 0.2, (300, 3, 3))).astype(np.float32)
    origins, ends = random.random((200, 3)) * 6 - 1, random.random((200, 3)) * 4
    rays = [ray(origin, end - origin) for origin, end in zip(origins.tolist(), ends, strict=True)]
    expected = None
    for flags in (0, 1, 2, 4, 5, 6, 8, 9, 10, 16, 20, 24):
        scene = [gas(triangles(corners, (1,)), build_flags=flags)]
        found = [None if missed(result) else (closest(result)["prim"], closest(result)["tmax"]) for result in trace(harness, scene, rays)]
        expected = expected or found
        assert [hit and hit[0] for hit in found] == [hit and hit[0] for hit in expected], flags
        for hit, same, one in zip(found, expected, rays, strict=True):
            reference = brute_force.scene_candidates(scene, one["in"])
            assert (hit is None) == (not reference)
            if hit and same:
                assert hit[1] == pytest.approx(same[1], rel=1e-5) == pytest.approx(reference[0].t, rel=1e-4)


def test_T111_buffers_may_change_after_the_build(harness: Harness) -> None:
    corners, indices = np.array(CORNER, np.float32), np.array([[0, 1, 2]], np.uint32)
    accel = harness.context.accel_build([ox.BuildInputTriangles(corners, indices)])
    corners += 100.0
    indices[:] = 0
    box = np.asarray(accel.aabb, np.float32).reshape(2, 3)
    assert np.allclose(box, [[0, 0, 0], [1, 1, 0]], atol=1e-6)


def test_T112_handles_are_not_zero(harness: Harness) -> None:
    made = [harness.context.accel_build([ox.BuildInputTriangles(np.array(CORNER, np.float32))]) for _ in range(4)]
    assert len({accel.handle for accel in made}) == 4
    assert all(accel.handle for accel in made)


def test_T115_a_closed_mesh_lets_no_ray_out(harness: Harness) -> None:
    corners = icosphere(3)
    random = np.random.default_rng(115)
    # aim from the centre region at vertices, edge points and faces alike
    weights = random.dirichlet((0.3, 0.3, 0.3), 4000)
    weights[:1000] = np.eye(3)[random.integers(0, 3, 1000)]
    weights[1000:2000, 2] = 0.0
    faces = corners[random.integers(0, len(corners), 4000)]
    targets = np.einsum("ij,ijk->ik", weights / weights.sum(1, keepdims=True), faces)
    origins = random.normal(0, 0.05, (4000, 3))
    rays = [ray(origin, direction) for origin, direction in zip(origins.tolist(), (targets - origins).tolist(), strict=True)]
    results = trace(harness, [gas(triangles(corners, (1,)))], rays)
    assert sum(missed(result) for result in results) == 0


def test_T115_a_shared_edge_is_hit_once(harness: Harness) -> None:
    square = triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], indices=[0, 1, 2, 1, 3, 2])
    rays = [ray((t, 1.0 - t, 1.0)) for t in np.linspace(0.05, 0.95, 19)]
    assert all(kinds(result)[-1] == "CH" for result in trace(harness, [gas(square)], rays))


def icosphere(level: int) -> np.ndarray:
    """The triangles (n, 3, 3) of an icosahedron subdivided `level` times, on the unit sphere."""
    golden = (1 + math.sqrt(5)) / 2
    points = np.array([(-1, golden, 0), (1, golden, 0), (-1, -golden, 0), (1, -golden, 0), (0, -1, golden), (0, 1, golden),
                       (0, -1, -golden), (0, 1, -golden), (golden, 0, -1), (golden, 0, 1), (-golden, 0, -1), (-golden, 0, 1)])
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8),
             (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    corners = points[np.array(faces)] / math.hypot(1, golden)
    for _ in range(level):
        a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
        ab, bc, ca = ((p + q) / np.linalg.norm(p + q, axis=1, keepdims=True) for p, q in ((a, b), (b, c), (c, a)))
        corners = np.concatenate([np.stack(one, 1) for one in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    return corners.astype(np.float32)


