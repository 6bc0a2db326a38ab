"""Triangle meshes made by code, for hosts: superellipsoids, tori, surfaces of any grid of points. Shaders do not import this file.

Triangles are counter-clockwise from outside, normals are unit vectors at the vertices; y is up.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt


@dataclass(frozen=True)
class Mesh:
    """`vertices` and `normals` are float32 (n, 3), `indices` uint32 (m, 3)."""

    vertices: np.ndarray
    indices: np.ndarray
    normals: np.ndarray

    def moved(self, transform: npt.ArrayLike) -> Mesh:
        """Through a 3 x 4 matrix that does not mirror."""
        matrix = np.asarray(transform, np.float64)
        vertices = self.vertices @ matrix[:, :3].T + matrix[:, 3]
        normals = self.normals @ np.linalg.inv(matrix[:, :3])
        return Mesh(vertices.astype(np.float32), self.indices, unit(normals))

    def part(self, triangles: np.ndarray) -> Mesh:
        """The triangles of a mask or a list of numbers; all vertices stay."""
        return Mesh(self.vertices, np.ascontiguousarray(self.indices[triangles]), self.normals)

    def centers(self) -> np.ndarray:
        """The middle of each triangle, (m, 3)."""
        middle: np.ndarray = self.vertices[self.indices].mean(axis=1)
        return middle


def merged(meshes: Sequence[Mesh]) -> Mesh:
    """Several meshes as one."""
    first = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    indices = [mesh.indices + np.uint32(start) for mesh, start in zip(meshes, first, strict=False)]
    return Mesh(
        np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(indices), np.concatenate([mesh.normals for mesh in meshes])
    )


def unit(vectors: np.ndarray) -> np.ndarray:
    """Vectors of length 1 as float32; zero stays zero."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return (vectors / np.maximum(lengths, 1e-30)).astype(np.float32)


def surface(points: np.ndarray, normals: np.ndarray | None = None) -> Mesh:
    """A grid of points, (rows, columns, 3): its front is where rows run down and columns to the right. Without normals, those of the
    triangles around each vertex, weighted by area; vertices at one place share them, so seams and poles are smooth."""
    rows, columns = points.shape[:2]
    row, column = np.meshgrid(np.arange(rows - 1), np.arange(columns - 1), indexing="ij")
    a = row * columns + column
    b, c, d = a + 1, a + columns, a + columns + 1
    halves = [np.stack([a, c, b], -1).reshape(-1, 3), np.stack([b, c, d], -1).reshape(-1, 3)]
    indices = np.stack(halves, axis=1).reshape(-1, 3).astype(np.uint32)
    vertices = np.ascontiguousarray(points.reshape(-1, 3), np.float32)
    if normals is None:
        return Mesh(vertices, indices, vertex_normals(vertices, indices))
    return Mesh(vertices, indices, unit(normals.reshape(-1, 3)))


def vertex_normals(vertices: np.ndarray, indices: np.ndarray) -> np.ndarray:
    """The normals of the triangles around each place, weighted by area."""
    corners = vertices[indices].astype(np.float64)
    facets = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    _, place = np.unique(np.round(vertices, 6), axis=0, return_inverse=True)
    places = place.reshape(-1)[indices].ravel()
    sums = [np.bincount(places, np.repeat(facets[:, axis], 3), minlength=len(vertices)) for axis in range(3)]
    return unit(np.stack(sums, axis=1)[place.reshape(-1)])


def superellipsoid(vertical: float, horizontal: float, rows: int = 192, columns: int = 384) -> Mesh:
    """Radius 1: exponents 1 and 1 are a sphere, small ones a cube with round edges, 0.3 and 1 a drum, 2 and 2 an octahedron. A. Barr,
    "Superquadrics and Angle-Preserving Transformations", 1981."""
    down = np.linspace(0.5 * np.pi, -0.5 * np.pi, rows)[:, np.newaxis]
    around = np.linspace(-np.pi, np.pi, columns)[np.newaxis]
    points = superellipsoid_points(down, around, vertical, horizontal)
    return surface(points, superellipsoid_points(down, around, 2.0 - vertical, 2.0 - horizontal))


def superellipsoid_points(down: np.ndarray, around: np.ndarray, vertical: float, horizontal: float) -> np.ndarray:
    """Points of a superellipsoid; its normals are the points for 2 less each exponent."""
    ring = signed_power(np.cos(down), vertical)
    x = ring * signed_power(np.sin(around), horizontal)
    y = signed_power(np.sin(down), vertical) * np.ones_like(around)
    z = ring * signed_power(np.cos(around), horizontal)
    return np.stack([x, y, z], axis=-1)


def signed_power(x: np.ndarray, exponent: float) -> np.ndarray:
    """The power of the magnitude, with the sign."""
    power: np.ndarray = np.sign(x) * np.abs(x) ** exponent
    return power


def torus(radius: float, tube: float, rows: int = 192, columns: int = 384) -> Mesh:
    """Around the y axis."""
    around = np.linspace(-np.pi, np.pi, columns)[np.newaxis]
    across = np.linspace(np.pi, -np.pi, rows)[:, np.newaxis]
    out = np.cos(across)
    normals = np.stack([out * np.sin(around), np.sin(across) * np.ones_like(around), out * np.cos(around)], axis=-1)
    centers = radius * np.stack([np.sin(around), np.zeros_like(around), np.cos(around)], axis=-1)
    return surface(centers + tube * normals, normals)


def rectangle(corner: npt.ArrayLike, edge_u: npt.ArrayLike, edge_v: npt.ArrayLike) -> Mesh:
    """A parallelogram whose front is on the side of cross(edge_u, edge_v), as of a `RectangleLight`."""
    p, u, v = (np.asarray(vector, np.float64) for vector in (corner, edge_u, edge_v))
    vertices = np.array([p, p + u, p + u + v, p + v], np.float32)
    return Mesh(vertices, np.array([[0, 1, 2], [0, 2, 3]], np.uint32), unit(np.tile(np.cross(u, v), (4, 1))))


def backdrop(half_width: float, front: float, back: float, radius: float, height: float) -> Mesh:
    """A floor at height 0 from z = `front` to `back`, which bends up there into a wall: a studio without an edge."""
    angle = np.linspace(0.0, 0.5 * np.pi, 64)
    profile = np.stack([radius * (1.0 - np.cos(angle)), back - radius * np.sin(angle)], axis=1)
    profile = np.concatenate([[[0.0, front]], profile, [[height, back - radius]]])
    normal = np.concatenate([[[1.0, 0.0]], np.stack([np.cos(angle), np.sin(angle)], axis=1), [[0.0, 1.0]]])
    points, normals = np.zeros((len(profile), 2, 3)), np.zeros((len(profile), 2, 3))
    points[:, :, 0] = [half_width, -half_width]
    points[:, :, 1:] = profile[:, np.newaxis]
    normals[:, :, 1:] = normal[:, np.newaxis]
    return surface(points, normals)
