"""Areas N and O: curves of every basis, and ribbons."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import brute_force_curves
import numpy as np
import pytest
from harness import Harness
from oracle_scene import build
from scenes import calls, closest, gas, hitgroup, missed, ray, trace

import optixc as ox

IGNORE = 1
LINEAR, QUADRATIC, CUBIC, CATMULL_ROM, RIBBON, BEZIER = 0x2503, 0x2501, 0x2502, 0x2504, 0x2505, 0x2507
QUADRATIC_ROCAPS, CUBIC_ROCAPS = 0x2508, 0x2509
POINTS = ((0, 0, 0), (1, 2, 0), (3, 3, 0), (4, 0, 0))
LINE = ((0, 0, 0), (1, 0, 0), (2, 0, 0))
REQUIRE_SINGLE = 2


def curves(
    kind: int, points: Any, radius: Any, indices: Sequence[int] = (0,), caps: int = 0, flags: int = 0, **more: Any
) -> dict[str, Any]:
    """A curve input; `radius` is one for all points or one each."""
    vertices = np.asarray(points, np.float32)
    radii = np.broadcast_to(np.asarray(radius, np.float32), len(vertices))
    return {
        "type": "curves",
        "curveType": hex(kind),
        "vertices": [vertices.ravel().tolist()],
        "radii": [radii.tolist()],
        "indices": list(indices),
        "flags": [flags],
        "numSbtRecords": 1,
        "endcapFlags": caps,
        **more,
    }


def shoot(harness: Harness, item: dict[str, Any], *rays: dict[str, Any], mode: int = 0) -> list[Any]:
    """Trace with curve hit groups."""
    return trace(harness, [gas(item)], rays, [hitgroup(kind="curve", anyhit_mode=mode)])


def test_T187_linear_sides_and_round_ends(harness: Harness) -> None:
    item = curves(LINEAR, ((0, 0, 0), (1, 0, 0)), 0.25)
    side, end, past = shoot(harness, item, ray((0.5, 0, 2)), ray((1.1, 0, 2)), ray((1.26, 0, 2)))
    hit = closest(side)
    assert (hit["tmax"], hit["u"], hit["ptype"], hit["hitKind"]) == (pytest.approx(1.75, 1e-5), pytest.approx(0.5, 1e-5), "0x2503", 132)
    assert closest(end)["tmax"] == pytest.approx(1.770871, rel=1e-5)
    assert missed(past)


def test_T188_the_caps_of_linear_curves_are_round_always(harness: Harness) -> None:
    # Recorded: the flag is ignored, not refused (11_curves).
    (result,) = shoot(harness, curves(LINEAR, ((0, 0, 0), (1, 0, 0)), 0.25, caps=1), ray((1.1, 0, 2)))
    assert closest(result)["tmax"] == pytest.approx(1.770871, rel=1e-5)


@pytest.mark.parametrize(
    ("kind", "places"),
    [
        (CUBIC, ((0.0, 1.166667, 1.833333), (0.5, 2.0, 2.395833), (1.0, 2.833333, 2.333333))),
        (QUADRATIC, ((0.0, 0.5, 1.0), (0.5, 1.125, 1.875), (1.0, 2.0, 2.5))),
        (CATMULL_ROM, ((0.0, 1.0, 2.0), (0.5, 2.0, 2.8125), (1.0, 3.0, 3.0))),
        (BEZIER, ((0.0, 0.0, 0.0), (0.5, 2.0, 1.875), (1.0, 4.0, 0.0))),
    ],
)
def test_T189_where_each_basis_goes(harness: Harness, kind: int, places: Sequence[tuple[float, float, float]]) -> None:
    item = curves(kind, POINTS, 0.05)
    segment = brute_force_curves.segments([gas(item)], ray((0, 0, 0))["in"], 0)[0]
    for u, x, y in places:
        assert segment.at(u)[:2] == pytest.approx((x, y), abs=1e-5)
    inner = [0.1, 0.5, 0.9]
    rays = [ray((*segment.at(u)[:2], 2.0)) for u in inner]
    for u, result in zip(inner, shoot(harness, item, *rays), strict=True):
        hit = closest(result)
        assert hit["u"] == pytest.approx(u, abs=1e-3)  # T201
        assert hit["tmax"] == pytest.approx(1.95, rel=1e-4)
        assert len(hit["vertexData"]) == (12 if kind == QUADRATIC else 16)


def test_T190_a_quadratic_spans_the_middle_of_its_control_polygon(harness: Harness) -> None:
    on, before = shoot(harness, curves(QUADRATIC, LINE, 0.1), ray((1, 0, 2)), ray((0.45, 0, 2)))
    assert (closest(on)["tmax"], closest(on)["u"]) == (pytest.approx(1.9, rel=1e-5), pytest.approx(0.5, abs=1e-5))
    assert missed(before)


def test_T191_T192_ends_are_open_or_closed(harness: Harness) -> None:
    rays = ray((-1, 0, 0), (1, 0, 0)), ray((3, 0, 0), (-1, 0, 0)), ray((1.1, 0, 2))
    assert [missed(result) for result in shoot(harness, curves(QUADRATIC, LINE, 0.1), *rays)] == [True, True, False]
    for kind in (QUADRATIC, QUADRATIC_ROCAPS):
        first, last, side = (closest(result) for result in shoot(harness, curves(kind, LINE, 0.1, caps=1), *rays))
        assert (first["tmax"], first["u"], last["tmax"], last["u"]) == (1.5, 0.0, 1.5, 1.0)
        assert 0.0 < side["u"] < 1.0


def test_T193_segments_take_their_control_points_from_the_index(harness: Harness) -> None:
    points = [(float(i), 0.0, 0.0) for i in range(16)]
    results = shoot(harness, curves(CUBIC, points, 0.1, (10, 11, 12)), *(ray((x, 0, 2)) for x in (11.5, 12.5, 13.5)))
    assert [closest(result)["vertexData"][0::4] for result in results] == [[10, 11, 12, 13], [11, 12, 13, 14], [12, 13, 14, 15]]
    assert [closest(result)["prim"] for result in results] == [0, 1, 2]


def test_T194_caps_close_both_ends_of_every_strand(harness: Harness) -> None:
    points = [(float(i), 0.0, 0.0) for i in range(4)] + [(float(i) + 10.0, 0.0, 0.0) for i in range(4)]
    item = curves(QUADRATIC, points, 0.1, (0, 1, 4, 5), caps=1)
    results = shoot(
        harness, item, ray((-1, 0, 0), (1, 0, 0)), ray((5, 0, 0), (-1, 0, 0)), ray((5, 0, 0), (1, 0, 0)), ray((20, 0, 0), (-1, 0, 0))
    )
    assert [(closest(r)["prim"], closest(r)["u"], closest(r)["tmax"]) for r in results] == [
        (0, 0.0, 1.5),
        (1, 1.0, 2.5),
        (2, 0.0, 5.5),
        (3, 1.0, 7.5),
    ]


def test_T196_the_radius_follows_the_basis(harness: Harness) -> None:
    item = curves(CUBIC, [(float(i), 0.0, 0.0) for i in range(4)], (0.1, 0.1, 0.3, 0.3))
    segment = brute_force_curves.segments([gas(item)], ray((0, 0, 0))["in"], 0)[0]
    (result,) = shoot(harness, item, ray((1.5, 0, 2)))
    hit = closest(result)
    assert brute_force_curves.is_on_curve([gas(item)], ray((1.5, 0, 2))["in"], hit)
    assert 2.0 - hit["tmax"] == pytest.approx(segment.at(0.5)[3], abs=0.02)


@pytest.mark.parametrize("kind", [LINEAR, QUADRATIC, CUBIC, QUADRATIC_ROCAPS])
def test_T197_T198_T203_the_inside_is_never_met(harness: Harness, kind: int) -> None:
    points = [(float(i), 0.0, 0.0) for i in range(4)]
    item = curves(kind, points, 0.25, (1,) if kind == LINEAR else (0,))
    assert missed(shoot(harness, item, ray((1.4, 0, 0), (0.3, 0, 1)))[0])
    (through,) = shoot(harness, item, ray((1.4, 0, 2)), mode=IGNORE)
    assert missed(through)
    assert [event["tmax"] for event in calls(through)] == [pytest.approx(1.75, rel=1e-5)]


@pytest.mark.parametrize("kind", [LINEAR, QUADRATIC, CUBIC, CATMULL_ROM, BEZIER, CUBIC_ROCAPS])
def test_T199_one_call_for_one_crossing(harness: Harness, kind: int) -> None:
    (result,) = shoot(
        harness,
        curves(kind, POINTS, 0.1, flags=REQUIRE_SINGLE),
        ray((0.5, 1.0, 2.0) if kind == LINEAR else (2.0, *_height(kind, 2.0), 2.0)),
        mode=IGNORE,
    )
    assert len(calls(result)) == 1


def _height(kind: int, x: float) -> tuple[float]:
    """Where the axis over x is, by bisection."""
    segment = brute_force_curves.segments([gas(curves(kind, POINTS, 0.1))], ray((0, 0, 0))["in"], 0)[0]
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if segment.at(middle)[0] < x else (low, middle)
    return (float(segment.at(low)[1]),)


def test_T202_rocaps_of_constant_width_are_the_tube(harness: Harness) -> None:
    rays = [ray((x, y, 2)) for x in (0.7, 1.0, 1.3) for y in (-0.05, 0.0, 0.08)]
    tubes, rounded = (shoot(harness, curves(kind, LINE, 0.1), *rays) for kind in (QUADRATIC, QUADRATIC_ROCAPS))
    for a, b in zip(tubes, rounded, strict=True):
        assert closest(a)["tmax"] == pytest.approx(closest(b)["tmax"], abs=1e-4)
        assert closest(b)["hitKind"] == 142


@pytest.mark.parametrize("kind", brute_force_curves.ROCAPS)
def test_X12_normals_of_rocaps_point_away_from_the_axis(harness: Harness, kind: int) -> None:
    radii = np.float32([0.3, 0.2, 0.25, 0.4])
    basis = brute_force_curves.BASES[kind]
    terms = basis @ np.concatenate([np.asarray(POINTS, float), radii[:, None]], axis=1)[: len(basis)]
    rays = [ray((float(x), float(y), 2.0), (0.1, 0.05, -1.0)) for x in np.linspace(0.0, 4.0, 15) for y in np.linspace(0.0, 3.0, 12)]
    results = [hit for hit in zip(rays, shoot(harness, curves(kind, POINTS, radii), *rays), strict=True) if not missed(hit[1])]
    assert len(results) > 8
    for given, result in results:
        hit = closest(result)
        axis = np.array([hit["u"] ** power for power in range(len(terms))]) @ terms
        away = np.array(given["in"]["o"]) + hit["tmax"] * np.array(given["in"]["d"]) - axis[:3]
        normal = np.array(hit["normal"])
        assert away @ normal == pytest.approx(np.linalg.norm(away) * np.linalg.norm(normal), rel=1e-3)


def test_T203_a_negative_radius_leaves_a_rocaps_segment_out(harness: Harness) -> None:
    assert missed(shoot(harness, curves(QUADRATIC_ROCAPS, LINE, (0.1, -0.1, 0.1)), ray((1, 0, 2)))[0])


def test_T205_T232_bad_curves_are_named(harness: Harness) -> None:
    build_ = harness.context.accel_build
    points, radii, first = np.zeros((4, 3), np.float32), np.full(4, 0.1, np.float32), np.zeros(1, np.uint32)
    cubic = ox.PrimitiveType.ROUND_CUBIC_BSPLINE
    for bad, text in ((np.array([0.1, math.nan, 0.1, 0.1], np.float32), "nan"), (np.array([0.1, 0.1, -0.2, 0.1], np.float32), "-0.2")):
        with pytest.raises(ox.InvalidValueError, match=text):
            build_([ox.BuildInputCurves(cubic, points, bad, first)])
    with pytest.raises(ox.InvalidValueError, match="4 control points"):
        build_([ox.BuildInputCurves(cubic, points, radii, np.ones(1, np.uint32))])
    with pytest.raises(ox.InvalidValueError, match="flags is one word"):
        build_([ox.BuildInputCurves(cubic, points, radii, first, flags=[0, 1])])
    with pytest.raises(ox.InvalidValueError, match="ribbons"):
        build_([ox.BuildInputCurves(cubic, points, radii, first, normals=points)])
    with pytest.raises(ox.InvalidValueError, match="curve_type"):
        build_([ox.BuildInputCurves(ox.PrimitiveType.SPHERE, points, radii, first)])


def test_T206_T208_X15_a_flat_ribbon_from_both_sides(harness: Harness) -> None:
    up = [0.0, 0.0, 1.0] * 3
    item = curves(RIBBON, LINE, 0.5, normals=[up])
    on, below, beside = shoot(harness, item, ray((1, 0.25, 2)), ray((1, 0.25, -2), (0, 0, 1)), ray((1, 0.51, 2)))
    for hit in (closest(on), closest(below)):
        assert (hit["u"], hit["v"], hit["tmax"], hit["front"], hit["hitKind"]) == (pytest.approx(0.5), pytest.approx(0.5), 2.0, 1, 136)
        assert hit["normal"] == pytest.approx([0, 0, 1])
    assert missed(beside)
    assert missed(shoot(harness, item, ray((-1, 0, 0), (1, 0, 0)))[0])


def test_X14_a_ribbon_without_normals_lies_across_its_bend(harness: Harness) -> None:
    # a bend in the plane z = 0: the ribbon goes along z, so that rays in that plane along the bend's inner normal meet it
    bend = [(0, 0, 0), (1, 2, 0), (3, 2, 0)]
    rays = [ray((1.6, -3, z), (0, 1, 0)) for z in (-0.2, 0.0, 0.2, 0.31)]
    *met, beside = shoot(harness, curves(RIBBON, bend, 0.3), *rays)
    for result in met:
        hit = closest(result)
        tangent = np.array(bend[1]) * (1 - hit["u"]) + (np.array(bend[2]) - bend[1]) * hit["u"] - np.array(bend[0]) * (1 - hit["u"])
        assert np.dot(hit["normal"], tangent) == pytest.approx(0, abs=1e-5)
    assert missed(beside)
    random = np.random.default_rng(14)
    knotted = random.normal(size=(60, 3))
    rays = [ray(random.normal(0, 3, 3).tolist(), random.normal(0, 1, 3).tolist()) for _ in range(200)]
    assert any(not missed(result) for result in shoot(harness, curves(RIBBON, knotted, 0.2, indices=range(58)), *rays))


def test_T207_normals_turn_a_ribbon(harness: Harness) -> None:
    item = curves(RIBBON, LINE, 0.5, normals=[[0, 0, 1, 0, -1, 0, 0, 0, 1]])
    begin, end = shoot(harness, item, ray((0.501, 0.3, 2)), ray((1.499, 0.3, 2)))
    assert closest(begin)["v"] == pytest.approx(0.6, abs=0.01)  # lies flat where it begins
    assert missed(end)  # and stands upright where it ends


def test_curves_move_with_an_update(harness: Harness) -> None:
    scene = [gas(curves(QUADRATIC, LINE, 0.1, caps=1), build_flags=int(ox.BuildFlags.ALLOW_UPDATE))]
    made = build(harness.context, scene)
    points = np.asarray(LINE, np.float32) + np.array([0, 0, 1], np.float32)
    moved = ox.BuildInputCurves(
        ox.PrimitiveType.ROUND_QUADRATIC_BSPLINE,
        points,
        np.full(3, 0.1, np.float32),
        np.zeros(1, np.uint32),
        endcap_flags=ox.CurveEndcapFlags.ON,
    )
    made["gas"].update([moved])
    rays = ray((1, 0, 3)), ray((-1, 0, 1), (1, 0, 0))
    side, cap = trace(harness, scene, rays, [hitgroup(kind="curve")], made=made)
    assert closest(side)["tmax"] == pytest.approx(1.9, rel=1e-5)
    assert (closest(cap)["tmax"], closest(cap)["u"]) == (1.5, 0.0)
