"""The embreex package: closest hits of an array of rays; no shading."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from typing import Any

import numpy as np

from benchmarks.peers.frame import Frame

if importlib.util.find_spec("embreex") is not None:
    from embreex import rtcore_scene
    from embreex.mesh_construction import TriangleMesh

SHADER = False


def missing() -> str | None:
    """What has to be installed."""
    return None if importlib.util.find_spec("embreex") else "embreex is not installed"


def make(frame: Frame, threads: int) -> Callable[[], Any]:
    """Its `run` uses one thread whatever `threads` says."""
    if threads > 1:
        raise RuntimeError("embreex traces on one thread only")
    scene = rtcore_scene.EmbreeScene(robust=True)
    TriangleMesh(scene, frame.vertices, frame.triangles.astype(np.int32))
    directions = frame.directions().reshape(-1, 3)
    origins = np.broadcast_to(frame.camera.eye, directions.shape).copy()
    return lambda: scene.run(origins, directions)
