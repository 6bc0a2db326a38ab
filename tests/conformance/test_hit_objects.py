"""Area S: traversals and invocations against traces of the same random rays, and hit objects against hit programs."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from harness import Harness
from shaders import traversal as shader

import optixc as ox


class Rays:
    """Random rays at a cloud of triangles under two levels of instances."""

    def __init__(self, harness: Harness, count: int) -> None:
        self.harness = harness
        if "traversal" not in harness.kept:
            module, create = harness.module("traversal.py"), harness.context.program_group_create
            groups = {name: create(raygen=module[f"__raygen__{name}"]) for name in ("trace", "traverse", "distance", "both")}
            groups |= {"see": create(closesthit=module["__closesthit__see"], anyhit=module["__anyhit__odd"]),
                       "tell": create(closesthit=module["__closesthit__tell"]), "miss": create(miss=module["__miss__none"])}
            harness.kept["traversal"] = groups
        self.groups = harness.kept["traversal"]
        self.pipeline = harness.pipeline("traversal", self.groups.values())
        self.random = np.random.default_rng(11)
        self.count = count
        self.origins = self.random.uniform(-3.0, 3.0, (count, 3)).astype(np.float32)
        self.directions = self.random.normal(size=(count, 3)).astype(np.float32)
        self.scene = self.cloud()

    def cloud(self) -> Any:
        build = self.harness.context.accel_build
        corners = self.random.uniform(-1.0, 1.0, (60, 1, 3)) + self.random.uniform(-0.5, 0.5, (60, 3, 3))
        gas = build([ox.BuildInputTriangles(corners.reshape(-1, 3).astype(np.float32), flags=2)])

        def moved(child: Any, number: int) -> Any:
            matrix = np.concatenate([np.eye(3) + self.random.uniform(-0.3, 0.3, (3, 3)), self.random.uniform(-1, 1, (3, 1))], axis=1)
            return ox.Instance(child, matrix.astype(np.float32), instance_id=100 + number)

        inner = build([ox.BuildInputInstances([moved(gas, number) for number in range(3)])])
        return build([ox.BuildInputInstances([moved(inner, 10), moved(gas, 11), moved(inner, 12)])])

    def run(self, raygen: str, hit: str = "see", hint: int = 0) -> Any:
        handles = np.zeros((2, self.count, 5), shader.Handle.dtype)
        params = shader.Params(scene=self.scene.handle, origins=self.origins, directions=self.directions, hint=hint, handles=handles,
                               words=np.zeros((2, self.count, shader.WORDS), np.uint32),
                               numbers=np.zeros((2, self.count, shader.NUMBERS), np.float32))
        table = ox.ShaderBindingTable(raygen=self.groups[raygen].record(), miss=[self.groups["miss"].record()],
                                      hitgroup=[self.groups[hit].record()])
        self.harness.launch(self.pipeline, params, table, self.count)
        return params


def count_for(harness: Harness) -> int:
    return 150 if harness.mode == "interpreter" else 100_000


def same(first: Any, second: Any) -> bool:
    return first.words.tobytes() == second.words.tobytes() and first.numbers.tobytes() == second.numbers.tobytes()


@pytest.fixture(scope="module")
def rays(harness: Harness) -> Rays:
    return Rays(harness, count_for(harness))


def test_T257_traverse_and_invoke_are_a_trace(rays: Rays) -> None:
    traced, invoked = rays.run("trace"), rays.run("traverse")
    hits = traced.numbers[0, :, 0] > 0
    assert 0.1 < hits.mean() < 0.9
    assert traced.words[0, :, 2].max() > 1
    assert same(traced, invoked)


def test_T263_reordering_changes_nothing(rays: Rays) -> None:
    plain = rays.run("traverse")
    assert all(same(plain, rays.run("traverse", hint=hint)) for hint in (1, 7, 0xffffffff))


def test_T262_T264_distances_without_closest_hit_programs(rays: Rays) -> None:
    # The helper traverses, and its caller asks the hit object.
    traced, looked = rays.run("trace"), rays.run("distance")
    hits = traced.numbers[0, :, 0] > 0
    assert np.array_equal(looked.words[0, :, 0] == 1, hits)
    assert np.array_equal(looked.numbers[0, :, 0], np.abs(traced.numbers[0, :, 0]))
    assert not looked.words[1].any()


def test_T255_T265_a_hit_object_says_what_the_closest_hit_program_sees(harness: Harness, rays: Rays) -> None:
    both = rays.run("both", "tell")
    hits = both.words[0, :, 3] != 0
    assert 0.1 < hits.mean() < 0.9
    assert np.array_equal(both.words[0], both.words[1])
    assert np.array_equal(both.numbers[0], both.numbers[1])
    assert np.array_equal(both.handles[0], both.handles[1])
    # lists of one and of two instances, and the vertices are not all the same
    assert set(both.words[0, hits, 8].tolist()) == {1, 2}
    assert len(np.unique(both.numbers[0, hits, 10])) > 10
