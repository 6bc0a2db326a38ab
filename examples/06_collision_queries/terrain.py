"""A valley made by code: the mesh that the queries run against."""

from __future__ import annotations

import numpy as np

HALF_SIZE = 10.0


def height(x: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Hills inside, a steep rim outside."""
    hills = 0.5 * np.sin(0.9 * x) * np.cos(0.7 * z) + 0.25 * np.sin(2.3 * x + 1.0) * np.sin(1.9 * z)
    return hills + 4.0 * (np.maximum(np.abs(x), np.abs(z)) / HALF_SIZE) ** 8


def build(cells: int) -> tuple[np.ndarray, np.ndarray]:
    """float32 vertices (n, 3) and uint32 indices (m, 3): `cells` x `cells` squares of two triangles."""
    side = np.linspace(-HALF_SIZE, HALF_SIZE, cells + 1)
    x, z = np.meshgrid(side, side, indexing="ij")
    vertices = np.stack([x, height(x, z), z], -1).reshape(-1, 3).astype(np.float32)
    row, column = np.meshgrid(np.arange(cells), np.arange(cells), indexing="ij")
    a = row * (cells + 1) + column
    b, c = a + 1, a + cells + 1
    d = c + 1
    return vertices, np.concatenate([np.stack([a, b, d], -1).reshape(-1, 3), np.stack([a, d, c], -1).reshape(-1, 3)]).astype(np.uint32)
