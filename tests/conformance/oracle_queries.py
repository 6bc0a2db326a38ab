"""The recorded queries of vertices by handle.

Where the scene was not recorded it is made from the answers: the triangles of every SBT index in the order of their primitives.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from harness import Harness
from oracle_compare import close
from oracle_files import Probe, number, numbers
from oracle_not_copied import query_not_copied
from oracle_scene import build, handle_of
from shaders import random_access as shader

import optixc as ox

CORNER_NUMBERS = 9
VERTICES_OP, MOTION_OP = 4, 0
QUERY_KEYS = frozenset({"op", "time", "f", "u0", "verts", "prim", "primIdx", "sbtGASIndex"})
RANDOM_ACCESS = ox.BuildFlags.ALLOW_RANDOM_VERTEX_ACCESS


def is_triangle_query(probe: Probe) -> bool:
    """Whether the probe asks for the corners of triangles."""
    query = probe.data["queries"][0]
    if not isinstance(query, dict):
        return len(query) == CORNER_NUMBERS
    answer = query.get("verts", query.get("f", []))
    return set(query) <= QUERY_KEYS and len(answer) == CORNER_NUMBERS and query.get("op", VERTICES_OP) in (VERTICES_OP, MOTION_OP)


def moves(probe: Probe) -> bool:
    """Whether the queries are about a moving structure."""
    return isinstance(probe.data["queries"][0], dict) and "time" in probe.data["queries"][0]


def check_triangle_queries(harness: Harness, probe: Probe) -> None:
    """Corners and motion options by handle are the recorded ones."""
    asked = [_normal_form(index, query) for index, query in enumerate(probe.data["queries"])]
    gas = _scene(harness, probe, asked)
    corners, motion = _run(harness, handle_of(gas), asked, moves(probe))
    for row, (_, gas_index, _, answer, motion_answer) in enumerate(asked):
        if reason := query_not_copied(probe, gas_index):
            print(f"{probe.id}: query {row} not copied: {reason}")
        elif motion_answer is not None:
            assert motion[row] == motion_answer
        elif all(np.isfinite(answer)):  # the answer for a NaN vertex is garbage there
            assert all(close(a, b) for a, b in zip(corners[row], answer, strict=True)), (probe.data["queries"][row], corners[row])


def _normal_form(index: int, query: Any) -> tuple[int, int, float, list[float], list[float] | None]:
    """Primitive, SBT index, time, corners, and motion options where those were asked for."""
    if not isinstance(query, dict):
        return index, 0, 0.0, numbers(query), None
    answer = numbers(query.get("verts", query.get("f")))
    motion = [*answer[:2], float(query["u0"])] if query.get("op") == MOTION_OP else None
    return query.get("primIdx", query.get("prim", 0)), query.get("sbtGASIndex", 0), number(query.get("time", 0)), answer, motion


def _scene(harness: Harness, probe: Probe, asked: list[Any]) -> Any:
    if probe.scene:
        return next(iter(build(harness.context, probe.scene).values()))
    if moves(probe):
        begin, end, count = next((motion for *_, motion in asked if motion is not None), (0.0, 1.0, 2.0))
        keys = [_corners_at(asked, begin + (end - begin) * key / (count - 1.0)) for key in range(int(count))]
        return harness.context.accel_build([ox.BuildInputTriangles(keys)], build_flags=RANDOM_ACCESS,
                                           motion_options=ox.MotionOptions(len(keys), begin, end))
    records = sorted({gas_index for _, gas_index, *_ in asked})
    inputs = [ox.BuildInputTriangles(np.array([answer for _, index, _, answer, _ in asked if index == record], np.float32).reshape(-1, 3))
              for record in records]
    return harness.context.accel_build(inputs, build_flags=RANDOM_ACCESS)


def _corners_at(asked: list[Any], time: float) -> np.ndarray:
    """The corners of the moving triangle at the time of one of its keys, which must have been asked for."""
    answer = next(answer for _, _, when, answer, motion in asked if motion is None and when == time)
    return np.array(answer, np.float32).reshape(-1, 3)


def _run(harness: Harness, handle: int, asked: list[Any], motion: bool) -> tuple[list[list[float]], list[list[float]]]:
    module = harness.module("random_access.py")
    raygen = harness.context.program_group_create(raygen=module["__raygen__corners"])
    pipeline = harness.pipeline(("random access", motion), [raygen], options=ox.PipelineCompileOptions(uses_motion_blur=motion))
    queries = np.zeros(len(asked), shader.Query.dtype)
    for row, (primitive, gas_index, time, _, _) in zip(queries, asked, strict=True):
        row["gas"], row["primitive"], row["gas_index"], row["time"] = handle, primitive, gas_index, time
    corners, options = np.zeros((len(asked), CORNER_NUMBERS), np.float32), np.zeros((len(asked), 3), np.float32)
    sbt = ox.ShaderBindingTable(raygen=raygen.record(), miss=[], hitgroup=[])
    harness.launch(pipeline, shader.Params(queries=queries, corners=corners, motion=options), sbt, len(asked))
    return corners.tolist(), options.tolist()
