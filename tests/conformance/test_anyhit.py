"""Area K: any-hit control; geometry, instance and ray flags."""

from __future__ import annotations

import itertools

import brute_force
import numpy as np
import pytest
from harness import Harness
from scenes import (
    CORNER,
    UP,
    boxes,
    calls,
    closest,
    gas,
    hitgroup,
    ias,
    instance,
    kinds,
    missed,
    ray,
    reported,
    trace,
    triangles,
)

ACCEPT, IGNORE, TERMINATE = 0, 1, 2
GF_DISABLE, GF_SINGLE, GF_NO_CULLING = 1, 2, 4
IF_NO_CULLING, IF_FLIP, IF_DISABLE, IF_ENFORCE = 1, 2, 4, 8
RF_DISABLE, RF_ENFORCE, RF_FIRST, RF_NO_CLOSESTHIT, RF_CULL_BACK, RF_CULL_FRONT = 1, 2, 4, 8, 16, 32
RF_CULL_DISABLED, RF_CULL_ENFORCED = 64, 128
ABOVE = (0.25, 0.25, 1.0)
MIRROR = [-1.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]


def layers(count: int, flags: int = 0) -> dict[str, object]:
    """Parallel triangles at z = 0, -1, ..."""
    return triangles([[(x, y, -float(level)) for x, y, _ in CORNER] for level in range(count)], (flags,))


def test_T128_one_call_per_crossing(harness: Harness) -> None:
    for flags in (GF_SINGLE, 0):
        for build in (0, 4, 8):
            (result,) = trace(harness, [gas(layers(5, flags), build_flags=build)], [ray(ABOVE)], [hitgroup(anyhit_mode=IGNORE)])
            seen = sorted(event["prim"] for event in calls(result))
            assert seen == [0, 1, 2, 3, 4] if flags else set(seen) == {0, 1, 2, 3, 4}
            assert missed(result)


def test_T129_terminate_ends_the_ray(harness: Harness) -> None:
    (result,) = trace(harness, [gas(layers(5))], [ray(ABOVE)], [hitgroup(anyhit_mode=TERMINATE)])
    assert kinds(result) == ["AH", "CH"]
    assert calls(result)[0]["prim"] == closest(result)["prim"]


@pytest.mark.parametrize(("geometry", "instance_flags", "ray_flags", "called"), [
    (GF_DISABLE, 0, 0, False), (GF_DISABLE, 0, RF_ENFORCE, True), (GF_DISABLE, IF_ENFORCE, 0, True),
    (GF_DISABLE, IF_ENFORCE, RF_DISABLE, False), (0, IF_DISABLE, RF_ENFORCE, True), (0, IF_DISABLE, 0, False), (0, 0, RF_DISABLE, False),
    (0, IF_DISABLE | IF_ENFORCE, 0, True), (0, 0, RF_DISABLE | RF_ENFORCE, True)])
def test_T130_who_decides_about_anyhit(harness: Harness, geometry: int, instance_flags: int, ray_flags: int, called: bool) -> None:
    scene = [gas(triangles(CORNER, (geometry,))), ias(instance(flags=instance_flags))]
    (result,) = trace(harness, scene, [ray(ABOVE, root="ias", flags=ray_flags)])
    assert kinds(result) == (["AH", "CH"] if called else ["CH"])


@pytest.mark.parametrize(("geometry", "ray_flags", "seen"), [
    (GF_DISABLE, RF_CULL_DISABLED, False), (0, RF_CULL_ENFORCED, False), (GF_DISABLE, RF_CULL_ENFORCED, True), (0, RF_CULL_DISABLED, True)])
def test_T131_T132_culling_by_anyhit_state(harness: Harness, geometry: int, ray_flags: int, seen: bool) -> None:
    (result,) = trace(harness, [gas(triangles(CORNER, (geometry,)))], [ray(ABOVE, flags=ray_flags)])
    assert missed(result) is not seen


def test_T133_the_flag_decides_not_the_program(harness: Harness) -> None:
    (result,) = trace(harness, [gas(triangles(CORNER))], [ray(ABOVE, flags=RF_CULL_DISABLED)], [hitgroup(anyhit=False)])
    assert kinds(result) == ["CH"]


def test_T134_a_hit_group_without_anyhit_accepts(harness: Harness) -> None:
    (result,) = trace(harness, [gas(triangles(CORNER))], [ray(ABOVE)], [hitgroup(anyhit=False)])
    assert kinds(result) == ["CH"]


def test_T135_disabled_closesthit(harness: Harness) -> None:
    results = trace(harness, [gas(triangles(CORNER))], [ray(ABOVE, flags=RF_NO_CLOSESTHIT), ray((5, 5, 1), flags=RF_NO_CLOSESTHIT)])
    assert [kinds(result) for result in results] == [["AH"], ["MS"]]


def test_T136_the_first_accepted_hit_ends_the_ray(harness: Harness) -> None:
    (result,) = trace(harness, [gas(layers(10))], [ray(ABOVE, flags=RF_FIRST)])
    assert kinds(result) == ["AH", "CH"]
    (result,) = trace(harness, [gas(layers(10, GF_SINGLE))], [ray(ABOVE, flags=RF_FIRST)], [hitgroup(anyhit_mode=IGNORE)])
    assert sorted(event["prim"] for event in calls(result)) == list(range(10))


def test_T137_shadow_rays_agree_with_brute_force(harness: Harness) -> None:
    random = np.random.default_rng(137)
    corners = (random.random((60, 1, 3)) * 4 + random.normal(0, 0.4, (60, 3, 3))).astype(np.float32)
    origins, ends = random.random((300, 3)) * 4, random.random((300, 3)) * 4
    flags = RF_FIRST | RF_NO_CLOSESTHIT | RF_DISABLE
    rays = [ray(origin, end, tmax=1.0, flags=flags) for origin, end in zip(origins.tolist(), (ends - origins).tolist(), strict=True)]
    scene = [gas(triangles(corners))]
    for result, one in zip(trace(harness, scene, rays), rays, strict=True):
        assert missed(result) == (not brute_force.scene_candidates(scene, one["in"]))


@pytest.mark.parametrize(("origin", "direction", "flags", "hits"), [
    (ABOVE, (0, 0, -1), RF_CULL_BACK, True), (ABOVE, (0, 0, -1), RF_CULL_FRONT, False),
    ((0.25, 0.25, -1.0), UP, RF_CULL_BACK, False), ((0.25, 0.25, -1.0), UP, RF_CULL_FRONT, True),
    (ABOVE, (0, 0, -1), RF_CULL_BACK | RF_CULL_FRONT, False)])
def test_T138_face_culling(harness: Harness, origin: tuple[float, ...], direction: tuple[float, ...], flags: int, hits: bool) -> None:
    (result,) = trace(harness, [gas(triangles(CORNER))], [ray(origin, direction, flags=flags)])
    assert missed(result) is not hits


def test_T139_culling_can_be_defeated(harness: Harness) -> None:
    below = (0.25, 0.25, -1.0)
    scene = [gas(triangles(CORNER, (GF_NO_CULLING,))), gas(triangles(CORNER), name="plain"), ias(instance("plain", flags=IF_NO_CULLING))]
    results = trace(harness, scene, [ray(below, UP, flags=RF_CULL_BACK), ray(below, UP, root="ias", flags=RF_CULL_BACK)])
    assert [closest(result)["hitKind"] for result in results] == [0xFF, 0xFF]


def test_T140_flipped_facing(harness: Harness) -> None:
    scene = [gas(triangles(CORNER)), ias(instance(flags=IF_FLIP))]
    rays = [ray(ABOVE, root="ias"), ray((0.25, 0.25, -1.0), UP, root="ias"), ray(ABOVE, root="ias", flags=RF_CULL_BACK),
            ray((0.25, 0.25, -1.0), UP, root="ias", flags=RF_CULL_BACK)]
    results = trace(harness, scene, rays)
    assert [closest(result)["hitKind"] for result in results[:2]] == [0xFF, 0xFE]
    assert [missed(result) for result in results[2:]] == [True, False]


def test_T141_a_mirror_does_not_turn_the_face(harness: Harness) -> None:
    scene = [gas(triangles(CORNER)), ias(instance(transform=MIRROR)), ias(instance(transform=MIRROR, flags=IF_FLIP), name="flipped")]
    results = trace(harness, scene, [ray(ABOVE, root="ias"), ray(ABOVE, root="flipped")])
    assert [closest(result)["hitKind"] for result in results] == [0xFE, 0xFF]


def test_T142_culling_is_for_triangles_only(harness: Harness) -> None:
    rays = [ray((0.25, 0.25, 5.0), flags=flags) for flags in (RF_CULL_BACK, RF_CULL_FRONT, RF_CULL_BACK | RF_CULL_FRONT)]
    groups = [hitgroup(kind="custom", reports=[reported(5.0)])]
    assert all(kinds(result) == ["IS", "AH", "RP", "CH"] for result in trace(harness, [gas(boxes([[0, 0, 0, 1, 1, 1]]))], rays, groups))


def test_T143_exclusive_flags_raise_nothing(harness: Harness) -> None:
    # Recorded: illegal combinations raise nothing, not even in validation (spec T143 expects a report).
    flags = [RF_DISABLE | RF_CULL_DISABLED, RF_ENFORCE | RF_CULL_ENFORCED, RF_CULL_DISABLED | RF_CULL_ENFORCED]
    assert all(missed(result) for result in trace(harness, [gas(triangles(CORNER))], [ray(ABOVE, flags=flag) for flag in flags]))


def test_T144_ray_flags_have_sixteen_bits(harness: Harness) -> None:
    (result,) = trace(harness, [gas(triangles(CORNER))], [ray(ABOVE, flags=0x50000 | RF_CULL_BACK)])
    assert closest(result)["rayFlags"] == RF_CULL_BACK


@pytest.mark.parametrize("decision", [ACCEPT, IGNORE])
def test_T145_all_flags_against_the_model(harness: Harness, decision: int) -> None:
    geometry = (0, GF_DISABLE, GF_SINGLE, GF_NO_CULLING, GF_DISABLE | GF_NO_CULLING)
    instances = (0, IF_DISABLE, IF_ENFORCE, IF_DISABLE | IF_ENFORCE, IF_FLIP, IF_NO_CULLING)
    combinations = list(itertools.product(range(len(geometry)), range(len(instances))))
    scene = [*(gas(layers(2, flags), name=f"g{index}") for index, flags in enumerate(geometry)),
             ias(*(instance(f"g{g}", [1, 0, 0, 3 * g, 0, 1, 0, 3 * i, 0, 0, 1, 0], flags=instances[i]) for g, i in combinations))]
    ray_flags = [a | b | c for a in (0, 1, 2, 3) for b in (0, 16, 32, 48) for c in (0, 64, 128, 192)]
    rays = [ray((3 * g + 0.25, 3 * i + 0.25, z), (0, 0, -z), root="ias", flags=flags)
            for g, i in combinations for flags in ray_flags for z in (1.0, -3.0)]
    if harness.mode == "interpreter":
        # A prime step, so that every flag still meets every other; all of them would take minutes.
        rays = rays[::7]
    for result, one in zip(trace(harness, scene, rays, [hitgroup(anyhit_mode=decision)]), rays, strict=True):
        given = one["in"]
        candidates = [hit for hit in brute_force.scene_candidates(scene, given) if brute_force.visible(hit, given["flags"])]
        called = [hit for hit in candidates if brute_force.anyhit_enabled(hit.geometry_flags, hit.path.flags, given["flags"])]
        kept = [hit for hit in candidates if decision == ACCEPT or hit not in called]
        assert missed(result) == (not kept), given
        if kept:
            assert (closest(result)["prim"], closest(result)["hitKind"]) == (kept[0].primitive, kept[0].hit_kind), given
        nearer = {hit.primitive for hit in called if not kept or hit.t <= kept[0].t}
        seen = {event["prim"] for event in calls(result)}
        assert nearer <= seen <= {hit.primitive for hit in called}, given
