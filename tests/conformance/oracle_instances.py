"""Handles of instances and transforms: what they lead to, and their names in recorded transform lists."""

from __future__ import annotations

from typing import Any

import numpy as np
from harness import Harness
from oracle_scene import handle_of
from shaders import random_instances as shader

import optixc as ox

# Names are looked up for scenes of at most this many instances.
MANY = 64


def ask(harness: Harness, queries: list[tuple[int, int | None]]) -> tuple[np.ndarray, np.ndarray]:
    """Answers and matrices for handles; with a number, of that instance of an IAS."""
    module = harness.module("random_instances.py")
    raygen = harness.kept.setdefault("random instances", harness.context.program_group_create(raygen=module["__raygen__ask"]))
    pipeline = harness.pipeline("random instances", [raygen])
    rows = np.zeros(len(queries), shader.Query.dtype)
    for row, (handle, index) in zip(rows, queries, strict=True):
        row["handle"], row["is_instance"], row["index"] = handle, index is not None, index or 0
    answers, matrices = np.zeros(len(queries), shader.Answer.dtype), np.zeros((len(queries), 48), np.float32)
    params = shader.Params(queries=rows, answers=answers, matrices=matrices)
    sbt = ox.ShaderBindingTable(raygen=raygen.record(), miss=[], hitgroup=[])
    harness.launch(pipeline, params, sbt, len(queries))
    return answers, matrices


def instance_names(harness: Harness, nodes: list[dict[str, Any]], scene: dict[str, Any]) -> dict[int, str]:
    """The handle of every instance with its name in the files: that of the IAS and the index."""
    places = [(node["name"], index) for node in nodes for index in range(len(node.get("instances", [])))]
    if not 0 < len(places) <= MANY:
        return {}
    answers, _ = ask(harness, [(handle_of(scene[name]), index) for name, index in places])
    return {int(answer["handle"]): f"{name}[{index}]" for answer, (name, index) in zip(answers, places, strict=True)}
