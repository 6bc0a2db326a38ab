"""Random graphs against the brute-force reference: nested instances, static and moving transforms, motion of vertices, masks, flags."""

from __future__ import annotations

from typing import Any

import brute_force
import numpy as np
import pytest
from harness import Harness
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scenes import calls, closest, gas, hitgroup, ias, instance, missed, ray, trace, triangles
from test_random_scenes import AMBIGUOUS, RAY_FLAGS, decided, random_transform

RAYS = 60
IGNORE = 1
RECORDS = 64
SLOW = settings(max_examples=12, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture], derandomize=True)
Nodes = list[dict[str, Any]]


def random_motion(random: np.random.Generator, keys: int) -> dict[str, Any]:
    """Options with any range and vanish flags."""
    begin, length = random.uniform(-1, 1), random.uniform(0.2, 2)
    return {"numKeys": keys, "flags": int(random.choice([0, 0, 0, 1, 2, 3])), "timeBegin": float(begin), "timeEnd": float(begin + length)}


def random_structure(random: np.random.Generator, name: str, count: int) -> dict[str, Any]:
    """A GAS of triangles, at rest or with two or three keys."""
    corners = (random.uniform(-1, 1, (count, 1, 3)) + random.normal(0, 0.4, (count, 3, 3))).astype(np.float32)
    item = triangles(corners, random.integers(0, 8, 1).tolist())
    keys = int(random.choice([1, 1, 2, 3]))
    if keys == 1:
        return gas(item, name=name)
    moved = [corners + random.normal(0, 0.5, (1, 1, 3)) for _ in range(keys)]
    item["vertices"] = [key.astype(np.float32).ravel().tolist() for key in moved]
    return {**gas(item, name=name), "motion": random_motion(random, keys)}


def random_srt(random: np.random.Generator) -> list[float]:
    """One SRT key; quaternions of any length, on one side so that no turn passes through zero."""
    scale, shear, pivot = random.uniform(0.6, 1.6, 3), random.normal(0, 0.1, 3), random.normal(0, 0.5, 3)
    turn = np.append(random.normal(0, 0.7, 3), 1.0) * random.uniform(0.5, 2)
    key = [scale[0], shear[0], shear[1], pivot[0], scale[1], shear[2], pivot[1], scale[2], pivot[2], *turn, *random.uniform(-1, 1, 3)]
    return np.array(key, np.float32).tolist()


def random_node(random: np.random.Generator, name: str, below: list[str]) -> dict[str, Any]:
    """An IAS or a transform above some of the nodes that are there."""
    child = below[int(random.integers(len(below)))]
    kind = random.choice(["IAS", "IAS", "static", "matrixMotion", "srtMotion"])
    if kind == "static":
        return {"name": name, "kind": "static", "child": child, "data": random_transform(random)}
    if kind == "IAS":
        placed = [instance(below[int(random.integers(len(below)))], random_transform(random), instance_id=int(random.integers(1000)),
                           sbt_offset=int(random.integers(4)), mask=int(random.integers(1, 8)), flags=int(random.integers(16)))
                  for _ in range(int(random.integers(1, 4)))]
        motion = {"motion": random_motion(random, int(random.integers(2, 5)))} if random.random() < 0.3 else {}
        return {**ias(*placed, name=name), **motion}
    keys = int(random.integers(2, 5))
    if kind == "srtMotion":
        data = [value for _ in range(keys) for value in random_srt(random)]
    else:
        first = np.array(random_transform(random))
        data = [float(value) for _ in range(keys) for value in (first + random.normal(0, 0.15, 12)).astype(np.float32)]
    return {"name": name, "kind": str(kind), "child": child, "data": data, "motion": random_motion(random, keys)}


def random_graph(random: np.random.Generator, structures: int, nodes: int, count: int) -> Nodes:
    """Structures g0, g1, ..., nodes n0, n1, ... above them, and `top` above a few of all."""
    scene = [random_structure(random, f"g{number}", count) for number in range(structures)]
    for number in range(nodes):
        scene.append(random_node(random, f"n{number}", [node["name"] for node in scene][-4:]))
    names = [node["name"] for node in scene]
    placed = [instance(name, random_transform(random), instance_id=2000 + number, sbt_offset=number, mask=int(random.integers(1, 8)))
              for number, name in enumerate(names[-3:])]
    return [*scene, ias(*placed, name="top")]


@SLOW
@given(seed=st.integers(0, 2**32 - 1), structures=st.integers(1, 3), nodes=st.integers(1, 6), count=st.integers(2, 20),
       mode=st.sampled_from([0, IGNORE]))
def test_nearest_hits_through_graphs(harness: Harness, seed: int, structures: int, nodes: int, count: int, mode: int) -> None:
    random = np.random.default_rng(seed)
    scene = random_graph(random, structures, nodes, count)
    roots = ["top", "top", scene[-2]["name"]]
    origins, ends = random.uniform(-6, 6, (RAYS, 3)).astype(np.float32), random.uniform(-2, 2, (RAYS, 3)).astype(np.float32)
    rays = [ray(origin, end - origin, root=roots[number % 3], flags=int(random.choice(RAY_FLAGS)), mask=int(random.integers(1, 256)),
                time=float(random.choice([random.uniform(-2, 3), random.uniform(-0.5, 1)])))
            for number, (origin, end) in enumerate(zip(origins, ends, strict=True))]
    results = trace(harness, scene, rays, [hitgroup(record, anyhit_mode=mode) for record in range(RECORDS)], motion=True)
    for result, one in zip(results, rays, strict=True):
        check(scene, one, result, mode)


def check(scene: Nodes, one: dict[str, Any], result: Any, mode: int) -> None:
    """The closest hit, its instance, record and matrix, and the any-hit calls are those of the reference."""
    given_ray = one["in"]
    hits = [hit for hit in brute_force.scene_candidates(scene, given_ray) if brute_force.visible(hit, given_ray["flags"])]
    if not decided(scene, one, hits) or at_the_end_of_a_range(scene, given_ray["time"]):
        return
    called = [hit for hit in hits if brute_force.anyhit_enabled(hit.geometry_flags, hit.path.flags, given_ray["flags"])]
    kept = [hit for hit in hits if mode != IGNORE or hit not in called]
    assert missed(result) == (not kept), one
    if kept:
        event, hit = closest(result), kept[0]
        assert (event["prim"], event["instId"], event["instIdx"], event["gasIdx"], event["hitKind"], event["rec"]) == (
            hit.primitive, hit.path.instance_id, hit.path.instance_index, hit.gas_index, hit.hit_kind, hit.path.sbt_offset), one
        assert event["tmax"] == pytest.approx(hit.t, rel=AMBIGUOUS)
        size = np.abs(hit.path.to_world).max()
        assert np.allclose(np.array(event["o2w"]).reshape(3, 4), hit.path.to_world, atol=AMBIGUOUS * size), one
        size = np.abs(hit.path.to_object).max()
        assert np.allclose(np.array(event["w2o"]).reshape(3, 4), hit.path.to_object, atol=AMBIGUOUS * size), one
    must = sum(not kept or hit.t <= kept[0].t for hit in called)
    assert must <= len(calls(result)) <= len(called), one


def at_the_end_of_a_range(scene: Nodes, time: float) -> bool:
    """Whether rounding decides if something is there."""
    ends = [float(node["motion"][key]) for node in scene if "motion" in node for key in ("timeBegin", "timeEnd")]
    return any(abs(time - end) < AMBIGUOUS for end in ends)
