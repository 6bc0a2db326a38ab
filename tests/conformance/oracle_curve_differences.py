"""Where hits on curves may differ from the recorded ones: names, rules, reasons. See `oracle_differences`, which asks here."""

from __future__ import annotations

from typing import Any

import brute_force
import brute_force_curves
import numpy as np
from brute_force_curves import LINEAR, RIBBON, ROCAPS, Segment
from curve_reference import STEPS
from oracle_compare import CURVE_T, FIRST_CURVE_KIND, LAST_CURVE_KIND, SPHERE_KIND, close, mismatches, ray_scale
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
ALONG = "rays along curved strands"
RIM = "rims of ends"
TURNING = "ribbons that turn strongly"
MOVING_RIBBON = "ribbons between keys"

REASONS = {
    ALONG: "Embree's solver of round curves that are not linear misses some hits of rays within 0.005 of the axis' "
    "direction, of others about 3 in 10,000 of those that graze or run far",
    RIM: "the ray passes the rim of an end within a thousandth of its radius",
    TURNING: "given normals turn, or turn a ribbon, by more than 50 degrees from one border of segments to the next: from there on it "
    "leans there in a way that is not known",
    MOVING_RIBBON: "between keys the directions across are kept at right angles to the axis there; here they are blended",
    STRAIGHT_JOINT: "rays exactly at u = 0 or 1 of straight strands slip through there (notes of group 11); here they hit",
    PARALLEL: "rays along a straight strand (within 2e-5) that is not linear never hit there, not even end caps (notes of group 11); here "
    "they do; on linear strands Embree leaves out the first sphere",
    TOO_THICK: "where the radius comes near the axis' radius of curvature the surface folds into itself and solvers "
    "find different parts of it",
    GRAZING: "the ray touches a sphere within rounding",
    ROCAPS_CAP: "the recorded flat ends of rocaps lie off the plane through the end of the axis, by up to 0.05 radii at the rim; here they "
    "lie in it",
    CONE_END: "near the wide end of a cone the recorded parameter is 1 before the end is reached",
    INTERNAL: "segments of linear strands are met from inside of their neighbours there (notes of group 11); here joints are one surface",
    ROCAPS_ACCURACY: "the recorded hits lie off the swept spheres by up to 0.004 of a segment's length however thin it is (quadratic ones; "
    "others less), which bent and grazed strands turn into more along the ray; ours lie on them",
    INNER_CAP: "with end caps every segment is closed there, and a ray inside of a strand meets the discs between its segments; here "
    "strands are closed at their two ends",
    SECOND_CROSSING: "OptiX does not promise every crossing of one segment, and records one; here each is offered",
}
# A parameter this near to 0 or 1 is at the end of a segment.
AT_END = 3e-7
# In radii: the recorded ends are tilted by a few degrees; a grazing ray turns 1e-3 across the tube into more along the ray.
CAP_SPREAD, TUBE_SPREAD = 0.1, 0.05
# How far recorded hits on rocaps lie off the swept spheres, of the segment's length; and ours, in float64.
ROCAPS_OFF, OURS_OFF = 4e-3, 1e-4
# How far recorded flat ends of rocaps lie off their plane, in radii; how near a ray passes a rim that rounding decides, in radii.
CAP_OFF, ON_RIM = 0.05, 1e-3
# The sine of the angle between a ray and the axis of a curved strand at which Embree's solver begins to lose hits.
ALONG_SINE = 5e-3
# The cosine of 50 degrees.
STRONG_TURN = 0.643
# The growth of a radius along a segment that is more than rounding, of the radius.
GROWTH = 1e-6
ROUND = tuple(kind for kind in brute_force_curves.BASES if kind not in (LINEAR, RIBBON, *ROCAPS))
CURVE_TYPES = frozenset(brute_force_curves.BASES)
CURVE_KINDS = frozenset(range(FIRST_CURVE_KIND, LAST_CURVE_KIND + 1)) - {SPHERE_KIND}


def curve_difference(probe: Probe, given: dict[str, Any], ours: list[dict[str, Any]], theirs: list[dict[str, Any]]) -> str | None:
    """The difference that leaves a ray's hits open, None if there is none or no curve was hit."""
    if name := _of_hits(probe, given, ours, theirs):
        return name
    if name := _of_ribbons(probe, given, ours, theirs):
        return name
    if _passes_rim(probe, given, ours + theirs, ROCAPS, CAP_OFF):
        return ROCAPS_CAP
    if _passes_rim(probe, given, ours + theirs, ROUND, 0.0):
        return RIM
    return ALONG if _lost_along(probe, given, ours, theirs) else None


def _of_hits(probe: Probe, given: dict[str, Any], ours: list[dict[str, Any]], theirs: list[dict[str, Any]]) -> str | None:
    hits = [event for event in ours + theirs if event["ev"] in ("AH", "CH") and event["hitKind"] in CURVE_KINDS]
    if any(_is_inner_cap(probe, event) for event in theirs if event in hits):
        return INNER_CAP
    met = [(event, segment) for event in hits for segment in brute_force_curves.segments(probe.scene, given, event["prim"])]
    if met and all(segment.curve_type in ROCAPS for _, segment in met) and _same_primitives(ours, theirs) and (name := _of_rocaps(
        probe, given, hits, ours, met)):
        return name
    for event, segment in met:
        if segment.curve_type == RIBBON and not brute_force_curves.is_on_curve(probe.scene, given, event):
            return None
        if name := _of_hit(event, segment):
            return name
        if segment.curve_type == LINEAR and brute_force_curves.is_inside(probe.scene, given, event):
            return INTERNAL
    return None


def _of_ribbons(probe: Probe, given: dict[str, Any], ours: list[dict[str, Any]], theirs: list[dict[str, Any]]) -> str | None:
    """Every hit that differs lies on a ribbon whose direction across is not known: it moves, or has turned strongly before."""
    skip, scale = frozenset({"p", "oo", "od"}), ray_scale(given)
    agreed = [(mine, other) for mine in ours for other in theirs if _is_same(mine, other) and not mismatches(mine, other, scale, skip)]
    hits = [event for event in ours + theirs if event["ev"] in ("AH", "CH") and not any(event in pair for pair in agreed)]
    if not hits or not all(event["hitKind"] in CURVE_KINDS and brute_force_curves.is_on_curve(probe.scene, given, event) for event in hits):
        return None
    names = {_of_ribbon(probe, given, event["prim"]) for event in hits}
    return min(name for name in names if name) if None not in names else None


def _of_ribbon(probe: Probe, given: dict[str, Any], primitive: int) -> str | None:
    for node in probe.scene:
        for item in node.get("buildInputs", []):
            index = primitive - int(item.get("primitiveIndexOffset", 0))
            if item["type"] != "curves" or int(item["curveType"], 16) != RIBBON or not 0 <= index < len(item["indices"]):
                continue
            if item.get("normals") and _has_turned(item, item["indices"][index]):
                return TURNING
            if len(item["vertices"]) > 1 and 0.0 < brute_force.key_at(node["motion"], float(given["time"]))[1] < 1.0:
                return MOVING_RIBBON
    return None


def _has_turned(item: dict[str, Any], first: int) -> bool:
    """Whether normals or directions across turn strongly at a segment of this strand, up to the one that begins with this point."""
    for vertices, normals in zip(item["vertices"], item["normals"], strict=True):
        ups = np.reshape(normals, (-1, 3))
        for directions in (ups, np.cross(ups[:-1], np.diff(np.reshape(vertices, (-1, 3)), axis=0))):
            units = directions / np.maximum(np.linalg.norm(directions, axis=1), 1e-30)[:, None]
            segment = first
            while segment in item["indices"]:
                if abs(float(units[segment] @ units[segment + 1])) < STRONG_TURN:
                    return True
                segment -= 1
    return False


def _of_rocaps(probe: Probe, given: dict[str, Any], hits: list[dict[str, Any]], ours: list[dict[str, Any]],
               met: list[tuple[dict[str, Any], Segment]]) -> str | None:
    """The same segments were hit, a little elsewhere: on a flat end, or on the tube."""
    segment = met[0][1]
    ends = [float(event["u"]) for event in hits if event["u"] in (0.0, 1.0)]
    if ends:
        axis = segment.slope(ends[0])[:3]
        lean = abs(float(axis @ segment.direction)) / float(np.linalg.norm(axis) * np.linalg.norm(segment.direction))
        return ROCAPS_CAP if _has_caps(probe) and lean * _spread(hits, segment) < CAP_SPREAD else None
    on_tube = all(brute_force_curves.is_on_curve(probe.scene, given, event) for event in hits)
    if on_tube and _spread(hits, segment) < TUBE_SPREAD:
        return ROCAPS_ACCURACY
    return ROCAPS_ACCURACY if all(_is_near_tube(event, one, ours) for event, one in met) else None


def _is_near_tube(event: dict[str, Any], segment: Segment, ours: list[dict[str, Any]]) -> bool:
    """Whether a hit of ours lies on the swept spheres, and one of the others near them and near one of ours as the surface slopes."""
    t, length = float(event["tmax"]), float(np.linalg.norm(segment.at(1.0)[:3] - segment.at(0.0)[:3]))
    point = segment.origin + t * segment.direction
    if event in ours:
        return abs(segment.distance(point)) <= OURS_OFF * length
    away = point - segment.at(float(event["u"]))[:3]
    slope = abs(float(away @ segment.direction)) / float(np.linalg.norm(away))
    apart = min(abs(float(mine["tmax"]) - t) for mine in ours if mine["ev"] in ("AH", "CH") and mine["prim"] == event["prim"])
    return abs(segment.distance(point)) <= ROCAPS_OFF * length and apart * slope <= 2.0 * ROCAPS_OFF * length


def _spread(hits: list[dict[str, Any]], segment: Segment) -> float:
    """How far the hits on each primitive lie from each other, in radii."""
    length = float(np.linalg.norm(segment.direction))
    radius = max(float(segment.at(u)[3]) for u in (0.0, 0.5, 1.0))
    places: dict[int, list[float]] = {}
    for event in hits:
        places.setdefault(event["prim"], []).append(float(event["tmax"]))
    return max(max(t) - min(t) for t in places.values()) * length / radius


def _same_primitives(ours: list[dict[str, Any]], theirs: list[dict[str, Any]]) -> bool:
    """Whether the same segments were accepted in the end, and all recorded any-hit calls before were ours too."""
    called = {event["prim"] for event in ours if event["ev"] == "AH"}
    ends = [[event["prim"] for event in events if event["ev"] == "CH"] for events in (ours, theirs)]
    last = max((float(event["tmax"]) for event in ours + theirs if event["ev"] == "CH"), default=np.inf)
    return ends[0] == ends[1] and all(event["prim"] in called for event in theirs if event["ev"] == "AH" and float(event["tmax"]) <= last)


def _passes_rim(probe: Probe, given: dict[str, Any], events: list[dict[str, Any]], kinds: tuple[int, ...], off: float) -> bool:
    """Whether the ray comes from outside so near to the rim of an end that it counts whether that lies `off` radii off its plane."""
    for primitive in {event["prim"] for event in events if event["ev"] in ("AH", "CH")} or range(_most_segments(probe)):
        for segment in brute_force_curves.segments(probe.scene, given, primitive):
            for u, is_end in zip((0.0, 1.0), _ends(probe, primitive), strict=True):
                center, axis = segment.at(u), segment.slope(u)[:3]
                along = float(axis @ segment.direction)
                if not is_end or segment.curve_type not in kinds or along * (1.0 if u else -1.0) >= 0.0:
                    continue
                away = segment.origin + float((center[:3] - segment.origin) @ axis) / along * segment.direction - center[:3]
                sine = float(np.linalg.norm(np.cross(axis, segment.direction)))
                if abs(float(np.linalg.norm(away)) / center[3] - 1.0) <= ON_RIM + off * sine / abs(along):
                    return True
    return False


def _lost_along(probe: Probe, given: dict[str, Any], ours: list[dict[str, Any]], theirs: list[dict[str, Any]]) -> bool:
    """Whether ours lacks recorded hits, all of them true ones that the ray meets nearly along the axis, and has no other ones before."""
    lost = [event for event in theirs if event["ev"] in ("AH", "CH") and not any(_is_same(event, mine) for mine in ours)]
    added = [mine for mine in ours if mine["ev"] == "CH" and not any(_is_same(event, mine) for event in theirs)]
    return bool(lost) and all(event["hitKind"] in CURVE_KINDS and _is_along(probe, given, event) for event in lost) and all(
        float(mine["tmax"]) > min(float(event["tmax"]) for event in lost) for mine in added)


def _is_same(a: dict[str, Any], b: dict[str, Any]) -> bool:
    return a["ev"] == b["ev"] in ("AH", "CH") and a["prim"] == b["prim"] and close(float(a["tmax"]), float(b["tmax"]), CURVE_T)


def _is_along(probe: Probe, given: dict[str, Any], event: dict[str, Any]) -> bool:
    """Whether a recorded hit lies on its curve, which is round and not linear, and the ray runs along the axis there."""
    if not brute_force_curves.is_on_curve(probe.scene, given, event):
        return False
    for segment in brute_force_curves.segments(probe.scene, given, event["prim"]):
        axis = segment.slope(float(event["u"]))[:3]
        sine = float(np.linalg.norm(np.cross(axis, segment.direction)))
        if segment.curve_type in ROUND and sine <= ALONG_SINE * float(np.linalg.norm(axis) * np.linalg.norm(segment.direction)):
            return True
    return False


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
    """Whether the event is a hit exactly at the end of a segment with caps behind which its strand goes on."""
    u = float(event["u"])
    return u in (0.0, 1.0) and _has_caps(probe) and any(not is_end for is_end in _ends(probe, event["prim"])[int(u) : int(u) + 1])


def _ends(probe: Probe, primitive: int) -> tuple[bool, bool]:
    """Whether strands begin and end with the segments of this index."""
    found = []
    for item in (item for node in probe.scene for item in node.get("buildInputs", []) if item["type"] == "curves"):
        index = primitive - int(item.get("primitiveIndexOffset", 0))
        if 0 <= index < len(item["indices"]):
            step = STEPS.get(int(item["curveType"], 16), 1)
            found.append([item["indices"][index] + way not in item["indices"] for way in (-step, step)])
    return any(begins for begins, _ in found), any(ends for _, ends in found)


def _most_segments(probe: Probe) -> int:
    inputs = [item for node in probe.scene for item in node.get("buildInputs", []) if item["type"] == "curves"]
    return max((len(item["indices"]) for item in inputs), default=0)


def _has_caps(probe: Probe) -> bool:
    return any(item.get("endcapFlags") for node in probe.scene for item in node.get("buildInputs", []))


def crosses_again(event: dict[str, Any], events: list[dict[str, Any]]) -> bool:
    """Whether the event is one of several any-hit calls on one segment at different distances."""
    if event["ev"] != "AH":
        return False
    places = {round(float(other["tmax"]), 3) for other in events if other["ev"] == "AH" and other["prim"] == event["prim"]}
    return len(places) > 1
