"""Read the recorded results of a real OptiX: groups, probes, and the numbers that JSON cannot hold.

The folder is that of OXRT_ORACLE_DIR, by default `../shared/oracle` beside the repository. Nothing here knows what a probe means.
"""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

DEFAULT_FOLDER = Path(__file__).resolve().parents[2] / ".." / "shared" / "oracle"

HITGROUP_KINDS = {"triangles": "tri", "custom": "custom", "spheres": "sphere", "curves": "curve"}


@dataclass(frozen=True)
class Probe:
    """One recorded experiment; `data` is the JSON object as it stands in the file."""

    group: str
    data: dict[str, Any]

    @property
    def name(self) -> str:
        """The probe's name in its group."""
        return str(self.data["name"])

    @property
    def id(self) -> str:
        """A name that is unique over all groups."""
        return f"{self.group}-{self.name}"

    @property
    def scene(self) -> list[dict[str, Any]]:
        """The traversables of the scene, children before parents; empty where none was recorded."""
        scene = self.data.get("scene", [])
        return scene if isinstance(scene, list) else [scene]

    @property
    def rays(self) -> list[dict[str, Any]]:
        """The recorded rays with their events; empty where the probe holds counts only."""
        rays = self.data.get("rays", [])
        return rays if isinstance(rays, list) else []

    @property
    def hitgroups(self) -> list[dict[str, Any]]:
        """The hit records. Where none were recorded, record i has the id i and the plain programs, as many as the events name."""
        if self.data["hitgroups"]:
            return list(self.data["hitgroups"])
        last = max((event["rec"] for ray in self.rays for event in ray["events"]), default=0)
        types = [item["type"] for node in self.scene for item in node.get("buildInputs", [])]
        kind = HITGROUP_KINDS[types[0]] if types else "tri"
        return [{"kind": kind, "ch": True, "ah": True, "data": {"id": index, "ahMode": 0, "ahArg": 0}} for index in range(last + 1)]


def folder() -> Path:
    """Where the recorded files are looked for."""
    return Path(os.environ.get("OXRT_ORACLE_DIR", DEFAULT_FOLDER))


def probes() -> list[Probe]:
    """Every probe of every group, in the order of the files; empty where the folder is absent."""
    found: list[Probe] = []
    for path in sorted(folder().glob("*.json")):
        group = json.loads(path.read_text())
        found.extend(Probe(str(group["group"]), data) for data in group["probes"])
    return found


def number(value: Any) -> float:
    """A recorded number: "inf", "-inf" and "nan" are text in the files."""
    return float(value)


def numbers(values: Any) -> list[float]:
    """A recorded list of numbers."""
    return [float(value) for value in values]
