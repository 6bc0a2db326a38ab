"""Where a ray meets a strand of a curve, in float64 and without search structures: all roots of the polynomial that the definition gives.

Swept circles (the default round curves): the hit lies in the plane across the axis at u and one radius away from it, a polynomial of
degree 10 in u. Swept spheres (rocaps, linear curves): the entry distance has a minimum over u, the same degree. Ends: open, flat discs, or
round for linear curves. `Margin` shifts radius and ends, so that a test can ask for hits that are certain and for hits that are possible.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from brute_force_curves import BASES, LINEAR, RIBBON, ROCAPS
from numpy.polynomial import polynomial
from numpy.typing import NDArray

Floats = NDArray[np.float64]
SWEPT_CIRCLES = tuple(kind for kind in BASES if kind not in (LINEAR, RIBBON, *ROCAPS))
STEPS = {0x2507: 3, 0x250B: 3}
NEWTON_STEPS = 4
# A root's imaginary part, and the derivative of the axis along the ray, that are zero but for rounding.
REAL, ACROSS = 1e-5, 1e-9


@dataclass(frozen=True)
class Margin:
    """By how much the radius is grown, relative to it, and the ends moved outwards, in the parameter."""

    radius: float = 0.0
    end: float = 0.0


EXACT = Margin()


@dataclass(frozen=True)
class CurveHit:
    """One hit where the ray enters: distance, segment, parameter, the point's way from the axis, the surface normal."""

    t: float
    segment: int
    u: float
    normal: Floats


@dataclass(frozen=True)
class Strand:
    """Control points x, y, z, radius of one strand."""

    kind: int
    points: Floats
    caps: bool = False

    @property
    def firsts(self) -> list[int]:
        """The first control point of each segment."""
        count = BASES[self.kind].shape[1]
        return list(range(0, len(self.points) - count + 1, STEPS.get(self.kind, 1)))

    def terms(self, segment: int) -> Floats:
        """The segment as a polynomial: rows of the powers of u, columns x, y, z, radius."""
        basis = BASES[self.kind]
        first = self.firsts[segment]
        return np.asarray(basis @ self.points[first : first + basis.shape[1]])


def strand_hits(strand: Strand, origin: Floats, direction: Floats, margin: Margin = EXACT) -> list[CurveHit]:
    """Every place where the ray enters the strand, nearest first. Segments of linear curves cover each other: with a margin below zero
    places that may be covered are left out."""
    hits: list[CurveHit] = []
    last = len(strand.firsts) - 1
    length = float(np.linalg.norm(direction))
    for segment in range(last + 1):
        terms = strand.terms(segment)
        # from the point of the ray beside the segment: differences of large numbers would cost digits
        shift = float((terms[:, :3].sum(axis=0) - origin) @ direction) / length**2
        local = terms.copy()
        local[0, :3] -= origin + shift * direction
        local[:, 3] *= 1.0 + margin.radius
        low, high = (-margin.end if segment == 0 else 0.0), (1.0 + margin.end if segment == last else 1.0)
        find = _circle_roots if strand.kind in SWEPT_CIRCLES else _sphere_roots
        ray = direction / length
        found = find(local, ray, low, high)
        if strand.kind == LINEAR:
            found += [hit for end in (0.0, 1.0) if (hit := _entry(local, ray, end)) is not None]
            found = [min(found)] if found else []
        hits += [CurveHit(shift + t / length, segment, u, _normal(strand.kind, local, u, t * ray)) for t, u in found]
        if strand.caps and strand.kind != LINEAR:
            hits += [CurveHit(shift + t / length, segment, u, outward) for end, u in ((0, 0.0), (last, 1.0)) if end == segment
                     for t, outward in _cap(local, ray, u)]
    if strand.kind == LINEAR and margin.radius < 0.0:
        hits = [hit for hit in hits if not _is_covered(strand, hit, origin + hit.t * direction, 1.0 - 8.0 * margin.radius)]
    return sorted(hits, key=lambda hit: hit.t)


def _is_covered(strand: Strand, hit: CurveHit, point: Floats, factor: float) -> bool:
    """Whether a point lies inside of another segment, whose radii are grown by a factor."""
    for segment in range(len(strand.firsts)):
        (x, y, z, radius), slope = strand.terms(segment)
        axis, growth, start = slope[:3], slope[3] * factor, point - np.array([x, y, z])
        length = float(np.linalg.norm(axis))
        along = float(start @ axis) / length
        aside = float(np.sqrt(max(0.0, float(start @ start) - along * along)))
        lean = aside * growth / np.sqrt(max(1e-30, length**2 - growth**2))
        u = min(max((along + lean) / length, 0.0), 1.0)
        if segment != hit.segment and float(np.linalg.norm(start - u * axis)) < radius * factor + u * growth:
            return True
    return False


def _at(terms: Floats, u: float) -> Floats:
    return np.asarray(polynomial.polyval(u, terms))


def _dot(a: list[Floats], b: list[Floats]) -> Floats:
    total = polynomial.polymul(a[0], b[0])
    for x, y in zip(a[1:], b[1:], strict=True):
        total = polynomial.polyadd(total, polynomial.polymul(x, y))
    return np.asarray(total)


def _roots(condition: Floats, low: float, high: float) -> list[float]:
    """Real roots between two places, made exact by Newton's steps."""
    scale = np.abs(condition).max()
    if scale == 0.0:
        return []
    trimmed = polynomial.polytrim(condition / scale, 1e-14)
    found = polynomial.polyroots(trimmed)
    slope = polynomial.polyder(trimmed)
    result = []
    for root in found[np.abs(found.imag) < REAL].real:
        u = float(root)
        for _ in range(NEWTON_STEPS):
            incline = float(polynomial.polyval(u, slope))
            if incline != 0.0:
                step = float(polynomial.polyval(u, trimmed)) / incline
                u -= step if abs(step) < 1e-3 else 0.0
        if low <= u <= high:
            result.append(u)
    return result


def _circle_roots(terms: Floats, ray: Floats, low: float, high: float) -> list[tuple[float, float]]:
    axis = [terms[:, i] for i in range(3)]
    tangent = [np.asarray(polynomial.polyder(x)) for x in axis]
    along = _dot([np.array([x]) for x in ray], tangent)
    reach = _dot(axis, tangent)
    away = [polynomial.polysub(polynomial.polymul(reach, [x]), polynomial.polymul(along, c)) for x, c in zip(ray, axis, strict=True)]
    thick = polynomial.polymul(terms[:, 3], along)
    condition = polynomial.polysub(_dot(away, away), polynomial.polymul(thick, thick))
    found = []
    for u in _roots(np.asarray(condition), low, high):
        slope = float(polynomial.polyval(u, along))
        if abs(slope) > ACROSS * float(np.linalg.norm(_at(terms[:, :3], 1.0) - _at(terms[:, :3], 0.0))):
            t = float(polynomial.polyval(u, reach)) / slope
            if ray @ _normal(SWEPT_CIRCLES[0], terms, u, t * ray) < 0.0:
                found.append((t, u))
    return found


def _sphere_roots(terms: Floats, ray: Floats, low: float, high: float) -> list[tuple[float, float]]:
    z = terms[:, :3] @ ray
    across = [terms[:, i] - z * ray[i] for i in range(3)]
    depth = polynomial.polysub(polynomial.polymul(terms[:, 3], terms[:, 3]), _dot(across, across))
    half, forward = 0.5 * np.asarray(polynomial.polyder(depth)), np.asarray(polynomial.polyder(z))
    condition = polynomial.polysub(polynomial.polymul(polynomial.polymul(forward, forward), depth), polynomial.polymul(half, half))
    found = []
    for u in _roots(np.asarray(condition), low, high):
        here = _entry(terms, ray, u)
        beside = [_entry(terms, ray, u + step) for step in (-1e-4, 1e-4)]
        if here is not None and all(other is None or other[0] >= here[0] - 1e-12 for other in beside):
            found.append(here)
    return found


def _entry(terms: Floats, ray: Floats, u: float) -> tuple[float, float] | None:
    """Where the ray enters the sphere at u."""
    x, y, z, radius = _at(terms, u)
    center = np.array([x, y, z])
    forward = float(center @ ray)
    depth = radius * radius - float(np.sum((center - forward * ray) ** 2))
    return (forward - float(np.sqrt(depth)), u) if depth > 0.0 else None


def _normal(kind: int, terms: Floats, u: float, point: Floats) -> Floats:
    """The outward normal of the swept surface at a point of it, of length 1."""
    away = point - _at(terms[:, :3], u)
    if kind in SWEPT_CIRCLES:
        slope, bend = _at(polynomial.polyder(terms), u), _at(polynomial.polyder(terms[:, :3], 2), u)
        tangent, outwards = slope[:3], away / np.linalg.norm(away)
        away = outwards - tangent * slope[3] / float(tangent @ tangent - away @ bend)
    return np.asarray(away / np.linalg.norm(away))


def _cap(terms: Floats, ray: Floats, u: float) -> list[tuple[float, Floats]]:
    center, slope = _at(terms, u), _at(polynomial.polyder(terms[:, :3]), u)
    outward = slope / np.linalg.norm(slope) * (1.0 if u else -1.0)
    cosine = float(ray @ outward)
    if cosine >= 0.0:
        return []
    t = float(center[:3] @ outward) / cosine
    return [(t, outward)] if float(np.linalg.norm(t * ray - center[:3])) <= center[3] else []
