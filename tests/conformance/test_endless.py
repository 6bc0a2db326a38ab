"""Ctrl-C ends endless programs wherever they loop, in one lane or all; lanes without numbers or one alone leave the others alone."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from shaders import endless as shader

import optixc as ox

SIZE = 37
"""No multiple of the lanes."""
TRIANGLE = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
BOX = np.array([[0, 0, 0, 1, 1, 1]], np.float32)
PLACES = {name: getattr(shader, name)
          for name in ("ODD", "NESTED", "TRACES", "CLOSEST_HIT", "ANY_HIT", "ANY_HIT_RANGE", "MISS", "INTERSECTION", "CONTINUES")}


@dataclass
class Setup:
    """A pipeline for so many lanes, with what its launches need."""

    pipeline: Any
    groups: dict[str, Any]
    accels: dict[str, Any]

    def launch(self, place: int = 0, raygen: str = "main") -> np.ndarray:
        is_custom = place == shader.INTERSECTION
        sbt = ox.ShaderBindingTable(raygen=self.groups[raygen].record(), miss=[self.groups["miss"].record()],
                                    hitgroup=[self.groups["box" if is_custom else "triangle"].record()])
        out = np.full(SIZE, -1.0, np.float32)
        self.pipeline.launch(shader.Params(out, self.accels["box" if is_custom else "triangle"], place), sbt, SIZE)
        return out


@pytest.fixture(scope="module", params=[1, 8, 16])
def setup(request: pytest.FixtureRequest) -> Setup:
    context = ox.DeviceContext(threads=2)
    module, create = context.module_create(shader), context.program_group_create
    groups = {name: create(raygen=module[f"__raygen__{name}"]) for name in ("main", "no_numbers", "one_lane")}
    groups["miss"] = create(miss=module["__miss__main"])
    groups["triangle"] = create(closesthit=module["__closesthit__main"], anyhit=module["__anyhit__main"])
    groups["box"] = create(closesthit=module["__closesthit__main"], intersection=module["__intersection__main"])
    try:
        pipeline = context.pipeline_create(list(groups.values()), simd=request.param)
    except ox.NotSupportedError as error:
        pytest.skip(str(error))
    accels = {"triangle": context.accel_build([ox.BuildInputTriangles(TRIANGLE)]),
              "box": context.accel_build([ox.BuildInputCustomPrimitives(BOX)])}
    return Setup(pipeline, groups, accels)


@pytest.fixture
def ctrl_c() -> Iterator[Callable[[], None]]:
    """Presses Ctrl-C in a moment. A process of a background job ignores the signal, so Python's own handler is set."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield lambda: threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
    signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("place", list(PLACES))
def test_ctrl_c_ends_loops_everywhere(setup: Setup, ctrl_c: Callable[[], None], place: str) -> None:
    began = time.monotonic()
    ctrl_c()
    with pytest.raises(KeyboardInterrupt):
        setup.launch(PLACES[place])
    assert time.monotonic() - began < 1.3
    assert setup.launch().tolist() == [5.0] * 30 + [6.0] * 7


def test_rays_that_are_no_numbers_miss_alone(setup: Setup) -> None:
    """NaN and infinite origins and directions hit nothing; nor does anything behind an infinite tmin, or behind a NaN."""
    hits = [i % 2 == 1 and i % 5 != 4 and i % 11 != 7 for i in range(SIZE)]
    assert setup.launch(raygen="no_numbers").tolist() == [5.0 if hit else 6.0 for hit in hits]


@pytest.mark.parametrize("lane", [0, 7, 8, 15, 16, 31, 32, 36])
def test_one_lane_traces_alone(setup: Setup, lane: int) -> None:
    expected = np.full(SIZE, -1.0, np.float32)
    expected[lane] = 5.0
    np.testing.assert_array_equal(setup.launch(100 + lane, raygen="one_lane"), expected)
