"""What the runner understands of a recorded probe: every key and every word that it may meet, level by level.

A record with something else in it is told as not understood, and fails: what nobody has thought of must not be taken for agreement.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from oracle_compare import BARYCENTRIC_KEYS, MATRIX_KEYS, NUMBER_KEYS, VECTOR_KEYS
from oracle_files import Probe

# Words about the record: who is asked, what it is called, what was learned.
ABOUT = frozenset({"name", "section", "notes", "void"})
TRACED = ABOUT | {"pipeline", "scene", "hitgroups", "miss", "rays"}
PIPELINE = frozenset({"usesMotionBlur", "traversableGraphFlags", "omm"})
NODE = frozenset({"name", "kind", "buildFlags", "emittedAabb"})
NODES = {"GAS": NODE | {"buildInputs", "motion"}, "IAS": NODE | {"instances", "motion"},
         "static": frozenset({"name", "kind", "child", "data"})}
NODES["matrixMotion"] = NODES["srtMotion"] = NODES["static"] | {"motion"}
MOTION = frozenset({"numKeys", "flags", "timeBegin", "timeEnd"})
RECORDS = frozenset({"type", "flags", "numSbtRecords", "sbtIndexOffset", "sbtIndexOffsetSizeInBytes", "sbtIndexOffsetStride",
                     "primitiveIndexOffset"})
INPUTS = {
    "triangles": RECORDS | {"vertices", "preTransform", "indices", "indexBytes", "omm", "vertexFormat", "rawBytes", "rawStride"},
    "custom": RECORDS | {"aabbs"},
    "spheres": RECORDS | {"vertices", "radii", "singleRadius"},
    "curves": RECORDS | {"vertices", "indices", "radii", "curveType", "endcapFlags", "normals"}}
MICROMAPS, MICROMAP = frozenset({"indexingMode", "index", "indexSize", "indexOffset", "maps"}), frozenset({"level", "format", "states"})
INSTANCE = frozenset({"child", "transform", "instanceId", "sbtOffset", "visibilityMask", "flags"})
HITGROUP, RECORD = frozenset({"kind", "ctype", "endcap", "ch", "ah", "data"}), frozenset({"id", "ahMode", "ahArg", "reports"})
HITGROUP_KINDS = frozenset({"tri", "custom", "sphere", "curve"})
MODES = range(8)
REPORT = frozenset({"t", "tPerPrim", "kind", "a"})
RAY = frozenset({"in", "returned", "p", "nev", "events"})
GIVEN = frozenset({"root", "o", "d", "tmin", "tmax", "time", "mask", "flags", "sbtOffset", "sbtStride", "missIdx", "tag", "p1", "p2",
                   "p3"})
EXACT = frozenset({"ev", "rec", "prim", "gasIdx", "instIdx", "instId", "hitKind", "ptype", "p", "front", "back", "transformList",
                   "gasHandle", "attr", "mask", "rayFlags", "kind", "ret", "p1"})
EVENT = EXACT | NUMBER_KEYS | VECTOR_KEYS | MATRIX_KEYS | BARYCENTRIC_KEYS
EVENTS = frozenset({"IS", "RP", "AH", "CH", "MS"})


def not_understood(probe: Probe) -> list[str]:
    """What a traced probe holds that the runner has no meaning for, one text each."""
    return list(dict.fromkeys(_strange(probe)))


def _strange(probe: Probe) -> Iterator[str]:
    data = probe.data
    yield from _keys("the probe", data, TRACED)
    yield from (f"the probe has no {key}" for key in ("pipeline", "scene", "hitgroups", "miss", "rays") if key not in data)
    yield from _keys("pipeline", data.get("pipeline", {}), PIPELINE)
    for node in probe.scene:
        yield from _node(node)
    for hit in data.get("hitgroups", []):
        yield from _keys("a hit group", hit, HITGROUP)
        yield from _word("kind of hit group", hit["kind"], HITGROUP_KINDS)
        yield from _record(hit["data"])
    for record in data.get("miss", []):
        yield from _record(record)
    for ray in probe.rays:
        yield from _keys("a ray", ray, RAY)
        yield from (f"a ray has no {key}" for key in RAY if key not in ray)
        yield from _keys("a ray's input", ray["in"], GIVEN)
        for event in ray.get("events", []):
            yield from _word("event", event["ev"], EVENTS)
            yield from _keys("an event", event, EVENT)


def _node(node: dict[str, Any]) -> Iterator[str]:
    yield from _word("kind of traversable", node["kind"], NODES)
    yield from _keys(f"a {node['kind']}", node, NODES.get(node["kind"], frozenset(node)))
    yield from _keys("motion", node.get("motion", {}), MOTION)
    for item in node.get("buildInputs", []):
        yield from _word("type of build input", item["type"], INPUTS)
        yield from _keys(f"a build input of {item['type']}", item, INPUTS.get(item["type"], frozenset(item)))
        yield from _keys("opacity micromaps", item.get("omm", {}), MICROMAPS)
        for one in item.get("omm", {}).get("maps", []):
            yield from _keys("an opacity micromap", one, MICROMAP)
    for instance in node.get("instances", []):
        yield from _keys("an instance", instance, INSTANCE)


def _record(record: dict[str, Any]) -> Iterator[str]:
    yield from _keys("a record", record, RECORD)
    yield from _word("ahMode", record["ahMode"], MODES)
    for report in record.get("reports", []):
        yield from _keys("a report", report, REPORT)


def _keys(what: str, given: dict[str, Any], known: frozenset[str]) -> Iterator[str]:
    yield from (f"{what} holds {key!r}, which is not known here" for key in given if key not in known)


def _word(what: str, given: Any, known: Any) -> Iterator[str]:
    if given not in known:
        yield f"the {what} {given!r} is not known here"
