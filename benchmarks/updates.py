"""Updates against builds of the same structure, and what tracing costs after them, for every kind of build input and flag.

`python -m benchmarks.updates` prints one row for each. Everything lies within the cube from -1 to 1 and is bent by a twentieth of its size;
rays go from everywhere to everywhere, one by one. The time of a build is the median of several, like that of the updates after the first.
"""

from __future__ import annotations

import argparse
import statistics
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

import optixc as ox
from benchmarks.graphs import clock_seconds, normalised_mesh
from benchmarks.measure import Clock, LaunchContender, interleave
from benchmarks.ours import shader_module
from benchmarks.scenes import Floats

SIZE = 384
COUNT = 100_000
STRAND = 20
ALLOWED = 0.25
FLAGS = ox.BuildFlags


@dataclass
class Case:
    """A kind of structure: its build inputs at a step, from 0 (the build) to 1."""

    name: str
    inputs: Callable[[float], list[Any]]
    flags: int = 0
    keys: int = 1


@dataclass
class Cost:
    """Seconds of a build and of the updates, the first included; tracing after these over that after a build, with and without
    ALLOW_UPDATE."""

    name: str
    build: float
    updates: list[float]
    tracing: float
    tracing_without: float

    @property
    def first(self) -> float:
        """Share of the build."""
        return self.updates[0] / self.build

    @property
    def later(self) -> float:
        """Share of the build."""
        return statistics.median(self.updates[1:]) / self.build


def _bent(points: Floats, step: float) -> Floats:
    return np.ascontiguousarray(points + np.float32(0.05 * step) * np.sin(np.float32(3.0) * points[:, [1, 2, 0]]))


def _keys(points: Floats, step: float, keys: int) -> list[Floats]:
    """The points at every motion key, the last one further on its way."""
    return [_bent(points, step) + np.array([0.02 * key, 0.0, 0.0], np.float32) for key in range(keys)]


def _strands() -> tuple[Floats, Any]:
    """Points of strands from random places, and where their segments begin."""
    random = np.random.default_rng(3)
    strands = COUNT // STRAND
    steps = random.normal(scale=0.01, size=(strands, STRAND + 3, 3)) + random.normal(scale=0.02, size=(strands, 1, 3))
    points = random.uniform(-1.0, 1.0, (strands, 1, 3)) + np.cumsum(steps, axis=1)
    firsts = np.arange(strands)[:, None] * (STRAND + 3) + np.arange(STRAND)
    return points.reshape(-1, 3).astype(np.float32), firsts.ravel().astype(np.uint32)


def _curve_case(name: str, kind: ox.PrimitiveType, keys: int = 1) -> Case:
    points, firsts = _strands()
    radii = np.full(len(points), 0.002, np.float32)

    def inputs(step: float) -> list[Any]:
        moved = _keys(points, step, keys)
        return [ox.BuildInputCurves(kind, moved if keys > 1 else moved[0], [radii] * keys if keys > 1 else radii, firsts)]

    return Case(name, inputs, keys=keys)


def _dragon_cases() -> list[Case]:
    vertices, triangles = normalised_mesh("dragon")

    def at_rest(step: float) -> list[Any]:
        return [ox.BuildInputTriangles(_bent(vertices, step), triangles)]

    def moving(step: float) -> list[Any]:
        return [ox.BuildInputTriangles(_keys(vertices, step, 2), triangles)]

    named = {
        "dragon": 0,
        "dragon, fast trace": FLAGS.PREFER_FAST_TRACE,
        "dragon, fast build": FLAGS.PREFER_FAST_BUILD,
        "dragon, compaction": FLAGS.ALLOW_COMPACTION,
        "dragon, random vertex access": FLAGS.ALLOW_RANDOM_VERTEX_ACCESS,
    }
    return [*(Case(name, at_rest, int(flags)) for name, flags in named.items()), Case("dragon, two keys", moving, keys=2)]


def _point_cases() -> list[Case]:
    points = np.random.default_rng(5).uniform(-1.0, 1.0, (COUNT, 3)).astype(np.float32)
    radii = np.full(COUNT, 0.01, np.float32)

    def spheres(step: float) -> list[Any]:
        return [ox.BuildInputSpheres(_bent(points, step), radii)]

    def moving_spheres(step: float) -> list[Any]:
        return [ox.BuildInputSpheres(_keys(points, step, 2), [radii, radii])]

    def boxes_of(points: Floats) -> Floats:
        return np.concatenate([points - np.float32(0.01), points + np.float32(0.01)], axis=1)

    def boxes(step: float) -> list[Any]:
        return [ox.BuildInputCustomPrimitives(boxes_of(_bent(points, step)))]

    def moving_boxes(step: float) -> list[Any]:
        return [ox.BuildInputCustomPrimitives([boxes_of(key) for key in _keys(points, step, 2)])]

    return [
        Case("spheres", spheres),
        Case("spheres, two keys", moving_spheres, keys=2),
        Case("boxes", boxes),
        Case("boxes, two keys", moving_boxes, keys=2),
    ]


def _instance_cases(context: ox.DeviceContext) -> list[Case]:
    random = np.random.default_rng(7)
    points = random.uniform(-1.0, 1.0, (COUNT, 3)).astype(np.float32)
    turns = np.linalg.qr(random.normal(size=(COUNT, 3, 3)))[0].astype(np.float32)
    corners = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], np.float32)
    faces = np.array([[x, y, z] for x in (0, 1) for y in (2, 3) for z in (4, 5)], np.uint32)
    small = context.accel_build([ox.BuildInputTriangles(corners, faces)])
    nested = context.accel_build([ox.BuildInputInstances([ox.Instance(small)])])
    turned = np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]], np.float32)
    moving = context.matrix_motion_transform(small, np.stack([turned, turned + np.array([[0, 0, 0, 0.5]] * 3, np.float32)]))

    def inputs_of(child: Any) -> Callable[[float], list[Any]]:
        def inputs(step: float) -> list[Any]:
            children = np.full(COUNT, child.handle, np.uint64)
            places = np.concatenate([np.float32(0.01) * turns, _bent(points, step)[:, :, None]], axis=2)
            return [ox.BuildInputInstances(children, transforms=np.ascontiguousarray(places))]

        return inputs

    kept = {"instances": small, "instances of instances": nested, "moving instances": moving}
    found = [Case(name, inputs_of(child)) for name, child in kept.items()]
    return [*found, Case("instances, fast build", inputs_of(small), int(FLAGS.PREFER_FAST_BUILD))]


def cases(context: ox.DeviceContext) -> list[Case]:
    """What is measured."""
    kinds = ox.PrimitiveType
    return [
        *_dragon_cases(),
        *_point_cases(),
        _curve_case("linear curves", kinds.ROUND_LINEAR),
        _curve_case("linear curves, two keys", kinds.ROUND_LINEAR, keys=2),
        _curve_case("cubic curves", kinds.ROUND_CUBIC_BSPLINE),
        _curve_case("rocaps", kinds.ROUND_CUBIC_BSPLINE_ROCAPS),
        _curve_case("ribbons", kinds.FLAT_QUADRATIC_BSPLINE),
        *_instance_cases(context),
    ]


class Tracer:
    """Rays from everywhere to everywhere through structures of one kind."""

    def __init__(self, context: ox.DeviceContext) -> None:
        self.shader = shader_module("graphs")
        module = context.module_create(self.shader)
        make = context.program_group_create
        self.groups = [
            make(raygen=module["__raygen__incoherent"]),
            make(miss=module["__miss__nothing"]),
            make(closesthit=module["__closesthit__distance"], intersection=module["__intersection__nothing"]),
        ]
        self.table = ox.ShaderBindingTable(
            raygen=self.groups[0].record(), miss=[self.groups[1].record()], hitgroup=[self.groups[2].record()]
        )
        self.pipeline = context.pipeline_create(self.groups, simd=1, options=ox.PipelineCompileOptions(uses_motion_blur=True))

    def ratios(self, structures: dict[str, Any], over: str, rounds: int, clock: Clock) -> dict[str, float]:
        """Seconds of each structure over those of one of them."""
        image = np.zeros((SIZE, SIZE), np.float32)
        contenders = [
            LaunchContender(
                name,
                self.pipeline,
                self.table,
                self.shader.Params(image=image, scene=one.handle, eye=(0.0, 0.0, 9.0), reach=1.2, time=0.5),
                SIZE,
                SIZE,
            )
            for name, one in structures.items()
        ]
        timings = interleave(contenders, rounds, clock)
        return {name: timings.speed_up(over, name) for name in structures}


def measure(context: ox.DeviceContext, case: Case, tracer: Tracer, clock: Clock, rounds: int) -> Cost:
    """Builds, updates and traces."""
    options = ox.MotionOptions(case.keys, 0.0, 1.0) if case.keys > 1 else None
    prepared = [case.inputs(step / rounds) for step in range(rounds + 1)]

    def build(inputs: list[Any], flags: int) -> tuple[float, Any]:
        start = clock_seconds(clock)
        made = context.accel_build(inputs, build_flags=flags, motion_options=options)
        return clock_seconds(clock) - start, made

    updatable = case.flags | FLAGS.ALLOW_UPDATE
    builds = []
    for _ in range(rounds):
        seconds, built = build(prepared[0], updatable)
        builds.append(seconds)
    updates = []
    for inputs in prepared[1:]:
        start = clock_seconds(clock)
        built.update(inputs)
        updates.append(clock_seconds(clock) - start)
    structures = {"updated": built, "built": build(prepared[-1], updatable)[1], "without": build(prepared[-1], case.flags)[1]}
    ratios = tracer.ratios(structures, "built", rounds, clock)
    return Cost(case.name, statistics.median(builds), updates, ratios["updated"], ratios["updated"] / ratios["without"])


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.updates", description=__doc__)
    parser.add_argument("--only", default="", help="parts of the names of cases, comma-separated")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--clock", choices=[clock.value for clock in Clock], default=Clock.WALL.value)
    arguments = parser.parse_args()
    context = ox.DeviceContext(threads=1)
    tracer = Tracer(context)
    wanted = arguments.only.split(",")
    print(f"{'':28} build ms   first   later (at most {ALLOWED})   tracing over a build's with, without ALLOW_UPDATE")
    for case in cases(context):
        if any(part in case.name for part in wanted):
            one = measure(context, case, tracer, Clock(arguments.clock), arguments.rounds)
            row = f"{one.name:28} {1e3 * one.build:8.1f} {one.first:7.2f} {one.later:7.2f}"
            print(f"{row} {one.tracing:27.2f} {one.tracing_without:15.2f}", flush=True)


if __name__ == "__main__":
    main()
