"""Launch the event recorder over the rays of a probe and give its events in the form of the recorded files.

An event is a dictionary with the keys of the files (`ev`, `rec`, `prim`, `tmax`, ...), so that a comparison looks at the keys that were
recorded and at nothing else. Handles become the names of the scene.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from harness import Harness
from oracle_files import Probe, number, numbers
from oracle_instances import instance_names
from oracle_scene import handle_of
from shaders import recorder as layout

import optixc as ox

EVENT_NAMES = {layout.EVENT_INTERSECTION: "IS", layout.EVENT_REPORT: "RP", layout.EVENT_ANYHIT: "AH", layout.EVENT_CLOSESTHIT: "CH",
               layout.EVENT_MISS: "MS"}
USUAL_EVENTS = 12
MAX_REPORTS = 4
HIT_EVENTS = ("AH", "CH")
PRIMITIVE_EVENTS = ("IS", "AH", "CH")
HANDLE_INSTANCES = 64


@dataclass(frozen=True)
class RayResult:
    """What our side did for one ray: the payload after the trace, whether it returned, and the events in order."""

    payload: list[int]
    returned: int
    event_count: int
    events: list[dict[str, Any]]


def record(harness: Harness, probe: Probe, scene: dict[str, Any]) -> list[RayResult]:
    """Trace every ray of the probe through the recorder."""
    groups, pipeline = harness.recorder(tuple(sorted({hit["kind"] for hit in probe.hitgroups})),
                                        motion=probe.data["pipeline"]["usesMotionBlur"], micromaps=probe.data["pipeline"]["omm"])
    sbt = ox.ShaderBindingTable(
        raygen=groups["raygen"].record(),
        miss=[groups["miss"].record(_record(data)) for data in probe.data["miss"]],
        hitgroup=[groups[hit["kind"], hit["ch"], hit["ah"]].record(_record(hit["data"])) for hit in probe.hitgroups])
    rays = _rays(probe, scene)
    count = len(rays)
    room = 2 * max(ray.get("nev", USUAL_EVENTS) for ray in probe.rays) + 8
    words = np.zeros((count, room, layout.WORD_COUNT), np.uint32)
    values = np.zeros((count, room, layout.NUMBER_COUNT), np.float32)
    handles = np.zeros((count, room, layout.HANDLE_COUNT), layout.Handle.dtype)
    outcomes = np.zeros(count, layout.Outcome.dtype)
    counts = np.zeros(count, np.uint32)
    params = layout.Params(rays=rays, outcomes=outcomes, counts=counts, words=words, numbers=values, handles=handles)
    harness.launch(pipeline, params, sbt, count)
    names = {handle_of(traversable): name for name, traversable in scene.items()} | instance_names(harness, probe.scene, scene)
    return [RayResult([int(outcomes[ray][f"word{i}"]) for i in range(4)], int(outcomes[ray]["returned"]), int(counts[ray]),
                      [_event(words[ray, i], values[ray, i], handles[ray, i]["value"], names) for i in range(min(int(counts[ray]), room))])
            for ray in range(count)]


def _record(data: dict[str, Any]) -> layout.Record:
    reports = [layout.Report(number(one["t"]), number(one["tPerPrim"]), one["kind"], one["a"]) for one in data.get("reports", [])]
    padding = [layout.Report(0.0, 0.0, 0, [0] * 8)] * (MAX_REPORTS - len(reports))
    return layout.Record(data["id"], data["ahMode"], data["ahArg"], len(reports), *reports, *padding)


def _rays(probe: Probe, scene: dict[str, Any]) -> np.ndarray:
    rays = np.zeros(len(probe.rays), layout.Ray.dtype)
    for row, one in zip(rays, probe.rays, strict=True):
        given = one["in"]
        row["origin"], row["direction"] = numbers(given["o"]), numbers(given["d"])
        row["tmin"], row["tmax"], row["time"] = number(given["tmin"]), number(given["tmax"]), number(given["time"])
        row["mask"], row["flags"] = given["mask"], given["flags"]
        row["sbt_offset"], row["sbt_stride"], row["miss_index"] = given["sbtOffset"], given["sbtStride"], given["missIdx"]
        row["handle"] = handle_of(scene[given["root"]]) if given["root"] in scene else 0
        for word, key in enumerate(("p1", "p2", "p3"), 1):
            row[f"word{word}"] = given.get(key, 0)
    return rays


def _event(words: np.ndarray, values: np.ndarray, handles: np.ndarray, names: dict[int, str]) -> dict[str, Any]:
    """One event with every key that a recorded event may have."""
    kind = EVENT_NAMES[int(words[layout.TYPE])]
    event: dict[str, Any] = {"ev": kind, "rec": int(words[layout.RECORD])}
    if kind == "RP":
        event |= {"prim": int(words[layout.PRIMITIVE]), "t": float(values[layout.REPORTED_T]), "kind": int(words[layout.REPORTED_KIND]),
                  "ret": int(words[layout.RETURNED]), "tmaxBefore": float(values[layout.TMAX_BEFORE]),
                  "tmaxAfter": float(values[layout.TMAX_AFTER]), "p1": int(words[layout.PAYLOAD + 1])}
        return event
    event |= {"tmin": float(values[layout.TMIN]), "tmax": float(values[layout.TMAX]), "time": float(values[layout.TIME]),
              "rayFlags": int(words[layout.RAY_FLAGS]), "mask": int(words[layout.MASK]),
              "p": [int(word) for word in words[layout.PAYLOAD:layout.PAYLOAD + 4]],
              "wo": _floats(values, layout.WORLD_ORIGIN, 3), "wd": _floats(values, layout.WORLD_DIRECTION, 3)}
    if kind in PRIMITIVE_EVENTS:
        event |= _primitive(words, values, handles, names)
    if kind in ("IS", "AH"):
        event |= {"oo": _floats(values, layout.OBJECT_ORIGIN, 3), "od": _floats(values, layout.OBJECT_DIRECTION, 3)}
    if kind in HIT_EVENTS:
        event |= {"hitKind": int(words[layout.HIT_KIND]), "ptype": hex(int(words[layout.PRIMITIVE_TYPE])),
                  "front": int(words[layout.FRONT]), "back": int(words[layout.BACK]),
                  "attr": [int(word) for word in words[layout.ATTRIBUTES:layout.ATTRIBUTES + 8]],
                  "u": float(values[layout.U]), "v": float(values[layout.V]),
                  "vertexData": _floats(values, layout.VERTICES, int(words[layout.VERTEX_WORDS])),
                  "normal": _floats(values, layout.NORMAL, 3)}
    return event


def _primitive(words: np.ndarray, values: np.ndarray, handles: np.ndarray, names: dict[int, str]) -> dict[str, Any]:
    transforms = min(int(words[layout.TRANSFORM_COUNT]), 8)
    listed = [{"h": names.get(int(handles[layout.TRANSFORM_HANDLES + i]), hex(int(handles[layout.TRANSFORM_HANDLES + i]))),
               "type": int(words[layout.TRANSFORM_TYPES + i])} for i in range(transforms)]
    gas = int(handles[layout.GAS_HANDLE])
    return {"prim": int(words[layout.PRIMITIVE]), "instIdx": int(words[layout.INSTANCE_INDEX]),
            "instId": int(words[layout.INSTANCE_ID]), "gasIdx": int(words[layout.GAS_INDEX]), "transformList": listed,
            "gasHandle": names.get(gas, hex(gas)), "o2w": _floats(values, layout.OBJECT_TO_WORLD, 12),
            "w2o": _floats(values, layout.WORLD_TO_OBJECT, 12),
            "gasMotion": [float(values[layout.MOTION_BEGIN]), float(values[layout.MOTION_END]), int(words[layout.MOTION_STEPS])]}


def _floats(values: np.ndarray, first: int, count: int) -> list[float]:
    return [float(value) for value in values[first:first + count]]
