"""The recorded queries of control points and ribbon normals by handle.

The scenes were not recorded: a strand is made from the control points in the answers, its ribbon normals by the notes of the group.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from harness import Harness
from oracle_compare import RIBBON_NORMAL as NORMAL_TOLERANCE
from oracle_files import Probe, numbers
from shaders import curve_access as shader

import optixc as ox

POINT_FLOATS, CUBIC_POINTS = 4, 4
RIBBON_KEYS = {"prim", "u", "v", "verts", "normal"}
Turn = Callable[[int], np.ndarray | None]


def is_curve_query(probe: Probe) -> bool:
    """Whether the probe asks for control points of cubic curves, or of ribbons with their normals."""
    query = probe.data["queries"][0]
    return set(query) == RIBBON_KEYS if isinstance(query, dict) else len(query) == CUBIC_POINTS * POINT_FLOATS


def check_curve_queries(harness: Harness, probe: Probe) -> None:
    """Control points exactly, normals within their rounding. Which normals the ribbon was built with was not recorded: one of the ways of
    the group's notes must explain every answer."""
    asked = [query if isinstance(query, dict) else {"prim": int(query[0]), "u": 0, "v": 0, "verts": query}
             for query in probe.data["queries"]]
    if "normal" not in asked[0]:
        _answers(harness, asked, None)
        return
    worst = {name: _answers(harness, asked, turn) for name, turn in TURNS.items()}
    assert min(worst.values()) < NORMAL_TOLERANCE, f"largest error of a normal: {worst}"


def _answers(harness: Harness, asked: list[dict[str, Any]], turn: Turn | None) -> float:
    """The largest error of a normal; the control points must be right."""
    ribbon = turn is not None
    gas = _strand(harness, asked, turn)
    module = harness.module("curve_access.py")
    raygen = harness.kept.setdefault("curve access", harness.context.program_group_create(raygen=module["__raygen__points"]))
    pipeline = harness.pipeline("curve access", [raygen])
    queries = np.zeros(len(asked), shader.Query.dtype)
    for row, query in zip(queries, asked, strict=True):
        row["gas"], row["primitive"], row["u"], row["v"], row["is_ribbon"] = int(gas.handle), query["prim"], query["u"], query["v"], ribbon
    points, normals = np.zeros((len(asked), 16), np.float32), np.zeros((len(asked), 3), np.float32)
    sbt = ox.ShaderBindingTable(raygen=raygen.record(), miss=[], hitgroup=[])
    harness.launch(pipeline, shader.Params(queries=queries, points=points, normals=normals), sbt, len(asked))
    for row, query in enumerate(asked):
        assert points[row, : len(query["verts"])].tolist() == np.float32(numbers(query["verts"])).tolist()
    return max((float(np.abs(normals[row] - numbers(query["normal"])).max()) for row, query in enumerate(asked) if ribbon), default=0.0)


def _along_z(count: int) -> np.ndarray:
    return np.tile(np.float32([0.0, 0.0, 1.0]), (count, 1))


def _turning(count: int) -> np.ndarray:
    return np.array([(0.0, -math.sin(0.3 * number), math.cos(0.3 * number)) for number in range(count)], np.float32)


# by the notes of the group: no normals, all along z, turning about x by 0.3 per vertex
TURNS: dict[str, Turn] = {"none": lambda count: None, "along z": _along_z, "turning": _turning}


def _strand(harness: Harness, asked: list[dict[str, Any]], turn: Turn | None) -> ox.Accel:
    """One strand through all control points of the answers, which begin at the one with the primitive's number."""
    known = {query["prim"] + i: point for query in asked
             for i, point in enumerate(np.reshape(np.float32(numbers(query["verts"])), (-1, POINT_FLOATS)))}
    table = np.array([known[number] for number in range(max(known) + 1)], np.float32)
    segments = len(table) - (2 if turn else 3)
    kind = ox.PrimitiveType.FLAT_QUADRATIC_BSPLINE if turn else ox.PrimitiveType.ROUND_CUBIC_BSPLINE
    normals = turn(len(table)) if turn else None
    points, radii = np.ascontiguousarray(table[:, :3]), np.ascontiguousarray(table[:, 3])
    curves = ox.BuildInputCurves(kind, points, radii, np.arange(segments, dtype=np.uint32), normals=normals)
    return harness.context.accel_build([curves], build_flags=ox.BuildFlags.ALLOW_RANDOM_VERTEX_ACCESS)
