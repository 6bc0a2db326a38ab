"""Pinwheels, a flag and a ball while a shutter is open: python examples/09_motion_blur/host.py"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import garden
import numpy as np
import shader

import optixc as ox

sys.path.append(str(Path(__file__).resolve().parents[1]))
from rendering import Build, accumulate, options, pinhole, print_statistics, save, timed_build

EYE, TARGET, VERTICAL_FOV = (0.3, 1.75, 8.6), (0.1, 1.52, 0.0), 31.0
UP = np.array([0.0, 1.0, 0.0])
SUN = np.array([-0.55, 0.72, 0.52]) / np.linalg.norm([-0.55, 0.72, 0.52])
RED, WHITE, YELLOW, BLUE = (0.74, 0.06, 0.05), (0.88, 0.87, 0.84), (0.90, 0.58, 0.05), (0.05, 0.22, 0.62)
WOOD, GRASS, MOWN = (0.42, 0.29, 0.18), (0.10, 0.22, 0.045), (0.15, 0.31, 0.06)
# Turns while the shutter is open, size, place of the hub, lean, first angle, colours
WHEELS = [
    (0.012, 0.66, (-2.55, 1.60, 0.35), 0.30, 0.25, RED, WHITE),
    (0.075, 0.80, (-1.25, 2.30, -0.20), 0.12, 0.60, YELLOW, BLUE),
    (0.600, 0.66, (0.10, 1.55, 0.45), -0.10, 0.0, RED, YELLOW),
]
BALL_RADIUS, BALL_PLACE = 0.42, (1.75, 1.2)
FLAG_POLE = (1.35, 0.0, -0.9)
FLAG_KEYS = 5


@dataclass
class Thing:
    """A traversable with its paint."""

    traversable: Any
    paint: shader.Paint
    is_ball: bool = False


def paint(color: tuple[float, ...], other: tuple[float, ...] | None = None, pattern: int = shader.PLAIN, bands: int = 1) -> shader.Paint:
    """Record data."""
    return shader.Paint(color=color, other=other or color, pattern=pattern, bands=bands)


def turning(context: ox.DeviceContext) -> list[Thing]:
    """Pinwheels: one mesh, under SRT-motion transforms of different speeds."""
    wheel = context.accel_build([ox.BuildInputTriangles(*garden.wheel())])
    per_blade = len(garden.blade(0)[1])
    made = []
    for turns, size, place, lean, start, color, other in WHEELS:
        transform = context.srt_motion_transform(wheel, garden.spin(turns, size, place, lean, start))
        made.append(Thing(transform, paint(color, other, shader.BANDS, per_blade)))
    return made


def bouncing(context: ox.DeviceContext) -> Thing:
    """A ball: the built-in unit sphere under a matrix-motion transform."""
    unit = context.accel_build([ox.BuildInputSpheres(np.zeros((1, 3), np.float32), np.ones(1, np.float32))])
    return Thing(context.matrix_motion_transform(unit, garden.bounce(BALL_RADIUS, BALL_PLACE)), paint(RED, WHITE, shader.GORES), True)


def waving(context: ox.DeviceContext) -> Thing:
    """A flag: vertices of its own for every key."""
    place = (FLAG_POLE[0] + 0.04, 3.25, FLAG_POLE[2])
    keys = [garden.flag(phase, place) for phase in np.linspace(0.0, 1.5, FLAG_KEYS)]
    flag = ox.BuildInputTriangles([vertices for vertices, _ in keys], keys[0][1])
    row = 2 * (garden.FLAG_COLUMNS - 1) * (garden.FLAG_ROWS // 5)
    return Thing(context.accel_build([flag], motion_options=ox.MotionOptions(FLAG_KEYS)), paint(BLUE, WHITE, shader.BANDS, row))


def standing(context: ox.DeviceContext) -> list[Thing]:
    """The lawn, and sticks and the pole with their knobs."""
    lawn = np.array([[-400, 0, -400], [-400, 0, 400], [400, 0, 400], [400, 0, -400]], np.float32)
    ground = context.accel_build([ox.BuildInputTriangles(lawn, np.array([[0, 1, 2], [0, 2, 3]], np.uint32))])
    sticks, knobs = [], []
    for _, _, place, lean, *_ in WHEELS:
        hub, axle = np.array(place), np.array([np.sin(lean), 0.0, np.cos(lean)])
        behind = hub - 0.10 * axle
        sticks.append(garden.tube(behind * [1.0, 0.0, 1.0], behind + 0.06 * UP, 0.032))
        sticks.append(garden.tube(behind, hub + 0.08 * axle, 0.018))
        knobs.append((*(hub + 0.09 * axle), 0.06))
    pole = np.array(FLAG_POLE)
    sticks.append(garden.tube(pole, pole + 3.34 * UP, 0.04))
    knobs.append((*(pole + 3.38 * UP), 0.075))
    wood = context.accel_build([ox.BuildInputTriangles(*garden.merged(sticks))])
    spheres = np.array(knobs, np.float32)
    brass = context.accel_build([ox.BuildInputSpheres(np.ascontiguousarray(spheres[:, :3]), np.ascontiguousarray(spheres[:, 3]))])
    return [Thing(ground, paint(GRASS, MOWN, shader.LAWN)), Thing(wood, paint(WOOD)), Thing(brass, paint(YELLOW), True)]


def build_scene(context: ox.DeviceContext) -> tuple[Build, list[Thing]]:
    """Everything as instances of one structure; instance k has record k."""
    things = [*turning(context), bouncing(context), waving(context), *standing(context)]
    instances = [ox.Instance(thing.traversable, sbt_offset=number) for number, thing in enumerate(things)]
    return timed_build(context, [ox.BuildInputInstances(instances)]), things


def render(width: int, height: int, samples: int, shutter: float) -> np.ndarray:
    """The picture as (height, width, 4) floats; prints what it took."""
    context = ox.DeviceContext()
    module = context.module_create(shader)
    raygen = context.program_group_create(raygen=module["__raygen__paths"])
    nothing = context.program_group_create(miss=None)
    clear = context.program_group_create(miss=module["__miss__open"])
    triangles = context.program_group_create(closesthit=module["__closesthit__triangles"])
    ball = context.program_group_create(closesthit=module["__closesthit__ball"])
    motion = ox.PipelineCompileOptions(uses_motion_blur=True)
    pipeline = context.pipeline_create([raygen, nothing, clear, triangles, ball], max_trace_depth=1, options=motion)

    built, things = build_scene(context)
    records = [(ball if thing.is_ball else triangles).record(thing.paint) for thing in things]
    table = ox.ShaderBindingTable(raygen=raygen.record(), miss=[nothing.record(), clear.record()], hitgroup=records)
    image = np.zeros((height, width, 4), np.float32)
    ray_counts = np.zeros((height, width), np.uint32)
    params = shader.Params(
        image=image,
        ray_counts=ray_counts,
        scene=built.accel,
        camera=pinhole(EYE, TARGET, VERTICAL_FOV, width / height),
        sample=0,
        samples=samples,
        shutter=shutter,
        sun_direction=SUN,
        sun_color=(1.85, 1.7, 1.45),
        sun_cosine=np.cos(np.radians(1.2)),
    )
    seconds = accumulate(pipeline, params, table, (width, height), "motion blur")
    print(f"  {len(things)} things, {len(WHEELS) + 2} of them moving, {width} x {height} pixels, {samples} paths each")
    print_statistics(context, pipeline, built.seconds, int(ray_counts.sum(dtype=np.uint64)), seconds)
    return image


def main() -> None:
    parser = options(__doc__, "motion_blur.png", 960, 640, 64)
    parser.add_argument("--shutter", type=float, default=1.0, help="how long it is open: 1 is all of the motion, 0 an instant")
    arguments = parser.parse_args()
    print("a garden in the wind")
    image = render(arguments.width, arguments.height, arguments.samples, arguments.shutter)
    save(image, arguments)


if __name__ == "__main__":
    main()
