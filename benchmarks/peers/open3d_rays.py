"""Open3D's RaycastingScene: closest hits of an array of rays; no shading."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from typing import Any

import numpy as np

from benchmarks.peers.frame import Frame

if importlib.util.find_spec("open3d") is not None:
    import open3d

SHADER = False


def missing() -> str | None:
    """What has to be installed."""
    return None if importlib.util.find_spec("open3d") else "open3d is not installed"


def make(frame: Frame, threads: int) -> Callable[[], Any]:
    """The rays are one tensor of (n, 6)."""
    scene = open3d.t.geometry.RaycastingScene(nthreads=threads)
    scene.add_triangles(frame.vertices, frame.triangles)
    directions = frame.directions().reshape(-1, 3)
    rays = np.concatenate([np.broadcast_to(frame.camera.eye, directions.shape), directions], 1)
    tensor = open3d.core.Tensor(np.ascontiguousarray(rays, np.float32))
    return lambda: scene.cast_rays(tensor, nthreads=threads)
