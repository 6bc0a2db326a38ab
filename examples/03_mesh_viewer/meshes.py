"""Triangle meshes: from a file through trimesh, or a torus knot made by code."""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Mesh:
    """`vertices`, unit `normals` and linear `colors` are float32 (n, 3), `indices` uint32 (m, 3)."""

    vertices: np.ndarray
    indices: np.ndarray
    normals: np.ndarray
    colors: np.ndarray


def load(path: Path) -> Mesh:
    """Any format that trimesh reads (OBJ, PLY, glTF, STL, ...), all parts in one mesh, y up."""
    try:
        trimesh = importlib.import_module("trimesh")
    except ImportError as error:
        raise SystemExit("loading a mesh file needs trimesh: pip install trimesh") from error
    if not path.is_file():
        raise SystemExit(f"there is no file {path}")
    mesh = trimesh.load(path, force="mesh")
    vertices = np.ascontiguousarray(mesh.vertices, np.float32)
    indices = np.ascontiguousarray(mesh.faces, np.uint32)
    return Mesh(vertices, indices, vertex_normals(vertices, indices), file_colors(mesh.visual, len(vertices)))


def file_colors(visual: Any, count: int) -> np.ndarray:
    """Colours per vertex where the file has them, as linear floats; else the same grey everywhere."""
    stored = visual.to_color() if hasattr(visual, "to_color") else visual
    encoded = getattr(stored, "vertex_colors", None)
    if encoded is None or len(encoded) != count or not getattr(visual, "defined", False):
        return np.full((count, 3), 0.6, np.float32)
    values = np.asarray(encoded)[:, :3] / 255.0
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4).astype(np.float32)


def vertex_normals(vertices: np.ndarray, indices: np.ndarray) -> np.ndarray:
    """The normals of the triangles around each vertex, weighted by area."""
    corners = vertices[indices].astype(np.float64)
    facets = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.stack([np.bincount(indices.ravel(), np.repeat(facets[:, axis], 3), minlength=len(vertices)) for axis in range(3)], axis=1)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.where(lengths > 0.0, normals / np.maximum(lengths, 1e-300), [0.0, 1.0, 0.0]).astype(np.float32)


def torus_knot(p: int = 2, q: int = 3, segments: int = 1024, sides: int = 64) -> Mesh:
    """A tube around the (p, q) torus knot, coloured along its length."""
    t = np.linspace(0.0, 2.0 * np.pi, segments, endpoint=False)
    center, tangent = knot(t, p, q), knot(t + 1e-4, p, q) - knot(t - 1e-4, p, q)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    side = np.cross(tangent, center)
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    up = np.cross(side, tangent)

    angle = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)[:, np.newaxis]
    normals = np.cos(angle) * side[:, np.newaxis] + np.sin(angle) * up[:, np.newaxis]
    vertices = center[:, np.newaxis] + 0.32 * normals
    hue = 0.5 + 0.5 * np.cos(t[:, np.newaxis] + [0.0, 2.1, 4.2])
    colors = np.broadcast_to((0.08 + 0.75 * hue**2)[:, np.newaxis], vertices.shape)
    arrays = [np.ascontiguousarray(array.reshape(-1, 3), np.float32) for array in (vertices, normals, colors)]
    return Mesh(arrays[0], closed_grid(segments, sides), arrays[1], arrays[2])


def knot(t: np.ndarray, p: int, q: int) -> np.ndarray:
    """The centre line of the knot, (n, 3)."""
    radius = 2.0 + np.cos(q * t)
    return 0.6 * np.stack([radius * np.cos(p * t), radius * np.sin(p * t), np.sin(q * t)], axis=1)


def closed_grid(rows: int, columns: int) -> np.ndarray:
    """Two triangles per cell of a grid that closes both ways."""
    row, column = np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij")
    a, b = row * columns + column, row * columns + (column + 1) % columns
    below = (row + 1) % rows * columns
    c, d = below + column, below + (column + 1) % columns
    return np.concatenate([np.stack([a, d, b], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)]).astype(np.uint32)


def ground(height: float, half_size: float) -> Mesh:
    """A horizontal square that faces up."""
    x = half_size
    vertices = np.array([[-x, height, -x], [-x, height, x], [x, height, x], [x, height, -x]], np.float32)
    normals = np.tile(np.array([0.0, 1.0, 0.0], np.float32), (4, 1))
    return Mesh(vertices, np.array([[0, 1, 2], [0, 2, 3]], np.uint32), normals, np.full((4, 3), 0.42, np.float32))
