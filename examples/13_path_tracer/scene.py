"""The garage: cars, floor, lamp and sky, as arrays and materials. No file is read."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import car
import numpy as np
from shader import LAMP_INSTANCE

from optixc.stdlib.camera import ThinLens
from optixc.stdlib.environment import EnvironmentMap, environment_map
from optixc.stdlib.light import RectangleLight
from optixc.stdlib.principled import Principled
from optixc.stdlib.shapes import Mesh, rectangle

sys.path.append(str(Path(__file__).resolve().parents[1]))
from rendering import pinhole

EYE = (5.4, 1.55, 5.3)
TARGET = (0.45, 0.50, -0.55)
VERTICAL_FOV = 27.0
APERTURE = 0.035


@dataclass(frozen=True)
class Object:
    """A mesh with a material, at a place (3 x 4)."""

    mesh: Mesh
    material: Principled
    place: np.ndarray
    instance_id: int = 0


def material(
    color: tuple[float, float, float], *, metallic: float = 0.0, roughness: float = 0.5, specular: float = 0.5, coat: float = 0.0
) -> Principled:
    """A principled material whose coat is smooth."""
    return Principled(color, metallic, roughness, specular, 0.0, coat, 0.03)


COMMON = {
    "glass": material((0.008, 0.010, 0.012), roughness=0.05, coat=1.0),
    "rubber": material((0.018, 0.018, 0.019), roughness=0.55),
    "chrome": material((0.86, 0.87, 0.88), metallic=1.0, roughness=0.09),
    "black": material((0.010, 0.010, 0.011), roughness=0.6, specular=0.2),
    "lamp": material((0.80, 0.80, 0.78), metallic=0.85, roughness=0.12, coat=1.0),
    "tail": material((0.55, 0.015, 0.012), roughness=0.2, coat=1.0),
}
CREAM = material((0.82, 0.80, 0.76), roughness=0.4, coat=1.0)
AMBER = material((0.85, 0.55, 0.10), roughness=0.4, coat=1.0)
# Paint, stripes, and where: x, z and degrees
CARS = [
    (material((0.55, 0.012, 0.016), metallic=0.45, roughness=0.32, coat=1.0), CREAM, (0.0, 0.3, 4.0)),
    (material((0.012, 0.10, 0.32), metallic=0.55, roughness=0.34, coat=1.0), AMBER, (-3.7, -0.7, -12.0)),
    (material((0.02, 0.16, 0.085), metallic=0.45, roughness=0.34, coat=1.0), CREAM, (1.0, -3.5, 16.0)),
]


def placed(x: float, z: float, turn: float) -> np.ndarray:
    """Turned about the y axis (degrees), then moved on the floor."""
    a = np.radians(turn)
    return np.array([[np.cos(a), 0.0, np.sin(a), x], [0.0, 1.0, 0.0, 0.0], [-np.sin(a), 0.0, np.cos(a), z]])


def lamp() -> RectangleLight:
    """A long box of light above the cars; it shines down."""
    return RectangleLight(corner=(-2.6, 4.2, -2.2), edge_u=(5.4, 0.0, 0.0), edge_v=(0.0, 0.0, 2.4), radiance=(11.0, 10.4, 9.6))


def objects() -> list[Object]:
    """All that rays can hit."""
    light = lamp()
    floor = material((0.13, 0.125, 0.12), roughness=0.30, specular=0.4)
    still = placed(0.0, 0.0, 0.0)
    made = [
        Object(rectangle((-500.0, 0.0, 500.0), (1000.0, 0.0, 0.0), (0.0, 0.0, -1000.0)), floor, still),
        Object(rectangle(light.corner, light.edge_u, light.edge_v), COMMON["black"], still, LAMP_INSTANCE),
    ]
    parts = car.car()
    for paint, stripe, place in CARS:
        materials = {**COMMON, "paint": paint, "stripe": stripe}
        made += [Object(mesh, materials[name], placed(*place)) for name, mesh in parts.items()]
    return made


def sky(width: int = 256) -> EnvironmentMap:
    """An evening: warm at the horizon, blue above, a low sun behind thin clouds."""
    rows, columns = np.meshgrid((np.arange(width // 2) + 0.5) / (width // 2), (np.arange(width) + 0.5) / width, indexing="ij")
    phi, theta = (2.0 * columns - 1.0) * np.pi, rows * np.pi
    direction = np.stack([np.sin(theta) * np.sin(phi), np.cos(theta), -np.sin(theta) * np.cos(phi)], axis=-1)
    up = np.clip(direction[..., 1:2], 0.0, 1.0)
    warm, blue = np.array([0.95, 0.52, 0.28]), np.array([0.10, 0.20, 0.42])
    color = blue + (warm - blue) * np.exp(-7.0 * up)
    sun = np.array([-0.80, 0.16, 0.30])
    cosine = np.clip(direction @ (sun / np.linalg.norm(sun)), 0.0, 1.0)[..., np.newaxis]
    color = color + np.array([26.0, 15.0, 7.0]) * cosine**900 + np.array([1.2, 0.6, 0.25]) * cosine**24
    return environment_map(np.where(direction[..., 1:2] > 0.0, color, np.array([0.05, 0.045, 0.04])))


def camera(aspect: float) -> ThinLens:
    """In focus at the target."""
    view = pinhole(EYE, TARGET, VERTICAL_FOV, aspect)
    lens_u, lens_v = (APERTURE * np.asarray(half) / np.linalg.norm(half) for half in (view.u, view.v))
    return ThinLens(view.eye, view.u, view.v, view.w, lens_u, lens_v)
