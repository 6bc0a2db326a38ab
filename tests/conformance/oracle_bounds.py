"""The recorded boxes of acceleration structures, compared with those that ours emit: close, and equal where the box is that of points."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import brute_force
import numpy as np
from oracle_files import numbers

import optixc as ox

# Boxes there are grown by a few units in the last place of the largest coordinate.
PAD = 3e-6
# Boxes of curves are bounds of control points there and of the curve here, both grown by radii; in radii.
OF_CURVES = 1.25
# Instances that move, turn, or hold curves: both sides bound the body below in ways of their own; of the largest coordinate.
MOVING = 0.25
# Boxes beyond this are cut off there and here at different places.
FARTHEST = 1e12


def box_differences(nodes: list[dict[str, Any]], made: Mapping[str, Any]) -> list[str]:
    """What is wrong with the boxes of the structures of a scene, one text each."""
    inputs = [item for node in nodes for item in node.get("buildInputs", [])]
    turned = any(_turns(instance["transform"]) for node in nodes for instance in node.get("instances", []))
    is_blended = turned or any("motion" in node for node in nodes) or any(item["type"] == "curves" for item in inputs)
    found = []
    for node in nodes:
        if "emittedAabb" not in node:
            continue
        recorded = np.reshape(numbers(node["emittedAabb"]), (-1, 2, 3))
        ours = made[node["name"]].emit_property(ox.AccelPropertyType.AABBS).astype(np.float64)
        if ours.shape != recorded.shape:
            found.append(f"{node['name']}: {len(ours)} boxes, recorded {len(recorded)}")
        elif _is_comparable(recorded) and not _bounds_its_moments(nodes, node, ours, recorded):
            found.extend(_difference(node, is_blended, ours, recorded))
    return found


def _bounds_its_moments(nodes: list[dict[str, Any]], node: dict[str, Any], ours: np.ndarray, recorded: np.ndarray) -> bool:
    """Whether each box of instances that move bounds what is below at its key's time, ours closely. The recorded ones also hold between
    the keys when they are blended, which makes them wider where something below turns."""
    motion = node.get("motion", {})
    if node["kind"] != "IAS" or motion.get("numKeys", 0) < 2:
        return False
    for time, own, other in zip(np.linspace(motion["timeBegin"], motion["timeEnd"], motion["numKeys"]), ours, recorded, strict=True):
        below = _below_at(nodes, node["name"], float(time))
        if below is None:
            return False
        low, high = below
        pad = PAD * float(np.abs(recorded).max())
        beyond = MOVING * float(np.linalg.norm(high - low))
        if not all(np.all(box[0] <= low + pad) and np.all(box[1] >= high - pad) for box in (own, other)):
            return False
        if np.any(own[0] < low - beyond) or np.any(own[1] > high + beyond):
            return False
    return True


def _below_at(nodes: list[dict[str, Any]], root: str, time: float) -> tuple[np.ndarray, np.ndarray] | None:
    """The exact box around everything under a root at a time; None where nothing is there, or curves, whose boxes are not known."""
    given = {"root": root, "o": [0, 0, 0], "d": [0, 0, 1], "tmin": 0, "tmax": 0, "time": time, "mask": 255}
    boxes = []
    for item, path, _, _ in brute_force.leaves(nodes, given):
        matrix = path.to_world
        if item["type"] == "curves":
            return None
        if item["type"] == "custom":
            corners = item["aabbs"].reshape(-1, 2, 3)
            points = np.array([[box[i, 0], box[j, 1], box[k, 2]] for box in corners for i in (0, 1) for j in (0, 1) for k in (0, 1)])
        else:
            points = item["vertices"].reshape(-1, 3)
        centers = points @ matrix[:, :3].T + matrix[:, 3]
        radii = np.broadcast_to(np.abs(item.get("radii", 0.0)), len(points))[:, None] * np.linalg.norm(matrix[:, :3], axis=1)
        boxes += [(centers - radii).min(axis=0), (centers + radii).max(axis=0)]
    return (np.min(boxes, axis=0), np.max(boxes, axis=0)) if boxes else None


def _turns(transform: list[Any]) -> bool:
    """Whether boxes along the axes become boxes that are not: the matrix mixes axes."""
    matrix = np.reshape(numbers(transform), (3, 4))[:, :3]
    return bool((np.count_nonzero(matrix, axis=1) > 1).any())


def _is_comparable(recorded: np.ndarray) -> bool:
    """Not of curves that move, whose boxes are garbage there, nor of nothing, nor of boxes without end."""
    is_box = np.all(recorded[:, 0] <= recorded[:, 1])
    return bool(np.all(np.isfinite(recorded)) and np.abs(recorded).max() < FARTHEST and is_box)


def _difference(node: dict[str, Any], is_blended: bool, ours: np.ndarray, recorded: np.ndarray) -> list[str]:
    size = float(np.abs(recorded).max())
    apart = float(np.abs(ours - recorded).max())
    radii = [abs(radius) for item in node.get("buildInputs", []) if item["type"] == "curves" for key in item["radii"]
             for radius in numbers(key)]
    # Of turned instances each side bounds what lies below as well as it can, there more closely.
    inside = bool(np.all(ours[:, 0] <= recorded[:, 0] + PAD * size) and np.all(ours[:, 1] >= recorded[:, 1] - PAD * size))
    if is_blended and node["kind"] == "IAS" and inside:
        return []
    pad = (MOVING if is_blended and node["kind"] == "IAS" else PAD) * size + OF_CURVES * max(radii, default=0.0)
    return [f"{node['name']}: box {ours.tolist()}, recorded {recorded.tolist()}"] if apart > pad else []
