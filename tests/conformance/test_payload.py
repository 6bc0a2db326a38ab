"""Area F: payload."""

from __future__ import annotations

import numpy as np
from harness import Harness
from scenes import boxes, gas, hitgroup, kinds, ray, trace
from shaders import payload as shader

import optixc as ox

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
BEFORE = [10, 11, 12, 13, 14, 15, 16, 17]
CLOSEST_HITS = ("third", "by_number", "three", "copy_first", "nested", "scratch", "undefined")


def run(harness: Harness, closesthit: str | None = None, anyhit: bool = False, mode: int = 0, layers: int = 1, flags: int = 0,
        geometry_flags: int = 0, raygen: str = "eight", miss: bool = True) -> list[int]:
    """The words after one trace at `layers` parallel triangles."""
    module = harness.module("payload.py")
    create = harness.context.program_group_create
    if "payload groups" not in harness.kept:
        groups = {("raygen", name): create(raygen=module[f"__raygen__{name}"]) for name in ("eight", "tuple")}
        groups |= {("miss", True): create(miss=module["__miss__copy_first"]), ("miss", False): create(miss=None)}
        groups |= {(name, hit): create(closesthit=name and module[f"__closesthit__{name}"],
                                       anyhit=module["__anyhit__by_mode"] if hit else None)
                   for name in (*CLOSEST_HITS, None) for hit in (False, True)}
        harness.kept["payload groups"] = groups
    groups = harness.kept["payload groups"]
    pipeline = harness.pipeline("payload", groups.values(), max_trace_depth=4)
    levels = np.concatenate([CORNERS - (0, 0, level) for level in range(layers)]).astype(np.float32) if layers else CORNERS + 50
    scene = harness.context.accel_build([ox.BuildInputTriangles(levels, flags=geometry_flags)])
    out = np.zeros((1, 8), np.uint32)
    params = shader.Params(scene=scene.handle, out=out, mode=np.array([mode], np.uint32), ray_flags=flags,
                           scratch=np.zeros((1, 4), np.uint32))
    params.scratch[0, :3] = BEFORE[:3]
    sbt = ox.ShaderBindingTable(raygen=groups["raygen", raygen].record(), miss=[groups["miss", miss].record()],
                                hitgroup=[groups[closesthit, anyhit].record()])
    harness.launch(pipeline, params, sbt, 1)
    return [int(word) for word in out[0]]


def test_T051_words_that_nobody_sets_keep_their_value(harness: Harness) -> None:
    assert run(harness, "third") == [10, 11, 12, 33, 14, 15, 16, 17]


def test_T051_words_by_number_are_the_fields(harness: Harness) -> None:
    assert run(harness, "by_number") == [10, 11, 12, 110, 14, 15, 16, 17]


def test_T050_the_tuple_form_gives_the_words_back(harness: Harness) -> None:
    assert run(harness, "three", raygen="tuple")[:3] == [1, 2, 3]


def test_T052_anyhit_counts_and_the_miss_program_sees_it(harness: Harness) -> None:
    require_single = 2
    assert run(harness, anyhit=True, mode=shader.COUNT, layers=5, geometry_flags=require_single)[:2] == [15, 15]


def test_T053_words_set_before_terminate_are_kept(harness: Harness) -> None:
    assert run(harness, "copy_first", anyhit=True, mode=shader.TERMINATE)[:2] == [77, 77]


def test_T053_nothing_runs_after_ignore(harness: Harness) -> None:
    assert run(harness, "copy_first", anyhit=True, mode=shader.WRITE_AFTER_IGNORE)[:2] == [10, 10]


def test_T054_what_an_intersection_program_writes_is_kept(harness: Harness) -> None:
    (result,) = trace(harness, [gas(boxes([[0, 0, 0, 1, 1, 1]]))], [ray((0.5, 0.5, 5.0))], [hitgroup(kind="custom")])
    assert kinds(result) == ["IS", "MS"]
    assert result.events[1]["p"][1] == 0x10000


def test_T055_nested_traces_have_their_own_words(harness: Harness) -> None:
    # depth 10 sees 11 + (depth 11 sees ...): each level adds its inner caller's first word and 100 times its own
    words = run(harness, "nested")
    assert words == [10, 11, 12 + 11 + 1000, 13, 14, 15, 16, 17]


def test_T066_an_empty_miss_group_changes_nothing(harness: Harness) -> None:
    assert run(harness, layers=0, miss=False) == BEFORE


def test_T067_an_empty_hit_group_is_a_hit_without_programs(harness: Harness) -> None:
    assert run(harness) == BEFORE


def test_T056_a_hit_program_writes_memory_of_its_caller(harness: Harness) -> None:
    # Where OptiX packs a pointer into two words, a payload carries the row of an array that the caller works on.
    assert run(harness, "scratch") == [10, 11, 12, 13, 14, 15, 16, 10 + 11 + 12]


def test_T064_an_undefined_word_leaves_the_others_alone(harness: Harness) -> None:
    words = run(harness, "undefined")
    assert words[:5] + words[6:] == [10, 11, 12, 13, 14, 16, 17]
