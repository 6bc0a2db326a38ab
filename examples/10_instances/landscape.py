"""Hills, three kinds of trees, and where a million of them stand; all made by code. y is up, lengths are metres."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

SIZE = 2400.0
CELLS = 512
WATER_LEVEL = -14.0

Mesh = tuple[np.ndarray, np.ndarray]


def grid(rows: int, columns: int) -> np.ndarray:
    """Two triangles per cell of a grid of vertices, row by row: uint32 (m, 3)."""
    row, column = np.meshgrid(np.arange(rows - 1), np.arange(columns - 1), indexing="ij")
    a = row * columns + column
    b, c, d = a + 1, a + columns, a + columns + 1
    return np.stack([np.stack([a, c, d], -1), np.stack([a, d, b], -1)], axis=2).reshape(-1, 3).astype(np.uint32)


def smooth_noise(seed: int, roughness: float, coarsest: int) -> np.ndarray:
    """(CELLS, CELLS) values of mean 0 and deviation 1: white noise filtered to fall with frequency to the power of `roughness`."""
    spectrum = np.fft.fft2(np.random.default_rng(seed).normal(size=(CELLS, CELLS)))
    frequency = np.fft.fftfreq(CELLS, 1.0 / CELLS)
    distance = np.hypot(frequency[:, np.newaxis], frequency)
    filtered = np.fft.ifft2(spectrum * np.maximum(distance, coarsest) ** -roughness * (distance > 0.0)).real
    return filtered / filtered.std()


@dataclass(frozen=True)
class Landscape:
    """Heights and steepness on a grid over the square from -SIZE / 2 to SIZE / 2; rows go along z."""

    heights: np.ndarray
    steepness: np.ndarray

    def at(self, field: np.ndarray, x: np.ndarray, z: np.ndarray) -> np.ndarray:
        """A field of the grid between its points."""
        column = np.clip((x / SIZE + 0.5) * (CELLS - 1), 0, CELLS - 1.001)
        row = np.clip((z / SIZE + 0.5) * (CELLS - 1), 0, CELLS - 1.001)
        j, i = column.astype(int), row.astype(int)
        s, t = column - j, row - i
        return (1 - t) * ((1 - s) * field[i, j] + s * field[i, j + 1]) + t * ((1 - s) * field[i + 1, j] + s * field[i + 1, j + 1])

    def mesh(self) -> Mesh:
        """The ground."""
        place = np.linspace(-0.5 * SIZE, 0.5 * SIZE, CELLS)
        x, z = np.meshgrid(place, place)
        return np.stack([x, self.heights, z], axis=-1).reshape(-1, 3).astype(np.float32), grid(CELLS, CELLS)


def landscape() -> Landscape:
    """Hills that rise into the distance around a lake."""
    place = np.linspace(-1.0, 1.0, CELLS)
    x, z = np.meshgrid(place, place)
    heights = 14.0 + 20.0 * smooth_noise(11, 2.1, 2)
    heights += 150.0 * np.clip(-z - 0.15, 0.0, 1.0) ** 1.6 + 60.0 * np.abs(x) ** 2.5
    heights -= 46.0 * np.exp(-(((x - 0.02) / 0.22) ** 2) - ((z - 0.28 - 0.35 * x) / 0.10) ** 2)
    along_z, along_x = np.gradient(heights, SIZE / (CELLS - 1))
    slope = np.hypot(along_z, along_x)
    return Landscape(heights, slope)


def square(height: float) -> Mesh:
    """A horizontal square under and around everything."""
    reach = 0.5 * SIZE
    corners = [[-reach, height, -reach], [-reach, height, reach], [reach, height, reach], [reach, height, -reach]]
    return np.array(corners, np.float32), np.array([[0, 1, 2], [0, 2, 3]], np.uint32)


def trunk(height: float, radius: float, sides: int = 7) -> Mesh:
    """A cone."""
    angle = np.linspace(0.0, 2.0 * np.pi, sides + 1)
    ring = np.stack([np.cos(angle), np.zeros(sides + 1), np.sin(angle)], axis=1)
    return np.concatenate([radius * ring, 0.15 * radius * ring + [0.0, height, 0.0]]).astype(np.float32), grid(2, sides + 1)


def conifer(tiers: int = 11, points: int = 13) -> Mesh:
    """Skirts of drooping, jagged branches, one above the other; about a unit high."""
    random = np.random.default_rng(5)
    vertices: list[np.ndarray] = []
    triangles: list[np.ndarray] = []
    for tier in range(tiers):
        share = tier / (tiers - 1)
        base, top = 0.12 + 0.80 * share, 0.26 + 0.76 * share
        reach = 0.24 * (1.0 - share) ** 0.85 + 0.018
        angle = np.linspace(0.0, 2.0 * np.pi, 2 * points, endpoint=False) + random.uniform(0.0, 1.0)
        far = np.where(np.arange(2 * points) % 2 == 0, 1.0, 0.55) * random.uniform(0.8, 1.15, 2 * points) * reach
        rim = np.stack([far * np.cos(angle), base - 0.10 * far + random.uniform(-0.012, 0.012, 2 * points), far * np.sin(angle)], axis=1)
        start = sum(len(part) for part in vertices)
        vertices.append(np.concatenate([rim, [[0.0, top, 0.0]]]))
        k = np.arange(2 * points)
        triangles.append(np.stack([start + k, np.full_like(k, start + 2 * points), start + (k + 1) % (2 * points)], axis=1))
    return np.concatenate(vertices).astype(np.float32), np.concatenate(triangles).astype(np.uint32)


def crown(width: float, height: float, middle: float, seed: int, tufts: int = 420) -> Mesh:
    """A crown of tufts, each a small bent quad, on the bumpy outside of an ellipsoid."""
    random = np.random.default_rng(seed)
    normal = random.normal(size=(tufts, 3))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    bumps = 1.0 + 0.16 * np.sin(5.0 * normal[:, :1] + 2.0) * np.sin(4.0 * normal[:, 1:2]) + random.uniform(-0.16, 0.05, (tufts, 1))
    center = normal * bumps * [width, height, width] + [0.0, middle, 0.0]
    facing = normal + 0.45 * random.normal(size=(tufts, 3))
    facing /= np.linalg.norm(facing, axis=1, keepdims=True)
    side = np.cross(facing, random.normal(size=(tufts, 3)))
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    up = np.cross(facing, side)
    half = width * random.uniform(0.16, 0.30, (tufts, 1))
    ring = [side, up, -side, -up]
    corners = np.stack([center + half * one - 0.4 * half * facing for one in ring] + [center + 0.25 * half * facing], axis=1)
    start = 5 * np.arange(tufts, dtype=np.uint32)[:, np.newaxis, np.newaxis]
    fan = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]], np.uint32)
    return corners.reshape(-1, 3).astype(np.float32), (start + fan).reshape(-1, 3)


def species() -> list[tuple[Mesh, Mesh]]:
    """Trunk and leaves of a spruce, an oak and a birch, each about a unit high."""
    return [
        (trunk(0.9, 0.018), conifer()),
        (trunk(0.75, 0.035), crown(0.34, 0.30, 0.66, 1)),
        (trunk(0.85, 0.016), crown(0.19, 0.36, 0.62, 2)),
    ]


def forest(land: Landscape, count: int, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Species (count,) and transforms float32 (count, 3, 4): none in the water, few on steep slopes and in glades, spruces higher up."""
    random = np.random.default_rng(seed)
    density = np.clip(1.3 + 0.9 * smooth_noise(21, 1.6, 4), 0.02, 1.0) * np.clip(1.6 - 1.6 * land.steepness, 0.05, 1.0)
    density *= np.clip((land.heights - WATER_LEVEL - 1.0) / 2.0, 0.0, 1.0)
    mix = smooth_noise(31, 1.8, 6)
    places = np.empty((0, 2))
    while len(places) < count:
        tried = random.uniform(-0.5 * SIZE, 0.5 * SIZE, (2 * count, 2))
        kept = random.random(len(tried)) < land.at(density, tried[:, 0], tried[:, 1])
        places = np.concatenate([places, tried[kept]])
    x, z = places[:count].T
    y = land.at(land.heights, x, z)
    cold = 0.03 * y + 0.8 * land.at(mix, x, z) + 0.35 * random.normal(size=count)
    kind = np.where(cold > 0.40, 0, np.where(random.random(count) < 0.62, 1, 2))

    # Upright, turned about the vertical, of differing heights and girths
    height = np.array([17.0, 11.0, 13.0])[kind] * random.uniform(0.55, 1.2, count)
    girth = height * random.uniform(0.8, 1.15, count)
    angle = random.uniform(0.0, 2.0 * np.pi, count)
    transforms = np.zeros((count, 3, 4), np.float32)
    transforms[:, 0, 0], transforms[:, 0, 2] = girth * np.cos(angle), girth * np.sin(angle)
    transforms[:, 2, 0], transforms[:, 2, 2] = -girth * np.sin(angle), girth * np.cos(angle)
    transforms[:, 1, 1] = height
    transforms[:, :, 3] = np.stack([x, y - 0.2, z], axis=1)
    return kind, transforms
