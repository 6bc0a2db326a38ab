"""Leaves cut out by a filtered texture, with and without opacity micromaps: any-hit programs saved, and rays a second.

`python -m benchmarks.micromaps` prints one row for each width. The crown of leaves is that of the cut-outs; the picture is the leaf of the
scenes' folder. Both contenders are one pipeline on two structures, so only the micromaps differ; a second pipeline counts.
"""

from __future__ import annotations

import argparse
import dataclasses
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import optixc as ox
from benchmarks.measure import Clock, LaunchContender, interleave
from benchmarks.ours import shader_module
from benchmarks.scenes import SUN, Scene, SceneMissing, leaf_scene, scenes_folder

LEVEL = 6
MUST_SAVE, MUST_SPEED_UP = 0.90, 1.15


@dataclass
class Saving:
    """Shares of any-hit programs and of micro-triangles' area, and the speed with micromaps over that without."""

    lanes: int
    saved: float
    known: float
    speed_up: float
    same_image: bool


def leaf_picture() -> NDArray[np.uint8]:
    """RGBA of the leaf of the scenes' folder."""
    path = scenes_folder() / "tex_leaf_nv.npz"
    if not path.is_file():
        raise SceneMissing(f"no {path}: set OXRT_SCENES_DIR to the folder of the benchmark scenes")
    with np.load(path) as arrays:
        return np.ascontiguousarray(arrays["rgba"])


def measure(scene: Scene, lanes: tuple[int, ...], rounds: int, size: int, clock: Clock) -> list[Saving]:
    """One thread; medians over interleaved rounds."""
    context = ox.DeviceContext(threads=1)
    shader = shader_module("micromaps")
    module = context.module_create(shader)
    make = context.program_group_create
    raygen = make(raygen=module["__raygen__micromaps"])
    hit = make(closesthit=module["__closesthit__leaf"], anyhit=module["__anyhit__alpha"])
    misses = [make(miss=module["__miss__sky"]), make(miss=module["__miss__visible"])]
    baked = ox.bake_opacity_micromap(np.ascontiguousarray(scene.texels[..., 3]), scene.uvs, scene.triangles, level=LEVEL)
    structures = {
        "without": context.accel_build([ox.BuildInputTriangles(scene.vertices, scene.triangles)]),
        "with": context.accel_build([ox.BuildInputTriangles(scene.vertices, scene.triangles, opacity_micromap=baked.build(context))]),
    }
    leaves = shader.Leaves(triangles=scene.triangles, uvs=scene.uvs, picture=ox.Texture2D(scene.texels))
    table = ox.ShaderBindingTable(raygen=raygen.record(), miss=[one.record() for one in misses], hitgroup=[hit.record(leaves)])
    camera = shader_module("camera").Camera(
        **{name: getattr(scene.camera, name) for name in ("eye", "u", "v", "w")}, pixel=(2.0 / size, 2.0 / size), skip=0
    )
    options = ox.PipelineCompileOptions(allow_opacity_micromaps=True)
    found = []
    for width in lanes:
        runs = {name: np.zeros(1, np.uint64) for name in structures}
        contenders = []
        for counting in (True, False):
            pipeline = context.pipeline_create(
                [raygen, *misses, hit], max_trace_depth=2, simd=width, options=options, bound_values={"counting": counting}
            )
            contenders = [
                LaunchContender(
                    name, pipeline, table, _params(shader, structure, camera, scene, runs[name], size, counting), size, size
                )
                for name, structure in structures.items()
            ]
            if counting:
                for one in contenders:
                    one.run()
        timings = interleave(contenders, rounds, clock)
        without, with_maps = (int(runs[name][0]) for name in ("without", "with"))
        same = np.array_equal(*(one.params.image for one in contenders))
        found.append(Saving(width, 1.0 - with_maps / without, baked.known, timings.speed_up("with", "without"), same))
    return found


def _params(shader: Any, accel: Any, camera: Any, scene: Scene, runs: NDArray[np.uint64], size: int, counting: bool) -> Any:
    image = np.zeros((size, size, 4), np.float32)
    return shader.Params(image=image, scene=accel, camera=camera, sun=SUN, offset=scene.offset, runs=runs, counting=counting)


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.micromaps", description=__doc__)
    parser.add_argument("--size", type=int, default=1024, help="pixels along each side")
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--clock", choices=[clock.value for clock in Clock], default=Clock.WALL.value)
    parser.add_argument("--lanes", default="1,8,16", help="widths, comma-separated")
    arguments = parser.parse_args()
    scene = dataclasses.replace(leaf_scene(), texels=leaf_picture())
    lanes = tuple(int(part) for part in arguments.lanes.split(","))
    for one in measure(scene, lanes, arguments.rounds, arguments.size, Clock(arguments.clock)):
        print(
            f"{one.lanes:2} lanes: {100 * one.saved:.1f} % of any-hit programs saved (must {100 * MUST_SAVE:.0f}), "
            f"{one.speed_up:.2f} times the rays/s (must {MUST_SPEED_UP}), {100 * one.known:.1f} % of the area known, "
            f"{'the same image' if one.same_image else 'ANOTHER IMAGE'}"
        )


if __name__ == "__main__":
    main()
