"""A ring of gold, a ball of glass and one of green glass on a floor before a wall, and a lamp. Made by code."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from shader import Kind

from optixc.stdlib.light import RectangleLight
from optixc.stdlib.shapes import Mesh, backdrop, rectangle, superellipsoid, surface

EYE = (0.3, 5.0, 6.6)
TARGET = (0.1, 0.42, -0.1)
VERTICAL_FOV = 33.0


@dataclass(frozen=True)
class Object:
    mesh: Mesh
    kind: Kind
    color: tuple[float, float, float]


def lamp() -> RectangleLight:
    """A small one, above and behind on the left, that shines at the middle of the floor."""
    center, half = np.array([-6.2, 4.6, -1.2]), 0.28
    inwards = np.array([0.3, 0.0, 0.6]) - center
    right = np.cross(inwards, [0.0, 1.0, 0.0])
    right *= 2.0 * half / np.linalg.norm(right)
    up = np.cross(right, inwards)
    up *= 2.0 * half / np.linalg.norm(up)
    return RectangleLight(corner=center - 0.5 * (right + up), edge_u=up, edge_v=right, radiance=(480.0, 450.0, 400.0))


def power(light: RectangleLight) -> np.ndarray:
    """Of a lamp that is as bright from everywhere: pi times area times radiance."""
    area = np.linalg.norm(np.cross(light.edge_u, light.edge_v))
    result: np.ndarray = np.pi * area * np.array(light.radiance)
    return result


def ring(radius: float, width: float, height: float) -> Mesh:
    """A band with round edges that stands on the floor."""
    around = np.linspace(-np.pi, np.pi, 721)[np.newaxis]
    across = np.linspace(np.pi, -np.pi, 97)[:, np.newaxis]
    out = 0.5 * width * np.sign(np.cos(across)) * np.abs(np.cos(across)) ** 0.3
    up = 0.5 * height * (1.0 + np.sign(np.sin(across)) * np.abs(np.sin(across)) ** 0.3) * np.ones_like(around)
    return surface(np.stack([(radius + out) * np.sin(around), up, (radius + out) * np.cos(around)], axis=-1))


def stands(mesh: Mesh, scale: float, x: float, y: float, z: float) -> Mesh:
    return mesh.moved(np.column_stack([scale * np.eye(3), [x, y, z]]))


def objects() -> list[Object]:
    """All that rays can hit."""
    light, ball = lamp(), superellipsoid(1.0, 1.0, 400, 800)
    cube = superellipsoid(0.3, 0.3, 400, 800)
    return [
        Object(backdrop(14.0, 12.0, -3.6, 1.5, 8.0), Kind.DIFFUSE, (0.72, 0.70, 0.66)),
        Object(stands(ring(1.05, 0.08, 0.42), 1.0, 1.2, 0.0, 0.95), Kind.METAL, (1.0, 0.78, 0.36)),
        Object(stands(ball, 0.85, -1.15, 0.8501, -0.45), Kind.GLASS, (1.0, 1.0, 1.0)),
        Object(stands(cube, 0.45, 0.95, 0.4501, -1.2), Kind.GLASS, (0.25, 0.85, 0.45)),
        Object(stands(ball, 0.5, -1.9, 0.5, 1.35), Kind.DIFFUSE, (0.70, 0.16, 0.12)),
        Object(rectangle(light.corner, light.edge_u, light.edge_v), Kind.LAMP, (0.0, 0.0, 0.0)),
    ]
