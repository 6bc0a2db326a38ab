"""The recorded callables probe: the log of calls from every kind of program."""

from __future__ import annotations

from typing import Any

import numpy as np
from harness import Harness
from oracle_compare import close
from oracle_files import Probe
from shaders import callables as shader

import optixc as ox

MAX_ROWS = 64
RAYGEN_ID, K = 99, 0.5
# by the results: record 1's k is 0.5, record 5 adds and multiplies 3
CALLABLES = (("add", None, 1, 0.0), ("vector", None, 2, K), ("nested", None, 3, 0.0), ("traverse", None, 4, 0.0),
             (None, "trace", 5, 0.0), ("both", "both", 6, 3.0))
TRIANGLE_RECORD, CUSTOM_RECORD, HIT_RECORDS, MISS_RECORDS = 6, 7, 8, 3


def check_callables(harness: Harness, probe: Probe) -> None:
    """Every row of the log is the recorded one, in order."""
    log = _run(harness)
    assert [row["what"] for row in log] == [row["what"] for row in probe.data["log"]]
    for ours, recorded in zip(log, probe.data["log"], strict=True):
        assert all(ours[key] == recorded[key] for key in ("rec", "prim", "p", "extra")), (ours, recorded)
        assert all(close(a, b) for a, b in zip(ours["f"], recorded["f"], strict=True)), (ours, recorded)
        assert close(ours["tmax"], recorded["tmax"]), (ours, recorded)


def _run(harness: Harness) -> list[dict[str, Any]]:
    module, create, build = harness.module("callables.py"), harness.context.program_group_create, harness.context.accel_build
    raygen, miss, simple_miss = (create(raygen=module["__raygen__call"]), create(miss=module["__miss__call"]),
                                 create(miss=module["__miss__simple"]))
    triangle = create(closesthit=module["__closesthit__call"], anyhit=module["__anyhit__call"])
    custom = create(closesthit=module["__closesthit__call"], anyhit=module["__anyhit__call"], intersection=module["__intersection__call"])
    simple = create(closesthit=module["__closesthit__simple"])
    called = [create(direct_callable=direct and module[f"__direct_callable__{direct}"],
                     continuation_callable=continuation and module[f"__continuation_callable__{continuation}"])
              for direct, continuation, _, _ in CALLABLES]
    pipeline = harness.pipeline("callables", [raygen, miss, simple_miss, triangle, custom, simple, *called], max_trace_depth=4)
    corners, bounds = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32), np.array([[0, 0, 0, 1, 1, 1]], np.float32)
    gas, box = build([ox.BuildInputTriangles(corners)]), build([ox.BuildInputCustomPrimitives(bounds)])
    log, values = np.zeros((MAX_ROWS, shader.LOG_WORDS), np.uint32), np.zeros((MAX_ROWS, shader.LOG_NUMBERS), np.float32)
    count, side = np.zeros(1, np.uint32), np.zeros(2, np.uint32)
    params = shader.Params(log=log, log_numbers=values, log_count=count, side=side, scene=gas.handle, boxes=box.handle)
    hits = [simple.record() for _ in range(HIT_RECORDS)]
    hits[TRIANGLE_RECORD] = triangle.record(shader.Record(TRIANGLE_RECORD, 0.0))
    hits[CUSTOM_RECORD] = custom.record(shader.Record(CUSTOM_RECORD, 0.0))
    misses = [simple_miss.record(), simple_miss.record(), miss.record(shader.Record(MISS_RECORDS - 1, 0.0))]
    sbt = ox.ShaderBindingTable(raygen=raygen.record(shader.Record(RAYGEN_ID, 0.0)), miss=misses, hitgroup=hits,
                                callables=[group.record(shader.Record(number, k)) for group, (_, _, number, k)
                                           in zip(called, CALLABLES, strict=True)])
    harness.launch(pipeline, params, sbt, 1)
    return [{"what": int(words[0]), "rec": int(words[1]), "prim": int(words[2]), "p": words[3:7].tolist(), "extra": words[7:15].tolist(),
             "f": numbers[:8].tolist(), "tmax": float(numbers[8])} for words, numbers in zip(log[:int(count[0])], values, strict=False)]
