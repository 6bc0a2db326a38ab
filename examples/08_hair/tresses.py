"""Tresses of hair made by code: straight, wavy and curly, as control points of cubic B-splines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

POINTS = 32
LENGTH = 2.5
RADIUS = 0.0016


@dataclass(frozen=True)
class Style:
    """How a tress falls: the radius of its locks' helices at their ends, turns along the length, how much locks gather, stray hairs."""

    curl: float
    turns: float
    gathering: float
    frizz: float
    locks: int


STRAIGHT = Style(curl=0.012, turns=1.5, gathering=0.30, frizz=0.012, locks=90)
WAVY = Style(curl=0.055, turns=3.5, gathering=0.62, frizz=0.014, locks=46)
CURLY = Style(curl=0.085, turns=8.0, gathering=0.86, frizz=0.015, locks=36)


def tress(style: Style, x: float, strands: int, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Vertices (strands * POINTS, 3), radii, and the first control point of every segment; roots at height 0 around `x`."""
    random = np.random.default_rng(seed)
    down = np.linspace(0.0, 1.0, POINTS)

    # Roots on a flat ellipse; each strand belongs to the lock whose root is next to its own
    roots = in_ellipse(random, strands)
    lock_roots = in_ellipse(random, style.locks)
    lock = np.argmin(((roots[:, np.newaxis] - lock_roots) ** 2).sum(axis=2), axis=1)

    # The locks: they fall apart a little, and turn around their middle with growing radius
    fall = 1.0 + 0.25 * np.sin(np.pi * np.minimum(1.0, 1.3 * down)) - 0.12 * down
    phase = random.uniform(0.0, 2.0 * np.pi, (style.locks, 1))
    turns = style.turns * random.uniform(0.85, 1.15, (style.locks, 1))
    angle = phase + 2.0 * np.pi * turns * down
    radius = style.curl * random.uniform(0.7, 1.3, (style.locks, 1)) * smooth(0.02, 0.35, down)
    around = radius[..., np.newaxis] * np.stack([np.cos(angle), 0.8 * np.sin(angle)], axis=-1)
    middle = lock_roots[:, np.newaxis] * fall[:, np.newaxis] + around

    # The strands: towards their lock's middle on the way down, with a slow wander of their own
    gathering = style.gathering * smooth(0.0, 0.5, down)
    apart = (roots - lock_roots[lock])[:, np.newaxis] * (fall * (1.0 - gathering))[:, np.newaxis]
    wander = style.frizz * slow_noise(random, strands) * smooth(0.0, 0.4, down)[:, np.newaxis]
    stray = np.where(random.random((strands, 1, 1)) < 0.03, 4.0, 1.0)
    place = middle[lock] + apart + wander * stray

    # Helices take length from the fall; ends are not cut in one line
    length = LENGTH * random.uniform(0.93, 1.0, (strands, 1)) * (1.0 - 0.9 * style.curl * np.sqrt(style.turns))
    vertices = np.stack([x + place[..., 0], -length * down, place[..., 1]], axis=-1)
    taper = np.where(down > 0.75, 1.0 - 0.7 * (down - 0.75) / 0.25, 1.0)
    radii = RADIUS * random.uniform(0.8, 1.2, (strands, 1)) * taper
    first = np.arange(strands)[:, np.newaxis] * POINTS + np.arange(POINTS - 3)
    return vertices.reshape(-1, 3).astype(np.float32), radii.ravel().astype(np.float32), first.ravel().astype(np.uint32)


def in_ellipse(random: np.random.Generator, count: int) -> np.ndarray:
    """Points of a flat ellipse, (count, 2)."""
    angle, distance = random.uniform(0.0, 2.0 * np.pi, count), np.sqrt(random.random(count))
    return np.stack([0.42 * distance * np.cos(angle), 0.10 * distance * np.sin(angle)], axis=1)


def smooth(low: float, high: float, x: np.ndarray) -> np.ndarray:
    """0 below `low`, 1 above `high`, without a bend between."""
    t = np.clip((x - low) / (high - low), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def slow_noise(random: np.random.Generator, count: int) -> np.ndarray:
    """Two sums of a few sine waves along each strand, (count, POINTS, 2)."""
    down = np.linspace(0.0, 1.0, POINTS)[:, np.newaxis]
    total = np.zeros((count, POINTS, 2))
    for waves in (1.0, 2.3, 4.1):
        phase = random.uniform(0.0, 2.0 * np.pi, (count, 1, 2))
        total += random.normal(size=(count, 1, 2)) / waves * np.sin(2.0 * np.pi * waves * down + phase)
    return total


def box(low: tuple[float, float, float], high: tuple[float, float, float]) -> tuple[np.ndarray, np.ndarray]:
    """An axis-aligned box of triangles."""
    corners = np.array([[(low, high)[k >> axis & 1][axis] for axis in range(3)] for k in range(8)], np.float32)
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return corners, np.array([triangle for a, b, c, d in faces for triangle in ((a, b, c), (a, c, d))], np.uint32)
