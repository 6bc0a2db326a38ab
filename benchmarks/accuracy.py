"""Writes docs/accuracy.md: how far hits are from the exact ones, for each kind of primitive, near and far; and what robust scenes cost.

    python -m benchmarks.accuracy [FILE]

Each ray is compared with the same ray in float64: the numbers of the ray and of the primitive are exact in float32 on both sides, so the
whole difference is the traversal's. Rays aim at places well inside of the primitive or well beside it; nothing depends on a limit case.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import optixc as ox
from benchmarks.machine import describe
from benchmarks.measure import Clock, LaunchContender, interleave
from benchmarks.ours import shader_module

sys.path.append(str(Path(__file__).resolve().parents[1] / "tests" / "conformance"))

from curve_reference import Strand, strand_hits
from oracle_counts import sphere

Floats = NDArray[np.float64]
DISTANCES = (3.0, 1e2, 1e4, 1e6)
RAYS = 1500
# Rays that aim here (of the distance from the middle to the outline) hit, and here miss.
INSIDE, OUTSIDE = 0.9, 1.1
NOT_ROBUST = 65536
MESH_DIVISIONS, MESH_RAYS, ROUNDS = 6, 1 << 18, 7
BEND = np.array([(0.0, 0.0, 0.0), (1.0, 0.3, 0.0), (2.0, 0.0, 0.3), (3.0, 0.2, 0.0)])
STRAIGHT = np.outer(np.arange(4.0), [1.0, 0.0, 0.0])
RADIUS = 0.1

HEAD = """# Accuracy of hits

Made by `python -m benchmarks.accuracy`; do not edit. {rays} rays in each row, against the same rays in float64; numbers are the worst
of all rays, in brackets the median. A primitive has a size of 1 (triangles: edges of 1, spheres: radius 1, strands: segments of 1 and
radius {radius}) and lies up to 1 from the origin of the coordinates; the ray begins at the distance of the column.

- **t**: error of the distance, relative to it. Where a ray grazes, the outline's error turns into more along the ray.
- **wrong**: hits where there is none and the reverse. Rays aim at 90 % of the size and less, or at 110 % and more; from 1e6 away the
  rounding of their directions brings some of them to the outline itself.
- **normal**: angle to the exact normal at the exact hit, in radians. **u**: error of the parameter (barycentrics, curve parameter).

Triangles, spheres and linear curves are Embree's, whose differences of coordinates have 24 bits: what is left of a primitive seen from
1e6 times its size is a few percent. Curves of the other bases, rocaps and ribbons are moved to the ray's near point first.

{machine}
"""
TAIL = """
## Robust scenes

Structures are built for watertight edges (Embree's robust mode). Build flag {flag} (`OXRT_BUILD_FLAG_NOT_ROBUST`) leaves that out. A closed
mesh of {triangles:,} triangles from inside, rays exactly at its edges and vertices for the leaks, at random places for the speed (one
thread):

| | through edges | through vertices | rays/s |
|---|---|---|---|
{robust}

Where a ray passes a vertex within rounding, the edges that meet there are rounded apart from each other, and the finer the mesh the more
often none of its triangles takes the ray. OptiX recorded no leak in a million such rays.

Precise and fast arithmetic in shaders do not change hits; what they do to functions is in [math.md](math.md).
"""


@dataclass(frozen=True)
class Case:
    """One primitive: how it is built, which program reads its hits, places on it or beside it, and the exact hit of a ray."""

    name: str
    program: str
    build: Callable[[], Any]
    aims: Callable[[np.random.Generator, int], tuple[Floats, NDArray[np.bool_]]]
    exact: Callable[[Floats, Floats], tuple[float, float, Floats] | None]


def _triangle() -> Case:
    corners = np.float32([(0.1, 0.2, 0.0), (1.0, 0.1, 0.2), (0.3, 0.9, 0.4)]).astype(np.float64)

    def aims(random: np.random.Generator, count: int) -> tuple[Floats, NDArray[np.bool_]]:
        hit = random.random(count) < 0.7
        spread = np.where(hit, random.uniform(0.0, INSIDE, count), random.uniform(OUTSIDE, 1.5, count))[:, None]
        edge = random.integers(0, 3, count)
        along = random.random((count, 1))
        border = corners[edge] * along + corners[(edge + 1) % 3] * (1.0 - along)
        return corners.mean(axis=0) * (1.0 - spread) + border * spread, hit

    def exact(origin: Floats, direction: Floats) -> tuple[float, float, Floats] | None:
        ab, ac = corners[1] - corners[0], corners[2] - corners[0]
        normal = np.cross(ab, ac)
        t = float((corners[0] - origin) @ normal / (direction @ normal))
        p = np.cross(direction, ac)
        u = float((origin - corners[0]) @ p / (ab @ p))
        v = float(direction @ np.cross(origin - corners[0], ab) / (ab @ p))
        return (t, u, normal) if min(u, v, 1.0 - u - v) >= 0.0 else None

    return Case("triangle", "triangles", lambda: ox.BuildInputTriangles(corners.astype(np.float32)), aims, exact)


def _sphere() -> Case:
    center = np.float32([0.3, -0.2, 0.5]).astype(np.float64)

    def exact(origin: Floats, direction: Floats) -> tuple[float, float, Floats] | None:
        length = float(np.linalg.norm(direction))
        ray = direction / length
        along = float((center - origin) @ ray)
        aside = origin + along * ray - center
        depth = 1.0 - float(aside @ aside)
        if depth <= 0.0:
            return None
        return (along - depth**0.5) / length, 0.0, aside - depth**0.5 * ray

    def build() -> Any:
        return ox.BuildInputSpheres(center[None].astype(np.float32), np.ones(1, np.float32))

    return Case("sphere", "spheres", build, lambda random, count: _around(random, count, center, np.ones(count)), exact)


def _curve(name: str, kind: int) -> Case:
    points = np.column_stack([BEND, np.full(4, RADIUS)]).astype(np.float32).astype(np.float64)
    count = 2 if "LINEAR" in ox.PrimitiveType(kind).name else 3 if "QUADRATIC" in ox.PrimitiveType(kind).name else 4
    strand = Strand(kind, points[:count])

    def aims(random: np.random.Generator, number: int) -> tuple[Floats, NDArray[np.bool_]]:
        places = [np.array([u**k for k in range(len(strand.terms(0)))]) @ strand.terms(0) for u in random.uniform(0.2, 0.8, number)]
        return _around(random, number, np.array(places)[:, :3], np.full(number, RADIUS))

    def exact(origin: Floats, direction: Floats) -> tuple[float, float, Floats] | None:
        hits = strand_hits(strand, origin, direction)
        return (hits[0].t, hits[0].u, hits[0].normal) if hits else None

    def build() -> Any:
        control = strand.points.astype(np.float32)
        return ox.BuildInputCurves(ox.PrimitiveType(kind), np.ascontiguousarray(control[:, :3]), np.ascontiguousarray(control[:, 3]),
                                   np.zeros(1, np.uint32))

    return Case(name, "curves", build, aims, exact)


def _ribbon() -> Case:
    normal = np.array([0.0, 0.6, 0.8])
    across = np.cross(normal, [1.0, 0.0, 0.0])

    def aims(random: np.random.Generator, count: int) -> tuple[Floats, NDArray[np.bool_]]:
        hit = random.random(count) < 0.7
        side = RADIUS * np.where(hit, random.uniform(-INSIDE, INSIDE, count), random.uniform(OUTSIDE, 1.5, count))
        return np.outer(random.uniform(0.7, 1.3, count), [1.0, 0.0, 0.0]) + side[:, None] * across, hit

    def exact(origin: Floats, direction: Floats) -> tuple[float, float, Floats] | None:
        t = float(-(origin @ normal) / (direction @ normal))
        point = origin + t * direction
        return (t, float(point[0]) - 0.5, normal) if abs(float(point @ across)) <= RADIUS and 0.5 <= point[0] <= 1.5 else None

    def build() -> Any:
        normals = np.tile(np.float32(normal), (3, 1))
        return ox.BuildInputCurves(ox.PrimitiveType.FLAT_QUADRATIC_BSPLINE, STRAIGHT[:3].astype(np.float32), np.full(3, RADIUS, np.float32),
                                   np.zeros(1, np.uint32), normals=normals)

    return Case("ribbon with normals", "ribbons", build, aims, exact)


def _around(random: np.random.Generator, count: int, center: Floats, radius: Floats) -> tuple[Floats, NDArray[np.bool_]]:
    """Places beside a centre; rays turn about them later, so they lie across the ray."""
    hit = random.random(count) < 0.7
    distance = radius * np.where(hit, random.uniform(0.0, INSIDE, count), random.uniform(OUTSIDE, 1.5, count))
    return np.concatenate([np.broadcast_to(center, (count, 3)), distance[:, None]], axis=1), hit


def _rays(random: np.random.Generator, case: Case, distance: float) -> tuple[Floats, Floats, NDArray[np.bool_]]:
    """Origins and directions, exact in float32, and whether they aim inside."""
    aims, hit = case.aims(random, RAYS)
    directions = random.normal(size=(RAYS, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    if aims.shape[1] == 4:  # across the ray, and for curves across the axis too, or the ray would meet them all the same
        axis = BEND[1] - BEND[0] if case.program == "curves" else random.normal(size=3)
        aside = np.cross(directions, axis)
        aims = aims[:, :3] + aims[:, 3:] * aside / np.linalg.norm(aside, axis=1, keepdims=True)
    origins = (aims - distance * directions).astype(np.float32).astype(np.float64)
    # towards the place as seen from where the ray really begins
    directions = (aims - origins) / np.linalg.norm(aims - origins, axis=1, keepdims=True)
    return origins, directions.astype(np.float32).astype(np.float64), hit


def _measure(context: ox.DeviceContext, case: Case, distance: float, lanes: int) -> list[str]:
    """The cells of one row."""
    origins, directions, aimed = _rays(np.random.default_rng(int(distance)), case, distance)
    module, make = context.module_create(shader_module("accuracy")), context.program_group_create
    groups = [make(raygen=module["__raygen__accuracy"]), make(miss=module["__miss__nothing"]),
              make(closesthit=module[f"__closesthit__{case.program}"])]
    pipeline = context.pipeline_create(groups, simd=lanes)
    table = ox.ShaderBindingTable(raygen=groups[0].record(), miss=[groups[1].record()], hitgroup=[groups[2].record()])
    hits, normals = np.zeros((RAYS, 4), np.float32), np.zeros((RAYS, 4), np.float32)
    params = shader_module("accuracy").Params(
        origins=origins.astype(np.float32), directions=directions.astype(np.float32), hits=hits, normals=normals,
        scene=context.accel_build([case.build()]))
    pipeline.launch(params, table, width=RAYS)
    exact = [case.exact(origin, direction) for origin, direction in zip(origins, directions, strict=True)]
    found = hits[:, 0] == 1.0
    both = [i for i in np.flatnonzero(found & aimed) if exact[i] is not None]
    t, u, wanted = (np.array([exact[i][part] for i in both]) for part in range(3))  # type: ignore[index]
    ours = normals[both, :3].astype(np.float64)
    cosine = np.abs((ours * wanted).sum(axis=1)) / np.linalg.norm(ours, axis=1) / np.linalg.norm(wanted, axis=1)
    sine = np.linalg.norm(np.cross(ours, wanted), axis=1) / np.linalg.norm(ours, axis=1) / np.linalg.norm(wanted, axis=1)
    columns = [np.abs(hits[both, 1] - t) / t, np.arctan2(sine, cosine), np.abs(hits[both, 2] - u)]
    cells = [f"{column.max():.1e} ({np.median(column):.0e})" for column in columns]
    decided = np.array([one is not None for one in exact])
    return [cells[0], f"{np.mean(found != decided):.1%}", cells[1], "-" if case.program == "spheres" else cells[2]]


def _robust(context: ox.DeviceContext) -> tuple[int, list[str]]:
    corners, faces = sphere(MESH_DIVISIONS)
    random = np.random.default_rng(4)
    picked = corners[faces[random.integers(0, len(faces), MESH_RAYS)]]
    origins = 0.3 * random.uniform(-1.0, 1.0, (MESH_RAYS, 3))
    module, make = context.module_create(shader_module("accuracy")), context.program_group_create
    groups = [make(raygen=module["__raygen__accuracy"]), make(miss=module["__miss__nothing"]),
              make(closesthit=module["__closesthit__triangles"])]
    pipeline = context.pipeline_create(groups)
    table = ox.ShaderBindingTable(raygen=groups[0].record(), miss=[groups[1].record()], hitgroup=[groups[2].record()])
    contenders, leaks = [], {}
    for name, flags in (("robust (default)", 0), ("not robust", NOT_ROBUST)):
        scene = context.accel_build([ox.BuildInputTriangles(corners.astype(np.float32), faces)], build_flags=flags)
        missed = []
        for aim in (0.3 * picked[:, 0] + 0.7 * picked[:, 1], picked[:, 0], random.normal(size=origins.shape)):
            hits, normals = np.zeros((MESH_RAYS, 4), np.float32), np.zeros((MESH_RAYS, 4), np.float32)
            params = shader_module("accuracy").Params(origins=origins.astype(np.float32), directions=(aim - origins).astype(np.float32),
                                                      hits=hits, normals=normals, scene=scene)
            pipeline.launch(params, table, width=MESH_RAYS)
            missed.append(float(np.mean(hits[:, 0] == 0.0)))
        leaks[name] = missed
        contenders.append(LaunchContender(name, pipeline, table, params, MESH_RAYS, 1))
    times = interleave(contenders, ROUNDS, Clock.CPU)
    return len(faces), [f"| {name} | {edges:.3%} | {vertices:.2%} | {MESH_RAYS / times.median(name) / 1e6:.1f} million |"
                        for name, (edges, vertices, _) in leaks.items()]


def page() -> str:
    """The whole of docs/accuracy.md."""
    context = ox.DeviceContext(threads=1)
    kinds = [_triangle(), _sphere()]
    for kind in ox.PrimitiveType:
        if kind.name.startswith("ROUND_"):
            words = kind.name.lower().replace("round_", "").replace("_", " ").replace("bspline", "B-spline").replace("bezier", "Bezier")
            kinds.append(_curve(words.replace("catmullrom", "Catmull-Rom").replace("catmull rom", "Catmull-Rom"), int(kind)))
    kinds.append(_ribbon())
    machine = f"Measured on: {describe()['processor']}."
    lines = [HEAD.format(rays=RAYS, radius=RADIUS, machine=machine), "| primitive | distance | t | wrong | normal | u |",
             "|---|---|---|---|---|---|"]
    for case in kinds:
        for distance in DISTANCES:
            lines.append(f"| {case.name} | {distance:g} | {' | '.join(_measure(context, case, distance, 1))} |")
    triangles, robust = _robust(context)
    lines.append(TAIL.format(flag=NOT_ROBUST, triangles=triangles, robust="\n".join(robust)))
    return "\n".join(lines)


if __name__ == "__main__":
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parents[1] / "docs" / "accuracy.md"
    target.write_text(page(), encoding="utf-8")
    print(target)
