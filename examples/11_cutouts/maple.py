"""A maple made by code: its leaf's picture, its branches, where its leaves hang and lie. y is up, lengths are metres."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

Mesh = tuple[np.ndarray, np.ndarray]
# The right half of the outline, from the end of the stem to the tip
OUTLINE = np.array(
    [
        *((0.02, -0.97), (0.025, -0.50), (0.20, -0.60), (0.43, -0.60), (0.37, -0.47), (0.60, -0.34), (0.82, -0.13), (0.70, -0.08)),
        *((0.86, 0.27), (0.72, 0.22), (0.62, 0.20), (0.55, 0.36), (0.42, 0.22), (0.28, 0.10), (0.33, 0.36), (0.42, 0.60), (0.31, 0.56)),
        *((0.20, 0.60), (0.10, 0.82), (0.0, 0.97)),
    ]
)
VEINS = [(0.0, 0.95), (0.84, 0.25), (0.40, 0.57), (0.42, -0.58), (0.80, -0.13)]
HUB = np.array([0.0, -0.47])
# A rectangle's two triangles: corners, and their places in the picture, whose first row is the tip's
CORNERS = np.array([[0, 1, 2], [0, 2, 3]])
PLACES = np.array([[0, 1], [1, 1], [1, 0], [0, 0]], np.float32)


def picture(size: int = 512, finer: int = 3) -> np.ndarray:
    """uint8 (size, size, 4): veins lighter than the rest, alpha 0 around the leaf; edges are smooth over a texel."""
    count = size * finer
    x, y = np.meshgrid((np.arange(count) + 0.5) / count * 2.0 - 1.0, 1.0 - (np.arange(count) + 0.5) / count * 2.0)
    inside = in_polygon(np.abs(x), y, np.concatenate([OUTLINE, [[-0.1, 0.97], [-0.1, -0.97]]]))
    alpha = inside.reshape(size, finer, size, finer).mean(axis=(1, 3))
    x, y = x[finer // 2 :: finer, finer // 2 :: finer], y[finer // 2 :: finer, finer // 2 :: finer]
    near = np.min([vein_distance(np.abs(x), y, np.array(tip)) for tip in VEINS], axis=0)
    light = 0.80 + 0.20 * np.exp(-((near / 0.016) ** 2)) - 0.10 * np.exp(-((near / 0.10) ** 2))
    light += 0.04 * np.sin(40.0 * near) * np.exp(-near / 0.2)
    rgba = np.empty((size, size, 4), np.uint8)
    rgba[..., :3] = np.round(255.0 * np.clip(light, 0.0, 1.0))[..., np.newaxis]
    rgba[..., 3] = np.round(255.0 * alpha)
    return rgba


def in_polygon(x: np.ndarray, y: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Whether points lie inside, by the number of edges to their right."""
    inside = np.zeros(x.shape, bool)
    for (ax, ay), (bx, by) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if ay != by:
            inside ^= ((ay > y) != (by > y)) & (x < ax + (y - ay) / (by - ay) * (bx - ax))
    return inside


def vein_distance(x: np.ndarray, y: np.ndarray, tip: np.ndarray) -> np.ndarray:
    """Distance from the line between the hub and a lobe's tip."""
    along = tip - HUB
    t = np.clip(((x - HUB[0]) * along[0] + (y - HUB[1]) * along[1]) / (along @ along), 0.0, 1.0)
    return np.hypot(x - HUB[0] - t * along[0], y - HUB[1] - t * along[1])


@dataclass
class Tree:
    """Branches as (points, radii), and the ends of the twigs as (points)."""

    random: np.random.Generator
    limbs: list[tuple[np.ndarray, np.ndarray]] = field(default_factory=list)
    twigs: list[np.ndarray] = field(default_factory=list)

    def grow(self, base: np.ndarray, direction: np.ndarray, length: float, radius: float, level: int) -> None:
        """A branch and all that grow from it; at level 0 it bears leaves."""
        steps = 6
        points = [base]
        for _ in range(steps):
            direction = direction + self.random.normal(scale=0.10, size=3) + [0.0, 0.06 if level > 1 else -0.02, 0.0]
            direction /= np.linalg.norm(direction)
            points.append(points[-1] + direction * length / steps)
        path = np.array(points)
        self.limbs.append((path, radius * np.linspace(1.0, 0.55 if level else 0.35, steps + 1)))
        if level <= 1:
            self.twigs.append(path)
        if level == 0:
            return
        first = self.random.uniform(0.0, 2.0 * np.pi)
        for number in range(4):
            lowest = steps - 1 if level >= 5 else steps // 2
            at = steps if number == 0 else int(self.random.integers(lowest, steps + 1))
            angle = first + 2.4 * number
            spread = np.radians(self.random.uniform(18.0, 30.0) if number == 0 else self.random.uniform(34.0, 58.0))
            aside = perpendicular(direction, angle)
            heading = np.cos(spread) * direction + np.sin(spread) * aside
            self.grow(path[at], heading, length * self.random.uniform(0.62, 0.80), 0.6 * radius, level - 1)


def perpendicular(direction: np.ndarray, angle: float) -> np.ndarray:
    """A unit vector across a direction."""
    helper = np.array([1.0, 0.0, 0.0]) if abs(direction[0]) < 0.6 else np.array([0.0, 0.0, 1.0])
    x = np.cross(direction, helper)
    x /= np.linalg.norm(x)
    return np.cos(angle) * x + np.sin(angle) * np.cross(direction, x)


def tree(seed: int = 4) -> Tree:
    """A young maple about four metres high."""
    made = Tree(np.random.default_rng(seed))
    made.grow(np.array([0.0, -0.05, 0.0]), np.array([0.05, 1.0, 0.02]), 1.3, 0.09, 5)
    return made


def bark(made: Tree, sides: int = 7) -> Mesh:
    """Tubes around all branches."""
    angle = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)[:, np.newaxis]
    vertices, triangles, start = [], [], 0
    for points, radii in made.limbs:
        along = points[-1] - points[0]
        x = perpendicular(along / np.linalg.norm(along), 0.0)
        y = np.cross(along / np.linalg.norm(along), x)
        rings = points[:, np.newaxis] + radii[:, np.newaxis, np.newaxis] * (np.cos(angle) * x + np.sin(angle) * y)
        vertices.append(rings.reshape(-1, 3))
        row, k = np.meshgrid(np.arange(len(points) - 1), np.arange(sides), indexing="ij")
        a, b = start + row * sides + k, start + row * sides + (k + 1) % sides
        triangles += [np.stack([a, b, b + sides], -1).reshape(-1, 3), np.stack([a, b + sides, a + sides], -1).reshape(-1, 3)]
        start += len(points) * sides
    return np.concatenate(vertices).astype(np.float32), np.concatenate(triangles).astype(np.uint32)


def hanging(made: Tree, per_twig: int, seed: int = 8) -> Mesh:
    """Leaves along the twigs: their tips point outwards and down, their faces up."""
    random = np.random.default_rng(seed)
    twigs = np.repeat(np.array(made.twigs), per_twig, axis=0)
    count = len(twigs)
    t = random.uniform(1.0, 5.999, count)
    step = t.astype(int)
    rows = np.arange(count)
    base = twigs[rows, step] + (t - step)[:, np.newaxis] * (twigs[rows, step + 1] - twigs[rows, step])
    out = base * [1.0, 0.0, 1.0] + 0.35 * random.normal(size=(count, 3))
    out /= np.linalg.norm(out, axis=1, keepdims=True)
    tip = out + [0.0, -0.75, 0.0] + 0.55 * random.normal(size=(count, 3))
    face = np.array([0.0, 1.0, 0.0]) + 0.6 * out + 0.45 * random.normal(size=(count, 3))
    half = random.uniform(0.045, 0.085, count)
    return rectangles(base + 0.05 * random.normal(size=(count, 3)), tip, face, half)


def fallen(count: int, seed: int = 9) -> Mesh:
    """Leaves on the ground, more of them under the tree."""
    random = np.random.default_rng(seed)
    angle, distance = random.uniform(0.0, 2.0 * np.pi, count), 0.25 + np.abs(random.normal(scale=2.0, size=count))
    base = np.stack([distance * np.cos(angle), random.uniform(0.015, 0.05, count), distance * np.sin(angle)], axis=1)
    tip = random.normal(size=(count, 3)) * [1.0, 0.12, 1.0]
    face = np.array([0.0, 1.0, 0.0]) + 0.25 * random.normal(size=(count, 3))
    return rectangles(base, tip, face, random.uniform(0.045, 0.08, count))


def rectangles(base: np.ndarray, tip: np.ndarray, face: np.ndarray, half: np.ndarray) -> Mesh:
    """Squares of half the size `half` that begin at `base` and reach towards `tip`, facing about `face`; two triangles each."""
    up = tip / np.linalg.norm(tip, axis=1, keepdims=True)
    side = np.cross(up, face)
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    center = base + up * half[:, np.newaxis]
    u, v = side * half[:, np.newaxis], up * half[:, np.newaxis]
    vertices = np.stack([center - u - v, center + u - v, center + u + v, center - u + v], axis=1)
    triangles = 4 * np.arange(len(base))[:, np.newaxis, np.newaxis] + CORNERS
    return vertices.reshape(-1, 3).astype(np.float32), triangles.reshape(-1, 3).astype(np.uint32)
