"""The recorded queries of control points and ribbon normals by handle.

The scenes were not recorded: a strand is made from the control points in the answers, its ribbon normals by the notes of the group.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from harness import Harness
from oracle_files import Probe, numbers
from shaders import curve_access as shader

import optixc as ox

POINT_FLOATS, CUBIC_POINTS = 4, 4
# by the notes of the group: no normals, all along z, turning about x by 0.3 per vertex
TURN = {"normals1": 0.0, "normals2": 0.3}
# A recorded normal holds a finite difference: its part that grows with v is off by 1e-4 of itself.
NORMAL_TOLERANCE = 2e-4


def is_curve_query(probe: Probe) -> bool:
    """Whether the probe asks for control points of cubic curves or of ribbons whose orientation is known."""
    query = probe.data["queries"][0]
    if isinstance(query, dict):
        return "normal" in query and any(probe.name.endswith(name) for name in TURN)
    return len(query) == CUBIC_POINTS * POINT_FLOATS


def check_curve_queries(harness: Harness, probe: Probe) -> None:
    """Control points exactly, normals within their rounding."""
    asked = [query if isinstance(query, dict) else {"prim": int(query[0]), "u": 0, "v": 0, "verts": query}
             for query in probe.data["queries"]]
    ribbon = "normal" in asked[0]
    gas = _strand(harness, probe, asked, ribbon)
    module = harness.module("curve_access.py")
    raygen = harness.context.program_group_create(raygen=module["__raygen__points"])
    pipeline = harness.pipeline("curve access", [raygen])
    queries = np.zeros(len(asked), shader.Query.dtype)
    for row, query in zip(queries, asked, strict=True):
        row["gas"], row["primitive"], row["u"], row["v"], row["is_ribbon"] = int(gas.handle), query["prim"], query["u"], query["v"], ribbon
    points, normals = np.zeros((len(asked), 16), np.float32), np.zeros((len(asked), 3), np.float32)
    sbt = ox.ShaderBindingTable(raygen=raygen.record(), miss=[], hitgroup=[])
    harness.launch(pipeline, shader.Params(queries=queries, points=points, normals=normals), sbt, len(asked))
    for row, query in enumerate(asked):
        assert points[row, : len(query["verts"])].tolist() == np.float32(numbers(query["verts"])).tolist()
        if ribbon:
            assert np.allclose(normals[row], numbers(query["normal"]), rtol=0, atol=NORMAL_TOLERANCE), (query, normals[row])


def _strand(harness: Harness, probe: Probe, asked: list[dict[str, Any]], ribbon: bool) -> ox.Accel:
    """One strand through all control points of the answers, which begin at the one with the primitive's number."""
    known = {query["prim"] + i: point for query in asked
             for i, point in enumerate(np.reshape(np.float32(numbers(query["verts"])), (-1, POINT_FLOATS)))}
    table = np.array([known[number] for number in range(max(known) + 1)], np.float32)
    segments = len(table) - (2 if ribbon else 3)
    kind = ox.PrimitiveType.FLAT_QUADRATIC_BSPLINE if ribbon else ox.PrimitiveType.ROUND_CUBIC_BSPLINE
    normals = None
    if ribbon:
        angles = [next(turn for name, turn in TURN.items() if probe.name.endswith(name)) * number for number in range(len(table))]
        normals = np.array([(0.0, -math.sin(angle), math.cos(angle)) for angle in angles], np.float32)
    points, radii = np.ascontiguousarray(table[:, :3]), np.ascontiguousarray(table[:, 3])
    curves = ox.BuildInputCurves(kind, points, radii, np.arange(segments, dtype=np.uint32), normals=normals)
    return harness.context.accel_build([curves], build_flags=ox.BuildFlags.ALLOW_RANDOM_VERTEX_ACCESS)
