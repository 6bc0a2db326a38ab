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
# What a program of the recorded pipelines does against the semantics of its payload type.
VIOLATIONS = {
    "BADREAD": "def __closesthit__bad(ray: Narrow):\n    params.seen[8] = ray.answer\n",
    "BADWRITE": "def __closesthit__bad(ray: Narrow):\n    ray.told = 1\n",
    "BADIDX": "def __closesthit__bad(ray: Open):\n    ray.sixth = 1\n",
}
SEEN = 9
# A word that the trace does not bring back: 0 there, which is not guaranteed; here it cannot be read.
NOT_BROUGHT_BACK = 0


def check_payload32(harness: Harness, probe: Probe) -> None:
    """The rows that the programs write are the recorded ones, in order."""
    recorded = [[row["tag"], row["depth"], *row["p"]] for row in probe.data["rows"]]
    tags = {row[0] for row in recorded}
    depth = 1 + max(row[1] for row in recorded)
    # the name says what the rows do not: ignored hits, misses, and the flag that keeps closest hit from running
    mode = 2 if re.search("ignore", probe.name) else 1 if re.search("miss", probe.name) else 0
    flags = (DISABLE_CLOSESTHIT if "disable_ch" in probe.name else 0) | (0 if 5 in tags else DISABLE_ANYHIT)
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
    seen = np.zeros(SEEN, np.uint32)
    sbt = ox.ShaderBindingTable(raygen=raygen.record(), miss=[one.record() for one in miss], hitgroup=[one.record() for one in hit])
    harness.launch(pipeline, payload_types.Params(scene=gas.handle, seen=seen, mode=int("miss" in probe.name)), sbt, 1)
    recorded = list(probe.data["u"])
    recorded[NOT_BROUGHT_BACK] = 0
    assert seen[:len(recorded)].tolist() == recorded


def check_payload_violation(harness: Harness, probe: Probe) -> None:
    """The program is refused when its module is created."""
    program = VIOLATIONS[probe.name.rsplit("_", 1)[1]]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "violation.py"
        path.write_text(f"{(SHADERS / 'payload_types.py').read_text()}\n\n@ox.program\n{program}", encoding="utf-8")
        with pytest.raises(ox.CompileError, match=r"Narrow|Open"):
            harness.context.module_create(path)
