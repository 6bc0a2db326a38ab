"""The recorded hit-object probes: the states and the log that their programs write, field by field."""

from __future__ import annotations

from typing import Any

import numpy as np
from harness import Harness
from oracle_compare import close
from oracle_files import Probe, numbers
from shaders import hit_objects as shader

import optixc as ox

MAX_ROWS = 64
INSTANCE_ID, BOX_INSTANCE_ID = 42, 43
# record 2 ignores its hits, record 4 traverses inside its closest hit, record 5 is the custom primitive's
RECORD_MODES = (0, 0, 2, 0, 4, 0)
CUSTOM_RECORD = 5
STATE_KEYS = ("tag", "isHit", "isMiss", "isNop", "instId", "instIdx", "prim", "nTransforms", "gasIdx", "hitKind", "rayFlags",
              "sbtRecordIndex", "sbtDataId")
STATE_VECTORS = {"wo": (0, 3), "wd": (3, 3), "uv": (9, 2), "o2w": (11, 12), "vert": (23, 9)}


def mode_of(probe: Probe) -> int:
    """The mode of the ray generation program: ten times it is the tag of its first state."""
    return int(probe.data["states"][0]["tag"]) // 10


def check_hit_objects(harness: Harness, probe: Probe) -> None:
    """States and log are the recorded ones, in order."""
    states, log = look_and_invoke(harness, mode_of(probe))
    assert [state["tag"] for state in states] == [state["tag"] for state in probe.data["states"]]
    for ours, recorded in zip(states, probe.data["states"], strict=True):
        _same(ours, recorded)
    recorded_log = next(value for key, value in probe.data.items() if key.startswith("log"))
    assert [row["what"] for row in log] == [row["what"] for row in recorded_log]
    for ours, recorded in zip(log, recorded_log, strict=True):
        _same(ours, recorded)


def _same(ours: dict[str, Any], recorded: dict[str, Any]) -> None:
    for key, value in recorded.items():
        if isinstance(value, list):
            assert len(ours[key]) == len(value), (key, ours, recorded)
            assert all(close(a, b, scale=1.0) for a, b in zip(ours[key], numbers(value), strict=True)), (key, ours, recorded)
        elif isinstance(value, float):
            assert close(ours[key], value), (key, ours, recorded)
        else:
            assert ours[key] == value, (key, ours, recorded)


def look_and_invoke(harness: Harness, mode: int) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """The states of the hit object and the calls of programs that one mode of the ray generation program writes down."""
    groups, pipeline = _pipeline(harness)
    build = harness.context.accel_build
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [2, 0, 0], [3, 0, 0], [2, 1, 0]], np.float32)
    eye = np.eye(3, 4, dtype=np.float32)
    gas, box = build([ox.BuildInputTriangles(corners)]), build([ox.BuildInputCustomPrimitives(np.array([[0, 0, 0, 1, 1, 1]], np.float32))])
    top = build([ox.BuildInputInstances([ox.Instance(gas, eye, instance_id=INSTANCE_ID)])])
    boxes = build([ox.BuildInputInstances([ox.Instance(box, eye, instance_id=BOX_INSTANCE_ID)])])
    states, state_numbers = np.zeros((MAX_ROWS, shader.STATE_WORDS), np.uint32), np.zeros((MAX_ROWS, shader.STATE_NUMBERS), np.float32)
    log, log_numbers = np.zeros((MAX_ROWS, shader.LOG_WORDS), np.uint32), np.zeros((MAX_ROWS, shader.LOG_NUMBERS), np.float32)
    state_gas, counts = np.zeros(MAX_ROWS, shader.Handle.dtype), np.zeros((2, 1), np.uint32)
    params = shader.Params(states=states, state_numbers=state_numbers, state_gas=state_gas, state_count=counts[0], log=log,
                           log_numbers=log_numbers, log_count=counts[1], scene=top.handle, boxes=boxes.handle, mode=mode)
    sbt = ox.ShaderBindingTable(
        raygen=groups["raygen"].record(), miss=[groups["miss"].record(shader.Record(index, 0)) for index in range(2)],
        hitgroup=[groups["custom" if index == CUSTOM_RECORD else "triangle"].record(shader.Record(index, record_mode))
                  for index, record_mode in enumerate(RECORD_MODES)])
    harness.launch(pipeline, params, sbt, 1)
    names = {gas.handle: "gas", box.handle: "box", 0: "0x0"}
    return ([_state(states[row], state_numbers[row], names[int(state_gas[row]["value"])]) for row in range(int(counts[0, 0]))],
            [_log(log[row], log_numbers[row]) for row in range(int(counts[1, 0]))])


def _pipeline(harness: Harness) -> tuple[dict[str, Any], Any]:
    if "hit object groups" not in harness.kept:
        module, create = harness.module("hit_objects.py"), harness.context.program_group_create
        hit, anyhit = module["__closesthit__hit_objects"], module["__anyhit__hit_objects"]
        harness.kept["hit object groups"] = {
            "raygen": create(raygen=module["__raygen__hit_objects"]), "miss": create(miss=module["__miss__hit_objects"]),
            "triangle": create(closesthit=hit, anyhit=anyhit),
            "custom": create(closesthit=hit, anyhit=anyhit, intersection=module["__intersection__hit_objects"])}
    groups = harness.kept["hit object groups"]
    # the recorded times come back, so motion was enabled
    return groups, harness.pipeline("hit objects", groups.values(), max_trace_depth=2,
                                    options=ox.PipelineCompileOptions(uses_motion_blur=True))


def _state(words: np.ndarray, values: np.ndarray, gas: str) -> dict[str, Any]:
    state: dict[str, Any] = {key: int(word) for key, word in zip(STATE_KEYS, words, strict=False)}
    state |= {key: [float(value) for value in values[first:first + count]] for key, (first, count) in STATE_VECTORS.items()}
    return state | {"tmin": float(values[6]), "tmax": float(values[7]), "time": float(values[8]), "gas": gas,
                    "attr": [int(word) for word in words[13:15]]}


def _log(words: np.ndarray, values: np.ndarray) -> dict[str, Any]:
    return {"what": int(words[0]), "rec": int(words[1]), "prim": int(words[2]), "p": [int(word) for word in words[3:7]],
            "extra": [int(word) for word in words[7:15]], "tmin": float(values[0]), "tmax": float(values[1]),
            "f": [float(value) for value in values[2:10]]}
