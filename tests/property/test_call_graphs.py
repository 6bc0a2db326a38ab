"""Random call graphs: programs that trace, call callables and throw, nested as chance has it; scalar code and packets agree.

Every program of a graph does a few random actions on a value: arithmetic, a call of a callables record that depends on the value, a trace
with a random ray, an exception. Depth is bounded by a counter that goes with the value, so every graph ends.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import optixc as ox

COUNT = 24
CALLABLES = 3
MODES = (1, 8, 16)
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
HEAD = """import optixc as ox
from optixc import float3, uint32


@ox.struct
class Params:
    scene: ox.Traversable
    out: ox.Array[uint32]
    codes: ox.Array[ox.int32]


@ox.payload
class Value:
    v: uint32
    fuel: uint32


params = ox.launch_params(Params)


@ox.device
def shoot(v: uint32, fuel: uint32) -> uint32:
    value = Value(v, fuel)
    ox.trace(params.scene, float3(0.25 + float(v % 2) * 5.0, 0.25, 1.0), float3(0.0, 0.0, -1.0), ray_flags=RAY_FLAGS, payload=value)
    return value.v


@ox.program
def __exception__e():
    i = ox.get_launch_index().x
    params.codes[i] = ox.get_exception_code()
"""

arithmetic = st.sampled_from(["v = v * 1664525 + 1013904223", "v = v ^ (v >> 7)", "v = v + fuel", "if v % 3 == 0:\n        v += 5"])
DIRECT = f"v = v * 3 + ox.direct_call(v % {CALLABLES}, v + 1, fuel - 1, result=uint32)"
CONTINUATION = f"v = v * 5 + ox.continuation_call(v % {CALLABLES}, v + 1, fuel - 1, result=uint32)"
TRACE = "v = v * 7 + shoot(v + 1, fuel - 1)"
throw = st.integers(0, 1 << 29).map(lambda code: f"if v % 11 == 4:\n        ox.throw_exception({code}, v)")


def body(draw: Any, can_trace: bool) -> list[str]:
    """Actions of one program; what nests needs fuel."""
    nesting = st.sampled_from([DIRECT, CONTINUATION, TRACE] if can_trace else [DIRECT])
    guarded = nesting.map(lambda text: f"if fuel > 0:\n        {text}")
    actions = draw(st.lists(st.one_of(arithmetic, guarded, throw), min_size=1, max_size=4))
    return [f"    {line}" for action in actions for line in action.split("\n    ")]


@st.composite
def graphs(draw: Any) -> str:
    parts = [HEAD.replace("RAY_FLAGS", str(draw(st.sampled_from([0, 0, 4]))))]
    for name, can_trace in (*((f"direct_callable__d{n}", False) for n in range(CALLABLES)),
                            *((f"continuation_callable__c{n}", True) for n in range(CALLABLES))):
        lines = [f"def __{name}(start: uint32, fuel: uint32) -> uint32:", "    v = start", *body(draw, can_trace), "    return v"]
        parts.append("\n".join(["@ox.program", *lines]))
    for name in ("closesthit__h", "miss__m"):
        lines = [f"def __{name}(value: Value):", "    v = value.v", "    fuel = value.fuel", *body(draw, True), "    value.v = v"]
        parts.append("\n".join(["@ox.program", *lines]))
    hit = draw(st.sampled_from(["ox.ignore_intersection()", "ox.terminate_ray()", "pass"]))
    parts.append(f"@ox.program\ndef __anyhit__a(value: Value):\n    value.v = value.v + 3\n    if value.v % 5 == 2:\n        {hit}")
    lines = ["def __raygen__r():", "    i = ox.get_launch_index().x", "    v = i", f"    fuel = uint32({draw(st.integers(1, 5))})",
             *body(draw, True), f"    {TRACE}", "    params.out[i] = v"]
    parts.append("\n".join(["@ox.program", *lines]))
    return "\n\n\n".join(parts) + "\n"


@pytest.fixture(scope="module")
def context() -> Iterator[ox.DeviceContext]:
    with tempfile.TemporaryDirectory() as folder:
        yield ox.DeviceContext(cache_dir=folder)


def run(context: ox.DeviceContext, text: str, simd: int) -> tuple[list[int], list[int]]:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "graph.py"
        path.write_text(text)
        module = context.module_create(path)
        groups: dict[str, Any] = {}
        create = context.program_group_create
        for n in range(CALLABLES):
            groups[f"call{n}"] = create(direct_callable=module[f"__direct_callable__d{n}"],
                                        continuation_callable=module[f"__continuation_callable__c{n}"])
        groups["hit"] = create(closesthit=module["__closesthit__h"], anyhit=module["__anyhit__a"])
        for kind, name in (("raygen", "r"), ("miss", "m"), ("exception", "e")):
            groups[kind] = create(**{kind: module[f"__{kind}__{name}"]})
        options = ox.PipelineCompileOptions(exception_flags=ox.ExceptionFlags.USER | ox.ExceptionFlags.TRACE_DEPTH)
        pipeline = context.pipeline_create(list(groups.values()), max_trace_depth=4, simd=simd, options=options)

    @ox.struct
    class Params:
        scene: ox.Traversable
        out: ox.Array[ox.uint32]
        codes: ox.Array[ox.int32]

    out, codes = np.zeros(COUNT, np.uint32), np.zeros(COUNT, np.int32)
    scene = context.accel_build([ox.BuildInputTriangles(CORNERS, flags=2)])
    table = ox.ShaderBindingTable(raygen=groups["raygen"].record(), miss=[groups["miss"].record()], hitgroup=[groups["hit"].record()],
                                  callables=[groups[f"call{n}"].record() for n in range(CALLABLES)],
                                  exception=groups["exception"].record())
    pipeline.launch(Params(scene=scene, out=out, codes=codes), table, COUNT)
    return out.tolist(), codes.tolist()


@settings(max_examples=6, deadline=None, suppress_health_check=list(HealthCheck))
@given(graphs())
def test_scalar_code_and_packets_agree(context: ox.DeviceContext, text: str) -> None:
    scalar, *packets = (run(context, text, simd) for simd in MODES)
    assert packets == [scalar] * len(packets)
