"""trimesh with embreex under it: the first triangle of an array of rays; no shading."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from typing import Any

import numpy as np

from benchmarks.peers.frame import Frame

if importlib.util.find_spec("trimesh") is not None:
    import trimesh
    from trimesh.ray import ray_pyembree

SHADER = False


def missing() -> str | None:
    """What has to be installed."""
    return None if importlib.util.find_spec("trimesh") else "trimesh is not installed"


def make(frame: Frame, threads: int) -> Callable[[], Any]:
    """Uses one thread whatever `threads` says."""
    if threads > 1:
        raise RuntimeError("trimesh traces on one thread only")
    mesh = trimesh.Trimesh(frame.vertices, frame.triangles, process=False)
    intersector = ray_pyembree.RayMeshIntersector(mesh)
    directions = frame.directions().reshape(-1, 3)
    origins = np.broadcast_to(frame.camera.eye, directions.shape).copy()
    return lambda: intersector.intersects_first(origins, directions)
