"""What a recorded probe needs, and which of it this project can do.

`FEATURES` is the one table. `test_oracle.py` checks each row against the runtime: a feature that is said to be missing must be refused,
so that a row has to be changed when support lands, and the probes that need it run from then on.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from harness import Harness
from oracle_files import Probe
from oracle_scene import build

import optixc as ox

TRIANGLE = {"type": "triangles", "vertices": [[0, 0, 0, 1, 0, 0, 0, 1, 0]], "flags": [0], "numSbtRecords": 1}
MOTION = {"numKeys": 2, "flags": 0, "timeBegin": 0.0, "timeEnd": 1.0}
IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]
STILL = [1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0]


@dataclass(frozen=True)
class Feature:
    """Whether it is there, and a smallest use of it that raises where it is not."""

    supported: bool
    use: Callable[[Harness], Any]


def _gas(item: dict[str, Any], **more: Any) -> dict[str, Any]:
    return {"name": "gas", "kind": "GAS", "buildFlags": 16, "buildInputs": [item], **more}


def _ias(child: str, name: str = "ias") -> dict[str, Any]:
    return {"name": name, "kind": "IAS", "buildFlags": 0, "instances": [
        {"child": child, "transform": IDENTITY, "instanceId": 0, "sbtOffset": 0, "visibilityMask": 255, "flags": 0}]}


def _scene(*nodes: dict[str, Any]) -> Callable[[Harness], Any]:
    return lambda harness: build(harness.context, list(nodes))


def _shader(name: str) -> Callable[[Harness], Any]:
    """A pipeline of all programs of a shader file, so that what they call is compiled too."""
    def use(harness: Harness) -> Any:
        module, create = harness.module(name), harness.context.program_group_create
        groups = [create(**{program.split("__")[1]: module[program]}) for program in module]
        return harness.pipeline(("feature", name), groups, max_trace_depth=4)
    return use


def _curve(kind: str) -> dict[str, Any]:
    return {"type": "curves", "curveType": kind, "vertices": [[0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0]], "radii": [[0.1] * 4],
            "indices": [0], "flags": [0], "numSbtRecords": 1, "endcapFlags": 0}


def _update(harness: Harness) -> None:
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
    accel = harness.context.accel_build([ox.BuildInputTriangles(corners)], build_flags=ox.BuildFlags.ALLOW_UPDATE)
    accel.update([ox.BuildInputTriangles(corners + 1)])


def _compaction(harness: Harness) -> None:
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
    accel = harness.context.accel_build([ox.BuildInputTriangles(corners)], build_flags=ox.BuildFlags.ALLOW_COMPACTION)
    if accel.compact().handle == accel.handle:
        raise NotImplementedError("compaction gives the same structure")


SPHERES = {"type": "spheres", "vertices": [[0, 0, 0]], "radii": [[1]], "flags": [0], "numSbtRecords": 1}
MICROMAP = {**TRIANGLE, "omm": {"indexingMode": 1, "index": [], "indexSize": 4, "indexOffset": 0,
                                "maps": [{"level": 0, "format": 1, "states": [1]}]}}
HALF = {**TRIANGLE, "vertexFormat": "0x2123", "rawBytes": [0] * 18, "rawStride": 0}
FLOAT2 = {**TRIANGLE, "vertexFormat": "0x2122", "rawBytes": [0] * 24, "rawStride": 0}

FEATURES: dict[str, Feature] = {
    "triangles": Feature(True, _scene(_gas(TRIANGLE))),
    "custom primitives": Feature(True, _scene(_gas({"type": "custom", "aabbs": [[0, 0, 0, 1, 1, 1]], "flags": [0], "numSbtRecords": 1}))),
    "instances": Feature(True, _scene(_gas(TRIANGLE), _ias("gas"))),
    "updates": Feature(True, _update),
    "compaction": Feature(True, _compaction),
    "spheres": Feature(True, _scene(_gas(SPHERES))),
    "curves": Feature(True, _scene(_gas(_curve("0x2503")))),
    "rocaps curves": Feature(True, _scene(_gas(_curve("0x2508")))),
    "ribbons": Feature(True, _scene(_gas(_curve("0x2505")))),
    "several instance levels": Feature(True, _scene(_gas(TRIANGLE), _ias("gas", "inner"), _ias("inner"))),
    "static transforms": Feature(True, _scene(_gas(TRIANGLE), {"name": "s", "kind": "static", "child": "gas", "data": IDENTITY})),
    "matrix motion": Feature(True, _scene(_gas(TRIANGLE), {"name": "m", "kind": "matrixMotion", "child": "gas", "motion": MOTION,
                                                            "data": IDENTITY * 2})),
    "SRT motion": Feature(True, _scene(_gas(TRIANGLE), {"name": "m", "kind": "srtMotion", "child": "gas", "motion": MOTION,
                                                         "data": STILL * 2})),
    "vertex motion": Feature(True, _scene(_gas({**TRIANGLE, "vertices": TRIANGLE["vertices"] * 2}, motion=MOTION))),
    "opacity micromaps": Feature(True, _scene(_gas(MICROMAP))),
    "vertex formats": Feature(True, _scene(_gas(HALF))),
    "vertex formats of two components": Feature(True, _scene(_gas(FLOAT2))),
    "random vertex access": Feature(True, _shader("random_access.py")),
    "random instance access": Feature(True, _shader("random_instances.py")),
    "hit objects": Feature(True, _shader("hit_objects.py")),
    "traverse data": Feature(True, _shader("hit_objects.py")),
    "callables": Feature(True, _shader("callables.py")),
    "exceptions": Feature(True, _shader("throwing.py")),
    "payload types": Feature(True, _shader("payload_types.py")),
    "payload of 32 words": Feature(True, _shader("payload32.py")),
}

CURVE_FEATURES = {"0x2505": "ribbons", "0x2508": "rocaps curves", "0x2509": "rocaps curves", "0x250a": "rocaps curves",
                  "0x250b": "rocaps curves"}
INPUT_FEATURES = {"triangles": "triangles", "custom": "custom primitives", "spheres": "spheres", "curves": "curves"}
NODE_FEATURES = {"static": "static transforms", "matrixMotion": "matrix motion", "srtMotion": "SRT motion", "IAS": "instances"}
TWO_COMPONENTS = ("0x2122", "0x2124", "0x2126")


def needed(probe: Probe) -> list[str]:
    """The features that a probe's scene and rays use, each once."""
    found: list[str] = []
    kinds = {node["name"]: node["kind"] for node in probe.scene}
    for node in probe.scene:
        found.extend([NODE_FEATURES[node["kind"]]] if node["kind"] in NODE_FEATURES else [])
        found.extend(_needed_by_inputs(node))
        children = [below["child"] for below in (node, *node.get("instances", [])) if "child" in below]
        if any(kinds.get(child, "GAS") != "GAS" for child in children):
            found.append("several instance levels")
    return list(dict.fromkeys(found))


def _needed_by_inputs(node: dict[str, Any]) -> list[str]:
    found = []
    moving = node.get("motion", {}).get("numKeys", 0) > 1
    for item in node.get("buildInputs", []):
        found.append(CURVE_FEATURES.get(item.get("curveType", ""), INPUT_FEATURES.get(item["type"], item["type"])))
        if moving:
            found.append("vertex motion")
        if "omm" in item:
            found.append("opacity micromaps")
        if "rawBytes" in item:
            found.append("vertex formats of two components" if item["vertexFormat"] in TWO_COMPONENTS else "vertex formats")
    return found


def missing(probe: Probe) -> list[str]:
    """Which of the features that a probe needs are not there."""
    return [name for name in needed(probe) if name not in FEATURES or not FEATURES[name].supported]
