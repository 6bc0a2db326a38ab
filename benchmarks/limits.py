"""Pure traversal of each workload's own rays, one thread: what no shading at all would reach."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import cffi
import numpy as np

from benchmarks.handwritten import Embree, EmbreeScene, build, compilers, make_job
from benchmarks.scenes import load_scene
from benchmarks.workloads import Workload

CAPACITY = 32
FLAGS = ("-DBENCH_RECORD",)


@dataclass
class RayClass:
    """Rays of one depth and kind, and the seconds that they take one by one, in packets and in coherent packets."""

    name: str
    rays: int
    single: float
    packet: float
    coherent: float


@dataclass
class Limit:
    """All classes of a row."""

    workload: str
    scene: str
    classes: list[RayClass] = field(default_factory=list)
    mrays_per_second: float = 0.0
    single_mrays_per_second: float = 0.0


def measure(embree: Embree, workload: Workload, scene_name: str) -> Limit:
    """Records the rays of the scalar kernel and times them in every form."""
    built = EmbreeScene(embree, load_scene(scene_name), with_light=workload.name in ("path", "heavy"))
    width, height = workload.launch_size
    image = np.zeros((height, width, 4), np.float32)
    job = make_job(embree, built, workload, 1, image)
    ffi = cffi.FFI()
    ffi.cdef(f"int {workload.name}_limits(void* job, void* results, int capacity);")
    library: Any = ffi.dlopen(str(build(workload.source, compilers()[-1], FLAGS)))
    results = embree.ffi.new(f"BenchLimit[{CAPACITY}]")
    count = getattr(library, f"{workload.name}_limits")(job, results, CAPACITY)
    limit = Limit(workload.name, scene_name)
    for one in results[0:count]:
        name = embree.ffi.string(one.name).decode()
        limit.classes.append(RayClass(name, int(one.rays), float(one.single), float(one.packet), float(one.coherent)))
    rays = sum(one.rays for one in limit.classes)
    limit.mrays_per_second = rays / sum(min(one.single, one.packet, one.coherent) for one in limit.classes) / 1e6
    limit.single_mrays_per_second = rays / sum(one.single for one in limit.classes) / 1e6
    return limit
