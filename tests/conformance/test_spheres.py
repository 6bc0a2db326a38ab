"""Area O: spheres."""

from __future__ import annotations

import brute_force
import numpy as np
import pytest
from harness import Harness
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scenes import calls, closest, gas, hitgroup, missed, offsets, ray, trace

IGNORE = 1
SPHERE_KIND = 138


def spheres(centers: object, radii: object, flags: tuple[int, ...] = (0,), **more: object) -> dict[str, object]:
    """A sphere input."""
    return {"type": "spheres", "vertices": [np.asarray(centers, np.float32).ravel().tolist()],
            "radii": [np.asarray(radii, np.float32).ravel().tolist()], "flags": list(flags), "numSbtRecords": len(flags), **more}


def shoot(harness: Harness, scene: list[dict[str, object]], *rays: dict[str, object], mode: int = 0, records: int = 1) -> list[object]:
    """Trace with sphere hit groups."""
    return trace(harness, scene, rays, [hitgroup(record, kind="sphere", anyhit_mode=mode) for record in range(records)])


def test_T209_a_sphere_from_outside(harness: Harness) -> None:
    (result,) = shoot(harness, [gas(spheres([(0, 0, 0)], [1]))], ray((0, 0, 3)))
    hit = closest(result)
    assert (hit["tmax"], hit["hitKind"], hit["ptype"], hit["front"]) == (2.0, SPHERE_KIND, "0x2506", 1)
    assert hit["vertexData"] == [0, 0, 0, 1]  # T215


def test_T210_nothing_from_inside(harness: Harness) -> None:
    results = shoot(harness, [gas(spheres([(0, 0, 0)], [1]))], ray((0, 0, 0)), ray((0, 0, 3), tmin=2.5), ray((0, 0, 3), tmin=2.0))
    assert [missed(result) for result in results] == [True, True, True]


def test_T211_an_ignored_entry_offers_no_exit(harness: Harness) -> None:
    (result,) = shoot(harness, [gas(spheres([(0, 0, 0)], [1], (2,)))], ray((0, 0, 3)), mode=IGNORE)
    assert missed(result)
    assert [event["tmax"] for event in calls(result)] == [2.0]


def test_T212_one_radius_for_all(harness: Harness) -> None:
    centers = [(3 * i, 0, 0) for i in range(20)]
    results = shoot(harness, [gas(spheres(centers, [1], singleRadius=True))], *(ray((3 * i, 0, 3)) for i in range(20)))
    assert [(closest(result)["prim"], closest(result)["tmax"]) for result in results] == [(i, 2.0) for i in range(20)]


def test_T213_records_by_sphere(harness: Harness) -> None:
    scene = [gas(spheres([(0, 0, 0), (5, 0, 0)], [1, 1], (0, 0), **offsets([1, 0])))]
    results = shoot(harness, scene, ray((0, 0, 3)), ray((5, 0, 3)), records=2)
    assert [closest(result)["rec"] for result in results] == [1, 0]


def test_T214_strange_radii(harness: Harness) -> None:
    # Recorded: 11_spheres; a negative radius acts as its absolute value, zero is never hit.
    scene = [gas(spheres([(0, 0, 0), (5, 0, 0)], [-1, 0]))]
    results = shoot(harness, scene, ray((0, 0, 3)), ray((5, 0, 3)))
    assert [missed(result) for result in results] == [False, True]


def test_random_spheres_agree_with_brute_force(harness: Harness) -> None:
    random = np.random.default_rng(209)
    scene = [gas(spheres(random.uniform(-3, 3, (40, 3)), random.uniform(0.1, 1.0, 40)))]
    origins, ends = random.uniform(-6, 6, (300, 3)), random.uniform(-3, 3, (300, 3))
    rays = [ray(origin, direction) for origin, direction in zip(origins, ends - origins, strict=True)]
    for result, one in zip(shoot(harness, scene, *rays), rays, strict=True):
        hits = brute_force.scene_candidates(scene, one["in"])
        assert missed(result) == (not hits)
        if hits:
            assert closest(result)["prim"] == hits[0].primitive
            assert closest(result)["tmax"] == pytest.approx(hits[0].t, rel=1e-3)


@settings(max_examples=12, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture], derandomize=True)
@given(seed=st.integers(0, 10_000), scale=st.sampled_from([1e-4, 1.0, 1e4]), distance=st.sampled_from([0.0, 0.9, 3.0, 1e3, 1e5]),
       place=st.sampled_from([0.0, 30.0]))
def test_spheres_of_every_scale_near_and_far(harness: Harness, seed: int, scale: float, distance: float, place: float) -> None:
    random = np.random.default_rng(seed)
    center = np.float32(scale * place * random.normal(size=3))
    radius = float(np.float32(scale * random.uniform(0.5, 1.0)))
    scene = [gas(spheres([center], [radius]))]
    # From inside, grazing, and past; the rounding of coordinates is what binary32 leaves of the largest of them
    aside = random.normal(size=(20, 3))
    aside /= np.linalg.norm(aside, axis=1, keepdims=True)
    directions = np.cross(aside, random.normal(size=(20, 3)))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    across = radius * random.choice([0.0, 0.5, 0.95, 1.05, 1.5], (20, 1))
    origins = np.float32(center + across * aside - scale * distance * directions)
    rays = [ray(origin, direction) for origin, direction in zip(origins, np.float32(directions), strict=True)]
    blur = 4.0 * 2.0**-23 * (scale * (distance + place * 3.0) / radius + 1.0)
    for result, one in zip(shoot(harness, scene, *rays), rays, strict=True):
        o, d = (np.asarray(one["in"][key], np.float32).astype(np.float64) for key in ("o", "d"))
        to_center = center.astype(np.float64) - o
        nearest = np.linalg.norm(np.cross(to_center, d)) / np.linalg.norm(d) / radius
        along = float(to_center @ d) / float(d @ d)
        entry = along - radius * np.sqrt(max(0.0, 1.0 - nearest**2)) / float(np.linalg.norm(d))
        if abs(nearest - 1.0) > blur and abs(entry) > 4.0 * blur * radius:
            assert missed(result) == (nearest > 1.0 or entry < 0.0), one
            if not missed(result):
                slack = blur * radius / max(0.05, np.sqrt(max(0.0, 1.0 - nearest**2)))
                assert abs(closest(result)["tmax"] - entry) * float(np.linalg.norm(d)) <= slack, (one, entry)


@pytest.mark.parametrize("radius", [1e-6, 1e-3, 1e2, 1e3, 1e4, 1e5, 1e6])
def test_distances_to_spheres_of_any_size(harness: Harness, radius: float) -> None:
    # Near the surface of a large sphere the distance is a small difference of large numbers; it must not lose digits all the same.
    random = np.random.default_rng(210)
    size = min(radius, 1.0)
    scene = [gas(spheres([(0, -radius, 0)], [radius]))]
    origins = random.uniform((-5, 0.1, -5), (5, 5, 5), (60, 3)) * size
    ends = random.uniform((-5, -0.6, -5), (5, -0.4, 5), (60, 3)) * size
    rays = [ray(np.float32(origin), np.float32((end - origin) / size)) for origin, end in zip(origins, ends, strict=True)]
    hit = 0
    for result, one in zip(shoot(harness, scene, *rays), rays, strict=True):
        found = [event.t for event in brute_force.scene_candidates(scene, one["in"])]
        if not missed(result) and found:
            hit += 1
            assert closest(result)["tmax"] == pytest.approx(found[0], rel=1e-6)
    assert hit > 0


def test_a_moving_large_sphere_keeps_its_digits(harness: Harness) -> None:
    item = spheres([(0, -1e6, 0)], [1e6])
    item["vertices"] = [[0.0, -1e6, 0.0], [0.0, -1e6 + 4.0, 0.0]]
    item["radii"] = [[1e6], [1e6]]
    scene = [{**gas(item), "motion": {"numKeys": 2, "flags": 0, "timeBegin": 0.0, "timeEnd": 1.0}}]
    rays = [ray((0, 10, 0), (0, -1, 0), time=time) for time in (0.0, 0.5, 1.0)]
    results = trace(harness, scene, rays, [hitgroup(kind="sphere")], motion=True)
    assert [closest(result)["tmax"] for result in results] == pytest.approx([10.0, 8.0, 6.0], abs=1e-4)
