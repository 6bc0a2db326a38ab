"""The recorded payload probes: 32 words through nested traces, two payload types, words used against their semantics."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path

import numpy as np
import pytest
from harness import SHADERS, Harness
from oracle_files import Probe
from shaders import payload32, payload_types

import optixc as ox

MAX_ROWS = 256
DISABLE_ANYHIT, DISABLE_CLOSESTHIT = 1, 8
# Tags of the rows, by the program that wrote them.
CLOSEST_HIT, ANYHIT, MISS = 2, 5, 6
# The fields of the payload types by number, and what a program of the recorded pipelines does with a word against its semantics, by the
# words of OptiX's message.
FIELDS = {0: ("Narrow", ("told", "answer", "counted")), 1: ("Open", ("word",))}
BODIES = {"Get": "    params.seen[8] = ray.{field}\n", "Set": "    ray.{field} = 1\n"}
MESSAGE = re.compile(r"payload value (\d+) of payload type (\d+) in optix(Get|Set)Payload|optix(Get|Set)Payload\w*.*?payload type (\d+)")
# Where the message does not say which word it was.
BEYOND = "beyond"
RESULT = "OPTIX_ERROR_INVALID_PAYLOAD_ACCESS"
SEEN = 9
# A word that the trace does not bring back: 0 there, which is not guaranteed; here it cannot be read.
NOT_BROUGHT_BACK = 0
# What the miss program answers.
MISSED = 2222


def check_payload32(harness: Harness, probe: Probe) -> None:
    """The rows that the programs write are the recorded ones, in order."""
    recorded = [[row["tag"], row["depth"], *row["p"]] for row in probe.data["rows"]]
    tags = {row[0] for row in recorded}
    depth = 1 + max(row[1] for row in recorded)
    # which programs wrote rows says how the ray was aimed, what any-hit did and which flags were set
    mode = 0 if MISS not in tags else 2 if ANYHIT in tags else 1
    flags = (0 if tags & {CLOSEST_HIT, MISS} else DISABLE_CLOSESTHIT) | (0 if ANYHIT in tags else DISABLE_ANYHIT)
    assert _run(harness, depth, mode, flags) == recorded


def _run(harness: Harness, depth: int, mode: int, flags: int) -> list[list[int]]:
    module = harness.module("payload32.py")
    create = harness.context.program_group_create
    raygen = create(raygen=module["__raygen__words"])
    miss = create(miss=module["__miss__words"])
    hit = create(closesthit=module["__closesthit__words"], anyhit=module["__anyhit__words"])
    pipeline = harness.pipeline("payload32", [raygen, miss, hit], max_trace_depth=8)
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
    gas = harness.context.accel_build([ox.BuildInputTriangles(corners)])
    rows = np.zeros((MAX_ROWS, 34), np.uint32)
    count = np.zeros(1, np.uint32)
    params = payload32.Params(scene=gas.handle, rows=rows, count=count, depth=depth, ray_flags=flags, mode=mode)
    harness.launch(pipeline, params, ox.ShaderBindingTable(raygen=raygen.record(), miss=[miss.record()], hitgroup=[hit.record()]), 1)
    return [[int(word) for word in row] for row in rows[:int(count[0])]]


def check_payload_types(harness: Harness, probe: Probe) -> None:
    """What the programs saw and brought back is what was recorded."""
    module, create = harness.module("payload_types.py"), harness.context.program_group_create
    raygen = create(raygen=module["__raygen__types"])
    miss = [create(miss=module[f"__miss__{name}"]) for name in ("narrow", "open")]
    hit = [create(closesthit=module[f"__closesthit__{name}"], anyhit=module[f"__anyhit__{name}"]) for name in ("narrow", "open")]
    pipeline = harness.pipeline("payload types", [raygen, *miss, *hit])
    gas = harness.context.accel_build([ox.BuildInputTriangles(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32))])
    seen, recorded = np.zeros(SEEN, np.uint32), list(probe.data["u"])
    sbt = ox.ShaderBindingTable(raygen=raygen.record(), miss=[one.record() for one in miss], hitgroup=[one.record() for one in hit])
    harness.launch(pipeline, payload_types.Params(scene=gas.handle, seen=seen, mode=int(recorded[1] == MISSED)), sbt, 1)
    recorded[NOT_BROUGHT_BACK] = 0
    assert seen[:len(recorded)].tolist() == recorded


def is_payload_violation(probe: Probe) -> bool:
    """Whether the record is a module that was refused for a payload word."""
    return str(probe.data["rc"]) == RESULT and MESSAGE.search(str(probe.data["log"])) is not None


def check_payload_violation(harness: Harness, probe: Probe) -> None:
    """The program is refused when its module is created."""
    found = MESSAGE.search(str(probe.data["log"]))
    assert found is not None
    name, fields = FIELDS[int(found.group(2) or found.group(5))]
    index = int(found.group(1) or len(fields))
    body = BODIES[found.group(3) or found.group(4)].format(field=fields[index] if index < len(fields) else BEYOND)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "violation.py"
        source = f"{(SHADERS / 'payload_types.py').read_text()}\n\n@ox.program\ndef __closesthit__bad(ray: {name}):\n{body}"
        path.write_text(source, encoding="utf-8")
        with pytest.raises(ox.CompileError, match=name):
            harness.context.module_create(path)
