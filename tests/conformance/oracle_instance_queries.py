"""The recorded queries of instances by handle.

The scene of the queries was not recorded; it is made from the answers.
"""

from __future__ import annotations

import re
from typing import Any

from harness import Harness
from oracle_compare import close
from oracle_files import Probe, numbers
from oracle_instances import ask
from oracle_scene import build, handle_of

INSTANCE_OP, TYPE_OP, STATIC_OP = 1, 2, 9
OPS = (INSTANCE_OP, TYPE_OP, STATIC_OP)
QUERY_KEYS = {"q", "op", "type", "id", "child", "f"}
RANDOM_ACCESS = 32
TRIANGLE = {"type": "triangles", "vertices": [[0, 0, 0, 1, 0, 0, 0, 1, 0]], "flags": [0], "numSbtRecords": 1}
NAMED_INSTANCE = re.compile(r"(\w+)\[(\d+)\]")


def is_instance_query(probe: Probe) -> bool:
    """Whether the probe asks handles of instances and transforms for what they lead to."""
    return all(isinstance(query, dict) and set(query) == QUERY_KEYS and query["op"] in OPS for query in probe.data["queries"])


def check_instance_queries(harness: Harness, probe: Probe) -> None:
    """Types, ids, children, matrices and inverses are the recorded ones."""
    recorded = probe.data["queries"]
    made = build(harness.context, _scene(recorded))
    names = {handle_of(traversable): name for name, traversable in made.items()} | {0: "0x0"}
    answers, matrices = ask(harness, [_query(one["q"], made) for one in recorded])
    for row, one in enumerate(recorded):
        answer = answers[row]
        is_static = one["op"] == STATIC_OP
        child = names[int(answer["static_child"] if is_static else answer["child"])]
        assert child == one["child"], one
        if not is_static:
            assert (int(answer["type"]), int(answer["id"])) == (one["type"], one["id"]), one
        ours = matrices[row][24:] if is_static else matrices[row][:24]
        assert all(close(a, b, scale=1.0) for a, b in zip(ours.tolist(), numbers(one["f"]), strict=True)), one


def _query(name: str, made: dict[str, Any]) -> tuple[int, int | None]:
    found = NAMED_INSTANCE.fullmatch(name)
    if found is not None:
        return handle_of(made[found.group(1)]), int(found.group(2))
    return handle_of(made[name.split(":")[1]]), None


def _scene(recorded: list[dict[str, Any]]) -> list[dict[str, Any]]:
    instances: dict[str, list[dict[str, Any]]] = {}
    static: dict[str, Any] = {}
    for one in recorded:
        if one["op"] == INSTANCE_OP:
            found = NAMED_INSTANCE.fullmatch(one["q"])
            assert found is not None
            instances.setdefault(found.group(1), []).append(
                {"child": one["child"], "transform": one["f"][:12], "instanceId": one["id"], "sbtOffset": 0, "visibilityMask": 255,
                 "flags": 0})
        if one["op"] == STATIC_OP:
            static[one["q"].split(":")[1]] = {"kind": "static", "child": one["child"], "data": one["f"][:12]}
    nodes: list[dict[str, Any]] = [{"name": "G", "kind": "GAS", "buildFlags": 16, "buildInputs": [TRIANGLE]}]
    nodes.extend({"name": name, **node} for name, node in static.items())
    known = {node["name"] for node in nodes}
    missing = {item["child"] for items in instances.values() for item in items} - known - set(instances)
    waiting = {name: {"name": name, "kind": "IAS", "buildFlags": RANDOM_ACCESS, "instances": items} for name, items in instances.items()}
    while waiting:
        ready = [name for name, node in waiting.items() if all(item["child"] in known for item in node["instances"])]
        for name in ready:
            nodes.append(waiting.pop(name))
            known.add(name)
        if not ready:  # a static transform whose own members were not asked for: above the last structure that is there
            name = sorted(missing)[0]
            nodes.append({"name": name, "kind": "static", "child": nodes[-1]["name"], "data": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]})
            known.add(name)
            missing.discard(name)
    return nodes

