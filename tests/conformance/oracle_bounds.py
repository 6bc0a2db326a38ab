"""The recorded boxes of acceleration structures, compared with those that ours emit: close, and equal where the box is that of points."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from oracle_files import numbers

import optixc as ox

# Boxes there are grown by a few units in the last place of the largest coordinate.
PAD = 3e-6
# Boxes of curves are bounds of control points there and of the curve here, both grown by radii; in radii.
OF_CURVES = 1.25
# Instances that move, or of curves: both sides bound the body below in ways of their own; of the largest coordinate.
MOVING = 0.25
# Boxes beyond this are cut off there and here at different places.
FARTHEST = 1e12


def box_differences(nodes: list[dict[str, Any]], made: Mapping[str, Any]) -> list[str]:
    """What is wrong with the boxes of the structures of a scene, one text each."""
    inputs = [item for node in nodes for item in node.get("buildInputs", [])]
    is_blended = any("motion" in node for node in nodes) or any(item["type"] == "curves" for item in inputs)
    found = []
    for node in nodes:
        if "emittedAabb" not in node:
            continue
        recorded = np.reshape(numbers(node["emittedAabb"]), (-1, 2, 3))
        ours = made[node["name"]].emit_property(ox.AccelPropertyType.AABBS).astype(np.float64)
        if ours.shape != recorded.shape:
            found.append(f"{node['name']}: {len(ours)} boxes, recorded {len(recorded)}")
        elif _is_comparable(recorded):
            found.extend(_difference(node, is_blended, ours, recorded))
    return found


def _is_comparable(recorded: np.ndarray) -> bool:
    """Not of curves that move, whose boxes are garbage there, nor of nothing, nor of boxes without end."""
    is_box = np.all(recorded[:, 0] <= recorded[:, 1])
    return bool(np.all(np.isfinite(recorded)) and np.abs(recorded).max() < FARTHEST and is_box)


def _difference(node: dict[str, Any], is_blended: bool, ours: np.ndarray, recorded: np.ndarray) -> list[str]:
    size = float(np.abs(recorded).max())
    apart = float(np.abs(ours - recorded).max())
    radii = [abs(radius) for item in node.get("buildInputs", []) if item["type"] == "curves" for key in item["radii"]
             for radius in numbers(key)]
    pad = (MOVING if is_blended and node["kind"] == "IAS" else PAD) * size + OF_CURVES * max(radii, default=0.0)
    return [f"{node['name']}: box {ours.tolist()}, recorded {recorded.tolist()}"] if apart > pad else []
