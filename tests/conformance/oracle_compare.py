"""Compare one event of ours with one recorded event, and check that a ray's log is a lawful run of its programs.

Integers and decisions are compared exactly, numbers within the relative errors stated here. What may differ between two correct
implementations stands in `oracle_differences` and nowhere else.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from oracle_events import RayResult
from oracle_files import Probe, number, numbers

# spec 05: 1e-5 relative where nothing is stated; both sides compute in binary32 and differ in the order of operations.
RELATIVE = 1e-5
# Barycentrics come from edge functions whose rounding grows with the ray's distance from the triangle: absolute, in [0, 1].
BARYCENTRIC = 1e-5
# The recorded curve hits lie on the analytic curve within 6e-6 (swept circle) and 1.2e-4 (rocaps) for radii of 0.1 to 0.5: two such
# solvers may differ by the sum. The parameter of a hit is worth less: near a turning point du/dt grows without bound.
CURVE_T = 2.4e-4
CURVE_PARAMETER = 5e-3
# A recorded normal of a ribbon holds a finite difference: it is off by 1e-4 of itself.
RIBBON_NORMAL = 2e-4
NUMBER_KEYS = frozenset({"tmin", "tmax", "time", "t", "tmaxBefore", "tmaxAfter"})
VECTOR_KEYS = frozenset({"wo", "wd", "oo", "od", "vertexData", "normal", "gasMotion"})
MATRIX_KEYS = frozenset({"o2w", "w2o"})
BARYCENTRIC_KEYS = frozenset({"u", "v"})
CURVE_TYPES = frozenset({"0x2501", "0x2502", "0x2503", "0x2504", "0x2505", "0x2507", "0x2508", "0x2509", "0x250a", "0x250b"})
FIRST_CURVE_KIND, LAST_CURVE_KIND, SPHERE_KIND = 128, 148, 138


def close(a: float, b: float, relative: float = RELATIVE, scale: float = 0.0) -> bool:
    """Whether two numbers agree; NaN agrees with NaN and an infinity with itself."""
    if math.isnan(a) or math.isnan(b):
        return math.isnan(a) and math.isnan(b)
    if math.isinf(a) or math.isinf(b):
        return a == b
    return abs(a - b) <= relative * max(abs(a), abs(b), scale)


def mismatches(ours: dict[str, Any], recorded: dict[str, Any], scale: float, skip: frozenset[str] = frozenset()) -> list[str]:
    """What is different in the keys that were recorded, one text per key. `scale` is the size of the ray's coordinates."""
    found = []
    curve = _is_curve(ours)
    for key, value in recorded.items():
        if key in skip:
            continue
        if key == "attr" and ours.get("ptype") != "0x2500":
            continue  # of built-in primitives the attributes are u and v, compared as numbers
        if not _equal(key, ours.get(key), value, scale, curve):
            found.append(f"{recorded['ev']}.{key}: {ours.get(key)} recorded {value}")
    return found


def _is_curve(event: dict[str, Any]) -> bool:
    return event.get("ptype") in CURVE_TYPES


def _equal(key: str, ours: Any, recorded: Any, scale: float, curve: bool) -> bool:
    if ours is None:
        return False
    if key in NUMBER_KEYS:
        return close(ours, number(recorded), max(RELATIVE, CURVE_T) if curve else RELATIVE, scale)
    if key in BARYCENTRIC_KEYS:
        return abs(ours - number(recorded)) <= (CURVE_PARAMETER if curve else BARYCENTRIC)
    if key in VECTOR_KEYS or key in MATRIX_KEYS:
        values = numbers(recorded)
        size = max([abs(value) for value in values if math.isfinite(value)], default=0.0)
        size = max(size, scale) if key in ("oo", "od") else size
        relative = RIBBON_NORMAL if key == "normal" else RELATIVE
        return len(ours) == len(values) and all(close(a, b, relative, size) for a, b in zip(ours, values, strict=True))
    return bool(ours == recorded)


def ray_scale(given: dict[str, Any]) -> float:
    """The size of a ray's coordinates in units of its direction: what the rounding of a hit distance is relative to."""
    origin = max((abs(value) for value in numbers(given["o"]) if math.isfinite(value)), default=0.0)
    length = math.sqrt(sum(value * value for value in numbers(given["d"]) if math.isfinite(value)))
    return origin / length if length > 0.0 else 0.0


def unlawful(probe: Probe, index: int, result: RayResult) -> list[str]:
    """What in our log of a ray contradicts the programs themselves: payload words, decisions, shrinking interval, final payload."""
    given = probe.rays[index]["in"]
    run = _Run(index, given, {hit["data"]["id"]: hit["data"] for hit in probe.hitgroups})
    for event in result.events:
        run.step(event)
    if not result.returned:
        run.found.append("the trace did not return")
    if result.payload != run.words:
        run.found.append(f"payload after the trace: {result.payload}, by the log {run.words}")
    return run.found


class _Run:
    """The recording programs, run over a log instead of a scene."""

    def __init__(self, index: int, given: dict[str, Any], records: dict[int, Any]) -> None:
        self.words = [index, given.get("p1", 0), given.get("p2", 0), given.get("p3", 0)]
        self.first_hit_ends = bool(given["flags"] & 4)
        self.records = records
        self.closest = math.inf
        self.accepted = False
        self.ended = False
        self.found: list[str] = []

    def step(self, event: dict[str, Any]) -> None:
        """Take one event."""
        kind = event["ev"]
        if kind == "RP":
            self._report(event)
            return
        self._check(event["p"] == self.words, f"{kind}.p {event['p']}, by the log {self.words}")
        if kind in ("IS", "AH"):
            self._check(not self.ended, f"{kind} after the ray was terminated")
        if kind == "IS":
            self.words[1] = (self.words[1] + 0x10000) & 0xFFFFFFFF
        elif kind == "AH":
            self._anyhit(event)
        elif kind == "CH":
            self._check(event["tmax"] <= self.closest, f"closest hit at {event['tmax']} behind an accepted one at {self.closest}")
            self.words[3] = (7000 + event["prim"]) & 0xFFFFFFFF
        elif kind == "MS":
            self._check(not self.accepted, "miss after an accepted hit")
            self.words[3] = 9000 + event["rec"]

    def _anyhit(self, event: dict[str, Any]) -> None:
        self._check(not event["tmax"] > self.closest, f"any hit at {event['tmax']} behind an accepted one at {self.closest}")
        self.words[1] += 1
        self.words[2] = (1000 + event["prim"]) & 0xFFFFFFFF
        decision = decide(self.records[event["rec"]], self.words[1] & 0xFFFF, event["prim"], event["hitKind"])
        self.accepted = decision != "ignore"
        if self.accepted:
            self.closest = event["tmax"]
            self.ended = decision == "terminate" or self.first_hit_ends

    def _report(self, event: dict[str, Any]) -> None:
        self._check(not self.ended, "optixReportIntersection returned from a terminated ray")
        self._check(event["p1"] == self.words[1], f"RP.p1 {event['p1']}, by the log {self.words[1]}")
        self._check(not event["ret"] or event["tmaxAfter"] == event["t"], f"accepted at {event['t']}, tmax is {event['tmaxAfter']}")

    def _check(self, fine: bool, text: str) -> None:
        if not fine:
            self.found.append(text)


def decide(record: dict[str, Any], calls: int, primitive: int, hit_kind: int) -> str:
    """What the recording any-hit program does: accept, ignore or terminate."""
    argument = record["ahArg"]
    match record["ahMode"]:
        case 1:
            return "ignore"
        case 2:
            return "terminate"
        case 3:
            return "ignore" if primitive & 1 else "accept"
        case 4:
            return "terminate" if calls == argument else "accept"
        case 5:
            return "ignore" if calls <= argument else "accept"
        case 6:
            return "ignore" if calls < argument else "terminate" if calls == argument else "accept"
        case 7:
            return "ignore" if hit_kind & 1 else "accept"
        case _:
            return "accept"


def same_sequence(ours: Sequence[dict[str, Any]], recorded: Sequence[dict[str, Any]]) -> bool:
    """Whether the same programs ran for the same records and primitives in the same order."""
    if len(ours) != len(recorded):
        return False
    return all(a["ev"] == b["ev"] and a["rec"] == b["rec"] and a.get("prim") == b.get("prim", a.get("prim"))
               for a, b in zip(ours, recorded, strict=True))
