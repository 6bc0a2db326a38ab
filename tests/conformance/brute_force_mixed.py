"""The reference of `brute_force` with boxes that are entered and left, and with round curves, in float64.

A round curve is met where the ray enters one of the spheres along it, at a parameter where that distance is least: linear segments have
round ends, the others are open. Segments stand alone: nothing is said about neighbours that hide each other's ends.
"""

from __future__ import annotations

from typing import Any

import brute_force
import numpy as np
from brute_force import Floats, Hit, Path
from brute_force_curves import BASES, LINEAR

ENTERED, LEFT = 1, 2
CURVE_KINDS = {LINEAR: 132, 0x2502: 130}
_PARAMETERS = np.linspace(0.0, 1.0, 401)
# A box or radius that is this much larger or smaller may not change what a ray meets, else binary32 and the solvers decide.
_MARGIN = 2e-3
# Where a ray meets the sphere at an open end within this much of its radius, nothing is said.
_END_MARGIN = 1.1


def candidates(scene: list[dict[str, Any]], given: dict[str, Any], scale: float = 1.0) -> list[Hit]:
    """Everything that the ray meets, nearest first, where radii are multiplied by `scale` and boxes grow as much."""
    found = []
    for item, path, ray, hits in brute_force.leaves(scaled(scene, scale), given):
        found += hits
        if item["type"] == "custom":
            found += _box_hits(item, path, ray)
        elif item["type"] == "curves":
            found += _curve_hits(item, path, ray)
    return sorted(found, key=lambda hit: hit.t)


def is_decided(scene: list[dict[str, Any]], given: dict[str, Any]) -> bool:
    """Whether slightly larger and smaller geometry is met alike, and no open end of a curve is near."""
    sets = [sorted((hit.t, *_name(hit)) for hit in candidates(scene, given, scale)) for scale in (1.0 - _MARGIN, 1.0, 1.0 + _MARGIN)]
    names = [sorted(name for _, *name in one) for one in sets]
    return names[0] == names[1] == names[2] and not _meets_an_end(scene, given)


def _name(hit: Hit) -> list[float]:
    return [hit.hit_kind, hit.primitive, hit.gas_index, hit.path.instance_id, hit.path.instance_index, *hit.path.to_world.ravel()]


def scaled(scene: list[dict[str, Any]], scale: float) -> list[dict[str, Any]]:
    """The scene with other radii and boxes."""
    if scale == 1.0:
        return scene
    made = []
    for node in scene:
        inputs = []
        for item in node.get("buildInputs", []):
            changed = dict(item)
            if "radii" in item:
                changed["radii"] = [[radius * scale for radius in key] for key in item["radii"]]
            if "aabbs" in item:
                by = np.array([[1.0 - scale], [scale - 1.0]])
                changed["aabbs"] = [(np.array(key).reshape(-1, 2, 3) + by).ravel().tolist() for key in item["aabbs"]]
            inputs.append(changed)
        made.append({**node, "buildInputs": inputs} if inputs else node)
    return made


def _box_hits(item: dict[str, Any], path: Path, ray: Any) -> list[Hit]:
    boxes = item["aabbs"].reshape(-1, 6)
    near, far = (boxes[:, :3] - ray.origin) / ray.direction, (boxes[:, 3:] - ray.origin) / ray.direction
    enter, leave = np.minimum(near, far).max(axis=1), np.maximum(near, far).min(axis=1)
    found = []
    for index in np.flatnonzero(enter <= leave):
        place = (brute_force.primitive(item, index), brute_force.record(item, index))
        found += [Hit(float(t), *place, kind, 0.0, 0.0, brute_force.flags(item, index), path)
                  for t, kind in ((enter[index], ENTERED), (leave[index], LEFT)) if ray.tmin <= t <= ray.tmax]
    return found


def _spheres_along(item: dict[str, Any]) -> Floats:
    """Centres and radii of the segments, of shape (segments, parameters, 4)."""
    basis = BASES[int(item["curveType"], 16)]
    table = np.column_stack([item["vertices"].reshape(-1, 3), item["radii"]])
    points = table[np.array(item["indices"])[:, None] + np.arange(basis.shape[1])]
    powers = _PARAMETERS[:, None] ** np.arange(len(basis))
    return np.einsum("up,pc,scx->sux", powers, basis, points)


def _entries(spheres: Floats, ray: Any, scale: float = 1.0) -> Floats:
    """Where the ray enters each sphere, infinite where it passes."""
    to_center = ray.origin - spheres[..., :3]
    a, b = ray.direction @ ray.direction, to_center @ ray.direction
    root = b * b - a * (np.sum(to_center * to_center, axis=-1) - (scale * spheres[..., 3]) ** 2)
    return np.where(root > 0.0, (-b - np.sqrt(np.maximum(root, 0.0))) / a, np.inf)


def _curve_hits(item: dict[str, Any], path: Path, ray: Any) -> list[Hit]:
    kind = int(item["curveType"], 16)
    entries = _entries(_spheres_along(item), ray)
    ends = np.full((len(entries), 1), np.inf)
    before, after = np.hstack([ends, entries[:, :-1]]), np.hstack([entries[:, 1:], ends])
    least = (entries < np.inf) & (entries < before) & (entries <= after)
    if kind != LINEAR:
        least[:, [0, -1]] = False
    return [Hit(float(entries[segment, place]), brute_force.primitive(item, segment), brute_force.record(item, segment), CURVE_KINDS[kind],
                float(_PARAMETERS[place]), 0.0, int(item["flags"][0]), path)
            for segment, place in np.argwhere(least) if ray.tmin < entries[segment, place] < ray.tmax]


def _meets_an_end(scene: list[dict[str, Any]], given: dict[str, Any]) -> bool:
    """Whether the ray meets the sphere at an open end of a curve, or begins inside of a curve."""
    for item, _, ray, _ in brute_force.leaves(scene, given):
        if item["type"] != "curves":
            continue
        spheres = _spheres_along(item)
        inside = np.linalg.norm(spheres[..., :3] - ray.origin, axis=-1) < _END_MARGIN * spheres[..., 3]
        met = _entries(spheres[:, [0, -1]], ray, _END_MARGIN) < np.inf
        if np.any(inside) or (int(item["curveType"], 16) != LINEAR and np.any(met)):
            return True
    return False


def in_order(hits: list[Hit], ray_flags: int) -> tuple[list[Hit], list[Hit]]:
    """What culling leaves, and of that what any-hit programs are called for."""
    seen = [hit for hit in hits if brute_force.visible(hit, ray_flags)]
    return seen, [hit for hit in seen if brute_force.anyhit_enabled(hit.geometry_flags, hit.path.flags, ray_flags)]

