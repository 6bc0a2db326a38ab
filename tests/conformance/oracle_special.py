"""Checks of the recorded probes that are not a scene with rays: which check a probe gets is decided by what was recorded in it.

A check reproduces the programs of its group (`shaders/`), runs them on the recorded or, where none was recorded, the described scene,
and compares.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from harness import Harness
from oracle_files import Probe
from oracle_payload import check_payload32


@dataclass(frozen=True)
class Check:
    """A check and the features that it needs besides those of the probe's scene."""

    features: tuple[str, ...]
    run: Callable[[Harness, Probe], None]


def check_of(probe: Probe) -> Check | None:
    """The check for a probe, None where there is none."""
    if "rows" in probe.data:
        return Check(("payload of 32 words",), check_payload32)
    return None


def why_not(probe: Probe) -> str:
    """What kind of record it is that has no check."""
    keys = sorted(set(probe.data) - {"name", "section", "notes"})
    return f"it holds {', '.join(keys)}"
