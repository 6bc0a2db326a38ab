"""A toy car made by code: a body and a cabin with round edges, wheels, bumpers. Four long, wheels on the ground, front towards +x."""

from __future__ import annotations

import numpy as np

from optixc.stdlib.shapes import Mesh, merged, superellipsoid, surface, torus

WHEELS = [(x, z) for x in (-1.16, 1.2) for z in (-0.74, 0.74)]
AXLE = 0.36


def car() -> dict[str, Mesh]:
    """Meshes by material: paint, stripe, glass, rubber, chrome, black, lamp and tail."""
    body, cabin = hull(), greenhouse()
    stripe = is_stripe(body.centers()) & (body.centers()[:, 1] > 0.4)
    glass = is_glass(cabin.centers())
    roof_stripe = is_stripe(cabin.centers()) & ~glass
    return {
        "paint": merged([body.part(~stripe), cabin.part(~glass & ~roof_stripe)]),
        "stripe": merged([body.part(stripe), cabin.part(roof_stripe)]),
        "glass": cabin.part(glass),
        "rubber": merged([wheel(tyre(), x, z) for x, z in WHEELS]),
        "chrome": merged([*(wheel(rim(), x, z) for x, z in WHEELS), bumper(1.93), bumper(-1.93), *mirrors()]),
        "black": merged([*(wheel(arch(), x, z) for x, z in WHEELS), grille()]),
        "lamp": merged([blob((1.80, 0.60, z), (0.12, 0.11, 0.15)) for z in (-0.52, 0.52)]),
        "tail": merged([blob((-1.90, 0.62, z), (0.06, 0.06, 0.15)) for z in (-0.52, 0.52)]),
    }


def loft(half_length: float, columns: int, outline: np.ndarray, bottom: np.ndarray, top: np.ndarray, half_width: np.ndarray) -> Mesh:
    """Rounded cross-sections along x: the arrays give each section's x over half the length, bottom, top and half width."""
    around = np.linspace(np.pi, -np.pi, columns)[np.newaxis]
    middle, half_height = 0.5 * (bottom + top)[:, np.newaxis], 0.5 * (top - bottom)[:, np.newaxis]
    rounded = 0.42
    y = middle + half_height * np.sign(np.sin(around)) * np.abs(np.sin(around)) ** rounded
    z = half_width[:, np.newaxis] * np.sign(np.cos(around)) * np.abs(np.cos(around)) ** rounded
    x = half_length * outline[:, np.newaxis] * np.ones_like(around)
    return surface(np.stack([x, y, z], axis=-1))


def stations(rows: int, roundness: float) -> tuple[np.ndarray, np.ndarray]:
    """Places along a shape from end to end, and how full the section is there: 0 at both ends."""
    angle = np.linspace(0.0, np.pi, rows)
    along = -np.sign(np.cos(angle)) * np.abs(np.cos(angle)) ** roundness
    return along, np.sin(angle) ** roundness


def hull(rows: int = 500, columns: int = 500) -> Mesh:
    """The body: a long bonnet that falls towards the front, a waist between the wheels."""
    along, full = stations(rows, 0.34)
    top = 0.80 - 0.10 * np.clip(along, 0.0, 1.0) ** 2 - 0.04 * np.clip(-along, 0.0, 1.0) ** 2
    bottom = np.full(rows, 0.24)
    middle = 0.5 * (top + bottom) - 0.03 * along**2
    half_height = 0.5 * (top - bottom) * full
    width = (0.80 + 0.035 * np.cos(2.0 * np.pi * along)) * full**0.8
    return loft(2.0, columns, along, middle - half_height, middle + half_height, width)


def greenhouse(rows: int = 500, columns: int = 500) -> Mesh:
    """The cabin: a raked ellipsoid that leans in towards the roof."""
    shape = superellipsoid(0.72, 0.62, rows, columns)
    x, y, z = shape.vertices.astype(np.float64).T
    lean = 1.0 - 0.16 * y
    points = np.stack([-0.28 + 1.02 * x * (1.0 - 0.12 * y) - 0.12 * y, 0.74 + 0.60 * y, 0.66 * z * lean], axis=-1)
    return surface(points.reshape(rows, columns, 3))


def is_stripe(place: np.ndarray) -> np.ndarray:
    """Two stripes along the car."""
    across = np.abs(place[:, 2])
    return (across > 0.06) & (across < 0.22)


def is_glass(place: np.ndarray) -> np.ndarray:
    """Windows all around, below the roof and between pillars."""
    x, y, z = place.T
    height = (y - 0.74) / 0.60
    window = (y > 0.86) & (y < 1.225)
    side = np.abs(z) > 0.545 - 0.10 * height
    pillar = np.abs(x + 0.34 + 0.12 * height) < 0.05
    ends = np.abs(np.abs(x + 0.30 + 0.12 * height) - (0.80 - 0.16 * height)) < 0.045
    return window & ~(side & pillar) & ~((np.abs(z) > 0.40) & ends)


def wheel(mesh: Mesh, x: float, z: float) -> Mesh:
    """A mesh around the y axis turned to an axle along z; its upper side looks outwards."""
    out = 1.0 if z > 0.0 else -1.0
    return mesh.moved([[1.0, 0.0, 0.0, x], [0.0, 0.0, -out, AXLE], [0.0, out, 0.0, z]])


def scaled(mesh: Mesh, x: float, y: float, z: float, shift: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Mesh:
    return mesh.moved(np.column_stack([np.diag([x, y, z]), shift]))


def blob(center: tuple[float, float, float], radii: tuple[float, float, float]) -> Mesh:
    return scaled(superellipsoid(0.8, 0.8, 96, 192), *radii, shift=center)


def tyre() -> Mesh:
    return scaled(torus(0.26, 0.10), 1.0, 1.15, 1.0)


def arch() -> Mesh:
    """What is dark around a wheel."""
    return scaled(superellipsoid(0.2, 1.0), 0.43, 0.075, 0.43, (0.0, 0.0, 0.0))


def rim() -> Mesh:
    """A ring, a hub and five spokes."""
    spoke = scaled(superellipsoid(0.6, 0.6, 48, 96), 0.10, 0.02, 0.03, (0.12, 0.075, 0.0))
    turns = [2.0 * np.pi * k / 5.0 for k in range(5)]
    spokes = [spoke.moved([[np.cos(a), 0.0, np.sin(a), 0.0], [0.0, 1.0, 0.0, 0.0], [-np.sin(a), 0.0, np.cos(a), 0.0]]) for a in turns]
    hub = scaled(superellipsoid(0.7, 1.0, 48, 96), 0.055, 0.03, 0.055, (0.0, 0.08, 0.0))
    ring = torus(0.185, 0.02).moved([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.085], [0.0, 0.0, 1.0, 0.0]])
    return merged([ring, hub, *spokes])


def bumper(x: float) -> Mesh:
    return scaled(superellipsoid(1.0, 0.4, 96, 384), 0.10, 0.045, 0.70, (x, 0.36, 0.0))


def grille() -> Mesh:
    return scaled(superellipsoid(0.4, 0.4, 96, 192), 0.08, 0.07, 0.34, (1.90, 0.55, 0.0))


def mirrors() -> list[Mesh]:
    return [blob((0.40, 0.87, z), (0.06, 0.055, 0.13)) for z in (-0.70, 0.70)]
