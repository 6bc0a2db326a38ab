"""Area S: states of the hit object after each kind of call. The recorded probes of a real OptiX say the same of more modes."""

from __future__ import annotations

from typing import Any

from harness import Harness
from oracle_hit_objects import look_and_invoke
from shaders import hit_objects

AT, DOWN = [0.25, 0.25, 5.0], [0.0, 0.0, -1.0]
CALLS = (hit_objects.CLOSESTHIT, hit_objects.MISS)


def seen(harness: Harness, mode: int) -> tuple[dict[int, dict[str, Any]], list[dict[str, Any]]]:
    """The states by their tags, the log in order."""
    states, log = look_and_invoke(harness, mode)
    return {state["tag"]: state for state in states}, log


def is_nop(state: dict[str, Any]) -> bool:
    """A nop whose other queries are all 0."""
    numbers = [state[key] for key in ("isHit", "isMiss", "instId", "instIdx", "prim", "nTransforms", "gasIdx", "hitKind", "rayFlags",
                                      "sbtRecordIndex", "tmin", "tmax", "time")]
    return state["isNop"] == 1 and not any(numbers) and not any(state["wo"]) and not any(state["wd"]) and not any(state["attr"])


def test_T254_programs_start_with_a_nop(harness: Harness) -> None:
    states, _ = seen(harness, 0)
    assert is_nop(states[0])
    assert is_nop(states[1])
    states, _ = seen(harness, 1)
    assert is_nop(states[11])
    closest_hit, _ = seen(harness, 11)
    assert is_nop(closest_hit[1000])


def test_T255_a_traversal_that_hits(harness: Harness) -> None:
    states, log = seen(harness, 1)
    state = states[10]
    assert (state["isHit"], state["isMiss"], state["isNop"]) == (1, 0, 0)
    assert (state["tmin"], state["tmax"], state["time"]) == (0.5, 5.0, 0.25)
    wanted = {"instId": 42, "instIdx": 0, "prim": 0, "hitKind": 254, "nTransforms": 1, "gas": "gas"}
    assert {key: state[key] for key in wanted} == wanted
    assert (state["wo"], state["wd"]) == (AT, DOWN)
    assert state["uv"] == [0.25, 0.25]
    # Nothing ran before the invoke but any-hit programs.
    assert not [row for row in log[: [row["what"] for row in log].index(110)] if row["what"] in CALLS]


def test_T256_a_traversal_that_misses(harness: Harness) -> None:
    states, log = seen(harness, 2)
    state = states[20]
    assert (state["isHit"], state["isMiss"], state["isNop"]) == (0, 1, 0)
    assert (state["tmax"], state["sbtRecordIndex"], state["nTransforms"]) == (100.0, 1, 0)
    assert [(row["what"], row["rec"]) for row in log if row["what"] in CALLS] == [(hit_objects.MISS, 1)]


def test_T258_a_trace_leaves_a_nop_and_the_own_hit(harness: Harness) -> None:
    states, _ = seen(harness, 3)
    assert states[30]["isHit"] == 1
    assert is_nop(states[31])
    assert is_nop(states[32])
    states, log = seen(harness, 11)
    assert (states[1001]["isHit"], states[1001]["wo"]) == (1, [2.25, 0.25, 3.0])
    own = next(row for row in log if row["what"] == hit_objects.CLOSESTHIT)
    after = [row for row in log if row["what"] in (hit_objects.AFTER_TRAVERSE, hit_objects.AFTER_INVOKE)]
    assert len(after) == 2
    # tmax, origin and primitive of the program's own hit are those from before the inner traversal
    assert all((row["tmax"], row["f"][1:4], row["prim"]) == (own["tmax"], own["f"][1:4], own["prim"]) for row in after)


def test_T259_invoking_a_nop_runs_nothing(harness: Harness) -> None:
    for mode, label in ((0, 100), (5, 151)):
        _, log = seen(harness, mode)
        assert not [row for row in log if row["what"] in CALLS]
        assert next(row["p"] for row in log if row["what"] == label)[:2] == [1, 2]


def test_T260_a_miss_that_is_made(harness: Harness) -> None:
    states, log = seen(harness, 4)
    assert (states[40]["isMiss"], states[40]["sbtRecordIndex"]) == (1, 1)
    (row,) = [row for row in log if row["what"] in CALLS]
    assert (row["what"], row["rec"], row["tmin"], row["tmax"], row["extra"][0]) == (hit_objects.MISS, 1, 0.125, 77.0, 8)
    assert row["f"][:7] == [0.25, *AT, *DOWN]


def test_T261_another_record_for_the_same_hit(harness: Harness) -> None:
    states, log = seen(harness, 6)
    assert (states[60]["sbtRecordIndex"], states[60]["sbtDataId"], states[60]["tmax"]) == (3, 3, 5.0)
    (row,) = [row for row in log if row["what"] in CALLS]
    assert (row["what"], row["rec"], row["prim"], row["tmax"]) == (hit_objects.CLOSESTHIT, 3, 0, 5.0)
