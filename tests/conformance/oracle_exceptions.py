"""The recorded exception probes: what ran before and after the throw in every launch index, and what the exception program saw."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from harness import Harness
from oracle_files import Probe
from shaders import throwing as shader

import optixc as ox
from optixc.diagnostics import CompileError

INDICES, MAX_ROWS, RECORDS, MISSES, CALLABLE_INDEX, EXCEPTION_ID = 3, 64, 9, 4, 6, 77
MAX_TRACE_DEPTH = 4
EXCEPTION_FLAG_USER, DEPTH_MODE = 4, 8
DETAIL, RECORD, DIMENSION = 2, 10, 11
COMPILE_ERROR = '''
import optixc as ox


@ox.program
def __raygen__throws():
    ox.throw_exception({code})
'''


def is_refused_code(probe: Probe) -> bool:
    """Whether the record is a compile error that names the code of an exception."""
    return _refused_code(probe) is not None


def _refused_code(probe: Probe) -> str | None:
    found = re.search(r"Exception code .* Found (-?\d+)", str(probe.data["rc"]))
    return found.group(1) if found else None


def check_refused_code(harness: Harness, probe: Probe) -> None:
    """A code outside 0 to 2^30 - 1 is a compile error."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "code.py"
        path.write_text(COMPILE_ERROR.format(code=_refused_code(probe)))
        with pytest.raises(CompileError, match="exception code"):
            harness.context.module_create(path)


def check_exceptions(harness: Harness, probe: Probe) -> None:
    """Trail, exceptions and depth log are the recorded ones; details that were not passed are stale there and not compared."""
    data = {key.split("(")[0].split("[")[0]: value for key, value in probe.data.items()}
    assert (data["launch"], data["sync"]) == ("OPTIX_SUCCESS", 0), "a launch that fails is not understood"
    assert data["exceptionCount"] == len(data["exceptions"])
    details = data["numDetails"]
    # a throw that is enabled and leaves no exception had no program to write it down
    with_program = not data["exceptionFlags"] & EXCEPTION_FLAG_USER or data["exceptionCount"] > 0 or data["mode"] == DEPTH_MODE
    trail, exceptions, depth_log = _run(harness, data, with_program)
    assert trail == data["perLaunchIndex"]
    recorded = [row[:DETAIL] + row[DETAIL:DETAIL + details] * (row[0] == data["code"]) + row[RECORD:DIMENSION + 1]
                for row in data["exceptions"]]
    ours = [row[:DETAIL] + row[DETAIL:DETAIL + details] * (row[0] == data["code"]) + row[RECORD:DIMENSION + 1] for row in exceptions]
    assert sorted(ours) == sorted(recorded)
    for index in range(INDICES):
        assert [(what, depth) for what, li, depth in depth_log if li == index] == [
            (row["what"], row["depth"]) for row in data["depthLog"] if row["li"] == index]


def _run(harness: Harness, data: dict[str, Any], with_program: bool) -> tuple[list[list[int]], list[list[int]], list[list[int]]]:
    module, create, build = harness.module("throwing.py"), harness.context.program_group_create, harness.context.accel_build
    raygen, miss = create(raygen=module["__raygen__throw"]), create(miss=module["__miss__throw"])
    hits = {"closesthit": module["__closesthit__throw"], "anyhit": module["__anyhit__throw"]}
    triangle, custom = create(**hits), create(**hits, intersection=module["__intersection__throw"])
    callable_group = create(direct_callable=module["__direct_callable__throw"],
                            continuation_callable=module["__continuation_callable__throw"])
    exception = create(exception=module["__exception__throw"])
    flags = data["exceptionFlags"]
    pipeline = harness.pipeline(("exceptions", flags), [raygen, miss, triangle, custom, callable_group, exception],
                                max_trace_depth=MAX_TRACE_DEPTH, options=ox.PipelineCompileOptions(exception_flags=flags))
    gas = build([ox.BuildInputTriangles(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32))])
    box = build([ox.BuildInputCustomPrimitives(np.array([[0, 0, 0, 1, 1, 1]], np.float32))])
    trail, thrown = np.zeros((INDICES, 8), np.uint32), np.zeros((MAX_ROWS, shader.EXCEPTION_WORDS), np.uint32)
    depth_log, counts = np.zeros((MAX_ROWS, 3), np.uint32), np.zeros((2, 1), np.uint32)
    params = shader.Params(trail=trail, exceptions=thrown, exception_count=counts[0], depth_log=depth_log, depth_count=counts[1],
                           scene=gas.handle, boxes=box.handle, mode=data["mode"], details=data["numDetails"], code=data["code"])
    hit = custom if data["mode"] == shader.INTERSECTION else triangle
    sbt = ox.ShaderBindingTable(raygen=raygen.record(), miss=[miss.record() for _ in range(MISSES)],
                                hitgroup=[hit.record() for _ in range(RECORDS)],
                                callables=[callable_group.record() for _ in range(CALLABLE_INDEX + 1)],
                                exception=exception.record(shader.Record(EXCEPTION_ID)) if with_program else None)
    harness.launch(pipeline, params, sbt, INDICES)
    return trail.tolist(), thrown[:int(counts[0, 0])].tolist(), depth_log[:int(counts[1, 0])].tolist()
