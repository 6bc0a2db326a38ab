"""Curves by their definition, in float64: where a segment is, how thick and how bent, and whether a reported hit lies on it.

There is no search here: a hit is given with its segment and parameter, and is judged by the distance of its point from the axis.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import brute_force
import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

LINEAR, RIBBON = 0x2503, 0x2505
ROCAPS = (0x2508, 0x2509, 0x250A, 0x250B)
_QUADRATIC = np.array([[0.5, 0.5, 0.0], [-1.0, 1.0, 0.0], [0.5, -1.0, 0.5]])
_CUBIC = np.array([[1.0, 4.0, 1.0, 0.0], [-3.0, 0.0, 3.0, 0.0], [3.0, -6.0, 3.0, 0.0], [-1.0, 3.0, -3.0, 1.0]]) / 6.0
_CATMULL_ROM = np.array([[0.0, 2.0, 0.0, 0.0], [-1.0, 0.0, 1.0, 0.0], [2.0, -5.0, 4.0, -1.0], [-1.0, 3.0, -3.0, 1.0]]) / 2.0
_BEZIER = np.array([[1.0, 0.0, 0.0, 0.0], [-3.0, 3.0, 0.0, 0.0], [3.0, -6.0, 3.0, 0.0], [-1.0, 3.0, -3.0, 1.0]])
_LINE = np.array([[1.0, 0.0], [-1.0, 1.0]])
BASES = {
    0x2501: _QUADRATIC,
    0x2502: _CUBIC,
    LINEAR: _LINE,
    0x2504: _CATMULL_ROM,
    RIBBON: _QUADRATIC,
    0x2507: _BEZIER,
    0x2508: _QUADRATIC,
    0x2509: _CUBIC,
    0x250A: _CATMULL_ROM,
    0x250B: _BEZIER,
}
# The recorded hits lie on the curve at their parameter within 1.2e-4 at radii up to 0.5; ours within rounding of t.
ON_SURFACE = 1e-3
# The sine of the angle between a ray and a straight strand that it runs along.
NEARLY = 2e-5


@dataclass(frozen=True)
class Segment:
    """A segment at the ray's time, with the ray in its space."""

    curve_type: int
    terms: Floats  # of the powers of u; columns x, y, z, radius
    points: Floats
    origin: Floats
    direction: Floats

    def at(self, u: float) -> Floats:
        """Axis and radius."""
        return np.asarray(np.array([u**k for k in range(len(self.terms))]) @ self.terms)

    def slope(self, u: float) -> Floats:
        """The derivative of axis and radius."""
        return np.asarray(np.array([k * u ** max(k - 1, 0) for k in range(len(self.terms))]) @ self.terms)

    def is_too_thick(self, u: float) -> bool:
        """Whether the radius is half of the axis' radius of curvature or more, or grows faster than the axis goes on."""
        radius = self.at(u)[3]
        tangent, bend = self.slope(u)[:3], np.array([k * (k - 1) * u ** max(k - 2, 0) for k in range(len(self.terms))]) @ self.terms[:, :3]
        speed = float(np.linalg.norm(tangent))
        if speed == 0.0 or abs(self.slope(u)[3]) >= speed:
            return True
        curvature = float(np.linalg.norm(np.cross(tangent, bend))) / speed**3
        return bool(curvature * radius >= 0.5)

    def is_thick(self) -> bool:
        """Whether it is too thick anywhere."""
        return any(self.is_too_thick(float(u)) for u in np.linspace(0.0, 1.0, 33))

    def holds(self, point: Floats) -> bool:
        """Whether a point lies inside of the spheres along the segment, by more than rounding."""
        axes = np.array([self.at(float(u)) for u in np.linspace(0.0, 1.0, 257)])
        return bool(np.any(np.linalg.norm(axes[:, :3] - point, axis=1) < axes[:, 3] - 1e-4))

    def distance(self, point: Floats) -> float:
        """How far a point lies outside of the spheres along the segment; below zero inside."""
        axes = np.array([self.at(float(u)) for u in np.linspace(0.0, 1.0, 1025)])
        return float((np.linalg.norm(axes[:, :3] - point, axis=1) - axes[:, 3]).min())

    def is_parallel(self) -> bool:
        """Whether the control points lie on a line that the ray is parallel to, or nearly."""
        steps = np.diff(self.points, axis=0)
        direction = self.direction / np.linalg.norm(self.direction)
        return all(float(np.linalg.norm(np.cross(step, direction))) < NEARLY * max(1e-30, float(np.linalg.norm(step))) for step in steps)

    def is_straight(self) -> bool:
        """Whether the control points lie on a line."""
        steps = np.diff(self.points, axis=0)
        return all(float(np.linalg.norm(np.cross(step, steps[0]))) < 1e-6 for step in steps)


def segments(scene: list[dict[str, Any]], given: dict[str, Any], primitive: int) -> list[Segment]:
    """The curve segments with this primitive index under the root."""
    found = []
    for item, _, ray, _ in brute_force.leaves(scene, given):
        index = primitive - int(item.get("primitiveIndexOffset", 0))
        if item["type"] == "curves" and 0 <= index < len(item["indices"]):
            kind = int(item["curveType"], 16)
            basis = BASES[kind]
            first = int(item["indices"][index])
            points = item["vertices"].reshape(-1, 3)[first : first + basis.shape[1]]
            radii = item["radii"][first : first + basis.shape[1]]
            found.append(Segment(kind, basis @ np.column_stack([points, radii]), points, ray.origin, ray.direction))
    return found


def is_on_curve(scene: list[dict[str, Any]], given: dict[str, Any], event: dict[str, Any]) -> bool:
    """Whether the hit of an event lies on the tube, or on a disc at its end; a hit of another kind of primitive does not."""
    if "u" not in event:
        return False
    for segment in segments(scene, given, event["prim"]):
        u, t = float(event["u"]), float(event["tmax"])
        point, axis = segment.origin + t * segment.direction, segment.at(u)
        away = point - axis[:3]
        distance = float(np.linalg.norm(away))
        size = max(1.0, float(np.abs(segment.points).max()))
        if segment.curve_type == RIBBON:
            return distance <= axis[3] * (1 + ON_SURFACE)
        if abs(distance - axis[3]) <= ON_SURFACE * size:
            return True
        across = segment.slope(u)[:3]
        flat = abs(float(away @ across)) <= 0.1 * float(np.linalg.norm(across))
        if u in (0.0, 1.0) and flat and distance <= axis[3] * (1 + ON_SURFACE):
            return True
    return False


def is_inside(scene: list[dict[str, Any]], given: dict[str, Any], event: dict[str, Any]) -> bool:
    """Whether the hit of an event, or the ray's origin, lies inside of some curve of the scene."""
    count = max((len(item["indices"]) for node in scene for item in node.get("buildInputs", []) if item["type"] == "curves"), default=0)
    t = float(event["tmax"])
    found = [segment for primitive in range(count) for segment in segments(scene, given, primitive)]
    return any(segment.holds(segment.origin + t * segment.direction) or segment.holds(segment.origin) for segment in found)


def grazes(segment: Segment) -> bool:
    """Whether the ray touches the sphere at the beginning or the end of a linear segment within rounding."""
    for u in (0.0, 1.0):
        x, y, z, radius = segment.at(u)
        away = np.array([x, y, z]) - segment.origin
        along = float(away @ segment.direction) / float(segment.direction @ segment.direction)
        distance = float(np.linalg.norm(away - along * segment.direction))
        if math.isclose(distance, radius, rel_tol=1e-5):
            return True
    return False
