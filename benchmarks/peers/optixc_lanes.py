"""The primary rays of shaders/primary.py, at the width that optixc takes by itself."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import optixc as ox
from benchmarks.ours import ours
from benchmarks.peers.frame import Frame
from benchmarks.scenes import mesh_scene
from benchmarks.workloads import WORKLOADS

SHADER = True


def missing() -> str | None:
    """Nothing is missing where the benchmarks run."""
    return None


def make(frame: Frame, threads: int) -> Callable[[], Any]:
    """One launch over all pixels."""
    workload = next(workload for workload in WORKLOADS if workload.name == "primary")
    return ours(ox.DeviceContext(threads=threads), mesh_scene(frame.scene), workload, "auto").run
