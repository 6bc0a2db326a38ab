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

# The largest offset or stride of a ray: they have four bits.
FIELD = 15
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
        """The recorded rays with their events; empty where the probe holds counts only, or rays of another form."""
        rays = self.data.get("rays", [])
        return rays if isinstance(rays, list) and all(isinstance(ray, dict) and "in" in ray for ray in rays) else []

    @property
    def hitgroups(self) -> list[dict[str, Any]]:
        """The hit records. Where none were recorded, record i has the id i and the plain programs, as many as the rays can reach."""
        if self.data["hitgroups"]:
            return list(self.data["hitgroups"])
        kinds = {HITGROUP_KINDS[item["type"]] for node in self.scene for item in node.get("buildInputs", [])} or {"tri"}
        if len(kinds) > 1:
            raise ValueError(f"no hit groups were recorded for a scene of {sorted(kinds)}: which record is of which kind is not known")
        plain = {"ahMode": 0, "ahArg": 0}
        return [{"kind": min(kinds), "ch": True, "ah": True, "data": {"id": index, **plain}} for index in range(self._last_record() + 1)]

    def _last_record(self) -> int:
        """A bound of the record indices that the rays can reach: offsets of instances and rays, and records of structures by the stride."""
        seen = max((event["rec"] for ray in self.rays for event in ray["events"]), default=0)
        offsets = [max((one["sbtOffset"] for one in node.get("instances", [])), default=0) for node in self.scene]
        records = [sum(item["numSbtRecords"] for item in node.get("buildInputs", [])) for node in self.scene]
        return int(max(seen, sum(offsets) + FIELD * max(records, default=0)))


def folder() -> Path:
    """Where the recorded files are looked for."""
    return Path(os.environ.get("OXRT_ORACLE_DIR", DEFAULT_FOLDER))


def probes() -> list[Probe]:
    """Every probe of every group, in the order of the files; empty where the folder is absent. A file that is no group is one probe too."""
    found: list[Probe] = []
    for path in sorted(folder().glob("*.json")):
        try:
            group = json.loads(path.read_text())
            found.extend(Probe(str(group.get("group", path.stem)), {"name": "?", **data}) for data in group["probes"])
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            found.append(Probe(path.stem, {"name": path.name, "unreadable": str(error)}))
    return found


def number(value: Any) -> float:
    """A recorded number: "inf", "-inf" and "nan" are text in the files."""
    return float(value)


def numbers(values: Any) -> list[float]:
    """A recorded list of numbers."""
    return [float(value) for value in values]
