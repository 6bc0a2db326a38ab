"""The same questions answered by numpy: every ray against every triangle, in double precision."""

from __future__ import annotations

import numpy as np


def nearest(origins: np.ndarray, directions: np.ndarray, vertices: np.ndarray, indices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distances (infinite for a miss) and triangle numbers (-1), in units of the directions' lengths.

    T. Möller, B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997.
    """
    corners = vertices[indices].astype(np.float64)
    corner, edge1, edge2 = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    distances = np.full(len(origins), np.inf)
    triangles = np.full(len(origins), -1)
    for k, (origin, direction) in enumerate(zip(origins.astype(np.float64), directions.astype(np.float64), strict=True)):
        p = np.cross(direction, edge2)
        determinant = np.einsum("ij,ij->i", edge1, p)
        with np.errstate(divide="ignore", invalid="ignore"):
            inverse = 1.0 / determinant
            s = origin - corner
            u = np.einsum("ij,ij->i", s, p) * inverse
            q = np.cross(s, edge1)
            v = (q @ direction) * inverse
            t = np.einsum("ij,ij->i", edge2, q) * inverse
            inside = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (t > 0.0)
        if inside.any():
            candidates = np.where(inside, t, np.inf)
            triangles[k] = candidates.argmin()
            distances[k] = candidates[triangles[k]]
    return distances, triangles
