"""Where a correct answer of ours may differ from the recorded one: every such difference has its name, rule and reason here.

A ray that is recorded differently must fall under one of these, and its own log must still be a lawful run (`oracle_compare.unlawful`).
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import replace
from itertools import pairwise
from typing import Any

import brute_force
import brute_force_curves
import numpy as np
import oracle_curve_differences
from oracle_compare import CURVE_T, close, decide, mismatches, ray_scale, same_sequence
from oracle_curve_differences import SECOND_CROSSING, crosses_again, curve_difference
from oracle_events import RayResult
from oracle_files import Probe, number, numbers
from oracle_not_copied import ray_not_copied

ORDER = "any-hit order"
REPETITION = "any-hit repetition"
BEYOND = "calls beyond the closest hit"
FIRST_ACCEPTED = "first accepted hit"
COINCIDENT = "coincident hits"
EDGE = "rays through edges"
UNDEFINED = "undefined ray"
BEYOND_BINARY32 = "lengths beyond binary32"
FAR_SPHERE = "spheres smaller than rounding"
MOVING_BOX = "boxes between more than two keys"

REASONS = {
    ORDER: "any-hit and intersection programs run in traversal order, which OptiX leaves open; the multiset of calls is the same",
    REPETITION: "without REQUIRE_SINGLE_ANYHIT_CALL OptiX may call any-hit again for a primitive (spatial splits there, none here)",
    BEYOND: "a candidate behind the hit that is accepted in the end is seen or not, by the traversal order",
    FIRST_ACCEPTED: "a terminated ray or a counting any-hit keeps the first accepted hit in traversal order, not the nearest",
    COINCIDENT: "which of several hits at one distance wins is left open",
    EDGE: "edges follow a top-left rule there: an isolated one is open or closed by its direction, a shared one gives one call; in Embree "
    "edges are closed, and every triangle that meets in an edge is called",
    FAR_SPHERE: "the ray begins so far away that its coordinates are rounded by more than the sphere's size",
    MOVING_BOX: "Embree bounds a box that moves through more than two keys by one that holds for more of them: intersection programs may "
    "be called for rays that miss the box at their time",
    UNDEFINED: "NaN in the ray, or an infinite origin or direction, is undefined; here built-in primitives and boxes are missed",
    BEYOND_BINARY32: "the square of the direction's length leaves binary32: which primitives cope differs",
} | oracle_curve_differences.REASONS

REQUIRE_SINGLE = 2
TERMINATE_ON_FIRST_HIT = 4
COUNTING_MODES = (2, 4, 5, 6)
# Two computed distances of one crossing differ by rounding only; hits this near to each other count as one place.
SAME_PLACE = 1e-6
# A number of calls that no counting any-hit program of the records waits for.
UNCOUNTED = 0xffff
# Directions whose squared length is a normal number of binary32.
SHORTEST, LONGEST = 1e-18, 1e18
# The rounding of a coordinate, relative to it.
BINARY32 = 2.0**-24
# What depends on the order in which candidates were seen.
ORDER_KEYS = frozenset({"p", "p1", "tmaxBefore", "tmaxAfter"})


def compare(probe: Probe, index: int, result: RayResult) -> tuple[set[str], list[str]]:
    """The named differences that explain our result for a ray, and what stays unexplained."""
    recorded = probe.rays[index]
    given = recorded["in"]
    result = _numbered(result, index, recorded["p"][0])
    events = result.events
    trimmed = recorded["nev"] > len(recorded["events"])
    if trimmed:  # the files left out one kind of event
        kinds = {event["ev"] for event in recorded["events"]}
        events = [event for event in events if event["ev"] in kinds]
    strict = _strict(probe, events, recorded, given)
    if not strict:
        return _of_payload(result, recorded, trimmed)
    if name := _exempt(probe, given) or ray_not_copied(probe, events, recorded["events"]):
        return {name}, []
    names, unexplained = _explain(probe, given, events, recorded["events"], strict)
    if unexplained and (name := curve_difference(probe, given, events, recorded["events"])):
        return {name}, []
    return names, unexplained


def _numbered(result: RayResult, index: int, number: int) -> RayResult:
    """Our result with the number that the ray had when it was recorded, which stands in payload word 0: others may have been left out."""
    if number == index:
        return result

    def renumber(words: list[int]) -> list[int]:
        return [number, *words[1:]] if words[0] == index else words

    events = [{**event, "p": renumber(event["p"])} if "p" in event else event for event in result.events]
    return replace(result, payload=renumber(result.payload), events=events)


def _of_payload(result: RayResult, recorded: dict[str, Any], trimmed: bool) -> tuple[set[str], list[str]]:
    """What the payload tells where the events agree. Calls that the files left out still count in words 1 and 2."""
    if result.payload == recorded["p"]:
        return set(), []
    if trimmed and (result.payload[0], result.payload[3]) == (recorded["p"][0], recorded["p"][3]):
        return {REPETITION}, []
    return set(), [f"payload {result.payload} recorded {recorded['p']}"]


def _exempt(probe: Probe, given: dict[str, Any]) -> str | None:
    """The difference that leaves the whole ray open, if there is one; its log must be lawful all the same."""
    origin, direction = numbers(given["o"]), numbers(given["d"])
    interval = [number(given["tmin"]), number(given["tmax"]), number(given["time"])]
    if any(math.isnan(value) for value in interval) or not all(math.isfinite(value) for value in origin + direction):
        return UNDEFINED
    if not SHORTEST < math.hypot(*direction) < LONGEST and any(direction):
        return BEYOND_BINARY32
    return FAR_SPHERE if _is_far(probe, given) else None


def _is_far(probe: Probe, given: dict[str, Any]) -> bool:
    radii = [abs(number(radius)) for node in probe.scene for item in node.get("buildInputs", []) if item["type"] == "spheres"
             for key in item["radii"] for radius in key]
    return bool(radii) and max(abs(value) for value in numbers(given["o"])) * BINARY32 > min(radii)


def _strict(probe: Probe, events: list[dict[str, Any]], recorded: dict[str, Any], given: dict[str, Any]) -> list[str]:
    if not same_sequence(events, recorded["events"]):
        return [f"events {_brief(events)} recorded {_brief(recorded['events'])}"]
    scale, skip = ray_scale(given), _garbage(probe, given)
    return [text for ours, theirs in zip(events, recorded["events"], strict=True) for text in mismatches(ours, theirs, scale, skip)]


def _garbage(probe: Probe, given: dict[str, Any]) -> frozenset[str]:
    """Keys that a driver bug fills: optixGetTriangleVertexData extrapolates past the end of more than two keys, where its form by handle
    and the traversal clamp, as ours do; and optixGetRibbonVertexData blends moving points with directions across the ribbon."""
    past = any(node["kind"] == "GAS" and node.get("motion", {}).get("numKeys", 0) > 2
               and number(given["time"]) > number(node["motion"]["timeEnd"]) for node in probe.scene)
    inputs = [item for node in probe.scene for item in node.get("buildInputs", [])]
    ribbons = any(item.get("curveType") == "0x2505" and len(item["vertices"]) > 1 for item in inputs)
    return frozenset({"vertexData"} if past or ribbons else ())


def _brief(events: list[dict[str, Any]]) -> str:
    return " ".join(f"{event['ev']}{event['rec']}.{event.get('prim', '-')}@{number(event.get('tmax', event.get('t', 0))):g}"
                    for event in events)


def _explain(probe: Probe, given: dict[str, Any], ours: list[dict[str, Any]], theirs: list[dict[str, Any]],
             strict: list[str]) -> tuple[set[str], list[str]]:
    scale = ray_scale(given)
    left_ours, left_theirs = _pair(ours, theirs, scale)
    names = {ORDER} if not left_ours and not left_theirs else set()
    if names and sum(event["ev"] in ("AH", "IS") for event in ours) < 2:
        return set(), strict
    names |= _drop(left_ours, left_theirs, SECOND_CROSSING,
                   lambda event: crosses_again(event, ours) and _candidate(probe, given, event))
    names |= _drop_repeated(probe, left_ours, left_theirs, ours, theirs, scale)
    if _order_decides(probe, given, ours + theirs):
        names |= _drop(left_ours, left_theirs, FIRST_ACCEPTED, lambda event: _candidate(probe, given, event))
    ends = [end for events in (ours, theirs) if (end := _end(probe, events)) is not None]
    names |= _drop(left_ours, left_theirs, BEYOND, lambda event: (_beyond(event, ends) and _candidate(probe, given, event))
                   or _box_beyond(probe, given, event, ends))
    if _coincident(probe, given, ours + theirs):
        names |= _drop(left_ours, left_theirs, COINCIDENT, lambda event: _candidate(probe, given, event))
    names |= _drop(left_ours, [], MOVING_BOX, lambda event: _near_moving_box(probe, given, event))
    if edges := brute_force.edges_passed(probe.scene, given):
        names |= _drop(left_ours, left_theirs, EDGE, lambda event: _after_edge(probe, given, event, edges))
    if left_ours or left_theirs:
        return names, [*strict, f"unexplained: ours {_brief(left_ours)} recorded {_brief(left_theirs)}"]
    return names, []


def _pair(ours: list[dict[str, Any]], theirs: list[dict[str, Any]], scale: float) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """What is left after each recorded event has taken one of ours that agrees with it but for what the order decides."""
    left, missing = list(ours), []
    for event in theirs:
        skip = ORDER_KEYS | ({"tmax"} if event["ev"] == "IS" else set())
        match = next((mine for mine in left if mine["ev"] == event["ev"] and not mismatches(mine, event, scale, frozenset(skip))), None)
        if match is None:
            missing.append(event)
        else:
            left.remove(match)
    return left, missing


def _same_place(probe: Probe) -> float:
    """How much two computed distances of one crossing may differ."""
    types = {item["type"] for node in probe.scene for item in node.get("buildInputs", [])}
    return CURVE_T if "curves" in types else SAME_PLACE


def _drop_repeated(probe: Probe, left_ours: list[dict[str, Any]], left_theirs: list[dict[str, Any]], ours: list[dict[str, Any]],
                   theirs: list[dict[str, Any]], scale: float) -> set[str]:
    flags = [flag for node in probe.scene for item in node.get("buildInputs", []) for flag in item["flags"]]
    single = all(flag & REQUIRE_SINGLE for flag in flags)

    def repeated(event: dict[str, Any], all_events: list[dict[str, Any]]) -> bool:
        same = [other for other in all_events if other["ev"] == event["ev"] == "AH" and other["rec"] == event["rec"]
                and other["prim"] == event["prim"] and close(number(other["tmax"]), number(event["tmax"]), _same_place(probe), scale)]
        return len(same) > 1

    before = len(left_ours) + len(left_theirs)
    if not single:
        left_ours[:] = [event for event in left_ours if not repeated(event, ours)]
    left_theirs[:] = [event for event in left_theirs if not repeated(event, theirs)]
    return {REPETITION} if len(left_ours) + len(left_theirs) < before else set()


def _drop(left_ours: list[dict[str, Any]], left_theirs: list[dict[str, Any]], name: str, rule: Any) -> set[str]:
    before = len(left_ours) + len(left_theirs)
    left_ours[:] = [event for event in left_ours if not rule(event)]
    left_theirs[:] = [event for event in left_theirs if not rule(event)]
    return {name} if len(left_ours) + len(left_theirs) < before else set()


def _candidate(probe: Probe, given: dict[str, Any], event: dict[str, Any]) -> bool:
    """Whether the ray has this hit, by brute force; or a call before the hit of a custom primitive whose box it meets."""
    if event["ev"] not in ("AH", "CH"):
        return event["ev"] in ("IS", "RP")
    t = number(event["tmax"])
    if brute_force_curves.is_on_curve(probe.scene, given, {**event, "tmax": t}) or _is_reported(probe, given, event, t):
        return True
    found = brute_force.scene_candidates(probe.scene, given)
    return any(hit.primitive == event["prim"] and close(hit.t, t, 1e-5, ray_scale(given)) for hit in found)


def _is_reported(probe: Probe, given: dict[str, Any], event: dict[str, Any], t: float) -> bool:
    """Whether the intersection program of the record reports this hit for a box that the ray meets."""
    data = next(hit["data"] for hit in probe.hitgroups if hit["data"]["id"] == event["rec"])
    reported = [number(one["t"]) + number(one["tPerPrim"]) * event["prim"] for one in data.get("reports", [])]
    return any(close(t, one) for one in reported) and any(
        box.primitive == event["prim"] for box in brute_force.scene_boxes(probe.scene, given))


def _after_edge(probe: Probe, given: dict[str, Any], event: dict[str, Any], edges: dict[int, float]) -> bool:
    """Whether the event hangs on whether a triangle whose edge the ray passes is met: its own calls, and what follows behind it."""
    if event["ev"] == "MS":
        return True
    if event["ev"] not in ("AH", "CH") or number(event["tmax"]) < min(edges.values()) * (1.0 - SAME_PLACE):
        return False
    return event["prim"] in edges or _candidate(probe, given, event)


def _order_decides(probe: Probe, given: dict[str, Any], events: list[dict[str, Any]]) -> bool:
    """Whether the ray keeps the first accepted hit: by its flag, by a terminating or by a counting any-hit program."""
    if given["flags"] & TERMINATE_ON_FIRST_HIT:
        return True
    records = {hit["data"]["id"]: hit["data"] for hit in probe.hitgroups}
    return any(event["ev"] == "AH" and records[event["rec"]]["ahMode"] in COUNTING_MODES for event in events)


def _end(probe: Probe, events: list[dict[str, Any]]) -> float | None:
    """Where the hit is that is kept in the end: the closest hit's place, or without that program the nearest accepted one's."""
    records = {hit["data"]["id"]: hit["data"] for hit in probe.hitgroups}
    found = [number(event["tmax"]) for event in events if event["ev"] == "CH"]
    found = found or [number(event["t"]) for event in events if event["ev"] == "RP" and event["ret"]]
    found = found or [number(event["tmax"]) for event in events if event["ev"] == "AH" and
                      decide(records[event["rec"]], UNCOUNTED, event["prim"], event["hitKind"]) != "ignore"]
    return min(found) if found else None


def _box_beyond(probe: Probe, given: dict[str, Any], event: dict[str, Any], ends: list[float]) -> bool:
    """Whether a custom primitive's box begins where the kept hit is or behind it; what it reports may lie before."""
    return event["ev"] != "MS" and bool(ends) and any(
        box.primitive == event["prim"] and box.enter >= max(ends) for box in brute_force.scene_boxes(probe.scene, given))


def _near_moving_box(probe: Probe, given: dict[str, Any], event: dict[str, Any]) -> bool:
    """Whether an intersection program that reports nothing was called for a primitive with more than two keys, and the ray meets the box
    that moves evenly around them."""
    if event["ev"] != "IS" or next(hit["data"] for hit in probe.hitgroups if hit["data"]["id"] == event["rec"]).get("reports"):
        return False
    scene = [_around_keys(node) if node["kind"] == "GAS" else node for node in probe.scene]
    return any(box.primitive == event["prim"] and box.path.instance_index == event["instIdx"]
               for box in brute_force.scene_boxes(scene, given))


def _around_keys(node: dict[str, Any]) -> dict[str, Any]:
    """A structure with two keys for the custom primitives of one with more, around all of them; others without what it holds."""
    count = node.get("motion", {}).get("numKeys", 0)
    inputs = []
    for item in node["buildInputs"] if count > 2 else []:
        if item["type"] == "custom":
            keys = np.array([numbers(key) for key in item["aabbs"]]).reshape(count, -1, 2, 3)
            even = np.linspace(keys[0], keys[-1], count)
            beyond = np.stack([(keys - even)[:, :, 0].min(axis=0), (keys - even)[:, :, 1].max(axis=0)], axis=1)
            inputs.append({**item, "aabbs": [(key + beyond).ravel().tolist() for key in (keys[0], keys[-1])]})
    return {**node, "buildInputs": inputs, **({"motion": {**node["motion"], "numKeys": 2}} if inputs else {})}


def _beyond(event: dict[str, Any], ends: list[float]) -> bool:
    """Whether an any-hit or intersection call lies behind the hit that both sides keep in the end."""
    if event["ev"] in ("IS", "RP"):
        return bool(ends)
    return event["ev"] == "AH" and bool(ends) and number(event["tmax"]) > max(ends)


def close_to(t: float) -> float:
    """The distance, rounded so that computed twice it is the same."""
    return round(t, 4)


def _coincident(probe: Probe, given: dict[str, Any], events: list[dict[str, Any]]) -> bool:
    """Whether the ray has two different candidates at one distance."""
    hits = {(event["rec"], event["prim"], close_to(number(event["tmax"]))) for event in events if event["ev"] in ("AH", "CH")}
    places = Counter(place for _, _, place in hits)
    distances = sorted(hit.t for hit in brute_force.scene_candidates(probe.scene, given))
    return any(count > 1 for count in places.values()) or any(
        math.isfinite(b) and close(a, b, SAME_PLACE) for a, b in pairwise(distances))

