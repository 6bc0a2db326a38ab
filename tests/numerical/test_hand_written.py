"""Compiled shaders beside the hand-written Embree loops of the benchmarks: the same picture; what each costs is reported, not judged."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

import optixc as ox
from optixc import toolchain

sys.path.append(str(Path(__file__).resolve().parents[2]))

from benchmarks.handwritten import Embree, EmbreeScene, compilers, hand_written
from benchmarks.measure import interleave
from benchmarks.ours import ours
from benchmarks.rays import differing
from benchmarks.scenes import SceneMissing, load_scene
from benchmarks.workloads import WORKLOADS


@pytest.mark.parametrize("name", ["primary", "ambient_occlusion"])
def test_T292_pictures_of_hand_written_kernels(name: str, record_property: Callable[[str, object], None]) -> None:
    # one strip of 16 rows out of 16
    workload = replace(next(one for one in WORKLOADS if one.name == name), share=16)
    try:
        scene = load_scene("sibenik")
    except SceneMissing as reason:
        pytest.skip(str(reason))
    threads = 1
    embree = Embree(threads)
    kernel = hand_written(embree, EmbreeScene(embree, scene, with_light=False), workload, workload.scalar_forms[0], compilers()[0], threads)
    context = ox.DeviceContext(threads=threads)
    widest = toolchain.processor_lanes("native")
    own = [ours(context, scene, workload, lanes, None) for lanes in sorted({1, widest})]
    timings = interleave([kernel, *own], 1)
    for one in own:
        record_property(f"{one.name} over {kernel.name}", timings.speed_up(one.name, kernel.name))
        assert differing(one.image, kernel.image) < 1e-3
    assert kernel.image[..., :3].std() > 0.05
