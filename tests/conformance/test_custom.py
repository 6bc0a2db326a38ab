"""Area J: custom primitives, reports and attributes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from harness import Harness
from scenes import boxes, calls, closest, gas, hitgroup, ias, instance, kinds, missed, ray, reported, trace

import optixc as ox

UNIT = [[0.0, 0.0, -0.5, 1.0, 1.0, 0.5]]
ABOVE = (0.25, 0.25, 5.0)
IGNORE, TERMINATE = 1, 2
ATTRIBUTES = tuple(range(11, 19))


def custom(*reports: dict[str, object], mode: int = 0, argument: int = 0, **more: object) -> list[dict[str, object]]:
    """One hit group whose intersection program reports these."""
    return [hitgroup(kind="custom", anyhit_mode=mode, argument=argument, reports=reports, **more)]  # type: ignore[arg-type]


@pytest.mark.parametrize(("t", "accepted"), [(1.0, False), (3.5, False), (math.nan, False), (2.0, True), (3.0, True), (2.5, True)])
def test_T117_reports_are_accepted_in_the_closed_interval(harness: Harness, t: float, accepted: bool) -> None:
    (result,) = trace(harness, [gas(boxes([[0, 0, 2, 1, 1, 3]]))], [ray(ABOVE, tmin=2.0, tmax=3.0)], custom(reported(t)))
    assert [event["ret"] for event in calls(result, "RP")] == [int(accepted)]
    assert len(calls(result, "AH")) == int(accepted)
    assert missed(result) is not accepted


def test_T118_the_nearest_report_wins(harness: Harness) -> None:
    reports = [reported(5.0, 1), reported(3.0, 2), reported(4.0, 3)]
    (result,) = trace(harness, [gas(boxes(UNIT))], [ray(ABOVE)], custom(*reports))
    assert [event["ret"] for event in calls(result, "RP")] == [1, 1, 0]
    assert (closest(result)["tmax"], closest(result)["hitKind"]) == (3.0, 2)


def test_T119_an_ignored_report_leaves_the_interval(harness: Harness) -> None:
    # any-hit ignores its first call
    reports = [reported(3.0, 1, attributes=ATTRIBUTES), reported(5.0, 2, attributes=ATTRIBUTES[::-1])]
    (result,) = trace(harness, [gas(boxes(UNIT))], [ray(ABOVE)], custom(*reports, mode=5, argument=1))
    assert [event["ret"] for event in calls(result, "RP")] == [0, 1]
    assert (closest(result)["tmax"], closest(result)["attr"]) == (5.0, list(ATTRIBUTES[::-1]))


def test_T120_a_terminated_report_does_not_return(harness: Harness) -> None:
    (result,) = trace(harness, [gas(boxes(UNIT))], [ray(ABOVE)], custom(reported(5.0), reported(3.0), mode=TERMINATE))
    assert kinds(result) == ["IS", "AH", "CH"]
    assert closest(result)["tmax"] == 5.0


def test_T121_eight_attributes(harness: Harness) -> None:
    (result,) = trace(harness, [gas(boxes(UNIT))], [ray(ABOVE)], custom(reported(3.0, 7, attributes=ATTRIBUTES)))
    assert calls(result, "AH")[0]["attr"] == closest(result)["attr"] == list(ATTRIBUTES)


def test_T122_attributes_are_those_of_the_nearer_primitive(harness: Harness) -> None:
    bounds = [*UNIT, [0.0, 0.0, -3.5, 1.0, 1.0, -2.5]]
    given = custom(reported(5.0, 1, per_primitive=3.0, attributes=ATTRIBUTES))
    (result,) = trace(harness, [gas(boxes(bounds))], [ray(ABOVE)], given)
    assert (closest(result)["prim"], closest(result)["attr"]) == (0, list(ATTRIBUTES))
    given = custom(reported(8.0, 1, per_primitive=-3.0, attributes=ATTRIBUTES))
    (result,) = trace(harness, [gas(boxes(bounds))], [ray(ABOVE)], given)
    assert closest(result)["prim"] == 1
    assert closest(result)["attr"] == [ATTRIBUTES[0] + 100, *ATTRIBUTES[1:]]


@pytest.mark.parametrize(("kind", "seen"), [(0, 0), (63, 63), (127, 127), (128, 128), (200, 200), (256, 0), (300, 44)])
def test_T123_hit_kinds_have_eight_bits(harness: Harness, kind: int, seen: int) -> None:
    # Recorded: 07_custom-hitkind_...; spec T123 says that 128 and above are rejected, but they come through.
    (result,) = trace(harness, [gas(boxes(UNIT))], [ray(ABOVE)], custom(reported(3.0, kind)))
    assert closest(result)["hitKind"] == seen
    if seen < 128:
        assert closest(result)["ptype"] == hex(ox.PrimitiveType.CUSTOM)


def test_T124_tmax_as_every_program_sees_it(harness: Harness) -> None:
    (result,) = trace(harness, [gas(boxes(UNIT))], [ray(ABOVE, tmax=10.0)], custom(reported(3.0)))
    assert calls(result, "IS")[0]["tmax"] == 10.0
    assert [(event["tmaxBefore"], event["tmaxAfter"]) for event in calls(result, "RP")] == [(10.0, 3.0)]
    assert calls(result, "AH")[0]["tmax"] == closest(result)["tmax"] == 3.0
    (result,) = trace(harness, [gas(boxes(UNIT))], [ray(ABOVE, tmax=10.0)], custom(reported(6.0), reported(4.0)))
    assert [event["tmax"] for event in calls(result, "AH")] == [6.0, 4.0]
    (result,) = trace(harness, [gas(boxes(UNIT))], [ray(ABOVE, tmax=10.0)], custom(reported(11.0)))
    assert calls(result, "MS")[0]["tmax"] == 10.0


def test_T125_inverted_and_nan_boxes_are_never_offered(harness: Harness) -> None:
    bounds = [*UNIT, [0.0, 0.0, 0.5, 1.0, 1.0, -0.5], [math.nan, 0.0, -0.5, 1.0, 1.0, 0.5], [0.0, 0.0, -3.0, 1.0, 1.0, -2.0]]
    (result,) = trace(harness, [gas(boxes(bounds))], [ray(ABOVE)], custom(reported(1.0), mode=IGNORE))
    assert sorted(event["prim"] for event in calls(result, "IS")) == [0, 3]


@pytest.mark.parametrize("columns", [8, 10])
def test_T126_boxes_may_lie_apart_by_multiples_of_eight_bytes(harness: Harness, columns: int) -> None:
    padded = np.full((3, columns), np.nan, np.float32)
    padded[:, :6] = UNIT
    padded[:, [2, 5]] -= np.float32([[0], [3], [6]])
    accel = harness.context.accel_build([ox.BuildInputCustomPrimitives(padded[:, :6])])
    (result,) = trace(harness, [], [ray(ABOVE, root="it")], custom(reported(1.0), mode=IGNORE), made={"it": accel})
    assert sorted(event["prim"] for event in calls(result, "IS")) == [0, 1, 2]


def test_T126_other_strides_are_named(harness: Harness) -> None:
    numbers = np.zeros(100, np.float32)
    for stride, message in ((20, "gaps inside"), (28, "28 bytes is no multiple of 8"), (-24, "gaps inside")):
        rows = np.lib.stride_tricks.as_strided(numbers[50:], (2, 6), (stride, 4))
        with pytest.raises(ox.InvalidValueError, match=message):
            harness.context.accel_build([ox.BuildInputCustomPrimitives(rows)])


def test_T127_no_report_is_a_miss(harness: Harness) -> None:
    (result,) = trace(harness, [gas(boxes(UNIT))], [ray(ABOVE)], custom())
    assert kinds(result) == ["IS", "MS"]
    assert result.payload[1] == 0x10000  # what the intersection program wrote is kept (T054)


def test_T116_attributes_reach_the_hit_through_an_instance(harness: Harness) -> None:
    scene = [gas(boxes(UNIT)), ias(instance(transform=np.diag([2.0, 2.0, 2.0, 1.0])[:3]))]
    (result,) = trace(harness, scene, [ray((0.5, 0.5, 8.0), root="ias")], custom(reported(7.0, 9, attributes=ATTRIBUTES)))
    assert calls(result, "IS")[0]["oo"] == [0.25, 0.25, 4.0]
    assert (closest(result)["tmax"], closest(result)["attr"]) == (7.0, list(ATTRIBUTES))


@pytest.mark.parametrize("flags", [0, ox.BuildFlags.PREFER_FAST_BUILD, ox.BuildFlags.PREFER_FAST_TRACE, ox.BuildFlags.ALLOW_UPDATE])
def test_only_boxes_that_a_ray_meets_are_offered(harness: Harness, flags: int) -> None:
    bounds = [[2.0 * i, 0.0, -0.5, 2.0 * i + 1.0, 1.0, 0.5] for i in range(5)]
    rays = [ray((2.0 * i + 0.5, 0.5, 5.0)) for i in range(5)] + [ray((1.5, 0.5, 5.0))]
    results = trace(harness, [gas(boxes(bounds), build_flags=int(flags))], rays, custom(reported(5.0)))
    assert [[event["prim"] for event in calls(result, "IS")] for result in results] == [[0], [1], [2], [3], [4], []]
