"""The brute-force reference finds what a real OptiX recorded, so that it may judge scenes that nobody recorded."""

from __future__ import annotations

import math
from typing import Any

import brute_force
import oracle_files
import pytest
from oracle_files import Probe, number
from oracle_not_copied import must_be_refused, ray_not_copied

# Recorded distances are binary32 of a driver that loses digits far from the origin; decisions must agree all the same.
T_RELATIVE = 1e-4
KNOWN_TYPES = ("triangles", "spheres")
HIT_EVENTS = ("AH", "CH")


def _covered(probe: Probe) -> bool:
    inputs = [item for node in probe.scene for item in node.get("buildInputs", [])]
    moving = any(node["kind"] in ("matrixMotion", "srtMotion") for node in probe.scene)
    return bool(probe.rays) and all(item["type"] in KNOWN_TYPES and "omm" not in item and "rawBytes" not in item for item in inputs) \
        and (probe.data["pipeline"]["usesMotionBlur"] or not moving) and not must_be_refused(probe)


PROBES = [probe for probe in oracle_files.probes() if _covered(probe)]


def _beyond_binary32(given: dict[str, Any]) -> bool:
    """Whether a ray's numbers leave what binary32 can compute with, or are undefined."""
    origin, direction = oracle_files.numbers(given["o"]), oracle_files.numbers(given["d"])
    values = [number(given[key]) for key in ("tmin", "tmax", "time")] + origin + direction
    return any(math.isnan(value) for value in values) or not 1e-20 < math.hypot(*direction) < 1e20 or max(map(abs, origin)) > 1e6


@pytest.mark.parametrize("probe", PROBES, ids=lambda probe: probe.id)
def test_recorded_hits_are_found(probe: Probe) -> None:
    for ray in probe.rays:
        given = ray["in"]
        if _beyond_binary32(given) or brute_force.edges_passed(probe.scene, given) or ray_not_copied(probe, [], ray["events"]):
            continue
        hits = [hit for hit in brute_force.scene_candidates(probe.scene, given) if brute_force.visible(hit, given["flags"])]
        recorded = [event for event in ray["events"] if event["ev"] in HIT_EVENTS]
        for event in recorded:
            t = number(event["tmax"])
            assert any((hit.primitive, hit.hit_kind) == (event["prim"], event["hitKind"])
                       and math.isclose(hit.t, t, rel_tol=T_RELATIVE, abs_tol=T_RELATIVE) for hit in hits), (given, event)
        missed = any(event["ev"] == "MS" for event in ray["events"])
        if missed and not recorded:
            assert not hits, given
