"""Where hits on curves may differ from the recorded ones: names, rules, reasons. See `oracle_differences`, which asks here."""

from __future__ import annotations

from typing import Any

import brute_force_curves
import numpy as np
from brute_force_curves import LINEAR, RIBBON, ROCAPS, Segment
from curve_reference import STEPS
from oracle_compare import FIRST_CURVE_KIND, LAST_CURVE_KIND, SPHERE_KIND
from oracle_files import Probe

STRAIGHT_JOINT = "joints of straight strands"
PARALLEL = "rays along a strand"
TOO_THICK = "strands thicker than their bends"
GRAZING = "grazing rays"
ROCAPS_CAP = "flat ends of rocaps"
CONE_END = "parameter at the end of a cone"
SECOND_CROSSING = "second crossing of a segment"
INTERNAL = "surfaces inside of linear strands"
ROCAPS_ACCURACY = "accuracy of rocaps"
INNER_CAP = "caps inside of strands"

REASONS = {
    STRAIGHT_JOINT: "rays exactly at u = 0 or 1 of straight strands slip through there (notes of group 11); here they hit",
    PARALLEL: "rays exactly along a straight strand that is not linear never hit there, not even end caps (notes "
    "of group 11); here they do; "
    "on linear strands Embree leaves out the first sphere",
    TOO_THICK: "where the radius comes near the axis' radius of curvature the surface folds into itself and solvers "
    "find different parts of it",
    GRAZING: "the ray touches a sphere within rounding",
    ROCAPS_CAP: "the recorded flat ends of rocaps lie off the plane through the end of the axis; here they lie in it",
    CONE_END: "near the wide end of a cone the recorded parameter is 1 before the end is reached",
    INTERNAL: "segments of linear strands are met from inside of their neighbours there (notes of group 11); here joints are one surface",
    ROCAPS_ACCURACY: "the recorded hits lie off the swept spheres by up to 5e-4, which bent and grazed strands turn into "
    "more along the ray",
    INNER_CAP: "with end caps every segment is closed there, and a ray inside of a strand meets the discs between its segments; here "
    "strands are closed at their two ends",
    SECOND_CROSSING: "OptiX does not promise every crossing of one segment, and records one; here each is offered",
}
# A parameter this near to 0 or 1 is at the end of a segment.
AT_END = 3e-7
# In radii: the recorded ends are tilted by a few degrees; a grazing ray turns 1e-3 across the tube into more along the ray.
CAP_SPREAD, TUBE_SPREAD = 0.1, 0.05
# The growth of a radius along a segment that is more than rounding, of the radius.
GROWTH = 1e-6
CURVE_TYPES = frozenset(brute_force_curves.BASES)
CURVE_KINDS = frozenset(range(FIRST_CURVE_KIND, LAST_CURVE_KIND + 1)) - {SPHERE_KIND}


def curve_difference(probe: Probe, given: dict[str, Any], ours: list[dict[str, Any]], theirs: list[dict[str, Any]]) -> str | None:
    """The difference that leaves a ray's hits open, None if there is none or no curve was hit."""
    hits = [event for event in ours + theirs if event["ev"] in ("AH", "CH") and event["hitKind"] in CURVE_KINDS]
    if any(_is_inner_cap(probe, event) for event in theirs if event in hits):
        return INNER_CAP
    met = [(event, segment) for event in hits for segment in brute_force_curves.segments(probe.scene, given, event["prim"])]
    if met and all(segment.curve_type in ROCAPS for _, segment in met) and _same_primitives(ours, theirs) and (name := _of_rocaps(
        probe, given, hits, met[0][1])):
        return name
    for event, segment in met:
        if segment.curve_type == RIBBON and not brute_force_curves.is_on_curve(probe.scene, given, event):
            return None
        if name := _of_hit(event, segment):
            return name
        if segment.curve_type == LINEAR and brute_force_curves.is_inside(probe.scene, given, event):
            return INTERNAL
    return None


def _of_rocaps(probe: Probe, given: dict[str, Any], hits: list[dict[str, Any]], segment: Segment) -> str | None:
    """The same segments were hit, a little elsewhere: on a flat end, or on the tube."""
    ends = [float(event["u"]) for event in hits if event["u"] in (0.0, 1.0)]
    if ends:
        axis = segment.slope(ends[0])[:3]
        lean = abs(float(axis @ segment.direction)) / float(np.linalg.norm(axis) * np.linalg.norm(segment.direction))
        return ROCAPS_CAP if _has_caps(probe) and lean * _spread(hits, segment) < CAP_SPREAD else None
    on_tube = all(brute_force_curves.is_on_curve(probe.scene, given, event) for event in hits)
    return ROCAPS_ACCURACY if on_tube and _spread(hits, segment) < TUBE_SPREAD else None


def _spread(hits: list[dict[str, Any]], segment: Segment) -> float:
    """How far the hits on each primitive lie from each other, in radii."""
    length = float(np.linalg.norm(segment.direction))
    radius = max(float(segment.at(u)[3]) for u in (0.0, 0.5, 1.0))
    places: dict[int, list[float]] = {}
    for event in hits:
        places.setdefault(event["prim"], []).append(float(event["tmax"]))
    return max(max(t) - min(t) for t in places.values()) * length / radius


def _same_primitives(ours: list[dict[str, Any]], theirs: list[dict[str, Any]]) -> bool:
    """Whether the same segments were accepted in the end, and all recorded any-hit calls were ours too."""
    called = {event["prim"] for event in ours if event["ev"] == "AH"}
    ends = [[event["prim"] for event in events if event["ev"] == "CH"] for events in (ours, theirs)]
    return ends[0] == ends[1] and all(event["prim"] in called for event in theirs if event["ev"] == "AH")


def _of_hit(event: dict[str, Any], segment: Segment) -> str | None:
    u = float(event["u"])
    if segment.curve_type == RIBBON:
        return None
    if segment.curve_type == LINEAR:
        return PARALLEL if segment.is_parallel() else GRAZING if brute_force_curves.grazes(segment) else None
    if segment.is_parallel():
        return PARALLEL
    if segment.is_straight() and (u <= AT_END or u >= 1.0 - AT_END):
        return CONE_END if u == 1.0 and abs(segment.slope(1.0)[3]) > GROWTH * segment.at(1.0)[3] else STRAIGHT_JOINT
    return TOO_THICK if segment.is_thick() else None


def _is_inner_cap(probe: Probe, event: dict[str, Any]) -> bool:
    """Whether the event is a hit exactly at the end of a segment behind which its strand goes on."""
    u = float(event["u"])
    for item in (item for node in probe.scene for item in node.get("buildInputs", []) if item["type"] == "curves" and item["endcapFlags"]):
        index = event["prim"] - int(item.get("primitiveIndexOffset", 0))
        if u in (0.0, 1.0) and 0 <= index < len(item["indices"]):
            step = STEPS.get(int(item["curveType"], 16), 1)
            if item["indices"][index] + (step if u else -step) in item["indices"]:
                return True
    return False


def _has_caps(probe: Probe) -> bool:
    return any(item.get("endcapFlags") for node in probe.scene for item in node.get("buildInputs", []))


def crosses_again(event: dict[str, Any], events: list[dict[str, Any]]) -> bool:
    """Whether the event is one of several any-hit calls on one segment at different distances."""
    if event["ev"] != "AH":
        return False
    places = {round(float(other["tmax"]), 3) for other in events if other["ev"] == "AH" and other["prim"] == event["prim"]}
    return len(places) > 1
