"""The scenes of the benchmarks as numpy arrays: meshes with their cameras and lights from a folder, two scenes made by code.

The folder is that of the tests (OXRT_SCENES_DIR, default ../shared/scenes beside the project); nothing of it is part of the project.
"""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float32]
Uints = NDArray[np.uint32]

IMAGE_SIZE = 1024
MATERIALS = 8
GLASS, METAL, PAINT = range(3)


class SceneMissing(Exception):
    """The files of a scene are not on this machine."""


@dataclass(frozen=True)
class Camera:
    """A pinhole: `u`, `v`, `w` span the image plane of a square image."""

    eye: Floats
    u: Floats
    v: Floats
    w: Floats


@dataclass(frozen=True)
class Light:
    """A parallelogram that emits to the side of its unit normal; in Whitted's picture `corner` is a point light."""

    corner: Floats
    edge_u: Floats
    edge_v: Floats
    n: Floats
    radiance: Floats

    @property
    def area(self) -> float:
        return float(np.linalg.norm(np.cross(self.edge_u, self.edge_v)))

    @property
    def vertices(self) -> Floats:
        """Its four corners."""
        corners = [self.corner, self.corner + self.edge_u, self.corner + self.edge_u + self.edge_v, self.corner + self.edge_v]
        return np.array(corners, np.float32)


QUAD_TRIANGLES: Uints = np.array([[0, 1, 2], [0, 2, 3]], np.uint32)



@dataclass(frozen=True)
class Scene:
    """What kernels and shaders of all workloads read; the parts that a scene lacks are empty."""

    name: str
    camera: Camera
    light: Light
    sky: Floats
    offset: float
    radius: float = 0.0
    noise_scale: float = 0.0
    vertices: Floats = field(default_factory=lambda: np.zeros((0, 3), np.float32))
    triangles: Uints = field(default_factory=lambda: np.zeros((0, 3), np.uint32))
    normals: Floats = field(default_factory=lambda: np.zeros((0, 3), np.float32))
    uvs: Floats = field(default_factory=lambda: np.zeros((0, 2), np.float32))
    texels: NDArray[np.uint8] = field(default_factory=lambda: np.zeros((0, 0, 4), np.uint8))
    spheres: Floats = field(default_factory=lambda: np.zeros((0, 4), np.float32))
    points: Floats = field(default_factory=lambda: np.zeros((0, 4), np.float32))
    """x, y, z, radius: of curves, whose segments begin at `segments`, or of spheres."""
    segments: Uints = field(default_factory=lambda: np.zeros(0, np.uint32))
    floor_size: float = 0.0
    material_of: Uints = field(default_factory=lambda: np.zeros(0, np.uint32))
    colors: Floats = field(default_factory=lambda: np.zeros((MATERIALS, 3), np.float32))
    surfaces: Floats = field(default_factory=lambda: np.zeros((MATERIALS, 5), np.float32))
    """Per material: metallic, roughness, specular, sheen, clearcoat."""
    kinds: Uints = field(default_factory=lambda: np.zeros(MATERIALS, np.uint32))


def scenes_folder() -> Path:
    """Where the meshes are looked for."""
    default = Path(__file__).resolve().parents[2] / "shared" / "scenes"
    return Path(os.environ.get("OXRT_SCENES_DIR", default))


def _vector(values: object) -> Floats:
    return np.asarray(values, np.float32)


def _unit(v: Floats) -> Floats:
    return (v / np.linalg.norm(v)).astype(np.float32)


def pinhole(position: object, forward: object, up: object, vertical_fov_deg: float) -> Camera:
    """A camera of a square image that looks along `forward`."""
    w = _unit(_vector(forward))
    half = np.float32(np.tan(np.radians(vertical_fov_deg) / 2))
    u = _unit(np.cross(w, _vector(up)).astype(np.float32))
    v = np.cross(u, w).astype(np.float32)
    return Camera(_vector(position), half * u, half * v, w)


def vertex_normals(vertices: Floats, triangles: Uints) -> Floats:
    """Unit normals, the mean of the triangles about a vertex weighted by area."""
    corners = vertices[triangles].astype(np.float64)
    faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.zeros((len(vertices), 3))
    for corner in range(3):
        np.add.at(normals, triangles[:, corner], faces)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.where(lengths > 0, normals / np.where(lengths > 0, lengths, 1), [0.0, 1.0, 0.0]).astype(np.float32)


# Four paints, used by stretches of 64 triangles in turn, so that neighbouring rays meet different SBT records now and then.
_MATTE_COLORS = [(0.8, 0.78, 0.74), (0.7, 0.35, 0.3), (0.35, 0.55, 0.7), (0.6, 0.62, 0.4)]
_PRINCIPLED = [(0.0, 0.6, 0.5, 0.0, 0.0), (0.0, 0.3, 0.5, 0.3, 1.0), (0.6, 0.25, 0.5, 0.0, 0.2), (0.2, 0.8, 0.4, 0.8, 0.0)]


def mesh_scene(name: str, camera: int = 0, with_normals: bool = True) -> Scene:
    """A mesh with camera number `camera`, ambient-occlusion radius and light of benchmark_scenes.json."""
    folder = scenes_folder()
    table = folder / "benchmark_scenes.json"
    if not table.exists():
        raise SceneMissing(f"no {table}: set OXRT_SCENES_DIR to the folder of the benchmark scenes")
    entry = json.loads(table.read_text())[name]
    with np.load(folder / entry["file"]) as arrays:
        vertices = np.ascontiguousarray(arrays["vertices"], np.float32)
        triangles = np.ascontiguousarray(arrays["triangles"], np.uint32)
    extent = float(np.linalg.norm(vertices.max(0) - vertices.min(0)))
    light = entry["light"]
    edge_u, edge_v = _vector(light["edge_u"]), _vector(light["edge_v"])
    colors = np.zeros((MATERIALS, 3), np.float32)
    surfaces = np.zeros((MATERIALS, 5), np.float32)
    colors[:4] = _MATTE_COLORS
    surfaces[:4] = _PRINCIPLED
    return Scene(
        name=name,
        camera=pinhole(**entry["cameras"][camera]),
        light=Light(
            corner=_vector(_vector(light["center"]) - edge_u / 2 - edge_v / 2),
            edge_u=edge_u,
            edge_v=edge_v,
            n=_unit(_vector(light["normal"])),
            radiance=_vector(light["radiance"]),
        ),
        sky=_vector((0.3, 0.4, 0.5)),
        offset=1e-5 * extent,
        radius=float(entry["ao_radius"]),
        noise_scale=40.0 / extent,
        vertices=vertices,
        triangles=triangles,
        normals=vertex_normals(vertices, triangles) if with_normals else np.zeros((0, 3), np.float32),
        material_of=(np.arange(len(triangles), dtype=np.uint32) // 64) % 4,
        colors=colors,
        surfaces=surfaces,
    )


_NO_LIGHT = Light(*(np.zeros(3, np.float32) for _ in range(5)))


def sphere_scene() -> Scene:
    """256 spheres of glass, metal and paint on a grid above a checkered floor."""
    random = np.random.default_rng(7)
    grid = np.stack(np.meshgrid(np.arange(16), np.arange(16)), -1).reshape(-1, 2) - 7.5
    radii = random.uniform(0.25, 0.45, len(grid))
    centres = grid + random.uniform(-0.05, 0.05, grid.shape)
    spheres = np.stack([centres[:, 0], radii, centres[:, 1], radii], 1).astype(np.float32)
    kinds = np.array([GLASS, GLASS, METAL, METAL, PAINT, PAINT, PAINT, PAINT], np.uint32)
    colors = [(0.95, 0.97, 0.95), (0.9, 0.95, 1.0), (0.9, 0.8, 0.5), (0.85, 0.85, 0.9)]
    colors += [(0.8, 0.2, 0.2), (0.2, 0.6, 0.3), (0.25, 0.35, 0.8), (0.9, 0.9, 0.85)]
    light = Light(_vector((6.0, 12.0, 5.0)), *(np.zeros(3, np.float32) for _ in range(4)))
    return Scene(
        name="spheres",
        camera=pinhole((0.0, 4.0, 11.0), (0.0, -0.42, -1.0), (0.0, 1.0, 0.0), 50.0),
        light=light,
        sky=_vector((0.35, 0.55, 0.9)),
        offset=1e-3,
        spheres=spheres,
        floor_size=20.0,
        # the last material is the floor's
        material_of=random.integers(0, MATERIALS - 1, len(grid)).astype(np.uint32),
        colors=np.array(colors, np.float32),
        kinds=kinds,
    )


def _leaf_texture(size: int = 512) -> NDArray[np.uint8]:
    """A leaf with a stem, lobes and holes: about half of it is opaque."""
    y, x = np.mgrid[0:size, 0:size].astype(np.float64) / size * 2.0 - 1.0 + 1.0 / size
    angle, distance = np.arctan2(x, -y), np.hypot(x, y)
    outline = 0.62 + 0.2 * np.cos(7.0 * angle) * np.cos(angle / 2.0) + 0.1 * np.cos(2.0 * angle)
    inside = (distance < outline) | ((np.abs(x) < 0.03) & (y > 0.0))
    holes = np.hypot(np.mod(6.0 * x, 1.0) - 0.5, np.mod(6.0 * y, 1.0) - 0.5) < 0.18
    veins = 0.5 + 0.5 * np.cos(14.0 * angle + 9.0 * distance)
    rgba = np.zeros((size, size, 4), np.uint8)
    rgba[..., 0] = 60 + 70 * veins
    rgba[..., 1] = 110 + 90 * veins
    rgba[..., 2] = 30 + 25 * veins
    rgba[..., 3] = np.where(inside & ~holes, 255, 0)
    return rgba


def leaf_scene(count: int = 30000) -> Scene:
    """Leaves as quads with an alpha texture, in a crown of 2 x 2 x 2 units."""
    random = np.random.default_rng(11)
    centres = random.normal(size=(count, 3))
    centres *= (random.random(count) ** (1 / 3) / np.linalg.norm(centres, axis=1))[:, None]
    axes, _ = np.linalg.qr(random.normal(size=(count, 3, 3)))
    half = 0.03 * random.uniform(0.7, 1.3, (count, 1))
    u, v = axes[:, :, 0] * half, axes[:, :, 1] * half
    vertices = np.stack([centres - u - v, centres + u - v, centres + u + v, centres - u + v], 1).reshape(-1, 3)
    quads: Uints = np.arange(0, 4 * count, 4, dtype=np.uint32).reshape(count, 1, 1)
    triangles: Uints = np.add(quads, QUAD_TRIANGLES, dtype=np.uint32).reshape(-1, 3)
    return Scene(
        name="leaves",
        camera=pinhole((0.3, 0.2, 2.6), (-0.3, -0.2, -2.6), (0.0, 1.0, 0.0), 45.0),
        light=_NO_LIGHT,
        sky=_vector((0.5, 0.7, 1.0)),
        offset=1e-4,
        vertices=vertices.astype(np.float32),
        triangles=triangles,
        uvs=np.tile(np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32), (count, 1)),
        texels=_leaf_texture(),
    )


def hair_scene() -> Scene:
    """150,000 linear segments of straight hair, from behind."""
    path = scenes_folder() / "hair_straight.npz"
    if not path.is_file():
        raise SceneMissing(f"no {path}: set OXRT_SCENES_DIR to the folder of the benchmark scenes")
    with np.load(path) as arrays:
        radii = np.full((len(arrays["points"]), 1), float(arrays["thickness"]) / 2)
        points = np.concatenate([arrays["points"], radii], axis=1).astype(np.float32)
        firsts = arrays["first"][:, None] + np.arange(int(arrays["count"].max()) - 1)
    middle = (points[:, :3].max(0) + points[:, :3].min(0)) / 2
    camera = pinhole(middle + _vector((0.0, -150.0, 0.0)), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), 38.0)
    return Scene("hair", camera, _NO_LIGHT, _vector((0, 0, 0)), 0.0, points=points, segments=firsts.ravel().astype(np.uint32))


def point_scene(count: int = 100_000) -> Scene:
    """Spheres of unlike sizes in a cube of 2 x 2 x 2 units."""
    random = np.random.default_rng(17)
    radii = 0.002 + 0.012 * random.random((count, 1)) ** 3
    points = np.concatenate([random.uniform(-1.0, 1.0, (count, 3)), radii], axis=1).astype(np.float32)
    camera = pinhole((0.0, 0.0, 4.0), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0), 40.0)
    return Scene("points", camera, _NO_LIGHT, _vector((0, 0, 0)), 0.0, points=points)


SUN: Floats = _unit(_vector((0.5, 0.8, 0.4)))


def load_scene(name: str, camera: int = 0) -> Scene:
    """The scene of that name; raises SceneMissing where its files are absent."""
    match name:
        case "spheres":
            return sphere_scene()
        case "leaves":
            return leaf_scene()
        case "hair":
            return hair_scene()
        case "points":
            return point_scene()
        case _:
            return mesh_scene(name, camera)
