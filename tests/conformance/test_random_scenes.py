"""Random scenes against the brute-force reference: instances, flags, masks, any-hit decisions."""

from __future__ import annotations

import itertools
from typing import Any

import brute_force
import numpy as np
import pytest
from harness import Harness
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scenes import boxes, calls, closest, gas, hitgroup, ias, instance, missed, ray, reported, trace, triangles

# Barycentric coordinates and distances nearer than this are the same to binary32 after a transform: such rays decide nothing.
AMBIGUOUS = 1e-4
RAYS = 60
IGNORE = 1
RAY_FLAGS = [a | b | c for a in (0, 1, 2) for b in (0, 16, 32) for c in (0, 64, 128)]
SLOW = settings(max_examples=15, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture], derandomize=True)


def random_transform(random: np.random.Generator) -> list[float]:
    """A well-conditioned 3x4 matrix; mirrors are among them."""
    rotation, _ = np.linalg.qr(random.normal(size=(3, 3)))
    linear = rotation @ np.diag(random.uniform(0.5, 2.0, 3)) + random.normal(0, 0.1, (3, 3))
    return np.concatenate([linear, random.uniform(-3, 3, (3, 1))], axis=1).astype(np.float32).ravel().tolist()


def random_scene(random: np.random.Generator, geometries: int, instances: int, count: int) -> list[dict[str, Any]]:
    """Structures g0, g1, ... of `count` triangles in two inputs, and `top` with instances of them."""
    nodes = []
    for number in range(geometries):
        corners = (random.uniform(-1, 1, (count, 1, 3)) + random.normal(0, 0.4, (count, 3, 3))).astype(np.float32)
        flags = random.integers(0, 8, 3).tolist()
        half = count // 2
        offsets = random.integers(0, 2, half).tolist()
        nodes.append(gas(triangles(corners[:half], flags[:2], sbtIndexOffset=offsets, sbtIndexOffsetSizeInBytes=4),
                         triangles(corners[half:], flags[2:]), name=f"g{number}"))
    placed = [instance(f"g{random.integers(geometries)}", random_transform(random), instance_id=100 + number,
                       sbt_offset=int(random.integers(4)), mask=int(random.integers(1, 8)), flags=int(random.integers(16)))
              for number in range(instances)]
    return [*nodes, ias(*placed, name="top")]


def random_rays(random: np.random.Generator, root: str) -> list[dict[str, Any]]:
    """Rays through the middle of the scene with every kind of flag and mask."""
    origins, ends = random.uniform(-5, 5, (RAYS, 3)).astype(np.float32), random.uniform(-2, 2, (RAYS, 3)).astype(np.float32)
    return [ray(origin, (end - origin), root=root, flags=int(random.choice(RAY_FLAGS)), mask=int(random.integers(1, 256)),
                tmin=float(random.choice([0.0, 0.5])), tmax=float(random.choice([1e16, 1.0])), sbt_offset=int(random.integers(3)),
                sbt_stride=int(random.integers(3))) for origin, end in zip(origins, ends, strict=True)]


def decided(scene: list[dict[str, Any]], one: dict[str, Any], hits: list[brute_force.Hit]) -> bool:
    """Whether binary32 cannot turn the answer: no edge, end point or second hit is too near."""
    bounds = [one["in"]["tmin"], *(hit.t for hit in hits), one["in"]["tmax"]]
    apart = all(b - a > AMBIGUOUS * max(1.0, abs(a)) for a, b in itertools.pairwise(bounds))
    return apart and not brute_force.edges_passed(scene, one["in"], AMBIGUOUS)


@SLOW
@given(seed=st.integers(0, 2**32 - 1), geometries=st.integers(1, 3), instances=st.integers(1, 8), count=st.integers(2, 30),
       mode=st.sampled_from([0, IGNORE]))
def test_nearest_hit_and_anyhit_calls(harness: Harness, seed: int, geometries: int, instances: int, count: int, mode: int) -> None:
    random = np.random.default_rng(seed)
    scene = random_scene(random, geometries, instances, count)
    rays = random_rays(random, "top")
    results = trace(harness, scene, rays, [hitgroup(record, anyhit_mode=mode) for record in range(16)])
    for result, one in zip(results, rays, strict=True):
        check(scene, one, result, mode)


def check(scene: list[dict[str, Any]], one: dict[str, Any], result: Any, mode: int) -> None:
    """The closest hit and the any-hit calls are those of the reference."""
    given_ray = one["in"]
    hits = [hit for hit in brute_force.scene_candidates(scene, given_ray) if brute_force.visible(hit, given_ray["flags"])]
    if not decided(scene, one, hits):
        return
    called = [hit for hit in hits if brute_force.anyhit_enabled(hit.geometry_flags, hit.path.flags, given_ray["flags"])]
    kept = [hit for hit in hits if mode != IGNORE or hit not in called]
    assert missed(result) == (not kept), one
    if kept:
        event, hit = closest(result), kept[0]
        record = hit.path.sbt_offset + hit.gas_index * given_ray["sbtStride"] + given_ray["sbtOffset"]
        assert (event["prim"], event["instId"], event["instIdx"], event["gasIdx"], event["hitKind"], event["rec"]) == (
            hit.primitive, hit.path.instance_id, hit.path.instance_index, hit.gas_index, hit.hit_kind, record), one
        assert event["tmax"] == pytest.approx(hit.t, rel=AMBIGUOUS)
    seen = {(event["prim"], event["gasIdx"], event["instIdx"]) for event in calls(result)}
    may = {(hit.primitive, hit.gas_index, hit.path.instance_index) for hit in called}
    must = {(hit.primitive, hit.gas_index, hit.path.instance_index) for hit in called if not kept or hit.t <= kept[0].t}
    assert must <= seen <= may, one


@SLOW
@given(seed=st.integers(0, 2**32 - 1), count=st.integers(1, 20), instances=st.integers(0, 5))
def test_custom_primitives_are_offered_by_their_boxes(harness: Harness, seed: int, count: int, instances: int) -> None:
    random = np.random.default_rng(seed)
    low = random.uniform(-1, 1, (count, 3))
    bounds = np.concatenate([low, low + random.uniform(0.1, 0.6, (count, 3))], axis=1).astype(np.float32)
    placed = [instance("g", random_transform(random), mask=int(random.integers(1, 4))) for _ in range(instances)]
    scene = [gas(boxes(bounds), name="g"), ias(*placed, name="top")]
    origins, ends = random.uniform(-4, 4, (RAYS, 3)), random.uniform(-1, 1, (RAYS, 3))
    rays = [ray(origin, direction, root="top" if instances else "g", mask=int(random.integers(1, 4)))
            for origin, direction in zip(origins, ends - origins, strict=True)]
    groups = [hitgroup(kind="custom", anyhit_mode=IGNORE, reports=[reported(1.0)])]
    for result, one in zip(trace(harness, scene, rays, groups), rays, strict=True):
        seen = {(event["prim"], event["instIdx"]) for event in calls(result, "IS")}
        must = {(box.primitive, box.path.instance_index) for box in brute_force.scene_boxes(resized(scene, -AMBIGUOUS), one["in"])}
        may = {(box.primitive, box.path.instance_index) for box in brute_force.scene_boxes(resized(scene, AMBIGUOUS), one["in"])}
        assert must <= seen <= may, one


def resized(scene: list[dict[str, Any]], by: float) -> list[dict[str, Any]]:
    """The scene with boxes grown on every side."""
    grown = []
    for node in scene:
        inputs = [{**item, "aabbs": [(np.array(key).reshape(-1, 2, 3) + np.array([[-by], [by]])).ravel().tolist() for key in item["aabbs"]]}
                  for item in node.get("buildInputs", [])]
        grown.append({**node, "buildInputs": inputs} if inputs else node)
    return grown
