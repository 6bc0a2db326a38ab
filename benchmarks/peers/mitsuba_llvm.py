"""Mitsuba 3 in llvm_ad_rgb: camera rays, closest hit and the interpolated normal as colour, in one compiled loop over all pixels."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from typing import Any

import numpy as np

from benchmarks.peers.frame import Frame
from benchmarks.scenes import IMAGE_SIZE

if importlib.util.find_spec("mitsuba") is not None:
    import drjit
    import mitsuba

    mitsuba.set_variant("llvm_ad_rgb")

SHADER = True


def missing() -> str | None:
    """What has to be installed."""
    return None if importlib.util.find_spec("mitsuba") else "mitsuba is not installed"


def make(frame: Frame, threads: int) -> Callable[[], Any]:
    """A mesh made from the arrays; the rays are made inside."""
    drjit.set_thread_count(threads)
    mesh = mitsuba.Mesh("mesh", len(frame.vertices), len(frame.triangles), has_vertex_normals=True)
    values = mitsuba.traverse(mesh)
    values["vertex_positions"] = frame.vertices.ravel()
    values["vertex_normals"] = frame.normals.ravel()
    values["faces"] = frame.triangles.ravel()
    values.update()
    scene = mitsuba.load_dict({"type": "scene", "mesh": mesh})
    camera = frame.camera
    eye, u, v, w = (mitsuba.Vector3f(*map(float, part)) for part in (camera.eye, camera.u, camera.v, camera.w))

    def render() -> Any:
        index = drjit.arange(mitsuba.UInt32, IMAGE_SIZE * IMAGE_SIZE)
        x = (mitsuba.Float(index % IMAGE_SIZE) + 0.5) * (2.0 / IMAGE_SIZE) - 1.0
        y = 1.0 - (mitsuba.Float(index // IMAGE_SIZE) + 0.5) * (2.0 / IMAGE_SIZE)
        ray = mitsuba.Ray3f(mitsuba.Point3f(eye), drjit.normalize(x * u + y * v + w))
        hit = scene.ray_intersect(ray, mitsuba.RayFlags.ShadingFrame, coherent=True)
        color = drjit.select(hit.is_valid(), 0.5 * hit.sh_frame.n + 0.5, 0.0)
        drjit.eval(color)
        drjit.sync_thread()
        return color

    image = np.array(render())
    if not np.isfinite(image).all() or image.max() <= 0.0:
        raise RuntimeError("Mitsuba's image is empty")
    return render
