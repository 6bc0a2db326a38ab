"""Area Q: compaction and relocation of every kind of geometry, and the properties that a structure emits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from harness import Harness
from oracle_scene import build
from scenes import CORNER, boxes, closest, gas, hitgroup, ias, instance, missed, ray, reported, trace, translation, triangles
from test_curves import BEZIER, CUBIC, CUBIC_ROCAPS, LINEAR, QUADRATIC, RIBBON, curves
from test_micromaps import mapped

import optixc as ox

COMPACT, UPDATE = ox.BuildFlags.ALLOW_COMPACTION, ox.BuildFlags.ALLOW_UPDATE
STRAND = ((0, 0, 0), (0.5, 0.1, 0), (1, 0, 0.2), (1.5, 0.2, 0), (2, 0, 0), (2.5, 0, 0))
AWAY, RAISED, MOTION, SHIFT = np.array([(0.3, 0.2, 3.0), (0, 0, 0.1), (1, 0, 2), (0, 7, 0)])
ACROSS = np.tile(np.float32([0, 0, 1]), (len(STRAND), 1)).ravel().tolist()


def spheres(*radii: float) -> dict[str, Any]:
    """Spheres in a row."""
    centers = [(float(number), 0.0, 0.0) for number in range(len(radii))]
    return {"type": "spheres", "vertices": [np.ravel(centers).tolist()], "radii": [list(radii)], "flags": [0], "numSbtRecords": 1}


INPUTS = {
    "triangles": (triangles(CORNER), "tri"),
    "micromaps": (mapped((0, 1, 2, 3), 1), "tri"),
    "custom": (boxes([(0, 0, 0, 1, 1, 1), (2, 0, 0, 3, 1, 1)]), "custom"),
    "spheres": (spheres(0.4, 0.2, 0.3), "sphere"),
    "linear": (curves(LINEAR, STRAND, 0.1, (0, 1, 3)), "curve"),
    "quadratic with caps": (curves(QUADRATIC, STRAND, 0.1, (0, 1, 2, 3), caps=1), "curve"),
    "cubic": (curves(CUBIC, STRAND, 0.1, (0, 1, 2)), "curve"),
    "bezier": (curves(BEZIER, STRAND, 0.1, (0, 2)), "curve"),
    "rocaps": (curves(CUBIC_ROCAPS, STRAND, 0.1, (0, 1, 2), caps=1), "curve"),
    "ribbon": (curves(RIBBON, STRAND, 0.1, (0, 1, 2, 3)), "curve"),
    "ribbon with normals": (curves(RIBBON, STRAND, 0.1, (0, 1, 2, 3), normals=[ACROSS]), "curve"),
}


def hits(harness: Harness, accel: ox.Accel, kind: str) -> list[tuple[int, float, float, float] | None]:
    """Primitive, distance and parameters along rays all over the structure; None for misses."""
    random = np.random.default_rng(240)
    ends = random.uniform((-0.3, -0.3, -0.2), (2.8, 0.4, 0.4), (80, 3))
    rays = [ray(end + AWAY, -AWAY, root="it") for end in ends]
    groups = [hitgroup(kind=kind, reports=[reported(1.0)] if kind == "custom" else ())]
    found = trace(harness, [], rays, groups, micromaps=True, made={"it": accel})
    events = [None if missed(result) else closest(result) for result in found]
    assert sum(event is not None for event in events) > 2
    return [event and (event["prim"], event["tmax"], event.get("u", 0.0), event.get("v", 0.0)) for event in events]


def made(harness: Harness, item: dict[str, Any], flags: int) -> ox.Accel:
    """A structure of one input."""
    accel = build(harness.context, [gas(item, build_flags=flags)])["gas"]
    assert isinstance(accel, ox.Accel)
    return accel


@pytest.mark.parametrize("name", INPUTS)
@pytest.mark.parametrize("flags", [COMPACT, COMPACT | UPDATE], ids=["static", "updatable"])
@pytest.mark.parametrize("way", ["compact", "relocate"])
def test_T240_T243_copies_are_hit_alike(harness: Harness, name: str, flags: int, way: str) -> None:
    item, kind = INPUTS[name]
    accel = made(harness, item, flags)
    before = hits(harness, accel, kind)
    copy = getattr(accel, way)()
    assert copy.handle != accel.handle
    accel.destroy()
    assert hits(harness, copy, kind) == before
    assert hits(harness, getattr(copy, way)(), kind) == before


@pytest.mark.parametrize("name", [name for name in INPUTS if name != "micromaps"])
def test_T242_copies_are_updated_on_their_own(harness: Harness, name: str) -> None:
    item, kind = INPUTS[name]
    accel = made(harness, item, COMPACT | UPDATE)
    before = hits(harness, accel, kind)
    copy = accel.compact()
    key = "aabbs" if kind == "custom" else "vertices"
    moved = {**item, key: [(np.reshape(item[key][0], (-1, 3)) + RAISED).ravel().tolist()]}
    copy.update(packed(moved))
    assert hits(harness, accel, kind) == before
    assert hits(harness, copy, kind) == hits(harness, made(harness, moved, UPDATE), kind)


def packed(item: dict[str, Any]) -> list[ox.BuildInput]:
    """The build input of a description."""
    match item["type"]:
        case "triangles":
            return [ox.BuildInputTriangles(np.reshape(np.float32(item["vertices"][0]), (-1, 3)))]
        case "custom":
            return [ox.BuildInputCustomPrimitives(np.reshape(np.float32(item["aabbs"][0]), (-1, 6)))]
        case "spheres":
            return [ox.BuildInputSpheres(np.reshape(np.float32(item["vertices"][0]), (-1, 3)), np.float32(item["radii"][0]))]
    normals = np.reshape(np.float32(item["normals"][0]), (-1, 3)) if "normals" in item else None
    points = np.reshape(np.float32(item["vertices"][0]), (-1, 3))
    radii, indices, caps = np.float32(item["radii"][0]), np.uint32(item["indices"]), item["endcapFlags"]
    return [ox.BuildInputCurves(int(item["curveType"], 16), points, radii, indices, normals=normals, endcap_flags=caps)]


def test_copies_hold_their_micromaps_when_the_array_is_gone(harness: Harness) -> None:
    array = harness.context.opacity_micromap_array_build([ox.OpacityMicromap(np.uint8([0, 1, 1, 1]), 1, 1)])
    inputs = [ox.BuildInputTriangles(np.float32(CORNER), opacity_micromap=ox.BuildInputOpacityMicromap(array))]
    accel = harness.context.accel_build(inputs, build_flags=COMPACT | UPDATE)
    before = hits(harness, accel, "tri")
    copy = accel.compact()
    accel.destroy()
    del accel, array, inputs
    assert hits(harness, copy, "tri") == before


def test_copies_know_their_records(harness: Harness) -> None:
    accel = harness.context.accel_build([ox.BuildInputSpheres(np.zeros((1, 3), np.float32), np.float32([1]))], build_flags=COMPACT)
    top = harness.context.accel_build([ox.BuildInputInstances([accel, accel], sbt_offsets=3)])
    other = accel.compact()
    assert (other.parts, top.relocate().parts) == (accel.parts, top.parts)
    assert [part.traversable for part in top.relocate([other, accel]).parts] == [other, accel]


def test_relocation_needs_a_list(harness: Harness) -> None:
    accel = harness.context.accel_build([ox.BuildInputTriangles(np.float32(CORNER))])
    top = harness.context.accel_build([ox.BuildInputInstances([accel])])
    with pytest.raises(ox.InvalidValueError, match="list of children"):
        top.relocate(accel)
    with pytest.raises(ox.InvalidValueError, match="relocate takes an accel"):
        top.relocate(["x"])


def test_T240_the_size_of_a_copy_is_told_before(harness: Harness) -> None:
    # Recorded: 15_api_errors emit_compacted_without_flag.
    item, _ = INPUTS["triangles"]
    with pytest.raises(ox.InvalidValueError, match="ALLOW_COMPACTION"):
        made(harness, item, 0).emit_property(ox.AccelPropertyType.COMPACTED_SIZE)
    accel = made(harness, item, COMPACT)
    size = accel.emit_property(ox.AccelPropertyType.COMPACTED_SIZE)
    assert 0 < accel.compact().memory_usage <= size <= accel.memory_usage


@pytest.mark.parametrize(("item", "low", "high"), [
    (triangles(CORNER), (0, 0, 0), (1, 1, 0)),
    (boxes([(0, 0, 0, 1, 1, 1), (2, 0, 0, 3, 1, 1), (9, 9, 9, 8, 8, 8)]), (0, 0, 0), (3, 1, 1)),
    (spheres(0.5, -0.25), (-0.5, -0.5, -0.5), (1.25, 0.5, 0.5)),
    (curves(LINEAR, ((0, 0, 0), (1, 0, 0)), 0.25), (-0.25, -0.25, -0.25), (1.25, 0.25, 0.25)),
])
def test_T114_boxes_of_each_motion_key(harness: Harness, item: dict[str, Any], low: Any, high: Any) -> None:
    key = "aabbs" if item["type"] == "custom" else "vertices"
    at_rest = made(harness, item, 0)
    expected = np.float32([low, high])
    assert at_rest.emit_property(ox.AccelPropertyType.AABBS)[0] == pytest.approx(expected, abs=1e-6)
    keys = [(np.reshape(item[key][0], (-1, 3)) + step * MOTION).ravel().tolist() for step in range(3)]
    radii = {"radii": item["radii"] * 3} if "radii" in item else {}
    motion = {"motion": {"numKeys": 3, "flags": 0, "timeBegin": 0.0, "timeEnd": 1.0}}
    scene = [{**gas({**item, key: keys, **radii}), **motion}, {**ias(instance(transform=translation(*SHIFT))), **motion}]
    accel, top = build(harness.context, scene).values()
    found = accel.emit_property(ox.AccelPropertyType.AABBS)
    assert found == pytest.approx(np.array([expected + step * MOTION for step in range(3)]), abs=1e-6, rel=1e-6)
    above = top.emit_property(ox.AccelPropertyType.AABBS)
    assert above.shape == (3, 2, 3)
    assert (above[:, 0] <= found[:, 0] + SHIFT).all()
    assert (above[:, 1] >= found[:, 1] + SHIFT).all()


def test_nothing_has_an_inverted_box(harness: Harness) -> None:
    accel = harness.context.accel_build([ox.BuildInputTriangles(np.full((3, 3), np.nan, np.float32))])
    low, high = accel.emit_property(ox.AccelPropertyType.AABBS)[0]
    assert (low > high).all()
    with pytest.raises(ox.InvalidValueError, match="COMPACTED_SIZE, AABBS"):
        accel.emit_property(3)
