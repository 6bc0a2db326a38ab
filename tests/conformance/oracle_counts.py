"""The recorded counts over scenes that the files do not hold: what was learned from them is asked of scenes of our own.

The rays there are random; which of them touch a silhouette is not repeated. What is repeated: no ray slips through, and a crossing away
from edges is one any-hit call. Repeated calls without REQUIRE_SINGLE are counted there and are none here.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from harness import Harness
from oracle_files import Probe
from shaders import crossings as shader

import optixc as ox

ROUND_CURVES = tuple(kind for kind in ox.PrimitiveType if kind.name.startswith("ROUND_"))
RAYS, SEGMENTS, SUBDIVISIONS = 4000, 8, 2
# The sphere of the recorded rays: near the origin, far from it, and small.
PLACES = ((0.0, 1.0), (1000.0, 1.0), (0.0, 1e-3))
INTERPRETED = 50
NAMED_BUILD = re.compile(r"ias_build_(?:instance_)?(mask|instanceId|sbtOffset|flags)_(0x[0-9a-fA-F]+|\d+)")
IAS_FIELDS = {"mask": "visibility_mask", "instanceId": "instance_id", "sbtOffset": "sbt_offset", "flags": "flags"}


def check_cracks(harness: Harness, probe: Probe) -> None:
    """No ray at the axis of a bent strand slips through its joints, for any round curve."""
    assert probe.data["misses"] == 0, "cracks were recorded: which strand has them is not known here"
    spread = np.linspace(0.0, 1.0, 3 * SEGMENTS + 1)
    points = np.stack([6.0 * spread, 0.4 * np.sin(9.0 * spread), 0.3 * np.cos(7.0 * spread)], 1).astype(np.float32)
    # Bezier segments go on smoothly where the end lies in the middle of its neighbours
    points[3:-1:3] = 0.5 * (points[2:-2:3] + points[4::3])
    for kind in ROUND_CURVES:
        count = 2 if "LINEAR" in kind.name else 3 if "QUADRATIC" in kind.name else 4
        firsts = np.arange(0, len(points) - count + 1, 3 if "BEZIER" in kind.name else 1, dtype=np.uint32)
        strand = ox.BuildInputCurves(kind, points, np.full(len(points), 0.2, np.float32), firsts)
        x = np.linspace(1.0, 5.0, _rays(harness))
        aimed = np.stack([x, np.interp(x, points[:, 0], points[:, 1]), np.full_like(x, 9.0)], 1)
        calls = _count(harness, strand, aimed, np.broadcast_to([0.0, 0.0, -1.0], aimed.shape))
        assert calls.min() > 0, f"{kind.name}: {np.count_nonzero(calls == 0)} of {len(x)} rays slip through"


def check_watertight(harness: Harness, probe: Probe) -> None:
    """No ray from inside slips through a vertex or an edge; away from them a closed mesh is met once from inside and twice from outside."""
    corners, faces = sphere(SUBDIVISIONS)
    rng = np.random.default_rng(5)
    for offset, size in PLACES:
        vertices = (corners * size + offset).astype(np.float32)
        picked = vertices[faces[rng.integers(0, len(faces), _rays(harness))]].astype(np.float64)
        aside = _unit(rng.normal(size=(len(picked), 3)))
        mesh = ox.BuildInputTriangles(vertices, faces, flags=ox.GeometryFlags.REQUIRE_SINGLE_ANYHIT_CALL)
        for weights in ((1.0, 0.0, 0.0), (0.3, 0.7, 0.0), (0.2, 0.5, 0.3)):
            aim = np.einsum("j,ijk->ik", weights, picked)
            inner = offset + 0.2 * size * aside
            calls = _count(harness, mesh, inner, aim - inner)
            assert calls.min() >= 1, (offset, size, weights, np.count_nonzero(calls == 0))
        assert set(np.unique(calls)) == {1}, (offset, size)
        outer = aim + 3.0 * (aim - offset)
        assert set(np.unique(_count(harness, mesh, outer, offset - outer))) == {2}, (offset, size)


def check_multiplicity(harness: Harness, probe: Probe) -> None:
    """Random rays through a mesh: with REQUIRE_SINGLE no repeated call there; here there is none in any case."""
    assert probe.data["duplicates"] <= probe.data["anyhit_calls"]
    corners, faces = sphere(SUBDIVISIONS)
    start = 3.0 * _unit(np.random.default_rng(6).normal(size=(_rays(harness), 3)))
    aim = 0.9 * np.random.default_rng(7).uniform(-0.5, 0.5, start.shape)
    calls = _count(harness, ox.BuildInputTriangles(corners.astype(np.float32), faces), start, aim - start)
    assert set(np.unique(calls)) == {2}


def check_grid(harness: Harness, probe: Probe) -> None:
    """Rays exactly at shared vertices and edges of a flat grid: never none. One call there; here each triangle of the edge may be met."""
    assert set(probe.data["anyhitCallHistogram"]) == {"1"}, "not one call for each ray: not understood"
    size = 8
    vertices = np.array([(x, y, 0) for y in range(size + 1) for x in range(size + 1)], np.float32)
    cells = [(y * (size + 1) + x, size + 1) for y in range(size) for x in range(size)]
    faces = np.array([(a, a + 1, a + row + 1) for a, row in cells] + [(a, a + row + 1, a + row) for a, row in cells], np.uint32)
    places = [(x + dx, y + dy, 1.0) for dx, dy in ((0, 0), (0.5, 0), (0, 0.5), (0.5, 0.5)) for x in range(1, size - 1)
              for y in range(1, size - 1)]
    calls = _count(harness, ox.BuildInputTriangles(vertices, faces), np.array(places), np.broadcast_to([0.0, 0.0, -1.0], (len(places), 3)))
    assert calls.min() >= 1


def check_micromap_order(harness: Harness, probe: Probe) -> None:
    """The corners of every micro-triangle of the recorded levels."""
    for level, recorded in enumerate(probe.data["levels"]):
        corners = ox.micromap_index_to_base_barycentrics(np.arange(len(recorded)), level)
        assert len(recorded) == 4**level
        assert np.concatenate(corners, axis=-1).reshape(-1, 6).tolist() == np.float32(recorded).tolist()


def check_instance_build(harness: Harness, probe: Probe) -> None:
    """What kills the build there is a named error here; what is ignored there is accepted."""
    found = NAMED_BUILD.match(probe.name)
    assert found is not None, f"which member of an instance {probe.name!r} sets is not known here"
    field, value = IAS_FIELDS[found.group(1)], int(found.group(2), 0)
    child = harness.context.accel_build([ox.BuildInputTriangles(np.eye(3, dtype=np.float32))])
    instance: dict[str, Any] = {field: value}

    def build() -> None:
        harness.context.accel_build([ox.BuildInputInstances([ox.Instance(child, np.eye(3, 4, dtype=np.float32), **instance)])])

    if "built" in str(probe.data["result"]):
        build()
        return
    try:
        build()
    except ox.OptixError as error:
        assert field.split("_")[0] in str(error)
        return
    raise AssertionError(f"{field} {value:#x} was accepted")


def check_compaction(harness: Harness, probe: Probe) -> None:
    """Compaction gives a new handle and no more bytes."""
    corners, faces = sphere(1)
    accel = harness.context.accel_build([ox.BuildInputTriangles(corners.astype(np.float32), faces)],
                                        build_flags=ox.BuildFlags.ALLOW_COMPACTION)
    before = accel.handle
    compact = accel.compact()
    assert (compact.handle != before) == probe.data["handleChanged"]
    assert probe.data["compactedSize"] <= probe.data["outputSize"]


def is_instance_build(probe: Probe) -> bool:
    """Whether the probe is the build of an instance with a member out of range."""
    return "result" in probe.data and NAMED_BUILD.match(probe.name) is not None


def sphere(subdivisions: int) -> tuple[np.ndarray, np.ndarray]:
    """An octahedron, refined onto the unit sphere: shared vertices, outside counter-clockwise."""
    corners = np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)], np.float64)
    faces = np.array([(a, b, c) if a % 2 == (b % 2) ^ (c % 2) else (a, c, b) for a in (0, 1) for b in (2, 3) for c in (4, 5)], np.uint32)
    for _ in range(subdivisions):
        triangles = corners[faces]
        middles = _unit(np.stack([triangles[:, i] + triangles[:, (i + 1) % 3] for i in range(3)], 1))
        ab, bc, ca = middles[:, 0], middles[:, 1], middles[:, 2]
        a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
        split = np.concatenate([np.stack(three, 1) for three in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
        corners, index = np.unique(split.reshape(-1, 3).round(12), axis=0, return_inverse=True)
        faces = index.reshape(-1, 3).astype(np.uint32)
    return corners, faces


def _unit(vectors: np.ndarray) -> np.ndarray:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))


def _rays(harness: Harness) -> int:
    return INTERPRETED if harness.mode == "interpreter" else RAYS


def _count(harness: Harness, built: Any, origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """The any-hit calls of each ray, all ignored."""
    module, create = harness.module("crossings.py"), harness.context.program_group_create
    if "crossings groups" not in harness.kept:
        harness.kept["crossings groups"] = (create(raygen=module["__raygen__lines"]), create(miss=None),
                                            create(anyhit=module["__anyhit__count"]))
    raygen, miss, hit = harness.kept["crossings groups"]
    pipeline = harness.pipeline("crossings", [raygen, miss, hit])
    table = ox.ShaderBindingTable(raygen=raygen.record(), miss=[miss.record()], hitgroup=[hit.record()])
    counts = np.zeros(len(origins), np.uint32)
    params = shader.Params(origins=_rows(origins), directions=_rows(directions), counts=counts,
                           scene=harness.context.accel_build([built]), length=1e5)
    harness.launch(pipeline, params, table, len(origins))
    return counts


def _rows(vectors: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(vectors, np.float32)
