"""Short words for scenes, rays and hit groups, in the form of the recorded files, and their trace through the event recorder."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from harness import Harness
from oracle_compare import unlawful
from oracle_events import RayResult, record
from oracle_files import Probe
from oracle_scene import build

IDENTITY = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)
CORNER = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
FAR = 1e16
DOWN = (0.0, 0.0, -1.0)
UP = (0.0, 0.0, 1.0)


def triangles(corners: Any, flags: Sequence[int] = (0,), **more: Any) -> dict[str, Any]:
    """A triangle input from corners in threes."""
    return {"type": "triangles", "vertices": [np.asarray(corners, np.float32).ravel().tolist()], "flags": list(flags),
            "numSbtRecords": len(flags), **more}


def boxes(bounds: Any, flags: Sequence[int] = (0,), **more: Any) -> dict[str, Any]:
    """A custom-primitive input from rows of six."""
    return {"type": "custom", "aabbs": [np.asarray(bounds, np.float32).ravel().tolist()], "flags": list(flags),
            "numSbtRecords": len(flags), **more}


def offsets(values: Sequence[int], size: int = 4) -> dict[str, Any]:
    """Per-primitive SBT index offsets of `size` bytes."""
    return {"sbtIndexOffset": list(values), "sbtIndexOffsetSizeInBytes": size}


def gas(*inputs: dict[str, Any], name: str = "gas", build_flags: int = 0) -> dict[str, Any]:
    """An acceleration structure of geometry."""
    return {"name": name, "kind": "GAS", "buildFlags": build_flags, "buildInputs": list(inputs)}


def instance(child: str = "gas", transform: Any = IDENTITY, instance_id: int = 0, sbt_offset: int = 0, mask: int = 255,
             flags: int = 0) -> dict[str, Any]:
    """One instance."""
    return {"child": child, "transform": np.asarray(transform, np.float64).ravel().tolist(), "instanceId": instance_id,
            "sbtOffset": sbt_offset, "visibilityMask": mask, "flags": flags}


def ias(*instances: dict[str, Any], name: str = "ias") -> dict[str, Any]:
    """An acceleration structure of instances."""
    return {"name": name, "kind": "IAS", "buildFlags": 0, "instances": list(instances)}


def translation(x: float, y: float, z: float) -> list[float]:
    """A 3x4 matrix that moves."""
    return [1.0, 0.0, 0.0, x, 0.0, 1.0, 0.0, y, 0.0, 0.0, 1.0, z]


def ray(origin: Sequence[float], direction: Sequence[float] = DOWN, root: str = "gas", tmin: float = 0.0, tmax: float = FAR,
        flags: int = 0, mask: int = 255, sbt_offset: int = 0, sbt_stride: int = 1, miss: int = 0, time: float = 0.0) -> dict[str, Any]:
    """One ray."""
    return {"in": {"root": root, "o": list(origin), "d": list(direction), "tmin": tmin, "tmax": tmax, "time": time, "mask": mask,
                   "flags": flags, "sbtOffset": sbt_offset, "sbtStride": sbt_stride, "missIdx": miss}}


def hitgroup(record_id: int = 0, kind: str = "tri", anyhit_mode: int = 0, argument: int = 0, closesthit: bool = True, anyhit: bool = True,
             reports: Sequence[dict[str, Any]] = ()) -> dict[str, Any]:
    """One hit record."""
    return {"kind": kind, "ctype": "0x0", "endcap": 0, "ch": closesthit, "ah": anyhit,
            "data": {"id": record_id, "ahMode": anyhit_mode, "ahArg": argument, "reports": list(reports)}}


def reported(t: float, kind: int = 1, per_primitive: float = 0.0, attributes: Sequence[int] = (0,) * 8) -> dict[str, Any]:
    """One report of the intersection program."""
    return {"t": t, "tPerPrim": per_primitive, "kind": kind, "a": list(attributes)}


def trace(harness: Harness, scene: Sequence[dict[str, Any]], rays: Sequence[dict[str, Any]],
          hitgroups: Sequence[dict[str, Any]] = (), misses: int = 1, motion: bool = False, micromaps: bool = False,
          made: dict[str, Any] | None = None) -> list[RayResult]:
    """What the recorder saw for each ray; each log is checked to be a lawful run of the programs. `made`: a scene built already."""
    probe = Probe("here", {"name": "scene", "pipeline": {"usesMotionBlur": motion, "omm": micromaps}, "scene": list(scene),
                           "rays": list(rays), "hitgroups": list(hitgroups) or [hitgroup()],
                           "miss": [{"id": index, "ahMode": 0, "ahArg": 0} for index in range(misses)]})
    results = record(harness, probe, build(harness.context, probe.scene) if made is None else made)
    for index, result in enumerate(results):
        assert unlawful(probe, index, result) == [], (index, rays[index])
    return results


def calls(result: RayResult, kind: str = "AH") -> list[dict[str, Any]]:
    """The events of one kind."""
    return [event for event in result.events if event["ev"] == kind]


def kinds(result: RayResult) -> list[str]:
    """The kinds of the events in order."""
    return [event["ev"] for event in result.events]


def closest(result: RayResult) -> dict[str, Any]:
    """The closest-hit event; there must be one."""
    found = calls(result, "CH")
    assert len(found) == 1, kinds(result)
    return found[0]


def missed(result: RayResult) -> bool:
    """Whether the miss program ran and nothing else did at the end."""
    return bool(calls(result, "MS")) and not calls(result, "CH")
