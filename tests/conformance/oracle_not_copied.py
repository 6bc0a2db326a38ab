"""Driver bugs and undefined behaviour in the recorded results that are not to be copied: by what stands in the scene and the record."""

from __future__ import annotations

import math
from typing import Any

from oracle_files import Probe, number

INDEX_BITS = "primitive indices have 30 bits"
MOTION_RANGE = "motion transforms of no or negative duration contradict themselves"
HIT_KINDS = "hit kinds 254 and 255 of custom primitives crash"
INFINITE_VERTEX = "a triangle with an infinite vertex is hit at NaN"

# What is there, with what is here instead.
NOT_COPIED = {
    INDEX_BITS: "32 bits",
    MOTION_RANGE: "refused by name",
    HIT_KINDS: "an ordinary hit of a custom primitive",
    INFINITE_VERTEX: "never hit",
}
THIRTY_BITS = 1 << 30
TRIANGLE_KINDS = (254, 255)
PER_TRIANGLE = {"triangles": 9, "custom": 6, "spheres": 3}


def must_be_refused(probe: Probe) -> bool:
    """Whether the scene holds motion whose time does not go on, which is recorded there and is refused by name here."""
    motions = [node["motion"] for node in probe.scene if "motion" in node]
    return any(motion["numKeys"] > 1 and number(motion["timeBegin"]) >= number(motion["timeEnd"]) for motion in motions)


def was_not_run(probe: Probe) -> str | None:
    """Why a recorded scene has no rays, None if that is not known."""
    reports = [report for hit in probe.data.get("hitgroups", []) for report in hit["data"].get("reports", [])]
    return HIT_KINDS if not probe.rays and any(report["kind"] & 0xFF in TRIANGLE_KINDS for report in reports) else None


def ray_not_copied(probe: Probe, ours: list[dict[str, Any]], theirs: list[dict[str, Any]]) -> str | None:
    """Why what is recorded for a ray is not to be copied, None if it is."""
    hits = [event for event in ours + theirs if event["ev"] in ("IS", "AH", "CH")]
    inputs = [item for node in probe.scene for item in node.get("buildInputs", [])]
    if any(_last_primitive(item) >= THIRTY_BITS for item in inputs) and any(event["prim"] >= THIRTY_BITS // 2 for event in hits):
        return INDEX_BITS
    if any(math.isnan(number(event["tmax"])) for event in theirs if event["ev"] in ("AH", "CH")) and _has_infinite_vertex(probe):
        return INFINITE_VERTEX
    if any(event.get("hitKind") in TRIANGLE_KINDS and event.get("ptype") == "0x2500" for event in ours):
        return HIT_KINDS
    return None


def query_not_copied(probe: Probe, gas_index: int) -> str | None:
    """Why the answer to a query by handle for this SBT index is not to be copied, None if it is."""
    first_record = 0
    for node in probe.scene:
        for item in node.get("buildInputs", []):
            if first_record <= gas_index < first_record + item["numSbtRecords"]:
                return INDEX_BITS if _last_primitive(item) >= THIRTY_BITS else None
            first_record += item["numSbtRecords"]
    return None


def _last_primitive(item: dict[str, Any]) -> int:
    return int(item.get("primitiveIndexOffset", 0)) + _count(item) - 1


def _count(item: dict[str, Any]) -> int:
    """The primitives of a build input."""
    if "indices" in item:
        return len(item["indices"]) // (3 if item["type"] == "triangles" else 1)
    if "rawBytes" in item:
        return len(item["rawBytes"])  # no fewer than there are
    numbers = item["aabbs"][0] if item["type"] == "custom" else item["vertices"][0]
    return len(numbers) // PER_TRIANGLE.get(item["type"], 1)


def _has_infinite_vertex(probe: Probe) -> bool:
    inputs = [item for node in probe.scene for item in node.get("buildInputs", []) if item["type"] == "triangles"]
    return any(math.isinf(number(value)) for item in inputs for key in item["vertices"] for value in key)
