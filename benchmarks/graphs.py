"""Graphs against the flattened static scene on the same rays, and a million instances.

`python -m benchmarks.graphs` prints one row for each. The scene is 64 bunnies in a cube, apart from each other; two levels are 8 groups of
8 neighbours; the moving graph has a matrix-motion transform of two equal keys above every bunny.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass
from typing import Any

import numpy as np

import optixc as ox
from benchmarks.measure import Clock, LaunchContender, interleave
from benchmarks.ours import shader_module
from benchmarks.scenes import Floats, SceneMissing, scenes_folder

SIZE = 384
ROUNDS = 7
MILLION = 1_000_000
CELLS = 4
SPACING = 1.6
GROUP = 8
GRAPHS = ("one level", "two levels", "moving")


@dataclass
class GraphTime:
    """Seconds of a graph over those of the flattened scene; `allowed` is what the project asks for."""

    graph: str
    rays: str
    lanes: int
    ratio: float
    allowed: float


def normalised_mesh(name: str) -> tuple[Floats, Any]:
    """The mesh within the cube from -1 to 1."""
    path = scenes_folder() / f"{name}.npz"
    if not path.is_file():
        raise SceneMissing(f"no {path}: set OXRT_SCENES_DIR to the folder of the benchmark scenes")
    with np.load(path) as arrays:
        vertices, triangles = arrays["vertices"] - arrays["vertices"].mean(axis=0), arrays["triangles"]
    return np.ascontiguousarray(vertices / np.abs(vertices).max(), np.float32), np.ascontiguousarray(triangles, np.uint32)


def _places() -> list[Floats]:
    """Matrices of the bunnies, neighbours next to each other in the list."""
    random = np.random.default_rng(1)
    half = CELLS // 2
    cells = sorted(np.ndindex(CELLS, CELLS, CELLS), key=lambda cell: [axis // half for axis in cell])
    made = []
    for cell in cells:
        turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
        center = (np.array(cell) - (CELLS - 1) / 2) * SPACING
        made.append(np.concatenate([0.7 * turn, center[:, None]], axis=1).astype(np.float32))
    return made


def _instances(context: ox.DeviceContext, children: list[Any], places: list[Floats] | None = None) -> Any:
    transforms = None if places is None else np.stack(places)
    return context.accel_build([ox.BuildInputInstances(children, transforms=transforms)])


def scenes(context: ox.DeviceContext) -> dict[str, Any]:
    """The same picture four ways."""
    vertices, triangles = normalised_mesh("bunny")
    places = _places()
    bunny = context.accel_build([ox.BuildInputTriangles(vertices, triangles)])
    moved = np.concatenate([vertices @ place[:, :3].T + place[:, 3] for place in places]).astype(np.float32)
    indices = np.concatenate([triangles + np.uint32(number * len(vertices)) for number in range(len(places))])
    groups = [_instances(context, [bunny] * GROUP, places[first:first + GROUP]) for first in range(0, len(places), GROUP)]
    moving = [context.matrix_motion_transform(bunny, np.stack([place, place])) for place in places]
    return {"flattened": context.accel_build([ox.BuildInputTriangles(moved, indices)]),
            "one level": _instances(context, [bunny] * len(places), places),
            "two levels": _instances(context, groups), "moving": _instances(context, moving)}


def measure(lanes: tuple[int, ...] = (1, 8, 16), rounds: int = ROUNDS, clock: Clock = Clock.WALL) -> list[GraphTime]:
    """One thread; medians over interleaved rounds."""
    context = ox.DeviceContext(threads=1)
    shader = shader_module("graphs")
    module = context.module_create(shader)
    made = scenes(context)
    miss, hit = (context.program_group_create(**{kind: module[f"__{kind}__{name}"]})
                 for kind, name in (("miss", "nothing"), ("closesthit", "distance")))
    found = []
    for rays in ("coherent", "incoherent"):
        raygen = context.program_group_create(raygen=module[f"__raygen__{rays}"])
        table = ox.ShaderBindingTable(raygen=raygen.record(), miss=[miss.record()], hitgroup=[hit.record()])
        for width in lanes:
            pipeline = context.pipeline_create([raygen, miss, hit], simd=width, options=ox.PipelineCompileOptions(uses_motion_blur=True))
            contenders = [LaunchContender(name, pipeline, table, _params(shader, scene), SIZE, SIZE) for name, scene in made.items()]
            timings = interleave(contenders, rounds, clock)
            allowed = 1.6 if width > 1 and rays == "coherent" else 1.25
            found += [GraphTime(name, rays, width, 1.0 / timings.speed_up(name, "flattened"), allowed) for name in GRAPHS]
    return found


def _params(shader: Any, scene: Any) -> Any:
    image = np.zeros((SIZE, SIZE), np.float32)
    return shader.Params(image=image, scene=scene.handle, eye=(0.0, 0.0, 9.0), reach=3.0, time=0.5)


def clock_seconds(clock: Clock) -> float:
    """Now, by the clock on the wall or as processor time of this process."""
    return time.perf_counter() if clock is Clock.WALL else time.process_time()


def measure_million(context: ox.DeviceContext, clock: Clock = Clock.WALL) -> tuple[float, float]:
    """Seconds and MiB of an IAS of a million bunnies."""
    vertices, triangles = normalised_mesh("bunny")
    bunny = context.accel_build([ox.BuildInputTriangles(vertices, triangles)])
    number = np.arange(MILLION)
    places = np.zeros((MILLION, 3, 4), np.float32)
    places[:, range(3), range(3)] = 1.0
    places[:, :, 3] = np.stack([number % 100, number // 100 % 100, number // 10000], axis=1)
    start = clock_seconds(clock)
    built = context.accel_build([ox.BuildInputInstances(np.full(MILLION, bunny.handle, np.uint64), transforms=places)])
    return clock_seconds(clock) - start, built.memory_usage / 2**20


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.graphs", description=__doc__)
    parser.add_argument("--parts", default="million,graphs", help="comma-separated")
    parser.add_argument("--lanes", default="1,8,16", help="widths, comma-separated")
    parser.add_argument("--rounds", type=int, default=ROUNDS)
    parser.add_argument("--clock", choices=[clock.value for clock in Clock], default=Clock.WALL.value)
    arguments = parser.parse_args()
    clock, parts = Clock(arguments.clock), arguments.parts.split(",")
    context = ox.DeviceContext()
    if "million" in parts:
        seconds, mebibytes = measure_million(context, clock)
        print(f"1,000,000 instances: {seconds:.2f} s, {mebibytes:.0f} MiB (allowed 10 s, 1536 MiB)")
    if "graphs" in parts:
        for found in measure(tuple(int(part) for part in arguments.lanes.split(",")), arguments.rounds, clock):
            row = f"{found.graph:>10}, {found.rays:>10}, {found.lanes:2} lanes"
            print(f"{row}: {found.ratio:.2f} of the flattened time (allowed {found.allowed})")


if __name__ == "__main__":
    main()
