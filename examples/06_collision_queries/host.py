"""Probe rays, line of sight and bouncing points against a mesh, checked by brute force: python examples/06_collision_queries/host.py"""

from __future__ import annotations

import argparse
import sys
import time

import brute_force
import numpy as np
import shader
import terrain

import optixc as ox


class Queries:
    """A mesh that answers questions; every question is one launch over a one-dimensional array."""

    def __init__(self, vertices: np.ndarray, indices: np.ndarray) -> None:
        context = ox.DeviceContext()
        module = context.module_create(shader)
        self.raygens = {name: context.program_group_create(raygen=module[f"__raygen__{name}"]) for name in ("probe", "sight", "move")}
        missed = context.program_group_create(miss=None)
        clear = context.program_group_create(miss=module["__miss__clear"])
        contact = context.program_group_create(closesthit=module["__closesthit__contact"])
        self.pipeline = context.pipeline_create([*self.raygens.values(), missed, clear, contact], max_trace_depth=1)
        self.misses = [missed.record(), clear.record()]
        self.hits = [contact.record()]
        self.scene = context.accel_build([ox.BuildInputTriangles(vertices, indices)])

    def run(self, name: str, query: object, count: int) -> None:
        """Launches one of the ray generation programs with its record."""
        table = ox.ShaderBindingTable(raygen=self.raygens[name].record(query), miss=self.misses, hitgroup=self.hits)
        self.pipeline.launch(shader.Params(scene=self.scene), table, width=count)

    def probe(self, origins: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Distance and number of the nearest triangle along each ray; infinite and -1 where there is none."""
        distances = np.empty(len(origins), np.float32)
        triangles = np.empty(len(origins), np.int32)
        query = shader.ProbeQuery(origins=origins, directions=directions, distances=distances, triangles=triangles)
        self.run("probe", query, len(origins))
        return distances, triangles

    def sight(self, points: np.ndarray, pairs: np.ndarray) -> np.ndarray:
        """Whether the two points of each pair see each other."""
        visible = np.empty(len(pairs), np.int32)
        self.run("sight", shader.SightQuery(points=points, pairs=pairs, visible=visible), len(pairs))
        return visible != 0

    def move(self, positions: np.ndarray, velocities: np.ndarray, bounces: np.ndarray, seconds: float) -> None:
        """Moves the points, in place."""
        query = shader.MotionQuery(
            positions=positions, velocities=velocities, bounces=bounces, seconds=seconds, restitution=0.7, clearance=1e-4
        )
        self.run("move", query, len(positions))


def check_probes(queries: Queries, mesh: tuple[np.ndarray, np.ndarray], random: np.random.Generator, count: int) -> bool:
    """Rays from points above the valley in all directions."""
    origins = np.column_stack([random.uniform(-9, 9, count), random.uniform(1.2, 3, count), random.uniform(-9, 9, count)])
    directions = random.normal(size=(count, 3))
    origins, directions = origins.astype(np.float32), directions.astype(np.float32)
    distances, triangles = queries.probe(origins, directions)
    expected, expected_triangles = brute_force.nearest(origins, directions, *mesh)
    hits = np.isfinite(expected)
    error = np.abs(distances[hits] / expected[hits] - 1.0).max(initial=0.0)
    same = np.count_nonzero(triangles == expected_triangles)
    print(f"probes         {count} rays, {np.count_nonzero(triangles >= 0)} hits; same triangle {same}, distance within {error:.1e}")
    return bool((np.isfinite(distances) == hits).all()) and error < 1e-4


def check_sight(queries: Queries, mesh: tuple[np.ndarray, np.ndarray], random: np.random.Generator, count: int) -> bool:
    """All pairs of observers, both ways, a few of them by brute force."""
    x, z = random.uniform(-8, 8, (2, count))
    points = np.column_stack([x, terrain.height(x, z) + 0.4, z]).astype(np.float32)
    first, second = np.triu_indices(count, 1)
    pairs = np.ascontiguousarray(np.column_stack([first, second]), np.uint32)
    visible = queries.sight(points, pairs)
    reverse = queries.sight(points, np.ascontiguousarray(pairs[:, ::-1]))
    sample = random.choice(len(pairs), min(500, len(pairs)), replace=False)
    starts, ends = points[pairs[sample, 0]], points[pairs[sample, 1]]
    distances, _ = brute_force.nearest(starts, ends - starts, *mesh)
    same = np.count_nonzero(visible[sample] == (distances >= 1.0))
    print(f"line of sight  {len(pairs)} pairs, {visible.mean():.1%} see each other; {same} of {len(sample)} as by brute force")
    return bool((visible == reverse).all()) and same == len(sample)


def check_motion(queries: Queries, random: np.random.Generator, count: int, steps: int) -> bool:
    """Points that fall into the valley and bounce; none may end up below the ground."""
    positions = np.column_stack([random.uniform(-5, 5, count), random.uniform(2, 4, count), random.uniform(-5, 5, count)]).astype(
        np.float32
    )
    velocities = random.normal(0.0, 1.0, (count, 3)).astype(np.float32)
    bounces = np.zeros(count, np.int32)
    start = time.perf_counter()
    for _ in range(steps):
        velocities[:, 1] -= 9.81 / 60.0
        queries.move(positions, velocities, bounces, 1.0 / 60.0)
    seconds = time.perf_counter() - start
    inside = np.abs(positions[:, [0, 2]]).max(axis=1) < terrain.HALF_SIZE
    up = np.tile(np.array([0.0, 1.0, 0.0], np.float32), (count, 1))
    above = ~np.isfinite(queries.probe(positions, up)[0])
    print(
        f"motion         {count} points, {steps} steps in {seconds:.2f} s, {bounces.sum()} bounces; {np.count_nonzero(above)} above ground"
    )
    return bool(above.all()) and bool(inside.any()) and int(bounces.sum()) > count


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cells", type=int, default=40, help="squares along each side of the valley")
    parser.add_argument("--rays", type=int, default=1000, help="probe rays")
    parser.add_argument("--observers", type=int, default=512, help="points whose pairs are tested for sight")
    parser.add_argument("--points", type=int, default=4096, help="moving points")
    parser.add_argument("--steps", type=int, default=120, help="steps of 1/60 s")
    arguments = parser.parse_args()

    random = np.random.default_rng(1)
    mesh = terrain.build(arguments.cells)
    queries = Queries(*mesh)
    print(f"valley         {len(mesh[1])} triangles")
    passed = [
        check_probes(queries, mesh, random, arguments.rays),
        check_sight(queries, mesh, random, arguments.observers),
        check_motion(queries, random, arguments.points, arguments.steps),
    ]
    print("all answers agree" if all(passed) else "SOME ANSWERS DIFFER")
    return 0 if all(passed) else 1


if __name__ == "__main__":
    sys.exit(main())
