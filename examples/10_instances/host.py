"""A million trees as instances of three: python examples/10_instances/host.py"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import landscape
import numpy as np
import shader

import optixc as ox

sys.path.append(str(Path(__file__).resolve().parents[1]))
from rendering import Build, accumulate, options, pinhole, print_statistics, save, timed_build

EYE, TARGET, VERTICAL_FOV = (230.0, 50.0, 770.0), (-40.0, 10.0, 300.0), 38.0
SUN = np.array([-0.62, 0.42, -0.18]) / np.linalg.norm([-0.62, 0.42, -0.18])
BARK = (0.10, 0.075, 0.055)
LEAVES = [
    ((0.030, 0.070, 0.035), (0.050, 0.095, 0.035)),
    ((0.085, 0.150, 0.030), (0.300, 0.180, 0.030)),
    ((0.150, 0.190, 0.040), (0.420, 0.260, 0.030)),
]
GRASS, ROCK, WATER = (0.105, 0.125, 0.040), (0.24, 0.22, 0.20), (0.012, 0.030, 0.030)


def material(color: tuple[float, ...], other: tuple[float, ...] | None = None, **more: Any) -> shader.Material:
    """Record data."""
    members = {"slope_color": color, "is_water": 0, "is_ground": 0, **more}
    return shader.Material(color=color, other=other or color, **members)


def materials() -> list[shader.Material]:
    """In the order of the records: trunk and leaves of each tree, the ground, the water."""
    trees = [one for leaves in LEAVES for one in (material(BARK), material(*leaves))]
    return [*trees, material(GRASS, slope_color=ROCK, is_ground=1), material(WATER, is_water=1)]


def build_scene(context: ox.DeviceContext, count: int) -> Build:
    """Structures for trees, ground and water, and one of all instances; its seconds are those of that one."""
    land = landscape.landscape()
    trees = [
        context.accel_build([ox.BuildInputTriangles(*trunk), ox.BuildInputTriangles(*leaves)]) for trunk, leaves in landscape.species()
    ]
    ground = context.accel_build([ox.BuildInputTriangles(*land.mesh())])
    water = context.accel_build([ox.BuildInputTriangles(*landscape.square(landscape.WATER_LEVEL))])
    kind, transforms = landscape.forest(land, count)

    # Arrays with one row for each instance: ground and water come last, where they stand
    handles = np.array([tree.handle for tree in trees], np.uint64)[kind]
    handles = np.append(handles, np.array([ground.handle, water.handle], np.uint64))
    transforms = np.concatenate([transforms, np.broadcast_to(np.eye(3, 4, dtype=np.float32), (2, 3, 4))])
    offsets = np.append(2 * kind, [2 * len(trees), 2 * len(trees) + 1]).astype(np.uint32)
    numbers = np.arange(len(handles), dtype=np.uint32)
    built = timed_build(context, [ox.BuildInputInstances(handles, transforms=transforms, sbt_offsets=offsets, instance_ids=numbers)])
    print(f"  {len(handles)} instances built in {built.seconds:.2f} s, {built.accel.memory_usage / 2**20:.0f} MiB")
    return built


def render(width: int, height: int, samples: int, count: int) -> np.ndarray:
    """The picture as (height, width, 4) floats; prints what it took."""
    context = ox.DeviceContext()
    module = context.module_create(shader)
    raygen = context.program_group_create(raygen=module["__raygen__paths"])
    nothing = context.program_group_create(miss=None)
    clear = context.program_group_create(miss=module["__miss__open"])
    surface = context.program_group_create(closesthit=module["__closesthit__surface"])
    pipeline = context.pipeline_create([raygen, nothing, clear, surface], max_trace_depth=1)

    built = build_scene(context, count)
    records = [surface.record(one) for one in materials()]
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
        sun_direction=SUN,
        sun_color=(6.4, 5.2, 3.7),
        haze=2.2e-4,
    )
    seconds = accumulate(pipeline, params, table, (width, height), "instances")
    print(f"  {width} x {height} pixels, {samples} paths each")
    print_statistics(context, pipeline, built.seconds, int(ray_counts.sum(dtype=np.uint64)), seconds)
    return image


def main() -> None:
    parser = options(__doc__, "instances.png", 1024, 576, 48)
    parser.add_argument("--trees", type=int, default=1_000_000, help="instances")
    arguments = parser.parse_args()
    print("a forest")
    image = render(arguments.width, arguments.height, arguments.samples, arguments.trees)
    save(image, arguments)


if __name__ == "__main__":
    main()
