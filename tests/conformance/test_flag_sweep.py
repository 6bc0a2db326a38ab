"""Every combination of ray, geometry and instance flags, for every kind of primitive and state of a micromap, against a decision function.

Each place holds an instance of two primitives, one behind the other. All combinations of the flags of a ray are traced at each place.
"""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from harness import Harness
from shaders import flag_sweep as shader

import optixc as ox

RF, GF, IF = ox.RayFlags, ox.GeometryFlags, ox.InstanceFlags
RAY_BITS = (RF.DISABLE_ANYHIT, RF.ENFORCE_ANYHIT, RF.TERMINATE_ON_FIRST_HIT, RF.DISABLE_CLOSESTHIT, RF.CULL_BACK_FACING_TRIANGLES,
            RF.CULL_FRONT_FACING_TRIANGLES, RF.CULL_DISABLED_ANYHIT, RF.CULL_ENFORCED_ANYHIT, RF.FORCE_OPACITY_MICROMAP_2_STATE)
INSTANCE_BITS = (IF.DISABLE_TRIANGLE_FACE_CULLING, IF.FLIP_TRIANGLE_FACING, IF.DISABLE_ANYHIT, IF.ENFORCE_ANYHIT,
                 IF.FORCE_OPACITY_MICROMAP_2_STATE, IF.DISABLE_OPACITY_MICROMAPS)
GEOMETRY_BITS = (GF.DISABLE_ANYHIT, GF.REQUIRE_SINGLE_ANYHIT_CALL, GF.DISABLE_TRIANGLE_FACE_CULLING)
NO_MAP, TRANSPARENT, OPAQUE, UNKNOWN_TRANSPARENT, UNKNOWN_OPAQUE = range(-1, 4)
TRIANGLE, CUSTOM, SPHERE, CURVE = range(4)
# primitive, micromap state, whether the ray comes from behind
VARIANTS = [*itertools.product([TRIANGLE], range(-1, 4), (0, 1)), (CUSTOM, NO_MAP, 0), (SPHERE, NO_MAP, 0), (CURVE, NO_MAP, 0)]
RECORD_OF = {TRIANGLE: 0, CUSTOM: 1, SPHERE: 2, CURVE: 3}
HIT_KINDS = {CUSTOM: 7, SPHERE: 138, CURVE: 132}
SPACING = 4.0
# Every launch takes the places from a step of its own on: all flags meet, each pair many times.
STEP = 23


def sums(bits: tuple[Any, ...]) -> np.ndarray:
    """Every combination."""
    return np.array([sum(chosen) for chosen in itertools.product(*((0, int(bit)) for bit in bits))], np.uint32)


RAY_FLAGS, GEOMETRY_FLAGS, INSTANCE_FLAGS = sums(RAY_BITS), sums(GEOMETRY_BITS), sums(INSTANCE_BITS)
PLACES = np.array(list(itertools.product(range(len(VARIANTS)), GEOMETRY_FLAGS, INSTANCE_FLAGS)), np.uint32)


def expected(places: np.ndarray, ray_flags: np.ndarray, micromaps: bool) -> dict[str, np.ndarray]:
    """For each ray flags (rows) and place (columns): whether primitives are seen, whether any-hit programs run, and the hit kind."""
    kind, state, behind = (np.array([variant[part] for variant in VARIANTS])[places[:, 0]] for part in range(3))
    geometry, instance, ray = places[:, 1], places[:, 2], ray_flags[:, None]
    two_states = ((ray & RF.FORCE_OPACITY_MICROMAP_2_STATE) != 0) | ((instance & IF.FORCE_OPACITY_MICROMAP_2_STATE) != 0)
    state = np.where((instance & IF.DISABLE_OPACITY_MICROMAPS) != 0, NO_MAP, state if micromaps else NO_MAP)
    state = np.where(two_states & (state >= UNKNOWN_TRANSPARENT), state - UNKNOWN_TRANSPARENT, state)
    enabled = np.where(state == NO_MAP, (geometry & GF.DISABLE_ANYHIT) == 0, state >= UNKNOWN_TRANSPARENT)
    for flags, disable, enforce in ((instance, IF.DISABLE_ANYHIT, IF.ENFORCE_ANYHIT), (ray, RF.DISABLE_ANYHIT, RF.ENFORCE_ANYHIT)):
        enabled = ((flags & enforce) != 0) | (((flags & disable) == 0) & enabled)
    seen = (state != TRANSPARENT) & ((ray & np.where(enabled, RF.CULL_ENFORCED_ANYHIT, RF.CULL_DISABLED_ANYHIT)) == 0)
    back = (behind == 1) != ((instance & IF.FLIP_TRIANGLE_FACING) != 0)
    kept = (kind != TRIANGLE) | ((geometry & GF.DISABLE_TRIANGLE_FACE_CULLING) != 0) | ((instance & IF.DISABLE_TRIANGLE_FACE_CULLING) != 0)
    seen &= kept | ((ray & np.where(back, RF.CULL_BACK_FACING_TRIANGLES, RF.CULL_FRONT_FACING_TRIANGLES)) == 0)
    hit_kind = np.where(kind == TRIANGLE, np.where(back, 0xFF, 0xFE), np.array([HIT_KINDS.get(one, 0) for one in range(4)])[kind])
    return {"seen": seen, "enabled": enabled & seen, "kind": hit_kind, "behind": behind}


def structure(context: ox.DeviceContext, kind: int, state: int, flags: int) -> ox.Accel:
    """Two primitives at heights 0 and -1."""
    at = [np.float32([0, 0, -height]) for height in range(2)]
    match kind:
        case 0:
            more = {} if state == NO_MAP else {"opacity_micromap": ox.BuildInputOpacityMicromap(None, np.full(2, -1 - state, np.int32))}
            corners = np.concatenate([np.float32([[-1, -1, 0], [1, -1, 0], [0, 1, 0]]) + one for one in at])
            item: Any = ox.BuildInputTriangles(corners, flags=flags, **more)
        case 1:
            item = ox.BuildInputCustomPrimitives(np.float32([[-1, -1, one[2], 1, 1, one[2]] for one in at]), flags=flags)
        case 2:
            item = ox.BuildInputSpheres(np.stack(at), np.full(2, 0.25, np.float32), flags=flags)
        case _:
            points = np.concatenate([[one - np.float32([1, 0, 0]), one + np.float32([1, 0, 0])] for one in at])
            item = ox.BuildInputCurves(ox.PrimitiveType.ROUND_LINEAR, points, np.full(4, 0.25, np.float32), np.uint32([0, 2]), flags=flags)
    return context.accel_build([item], build_flags=ox.BuildFlags.ALLOW_DISABLE_OPACITY_MICROMAPS)


def scenes(context: ox.DeviceContext) -> dict[str, Any]:
    """The places under one level of instances, and the same as a moving graph."""
    structures = {key: structure(context, *key) for key in {(*VARIANTS[place[0]][:2], int(place[1])) for place in PLACES}}
    children = [structures[*VARIANTS[place[0]][:2], int(place[1])] for place in PLACES]
    transforms = np.zeros((len(PLACES), 3, 4), np.float32)
    transforms[:, range(3), range(3)] = 1.0
    transforms[:, :2, 3] = centers()
    records = np.array([RECORD_OF[VARIANTS[place[0]][0]] for place in PLACES], np.uint32)
    flat = context.accel_build([ox.BuildInputInstances(children, transforms=transforms, sbt_offsets=records, flags=PLACES[:, 2])])
    moving = context.matrix_motion_transform(flat, np.stack([np.eye(3, 4, dtype=np.float32)] * 2))
    outer = int(IF.DISABLE_ANYHIT | IF.FLIP_TRIANGLE_FACING)  # flags of outer instances say nothing
    return {"flat": flat, "moving": context.accel_build([ox.BuildInputInstances([moving], flags=outer)])}


def centers() -> np.ndarray:
    number = np.arange(len(PLACES))
    return SPACING * np.stack([number % 100, number // 100], axis=1).astype(np.float32)


def sweep(harness: Harness, scene: Any, programs: str, micromaps: bool, chosen: np.ndarray) -> np.ndarray:
    """The words of all ray flags at the chosen places; rays only at some flags where they are interpreted."""
    anyhit = programs != "none"
    key = ("sweep", anyhit)
    if key not in harness.kept:
        module, create = harness.module("flag_sweep.py"), harness.context.program_group_create
        hit = {"closesthit": module["__closesthit__note"], **({"anyhit": module["__anyhit__count"]} if anyhit else {})}
        harness.kept[key] = [create(raygen=module["__raygen__sweep"]), create(miss=module["__miss__note"]), create(**hit),
                             create(**hit, intersection=module["__intersection__plane"])]
    raygen, miss, built_in, custom = harness.kept[key]
    options = ox.PipelineCompileOptions(uses_motion_blur=True, allow_opacity_micromaps=micromaps)
    pipeline = harness.pipeline(("sweep", anyhit, micromaps), harness.kept[key], options=options)
    record = shader.Record(int(programs == "ignore"))
    table = ox.ShaderBindingTable(raygen=raygen.record(), miss=[miss.record()],
                                  hitgroup=[group.record(record) for group in (built_in, custom, built_in, built_in)])
    places = np.zeros(len(chosen), shader.Place.dtype)
    places["x"], places["y"] = centers()[chosen].T
    places["height"] = np.where([VARIANTS[place[0]][2] for place in PLACES[chosen]], -4.0, 3.0)
    out = np.full((len(RAY_FLAGS), len(chosen)), 0xFFFFFFFF, np.uint32)
    harness.launch(pipeline, shader.Params(places=places, flags=RAY_FLAGS, out=out, scene=scene), table, len(chosen), len(RAY_FLAGS))
    return out


def check(out: np.ndarray, chosen: np.ndarray, programs: str, micromaps: bool) -> None:
    """Compares every word with the decision."""
    told = expected(PLACES[chosen], RAY_FLAGS, micromaps)
    ray = RAY_FLAGS[:, None]
    called = told["enabled"] if programs != "none" else np.zeros_like(told["enabled"])
    hit = told["seen"] & ~called if programs == "ignore" else told["seen"]
    runs_closest = hit & ((ray & RF.DISABLE_CLOSESTHIT) == 0)
    calls, ran, missed = out & 0xFF, (out & shader.CLOSESTHIT) != 0, (out & shader.MISSED) != 0
    for name, wrong in {
        "miss": missed != ~hit, "closest hit": ran != runs_closest,
        "hit kind": runs_closest & (out // shader.KIND != np.broadcast_to(told["kind"], out.shape)),
        "no call": ~called & (calls != 0), "too many calls": calls > 2,
        "calls": called & ((calls != 2) if programs == "ignore" else (calls < 1)),
        "calls after the first hit": called & hit & ((ray & RF.TERMINATE_ON_FIRST_HIT) != 0) & (calls != 1),
        "nearest": runs_closest & ((ray & RF.TERMINATE_ON_FIRST_HIT) == 0) & (((out & shader.SECOND) != 0) != (told["behind"] == 1)),
    }.items():
        found = np.argwhere(wrong)
        assert len(found) == 0, [(name, hex(RAY_FLAGS[row]), VARIANTS[PLACES[chosen[column]][0]], PLACES[chosen[column]][1:].tolist(),
                                  hex(out[row, column])) for row, column in found[:5]]


@pytest.mark.parametrize("graph", ["flat", "moving"])
@pytest.mark.parametrize("programs", ["none", "accept", "ignore"])
@pytest.mark.parametrize("micromaps", [False, True])
def test_every_combination_of_flags(harness: Harness, graph: str, programs: str, micromaps: bool) -> None:
    if "sweep scenes" not in harness.kept:
        harness.kept["sweep scenes"] = scenes(harness.context)
    start = ["none", "accept", "ignore"].index(programs) + 3 * micromaps + 6 * (graph == "moving")
    step = STEP if harness.mode != "interpreter" else len(PLACES) // 2 - 7
    chosen = np.arange(start, len(PLACES), step)
    check(sweep(harness, harness.kept["sweep scenes"][graph], programs, micromaps, chosen), chosen, programs, micromaps)
