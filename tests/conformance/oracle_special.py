"""Checks of the recorded probes that are not a scene with rays: which check a probe gets is decided by what was recorded in it.

A check reproduces the programs of its group (`shaders/`), runs them on the recorded or, where none was recorded, the described scene,
and compares. The name of a probe is looked at only where nothing else in the record says what was done: misuses of the host API, and
members of an instance out of range.
"""

from __future__ import annotations

from collections.abc import Callable

from harness import Harness
from oracle_api import check_misuse, check_properties, check_stack_helpers
from oracle_callables import check_callables
from oracle_counts import (
    check_compaction,
    check_cracks,
    check_grid,
    check_instance_build,
    check_micromap_order,
    check_multiplicity,
    check_watertight,
    is_instance_build,
)
from oracle_curve_queries import check_curve_queries, is_curve_query
from oracle_exceptions import check_exceptions, check_refused_code, is_refused_code
from oracle_files import Probe
from oracle_hit_objects import check_hit_objects
from oracle_instance_queries import check_instance_queries, is_instance_query
from oracle_keys import ABOUT
from oracle_not_copied import was_not_run
from oracle_payload import check_payload32, check_payload_types, check_payload_violation, is_payload_violation
from oracle_queries import check_triangle_queries, is_triangle_query

Check = Callable[[Harness, Probe], None]
# Keys with the names of what stands in them cut off, and the check of a record of these keys.
BY_KEYS: tuple[tuple[frozenset[str], Check], ...] = (
    (frozenset({"rows"}), check_payload32),
    (frozenset({"u"}), check_payload_types),
    (frozenset({"states", "log"}), check_hit_objects),
    (frozenset({"exceptionFlags", "mode", "numDetails", "code", "launch", "sync", "perLaunchIndex", "exceptionCount", "exceptions",
                "depthLog"}), check_exceptions),
    (frozenset({"log", "stackSizes"}), check_callables),
    (frozenset({"sizes", "out"}), check_stack_helpers),
    (frozenset({"values"}), check_properties),
    (frozenset({"rcName"}), check_misuse),
    (frozenset({"rc", "rcName"}), check_misuse),
    (frozenset({"rc", "rcName", "log"}), check_misuse),
    (frozenset({"rays", "misses", "firstMissX"}), check_cracks),
    (frozenset({"rays", "misses", "anyhitCallHistogram"}), check_watertight),
    (frozenset({"anyhitCallHistogram"}), check_grid),
    (frozenset({"anyhit_calls", "duplicates"}), check_multiplicity),
    (frozenset({"levels"}), check_micromap_order),
    (frozenset({"outputSize", "compactedSize", "handleChanged", "relocInfo"}), check_compaction),
)
BY_CONTENT: tuple[tuple[frozenset[str], Callable[[Probe], bool], Check], ...] = (
    (frozenset({"rc"}), is_refused_code, check_refused_code),
    (frozenset({"rc", "log"}), is_payload_violation, check_payload_violation),
    (frozenset({"result"}), is_instance_build, check_instance_build),
    (frozenset({"result", "log"}), is_instance_build, check_instance_build),
    (frozenset({"queries"}), is_instance_query, check_instance_queries),
    (frozenset({"queries"}), is_triangle_query, check_triangle_queries),
    (frozenset({"queries", "scene"}), is_triangle_query, check_triangle_queries),
    (frozenset({"queries"}), is_curve_query, check_curve_queries),
)
SPEED = frozenset({"triangles", "rays", "hits", "ms_per_launch", "Mrays_per_s", "gas_bytes"})


def check_of(probe: Probe) -> Check | None:
    """The check for a probe, None where the record is not understood."""
    keys = _keys(probe)
    for known, check in BY_KEYS:
        if keys == known:
            return check
    return next((check for known, fits, check in BY_CONTENT if keys == known and fits(probe)), None)


def nothing_to_compare(probe: Probe) -> str | None:
    """Why a record says nothing about what is right, None if it does."""
    if "void" in probe.data:
        return "the record says of itself that it is void"
    return "the speed of that machine" if _keys(probe) == SPEED else was_not_run(probe)


def why_not(probe: Probe) -> str:
    """What kind of record it is that has no check."""
    return f"it holds {', '.join(sorted(_keys(probe)))}"


def _keys(probe: Probe) -> frozenset[str]:
    return frozenset(key.split("(")[0].split("[")[0].split("{")[0] for key in probe.data) - ABOUT
