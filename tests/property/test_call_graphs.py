"""Random call graphs, built step by step: recursion to depth 31, callables that call callables, exceptions at random points, any-hit
programs that ignore and terminate. Scalar code, packets of 8 and 16 and the interpreter leave the same numbers and logs of calls.

A few graphs with every test run, many with --fuzz (--graphs changes their number).
"""

from __future__ import annotations

import tempfile
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from call_graphs import CALLABLES, NESTING, PROGRAMS, WRAPS, Graph
from hypothesis import HealthCheck, Phase, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, rule, run_state_machine_as_test

import optixc as ox
from optixc import api
from optixc.options import CompileOptions

COUNT = 40
BUDGET = 120
LANES = (8, 16)
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
NESTERS = ("raygen", "hit a", "hit b", "hit wide", "miss", "direct 0", "direct 1", "continuation 0", "continuation 1")
"""What has a call of some kind from the start, so that most graphs are deep."""
ACTIONS = (*NESTING, *NESTING, "throw", "end", "end", "arithmetic")


@ox.struct
class Params:
    scene: ox.Traversable
    out: ox.Array[ox.uint32]
    codes: ox.Array[ox.int32]
    details: ox.Array2[ox.uint32]
    budget: ox.Array[ox.uint32]
    log: ox.Array[ox.uint32]


@ox.struct
class Number:
    n: ox.uint32


class Ways:
    """A context and the scene of all graphs: two triangles with different records, a box, and a place with nothing."""

    def __init__(self) -> None:
        self.folder = tempfile.TemporaryDirectory()
        self.context = ox.DeviceContext(cache_dir=Path(self.folder.name) / "cache")
        build = self.context.accel_build
        corners = np.concatenate([CORNERS, CORNERS + np.float32([10, 0, 0])])
        triangles = build([ox.BuildInputTriangles(corners, num_sbt_records=2, flags=[2, 2], sbt_index_offsets=np.uint32([0, 1]))])
        box = build([ox.BuildInputCustomPrimitives(np.array([[20, 0, 0, 21, 1, 0.75]], np.float32), flags=2)])
        self.scene = build([ox.BuildInputInstances([ox.Instance(triangles), ox.Instance(box, sbt_offset=4)])])

    def results(self, text: str, depth: int) -> dict[str, dict[str, np.ndarray]]:
        """What each way to run leaves in the arrays of the parameters."""
        path = Path(self.folder.name) / "graph.py"
        path.write_text(text)
        module, create = self.context.module_create(path), self.context.program_group_create
        groups = self._groups(module, create)
        options = ox.PipelineCompileOptions(exception_flags=ox.ExceptionFlags.USER | ox.ExceptionFlags.TRACE_DEPTH)
        found = {}
        for lanes in (1, *LANES):
            pipeline = self.context.pipeline_create(list(groups.values()), max_trace_depth=depth, simd=lanes, options=options)
            found[f"{lanes} lanes"] = self._launch(groups, lambda p, t, pipeline=pipeline: pipeline.launch(p, t, COUNT))
            if lanes == 1:
                found["interpreted"] = self._launch(groups, partial(self._interpret, pipeline))
        return found

    def _groups(self, module: Any, create: Any) -> dict[str, Any]:
        groups = {"raygen": create(raygen=module["__raygen__r"]), "exception": create(exception=module["__exception__e"])}
        groups |= {f"miss {name}": create(miss=module[f"__miss__{name}"]) for name in "mw"}
        for n in range(CALLABLES):
            groups[f"call {n}"] = create(direct_callable=module[f"__direct_callable__c{n}"],
                                         continuation_callable=module[f"__continuation_callable__c{n}"])
        hit = {name: module[f"__closesthit__{name}"] for name in "abw"}
        box = module["__intersection__i"]
        groups["hit 0"] = create(closesthit=hit["a"], anyhit=module["__anyhit__a"])
        groups["hit 1"] = create(closesthit=hit["w"], anyhit=module["__anyhit__w"])
        groups["hit 2"] = create(closesthit=hit["b"], anyhit=module["__anyhit__w"])
        groups["hit 3"] = create(closesthit=hit["w"])
        groups["hit 4"] = create(closesthit=hit["b"], anyhit=module["__anyhit__a"], intersection=box)
        groups["hit 5"] = create(closesthit=hit["w"], anyhit=module["__anyhit__w"], intersection=box)
        return groups

    def _launch(self, groups: dict[str, Any], launch: Any) -> dict[str, np.ndarray]:
        arrays = {"out": np.zeros(COUNT, np.uint32), "codes": np.zeros(COUNT, np.int32), "details": np.zeros((COUNT, 2), np.uint32),
                  "budget": np.full(COUNT, BUDGET, np.uint32), "log": np.zeros(COUNT, np.uint32)}

        def records(*names: str) -> list[Any]:
            return [groups[name].record(Number(7 * number + 1)) for number, name in enumerate(names)]

        table = ox.ShaderBindingTable(raygen=groups["raygen"].record(), exception=records("exception")[0],
                                      miss=records("miss m", "miss w"), hitgroup=records(*(f"hit {n}" for n in range(6))),
                                      callables=records(*(f"call {n}" for n in range(CALLABLES))))
        launch(Params(scene=self.scene, **arrays), table)
        return arrays

    def _interpret(self, pipeline: Any, params: Any, table: Any) -> None:
        for index in range(COUNT):
            ox.interpret(pipeline, params, table, (COUNT, 1, 1), (index, 0, 0))


class CallGraphs(RuleBasedStateMachine):
    """Each step adds an action to some program; at the end the graph runs in every way."""

    ways: Ways

    @initialize(fuel=st.sampled_from([3, 8, 31, 31]), depth=st.sampled_from([1, 2, 5, 31, 31]),
                flows=st.lists(st.sampled_from(list(NESTING)), min_size=len(NESTERS), max_size=len(NESTERS)))
    def begin(self, fuel: int, depth: int, flows: list[str]) -> None:
        self.graph, self.depth = Graph(fuel=fuel), depth
        for name, flow in zip(NESTERS, flows, strict=True):
            self.graph.add(name, flow, "plain", 1)

    @rule(name=st.sampled_from(list(PROGRAMS)), action=st.sampled_from(ACTIONS), wrap=st.sampled_from(list(WRAPS)),
          number=st.integers(0, 999))
    def act(self, name: str, action: str, wrap: str, number: int) -> None:
        self.graph.add(name, action, wrap, number)

    def teardown(self) -> None:
        if not hasattr(self, "graph"):
            return
        text = self.graph.text()
        results = self.ways.results(text, self.depth)
        scalar = results.pop("1 lanes")
        for way, arrays in results.items():
            for key, values in arrays.items():
                wrong = np.argwhere(values != scalar[key])
                if wrong.size:
                    at = tuple(wrong[0])
                    pytest.fail(f"{key}{list(at)} is {values[at]} {way}, {scalar[key][at]} in scalar code, depth {self.depth}\n{text}")


def test_all_ways_run_random_call_graphs_alike(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    long_run = bool(request.config.getoption("--fuzz"))
    graphs = int(request.config.getoption("--graphs")) if long_run else 3
    monkeypatch.setattr(api, "CompileOptions", partial(CompileOptions, optimization=1 if long_run else 0))
    CallGraphs.ways = Ways()
    run_state_machine_as_test(CallGraphs, settings=settings(
        max_examples=graphs, stateful_step_count=20, deadline=None, database=None, derandomize=not long_run,
        phases=[Phase.generate], suppress_health_check=list(HealthCheck)))
