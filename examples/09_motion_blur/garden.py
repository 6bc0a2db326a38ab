"""Things that move in the wind, made by code: pinwheels, a flag, a ball; as meshes and as keys of their motion."""

from __future__ import annotations

import numpy as np

Mesh = tuple[np.ndarray, np.ndarray]
BLADES = 6
FLAG_COLUMNS, FLAG_ROWS = 60, 36


def grid(rows: int, columns: int) -> np.ndarray:
    """Two triangles per cell of a grid of vertices, row by row: uint32 (m, 3)."""
    row, column = np.meshgrid(np.arange(rows - 1), np.arange(columns - 1), indexing="ij")
    a = row * columns + column
    b, c, d = a + 1, a + columns, a + columns + 1
    return np.stack([np.stack([a, c, d], -1), np.stack([a, d, b], -1)], axis=2).reshape(-1, 3).astype(np.uint32)


def merged(parts: list[Mesh]) -> Mesh:
    """All parts as one mesh."""
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in parts[:-1])])
    indices = np.concatenate([part[1] + np.uint32(start) for part, start in zip(parts, starts, strict=True)])
    return np.concatenate([part[0] for part in parts]).astype(np.float32), indices.astype(np.uint32)


def blade(number: int, steps: int = 17) -> Mesh:
    """A curled sheet of paper from the hub outwards, in the plane of the wheel at its leading edge and lifted behind it."""
    radius, curl = np.meshgrid(np.linspace(0.0, 1.0, steps), np.linspace(0.0, 1.0, steps), indexing="ij")
    angle = 2.0 * np.pi * (number / BLADES) + radius * curl * 1.15
    reach = radius * (1.0 - 0.35 * curl**2)
    lift = 0.34 * radius * np.sin(0.8 * np.pi * curl)
    vertices = np.stack([reach * np.cos(angle), reach * np.sin(angle), lift], axis=-1)
    return vertices.reshape(-1, 3).astype(np.float32), grid(steps, steps)


def wheel() -> Mesh:
    """All blades in the plane z = 0, turning about z; the triangles of a blade follow each other."""
    return merged([blade(number) for number in range(BLADES)])


def tube(bottom: np.ndarray, top: np.ndarray, radius: float, sides: int = 24) -> Mesh:
    """A cylinder without ends."""
    along = (top - bottom) / np.linalg.norm(top - bottom)
    helper = np.array([1.0, 0.0, 0.0]) if abs(along[0]) < 0.5 else np.array([0.0, 0.0, 1.0])
    x = np.cross(along, helper)
    x /= np.linalg.norm(x)
    y = np.cross(along, x)
    angle = np.linspace(0.0, 2.0 * np.pi, sides + 1)[:, np.newaxis]
    ring = radius * (np.cos(angle) * x + np.sin(angle) * y)
    return np.concatenate([bottom + ring, top + ring]).astype(np.float32), grid(2, sides + 1)


def srt(angle: float, scale: float, place: tuple[float, float, float], lean: float) -> list[float]:
    """An SRT key: a wheel of this size turned by `angle` about its axle, which leans sideways by `lean`, at a place. Radians."""
    # The quaternion of the turn about z first, then of the lean about y
    cz, sz, cy, sy = np.cos(angle / 2), np.sin(angle / 2), np.cos(lean / 2), np.sin(lean / 2)
    turn = (sy * sz, sy * cz, cy * sz, cy * cz)
    return [scale, 0.0, 0.0, 0.0, scale, 0.0, 0.0, scale, 0.0, *turn, *place]


def spin(turns: float, scale: float, place: tuple[float, float, float], lean: float, start: float) -> np.ndarray:
    """SRT keys of a wheel that makes that many turns: keys lie at most 30 degrees apart, because quaternions are blended linearly."""
    keys = max(2, int(np.ceil(turns * 12)) + 1)
    return np.array([srt(start + 2.0 * np.pi * turns * t, scale, place, lean) for t in np.linspace(0.0, 1.0, keys)], np.float32)


def bounce(radius: float, place: tuple[float, float], keys: int = 17) -> np.ndarray:
    """Matrix keys of a ball that flies in, is flattened by the ground and takes off again: (keys, 3, 4)."""
    made = []
    for t in np.linspace(-1.0, 1.0, keys):
        # Between the contacts it is on the ground; outside it flies on a parabola
        contact = 0.3
        squash = 0.28 * max(0.0, 1.0 - (t / contact) ** 2) if abs(t) < contact else 0.0
        flight = max(0.0, abs(t) - contact)
        height = radius * (1.0 - squash) + 0.5 * flight * (1.6 - 0.75 * flight)
        wide = radius / np.sqrt(1.0 - squash)
        turn = -0.2 * t
        rotation = np.array([[np.cos(turn), -np.sin(turn), 0.0], [np.sin(turn), np.cos(turn), 0.0], [0.0, 0.0, 1.0]])
        linear = np.diag([wide, radius * (1.0 - squash), wide]) @ rotation
        made.append(np.concatenate([linear, [[place[0] + 0.28 * t], [height], [place[1]]]], axis=1))
    return np.array(made, np.float32)


def flag(phase: float, place: tuple[float, float, float]) -> Mesh:
    """A flag whose waves run away from the pole; `phase` is how far they have run, in radians. Triangles by row, from the top."""
    u, v = np.meshgrid(np.linspace(0.0, 1.0, FLAG_COLUMNS), np.linspace(0.0, 1.0, FLAG_ROWS))
    wave = 2.0 * np.pi * 1.45 * u - phase + 0.7 * v
    depth = 0.24 * u**0.8 * np.sin(wave) + 0.03 * u * np.sin(2.3 * wave + 3.0 * v)
    vertices = np.stack([1.9 * u * (1.0 - 0.05 * np.cos(wave)), -1.15 * v - 0.10 * u * u + 0.03 * u * np.sin(wave + 1.0), depth], axis=-1)
    return (vertices.reshape(-1, 3) + place).astype(np.float32), grid(FLAG_ROWS, FLAG_COLUMNS)
