"""Checks of the recorded probes that are not a scene with rays: which check a probe gets is decided by what was recorded in it.

A check reproduces the programs of its group (`shaders/`), runs them on the recorded or, where none was recorded, the described scene,
and compares.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from harness import Harness
from oracle_api import NEEDED, check_misuse, check_properties, check_stack_helpers, has_check
from oracle_callables import check_callables
from oracle_curve_queries import check_curve_queries, is_curve_query
from oracle_exceptions import check_exceptions, check_refused_code
from oracle_files import Probe
from oracle_hit_objects import USING_TRAVERSE_DATA, check_hit_objects, mode_of
from oracle_instance_queries import check_instance_queries
from oracle_payload import VIOLATIONS, check_payload32, check_payload_types, check_payload_violation
from oracle_queries import check_triangle_queries, is_triangle_query, moves


@dataclass(frozen=True)
class Check:
    """A check and the features that it needs besides those of the probe's scene."""

    features: tuple[str, ...]
    run: Callable[[Harness, Probe], None]


def check_of(probe: Probe) -> Check | None:
    """The check for a probe, None where there is none."""
    if "rows" in probe.data:
        return Check(("payload of 32 words",), check_payload32)
    if probe.name.startswith("payload_types") and "u" in probe.data:
        return Check(("payload types",), check_payload_types)
    if probe.name.startswith("payload_semantics_violation") and probe.name.rsplit("_", 1)[1] in VIOLATIONS:
        return Check(("payload types",), check_payload_violation)
    if "states" in probe.data:
        more = ("traverse data",) if mode_of(probe) == USING_TRAVERSE_DATA else ()
        return Check(("hit objects", *more), check_hit_objects)
    if "exceptionFlags" in probe.data:
        return Check(("exceptions",), check_exceptions)
    if probe.name.startswith("exception_code_out_of_range"):
        return Check(("exceptions",), check_refused_code)
    if probe.group.startswith("10_callables") and "log" in probe.data:
        return Check(("callables",), check_callables)
    if probe.name == "instance_random_access":
        return Check(("random instance access", "static transforms", "several instance levels"), check_instance_queries)
    if probe.data.get("queries") and is_triangle_query(probe):
        return Check(("random vertex access", *(("vertex motion",) if moves(probe) else ())), check_triangle_queries)
    if probe.data.get("queries") and is_curve_query(probe):
        return Check(("random vertex access", "curves"), check_curve_queries)
    if probe.name == "stack_size_helpers":
        return Check((), check_stack_helpers)
    if probe.name == "device_properties":
        return Check((), check_properties)
    if "rcName" in probe.data and has_check(probe):
        return Check(NEEDED.get(probe.name, ()), check_misuse)
    return None


def why_not(probe: Probe) -> str:
    """What kind of record it is that has no check."""
    keys = sorted(set(probe.data) - {"name", "section", "notes"})
    return f"it holds {', '.join(keys)}"
