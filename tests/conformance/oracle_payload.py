"""The recorded payload probes: 32 words through nested traces."""

from __future__ import annotations

import re

import numpy as np
from harness import Harness
from oracle_files import Probe
from shaders import payload32

import optixc as ox

MAX_ROWS = 256
DISABLE_ANYHIT, DISABLE_CLOSESTHIT = 1, 8


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
