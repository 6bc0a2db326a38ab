"""Random graphs that end in triangles, boxes, spheres, linear and cubic curves, against the reference without any acceleration structure.

Every structure has a record of its own: instances add their structure's number in the low three bits of the record's.
"""

from __future__ import annotations

import itertools
from typing import Any

import brute_force
import brute_force_mixed
import numpy as np
import pytest
from brute_force import Hit
from harness import Harness
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from oracle_scene import build
from scenes import boxes, gas, ias, instance, ray, triangles
from shaders import mixed_graphs as shader
from test_curves import curves
from test_random_graphs import Nodes, at_the_end_of_a_range, random_motion, random_srt
from test_random_scenes import AMBIGUOUS, RAY_FLAGS, random_transform
from test_spheres import spheres

import optixc as ox

RAYS = 48
STRUCTURES = 8
RECORDS = 16 * STRUCTURES
LINEAR, CUBIC = 0x2503, 0x2502
KINDS = ("triangles", "boxes", "spheres", "linear", "cubic")
# Two solvers of cubic curves agree within this in units of t; nearer hits have no order.
APART = 2e-3
SLOW = settings(max_examples=10, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture], derandomize=True)
EYE = (0.5, -0.25, 7.0)


def random_item(random: np.random.Generator, kind: str, count: int) -> dict[str, Any]:
    """A build input at rest."""
    flags = (int(random.integers(0, 8)),)
    centers = random.uniform(-1, 1, (count, 3))
    match kind:
        case "triangles":
            return triangles(centers[:, None] + random.normal(0, 0.5, (count, 3, 3)), flags)
        case "boxes":
            return boxes(np.concatenate([centers, centers + random.uniform(0.1, 0.7, (count, 3))], axis=1), flags)
        case "spheres":
            return spheres(centers, random.uniform(0.1, 0.4, count), flags)
        case "linear":
            points = (centers[:, None] + random.normal(0, 0.5, (count, 2, 3))).reshape(-1, 3)
            return curves(LINEAR, points, random.uniform(0.05, 0.2, 2 * count), range(0, 2 * count, 2), flags=flags[0])
        case _:
            points = (centers[:, None] + np.cumsum(random.normal(0, 0.6, (count, 4, 3)), axis=1)).reshape(-1, 3)
            return curves(CUBIC, points, 0.05, range(0, 4 * count, 4), flags=flags[0])


def random_structure(random: np.random.Generator, number: int, count: int) -> dict[str, Any]:
    """A GAS of one kind of primitive, at rest or with two or three keys."""
    item = random_item(random, KINDS[int(random.integers(len(KINDS)))], count)
    keys = int(random.choice([1, 1, 2, 3]))
    if keys > 1:
        for name, width in (("vertices", 3), ("aabbs", 3), ("radii", 0)):
            if name in item:
                first = np.array(item[name][0])
                moves = [np.tile(random.normal(0, 0.4, 3), len(first) // 3) if width else 0.0 for _ in range(keys)]
                grown = [1.0 if width else random.uniform(0.8, 1.2) for _ in range(keys)]
                item[name] = [np.float32(first * grow + move).tolist() for grow, move in zip(grown, moves, strict=True)]
    made = gas(item, name=f"g{number}", build_flags=int(random.choice([0, 1, 4])))
    return {**made, "motion": random_motion(random, keys)} if keys > 1 else made


def structure_below(scene: Nodes, name: str) -> int:
    """The number of the structure that a chain of transforms ends in, 0 above instances, which add their own."""
    node = next(node for node in scene if node["name"] == name)
    while "child" in node:
        node = next(other for other in scene if other["name"] == node["child"])
    return int(node["name"][1:]) if node["kind"] == "GAS" else 0


def random_instance(random: np.random.Generator, scene: Nodes, name: str, number: int) -> dict[str, Any]:
    offset = STRUCTURES * int(random.integers(3)) + structure_below(scene, name)
    return instance(name, random_transform(random), instance_id=number, sbt_offset=offset, mask=int(random.choice([255, 255, 1, 2, 6])),
                    flags=int(random.integers(16)))


def random_scene(random: np.random.Generator, structures: int, nodes: int, count: int) -> Nodes:
    """Structures g0, g1, ..., nodes n0, n1, ... above them: instances, static and moving transforms; and `top` above a few of all."""
    scene = [random_structure(random, number, count) for number in range(structures)]
    for number in range(nodes):
        below, name = [node["name"] for node in scene][-5:], f"n{number}"
        child, kind = below[int(random.integers(len(below)))], random.choice(["IAS", "static", "matrixMotion", "srtMotion"])
        if kind == "IAS":
            placed = [random_instance(random, scene, below[int(random.integers(len(below)))], 100 * number + place)
                      for place in range(int(random.integers(1, 4)))]
            motion = {"motion": random_motion(random, int(random.integers(2, 5)))} if random.random() < 0.3 else {}
            scene.append({**ias(*placed, name=name), **motion})
            continue
        keys = 1 if kind == "static" else int(random.integers(2, 5))
        first = np.array(random_transform(random))
        data = [value for _ in range(keys) for value in random_srt(random)] if kind == "srtMotion" else [
            float(value) for _ in range(keys) for value in (first + random.normal(0, 0.15, 12)).astype(np.float32)]
        motion = {} if kind == "static" else {"motion": random_motion(random, keys)}
        scene.append({"name": name, "kind": str(kind), "child": child, "data": data, **motion})
    placed = [random_instance(random, scene, node["name"], 2000 + number) for number, node in enumerate(scene[-4:])]
    return [*scene, ias(*placed, name="top")]


def box_table(scene: Nodes) -> tuple[np.ndarray, dict[int, tuple[int, int]]]:
    """The boxes of all structures at all keys, and where those of a structure begin and how many they are."""
    rows: list[list[float]] = [[0.0] * 6]
    places = {}
    for number, node in enumerate(scene):
        for item in node.get("buildInputs", []):
            if item["type"] == "custom":
                places[number] = (len(rows), len(item["aabbs"][0]) // 6)
                rows += [row for key in item["aabbs"] for row in np.reshape(key, (-1, 6)).tolist()]
    return np.array(rows, np.float32), places


def groups(harness: Harness, anyhit: bool) -> dict[str, Any]:
    """Program groups by role or kind of geometry."""
    key = ("mixed graphs", anyhit)
    if key not in harness.kept:
        module, create = harness.module("mixed_graphs.py"), harness.context.program_group_create
        programs = {"anyhit": module["__anyhit__count"]} if anyhit else {}
        solid = create(closesthit=module["__closesthit__solid"], **programs)
        harness.kept[key] = {
            "rays": create(raygen=module["__raygen__rays"]), "eye": create(raygen=module["__raygen__eye"]),
            "miss": create(miss=module["__miss__nothing"]), "triangles": solid, "spheres": solid,
            "custom": create(closesthit=module["__closesthit__solid"], intersection=module["__intersection__box"], **programs),
            "curves": create(closesthit=module["__closesthit__curve"], **programs)}
    return harness.kept[key]


def launch(harness: Harness, scene: Nodes, rays: list[dict[str, Any]], raygen: str, anyhit: bool, ignores: bool) -> Any:
    """The parameters after all rays were traced."""
    made = build(harness.context, scene)
    rows = np.zeros(len(rays), shader.Ray.dtype)
    for row, one in zip(rows, rays, strict=True):
        given_ray = one["in"]
        row["origin"], row["direction"] = given_ray["o"], given_ray["d"]
        for name in ("tmin", "tmax", "time", "mask", "flags"):
            row[name] = given_ray[name]
        row["sbt_offset"], row["handle"] = given_ray["sbtOffset"], int(made[given_ray["root"]].handle)
    table, places = box_table(scene)
    programs = groups(harness, anyhit)
    kinds = [node["buildInputs"][0]["type"] for node in scene if node["kind"] == "GAS"]
    records = []
    for number in range(RECORDS):
        structure = min(number % STRUCTURES, len(kinds) - 1)
        records.append(programs[kinds[structure]].record(shader.Record(number, *places.get(structure, (0, 0)), int(ignores))))
    sbt = ox.ShaderBindingTable(raygen=programs[raygen].record(), miss=[programs["miss"].record()], hitgroup=records)
    used = [programs[name] for name in (raygen, "miss", "triangles", "custom", "curves")]
    pipeline = harness.pipeline(("mixed graphs", raygen, anyhit), used, options=ox.PipelineCompileOptions(uses_motion_blur=True))
    count = len(rays)
    params = shader.Params(rays=rows, hits=np.zeros(count, shader.Hit.dtype), to_world=np.zeros((count, 12), np.float32),
                           to_object=np.zeros((count, 12), np.float32), boxes=table, eye=EYE, scene=made["top"].handle)
    harness.launch(pipeline, params, sbt, count)
    return params


def aimed(random: np.random.Generator, scene: Nodes, from_eye: bool) -> list[dict[str, Any]]:
    """Rays at or near primitives, from anywhere with all flags, masks and roots, or from one point with none."""
    made = []
    for number in range(RAYS):
        time = float(random.choice([random.uniform(-2, 3), random.uniform(-0.5, 1)]))
        mask = int(random.choice([255, 255, 255, 1, 2, 4, 6]))
        root = "top" if from_eye else ["top", "top", scene[-2]["name"]][number % 3]
        origin = np.float32(EYE) if from_eye else random.uniform(-6, 6, 3).astype(np.float32)
        end = (target(random, scene, root, time, mask) + random.normal(0, 0.15, 3)).astype(np.float32)
        if from_eye:
            made.append(ray(EYE, end - origin, root=root, mask=mask, time=time))
            continue
        flags = int(random.choice([0, int(random.choice(RAY_FLAGS))]))
        made.append(ray(origin, end - origin, root=root, flags=flags, mask=mask, time=time, tmin=float(random.choice([0.0, 0.0, 0.5])),
                        tmax=float(random.choice([1e16, 1.2])), sbt_offset=structure_below(scene, root)))
    return made


def target(random: np.random.Generator, scene: Nodes, root: str, time: float, mask: int) -> np.ndarray:
    """The middle of a primitive that can be seen at the time, or any point."""
    given_ray = ray((0, 0, 0), root=root, time=time, mask=mask)["in"]
    leaves = [(item, path) for item, path, *_ in brute_force.leaves(scene, given_ray)]
    if not leaves:
        return random.uniform(-2.5, 2.5, 3)
    item, path = leaves[int(random.integers(len(leaves)))]
    corners = {"triangles": 3, "custom": 2, "spheres": 1}.get(item["type"]) or len(item["vertices"]) // 3 // len(item["indices"])
    points = np.reshape(item["aabbs" if item["type"] == "custom" else "vertices"], (-1, corners, 3)).mean(axis=1)
    return path.to_world[:, :3] @ points[int(random.integers(len(points)))] + path.to_world[:, 3]


def is_decided(scene: Nodes, one: dict[str, Any], hits: list[Hit]) -> bool:
    """Whether binary32 and the solvers of curves cannot turn the answer."""
    bounds = [one["in"]["tmin"], *(hit.t for hit in hits), one["in"]["tmax"]]
    return (all(b - a > APART * max(1.0, abs(a)) for a, b in itertools.pairwise(bounds))
            and not brute_force.edges_passed(scene, one["in"], AMBIGUOUS) and not at_the_end_of_a_range(scene, one["in"]["time"])
            and brute_force_mixed.is_decided(scene, one["in"]))


def check(scene: Nodes, one: dict[str, Any], params: Any, row: int, anyhit: bool, ignores: bool) -> bool:
    """Compares one ray; whether there was something to compare."""
    flags = one["in"]["flags"]
    all_hits = brute_force_mixed.candidates(scene, one["in"])
    if not is_decided(scene, one, all_hits):
        return False
    seen, called = brute_force_mixed.in_order(all_hits, flags)
    kept = [hit for hit in seen if not (anyhit and ignores and hit in called)]
    found = params.hits[row]
    assert (int(found["is_hit"]), int(found["is_occluded"])) == (bool(kept), bool(kept)), one
    if kept:
        hit = kept[0]
        assert {name: int(found[name]) for name in ("primitive", "gas_index", "instance_id", "instance_index", "kind", "record")} == {
            "primitive": hit.primitive, "gas_index": hit.gas_index, "instance_id": hit.path.instance_id,
            "instance_index": hit.path.instance_index, "kind": hit.hit_kind,
            "record": hit.path.sbt_offset + hit.gas_index + one["in"]["sbtOffset"]}, one
        assert float(found["t"]) == pytest.approx(hit.t, rel=APART / 2), one
        for name, expected in (("to_world", hit.path.to_world), ("to_object", hit.path.to_object)):
            size = np.abs(expected).max()
            assert np.allclose(getattr(params, name)[row].reshape(3, 4), expected, atol=AMBIGUOUS * size), (name, one)
    if anyhit:
        must = sum(not kept or hit.t <= kept[0].t for hit in called)
        assert must <= int(found["calls"]) <= len(called), one
    return True


@SLOW
@given(seed=st.integers(0, 2**32 - 1), structures=st.integers(1, STRUCTURES), nodes=st.integers(1, 7), count=st.integers(1, 8),
       raygen=st.sampled_from(["rays", "rays", "eye"]), programs=st.sampled_from(["none", "accept", "ignore"]))
def test_graphs_of_all_primitives(harness: Harness, seed: int, structures: int, nodes: int, count: int, raygen: str, programs: str) -> None:
    random = np.random.default_rng(seed)
    scene = random_scene(random, structures, nodes, count)
    rays = aimed(random, scene, raygen == "eye")
    anyhit, ignores = programs != "none", programs == "ignore"
    params = launch(harness, scene, rays, raygen, anyhit, ignores)
    for row, one in enumerate(rays):
        check(scene, one, params, row, anyhit, ignores)
