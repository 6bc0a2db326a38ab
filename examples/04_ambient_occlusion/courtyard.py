"""A courtyard with arcades made by code: the scene that this example ships."""

from __future__ import annotations

import numpy as np

EYE = (-6.2, 1.75, 1.9)
TARGET = (0.4, 1.85, -0.5)
VERTICAL_FOV = 62.0
RADIUS = 4.0

Part = tuple[np.ndarray, np.ndarray]


def build() -> Part:
    """float32 vertices (n, 3) and uint32 indices (m, 3); y is up, the floor lies at 0."""
    bays, bay, depth = 4, 2.4, 2.2
    half = 0.5 * bays * bay
    parts = [
        box((-half - depth, -0.3, -half - depth), (half + depth, 0.0, half + depth)),
        *fountain(),
    ]
    for quarter in range(4):
        side = [arcade(bays, bay, half), *(turned_column(x, half) for x in np.linspace(-half, half, bays + 1)[1:]), wall(half, depth)]
        parts += [rotated(part, quarter) for part in side]
    return merged(parts)


def box(low: tuple[float, float, float], high: tuple[float, float, float]) -> Part:
    """An axis-aligned box."""
    corners = np.array([[(low, high)[k >> axis & 1][axis] for axis in range(3)] for k in range(8)], np.float32)
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return corners, np.array([triangle for a, b, c, d in faces for triangle in ((a, b, c), (a, c, d))], np.uint32)


def revolved(profile: list[tuple[float, float]], center: tuple[float, float], sides: int = 48) -> Part:
    """The (radius, height) profile turned around the vertical through (x, z)."""
    outline = np.array(profile)
    angle = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)
    x = center[0] + outline[:, :1] * np.cos(angle)
    z = center[1] + outline[:, :1] * np.sin(angle)
    y = np.broadcast_to(outline[:, 1:], x.shape)
    return np.stack([x, y, z], -1).reshape(-1, 3).astype(np.float32), strips(len(profile), sides, closed=True)


def strips(rows: int, columns: int, *, closed: bool) -> np.ndarray:
    """Two triangles per cell of a grid of vertices; `closed` joins the last column to the first."""
    row, column = np.meshgrid(np.arange(rows - 1), np.arange(columns if closed else columns - 1), indexing="ij")
    following = (column + 1) % columns
    a, b = row * columns + column, row * columns + following
    c, d = a + columns, b + columns
    return np.concatenate([np.stack([a, c, d], -1).reshape(-1, 3), np.stack([a, d, b], -1).reshape(-1, 3)]).astype(np.uint32)


def turned_column(x: float, z: float) -> Part:
    """Base, shaft with entasis, capital."""
    shaft = [(0.17 - 0.03 * t**2, 0.35 + 1.75 * t) for t in np.linspace(0.0, 1.0, 12)]
    base = [(0.0, 0.0), (0.30, 0.0), (0.30, 0.12), (0.27, 0.14), (0.24, 0.22), (0.26, 0.26), (0.22, 0.32)]
    capital = [(0.17, 2.12), (0.18, 2.18), (0.16, 2.20), (0.22, 2.34), (0.30, 2.40), (0.30, 2.50), (0.0, 2.50)]
    return revolved([*base, *shaft, *capital], (x, z))


def arcade(bays: int, bay: float, z: float, top: float = 4.3, thickness: float = 0.5) -> Part:
    """A wall on round arches along x, `bays` of them, above the columns' height; front, back and the arches' undersides."""
    spring, radius = 2.5, 0.5 * bay - 0.28
    angle = np.linspace(np.pi, 0.0, 33)
    arch_x = np.concatenate([[-0.5 * bay], radius * np.cos(angle), [0.5 * bay]])
    arch_y = np.concatenate([[spring], spring + radius * np.sin(angle), [spring]])
    parts: list[Part] = []
    for k in range(bays):
        x = arch_x + (k + 0.5 - 0.5 * bays) * bay
        for depth in (z - 0.5 * thickness, z + 0.5 * thickness):
            lower = np.stack([x, arch_y, np.full_like(x, depth)], -1)
            upper = np.stack([x, np.full_like(x, top), np.full_like(x, depth)], -1)
            parts.append((np.concatenate([lower, upper]).astype(np.float32), strips(2, len(x), closed=False)))
        edges = [np.stack([x, arch_y, np.full_like(x, z + side * 0.5 * thickness)], -1) for side in (-1.0, 1.0)]
        parts.append((np.concatenate(edges).astype(np.float32), strips(2, len(x), closed=False)))
    half = 0.5 * bays * bay
    parts.append(box((-half - 0.35, top, z - 0.35), (half + 0.35, top + 0.2, z + 0.35)))
    return merged(parts)


def wall(half: float, depth: float) -> Part:
    """The gallery's back wall, its bench and its ceiling, on the +z side."""
    outer = half + depth
    return merged(
        [
            box((-outer, 0.0, outer), (outer, 4.3, outer + 0.3)),
            box((-outer, 0.0, outer - 0.55), (outer, 0.45, outer)),
            box((-outer, 4.2, half), (outer, 4.3, outer)),
        ]
    )


def fountain() -> list[Part]:
    """Three steps, a basin, and a torus knot above it."""
    steps = [
        revolved([(0.0, 0.15 * k), (r, 0.15 * k), (r, 0.15 * (k + 1)), (0.0, 0.15 * (k + 1))], (0.0, 0.0), 8)
        for k, r in enumerate((2.1, 1.8, 1.5))
    ]
    basin = [(0.0, 0.45), (0.35, 0.45), (0.22, 0.6), (0.2, 1.0), (0.5, 1.1), (1.05, 1.4), (1.1, 1.5), (1.0, 1.5), (0.5, 1.22), (0.0, 1.18)]
    return [*steps, revolved(basin, (0.0, 0.0), 96), torus_knot()]


def torus_knot(segments: int = 512, sides: int = 32) -> Part:
    """A tube around the (2, 3) torus knot, standing in the basin."""

    def center(t: np.ndarray) -> np.ndarray:
        radius = 2.0 + np.cos(3.0 * t)
        return 0.24 * np.stack([radius * np.cos(2.0 * t), radius * np.sin(2.0 * t), np.sin(3.0 * t)], axis=1)

    t = np.linspace(0.0, 2.0 * np.pi, segments)
    along = center(t + 1e-4) - center(t - 1e-4)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    side = np.cross(along, center(t))
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    angle = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)[:, np.newaxis]
    ring = np.cos(angle) * side[:, np.newaxis] + np.sin(angle) * np.cross(side, along)[:, np.newaxis]
    vertices = center(t)[:, np.newaxis] + 0.15 * ring + [0.0, 2.08, 0.0]
    return vertices.reshape(-1, 3).astype(np.float32), strips(segments, sides, closed=True)


def rotated(part: Part, quarters: int) -> Part:
    """The part turned around the vertical by so many right angles."""
    x, y, z = part[0].T
    for _ in range(quarters):
        x, z = z, -x
    return np.stack([x, y, z], -1), part[1]


def merged(parts: list[Part]) -> Part:
    """All parts as one mesh."""
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in parts[:-1])])
    indices = np.concatenate([part[1] + np.uint32(start) for part, start in zip(parts, starts, strict=True)])
    return np.concatenate([part[0] for part in parts]).astype(np.float32), indices.astype(np.uint32)
