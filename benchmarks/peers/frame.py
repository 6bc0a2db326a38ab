"""The mesh, its normals and the rays of one image, as peers take them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmarks.scenes import IMAGE_SIZE, Camera, Floats, Uints, mesh_scene


@dataclass(frozen=True)
class Frame:
    """A scene of benchmark_scenes.json seen by its first camera."""

    scene: str
    vertices: Floats
    triangles: Uints
    normals: Floats
    camera: Camera

    @staticmethod
    def of(name: str) -> Frame:
        """The frame of the scene called `name`."""
        scene = mesh_scene(name)
        return Frame(name, scene.vertices, scene.triangles, scene.normals, scene.camera)

    def directions(self) -> Floats:
        """Unit directions through the pixels' centres, (1024, 1024, 3)."""
        centres = (np.arange(IMAGE_SIZE, dtype=np.float32) + np.float32(0.5)) * np.float32(2.0 / IMAGE_SIZE) - np.float32(1.0)
        x, y = np.meshgrid(centres, -centres)
        rays = x[..., None] * self.camera.u + y[..., None] * self.camera.v + self.camera.w
        return (rays / np.linalg.norm(rays, axis=-1, keepdims=True)).astype(np.float32)
