"""The scene of example 05 rendered by plain Python in double precision, one ray at a time: no code in common with the shader."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

Vector = np.ndarray
NEAR = 1e-3


@dataclass(frozen=True)
class Hit:
    """The nearest surface along a ray: which object, its number within it, and the normal that points into the air."""

    t: float
    name: str
    number: int
    normal: Vector
    place: tuple[float, float] = (0.0, 0.0)


def unit(v: Vector) -> Vector:
    return v / np.linalg.norm(v)


def reflectance(cosine: float, ratio: float) -> float:
    """Fresnel's equations for unpolarised light; `ratio` is the far index over the near one."""
    sine = math.sqrt(max(0.0, 1.0 - cosine * cosine)) / ratio
    if sine >= 1.0:
        return 1.0
    other = math.sqrt(1.0 - sine * sine)
    across = (cosine - ratio * other) / (cosine + ratio * other)
    along = (ratio * cosine - other) / (ratio * cosine + other)
    return (across**2 + along**2) / 2.0


def schlick(base: Vector, cosine: float) -> Vector:
    return base + (1.0 - base) * (1.0 - cosine) ** 5


class Renderer:
    """The objects of the example's host program and its limits, in double precision."""

    def __init__(self, host: Any, shader: Any) -> None:
        floor, metal, glass, plastic = host.objects()
        self.host, self.shader = host, shader
        self.light, self.light_color, self.ambient = (
            np.array(value) for value in (host.LIGHT_POSITION, host.LIGHT_COLOR, host.AMBIENT_COLOR)
        )
        self.floor, self.glass = floor, glass
        self.metal_base = np.array(metal.reflectance, np.float64)
        self.tint = np.array(glass.tint, np.float64)
        self.index = float(glass.refractive_index)
        self.plastic_colors = np.array(plastic.colors, np.float64)
        balls = np.array(plastic.spheres, np.float64)
        rows = [(*metal.center, metal.radius), (*glass.center, glass.outer_radius), (*glass.center, glass.inner_radius)]
        self.spheres = np.concatenate([np.array(rows, np.float64), balls])

    def surfaces(self, origin: Vector, direction: Vector, nearest: float, farthest: float) -> list[Hit]:
        """Everything that the ray crosses, in no order."""
        away = origin - self.spheres[:, :3]
        a, b = direction @ direction, away @ direction
        c = (away * away).sum(axis=1) - self.spheres[:, 3] ** 2
        discriminant = b * b - a * c
        found = []
        for i in np.flatnonzero(discriminant >= 0.0):
            root = math.sqrt(discriminant[i])
            for t in ((-b[i] - root) / a, (-b[i] + root) / a):
                if nearest <= t <= farthest:
                    normal = unit(origin + t * direction - self.spheres[i, :3])
                    name = "metal" if i == 0 else "glass" if i < 3 else "plastic"
                    found.append(Hit(float(t), name, int(i) - 3, -normal if i == 2 else normal))
        edge_u, edge_v = np.array(self.floor.edge_u, np.float64), np.array(self.floor.edge_v, np.float64)
        if direction[1] != 0.0:
            t = (float(self.floor.anchor.y) - origin[1]) / direction[1]
            point = origin + t * direction - np.array(self.floor.anchor, np.float64)
            u, v = point @ edge_u / (edge_u @ edge_u), point @ edge_v / (edge_v @ edge_v)
            if nearest <= t <= farthest and 0.0 <= u <= 1.0 and 0.0 <= v <= 1.0:
                found.append(Hit(float(t), "floor", 0, np.array([0.0, 1.0, 0.0]), (u, v)))
        return found

    def through(self, point: Vector) -> Vector:
        """The share of the light that reaches a point."""
        direction = self.light - point
        share = np.ones(3)
        for hit in self.surfaces(point, direction, NEAR, 1.0):
            if hit.name != "glass":
                return np.zeros(3)
            share = share * self.tint * (1.0 - reflectance(abs(float(unit(direction) @ hit.normal)), self.index))
        return share

    def phong(self, point: Vector, d: Vector, n: Vector, color: Vector, shine: float, exponent: float) -> Vector:
        result = color * self.ambient
        to_light = unit(self.light - point)
        if n @ to_light > 0.0:
            highlight = shine * max(0.0, float(n @ unit(to_light - d))) ** exponent
            result = result + self.through(point) * self.light_color * (float(n @ to_light) * color + highlight)
        return result

    def bounce(self, point: Vector, direction: Vector, weight: Vector, importance: float, depth: int) -> Vector:
        importance *= float(weight.max())
        if importance < self.shader.MIN_IMPORTANCE or depth >= self.shader.MAX_DEPTH:
            return np.zeros(3)
        return weight * self.radiance(point, direction, NEAR, importance, depth + 1)

    def radiance(self, origin: Vector, direction: Vector, nearest: float = 0.0, importance: float = 1.0, depth: int = 0) -> Vector:
        """What comes back along a ray."""
        d = unit(direction)
        hits = self.surfaces(origin, direction, nearest, math.inf)
        if not hits:
            t = math.sqrt(max(d[1], 0.0))
            return (1.0 - t) * np.array([0.75, 0.85, 0.95]) + t * np.array([0.10, 0.25, 0.60])
        hit = min(hits, key=lambda one: one.t)
        point, cosine = origin + hit.t * direction, -float(d @ hit.normal)
        mirrored = d + 2.0 * cosine * hit.normal
        match hit.name:
            case "floor":
                even = sum(math.floor(x * float(self.floor.checks)) for x in hit.place) % 2 == 0
                color = self.floor.light_color if even else self.floor.dark_color
                return self.phong(point, d, hit.normal, np.array(color, np.float64), 0.0, 1.0)
            case "metal":
                local = self.phong(point, d, hit.normal, 0.1 * self.metal_base, 0.9, 180.0)
                return local + self.bounce(point, mirrored, schlick(self.metal_base, cosine), importance, depth)
            case "plastic":
                local = self.phong(point, d, hit.normal, self.plastic_colors[hit.number], 0.35, 60.0)
                return local + self.bounce(point, mirrored, schlick(np.full(3, 0.04), cosine), importance, depth)
        return self.glass_radiance(point, d, hit.normal, importance, depth)

    def glass_radiance(self, point: Vector, d: Vector, normal: Vector, importance: float, depth: int) -> Vector:
        entering = float(d @ normal) < 0.0
        n = normal if entering else -normal
        ratio = self.index if entering else 1.0 / self.index
        cosine = -float(d @ n)
        mirrored = reflectance(cosine, ratio)
        color = self.bounce(point, d + 2.0 * cosine * n, np.full(3, mirrored), importance, depth)
        # Snell: the part along the surface shrinks by the ratio of indices
        along = (d + cosine * n) / ratio
        if along @ along < 1.0:
            bent = along - math.sqrt(1.0 - along @ along) * n
            color = color + self.bounce(point, bent, (1.0 - mirrored) * self.tint, importance, depth)
        if entering:
            halfway = unit(unit(self.light - point) - d)
            color = color + 0.6 * max(0.0, float(n @ halfway)) ** 250.0 * self.light_color
        return color
