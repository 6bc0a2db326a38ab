"""A maple whose leaves are cut-outs, with and without opacity micromaps: python examples/11_cutouts/host.py"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Any

import maple
import numpy as np
import shader

import optixc as ox

sys.path.append(str(Path(__file__).resolve().parents[1]))
from rendering import Build, accumulate, options, pinhole, print_statistics, save, timed_build

EYE, TARGET, VERTICAL_FOV = (1.1, 0.75, 6.4), (0.05, 1.85, 0.0), 39.0
SUN = np.array([0.72, 0.62, -0.12]) / np.linalg.norm([0.72, 0.62, -0.12])


def leaf_uvs() -> np.ndarray:
    """Texture coordinates by triangle of a rectangle and corner: float32 (2, 3, 2)."""
    return np.ascontiguousarray(maple.PLACES[maple.CORNERS])


def micromaps(context: ox.DeviceContext, mesh: maple.Mesh, alpha: np.ndarray, level: int) -> ox.BuildInputOpacityMicromap:
    """Bakes what the any-hit program would read into micromaps; all rectangles share those of two triangles."""
    vertices, triangles = mesh
    uvs = np.tile(maple.PLACES, (len(vertices) // 4, 1))
    return ox.bake_opacity_micromap(alpha, uvs, triangles, level=level, cutoff=0.5).build(context)


def build_scene(context: ox.DeviceContext, leaves: list[maple.Mesh], solids: list[maple.Mesh], baked: list[Any]) -> Build:
    """One structure: leaves that hang, leaves that lie, bark, lawn; `baked` has micromaps of both kinds of leaves, or None."""
    inputs = [ox.BuildInputTriangles(*mesh, opacity_micromap=maps) for mesh, maps in zip(leaves, baked, strict=True)]
    inputs += [ox.BuildInputTriangles(*mesh, flags=ox.GeometryFlags.DISABLE_ANYHIT) for mesh in solids]
    return timed_build(context, inputs)


def compare(pipeline: ox.Pipeline, params: Any, table: ox.ShaderBindingTable, size: tuple[int, int], scenes: dict[str, Build]) -> None:
    """Prints rays a second and runs of the any-hit program of one launch with each of the scenes."""
    runs = {}
    for name, built in scenes.items():
        params.scene = built.accel
        params.counts[:] = 0
        start = time.perf_counter()
        pipeline.launch(params, table, width=size[0], height=size[1])
        seconds = time.perf_counter() - start
        rays, runs[name] = (int(params.counts[..., k].sum(dtype=np.uint64)) for k in range(2))
        print(f"  {name:18} {rays / seconds / 1e6:.2f} Mrays/s, {runs[name] / rays:.3f} any-hit programs a ray")
    without, with_maps = runs.values()
    print(f"  saved              {100.0 * (1.0 - with_maps / max(without, 1)):.1f} % of the any-hit programs")


def render(width: int, height: int, samples: int, per_twig: int, level: int) -> np.ndarray:
    """The picture as (height, width, 4) floats; prints what it took."""
    context = ox.DeviceContext()
    module = context.module_create(shader)
    raygen = context.program_group_create(raygen=module["__raygen__paths"])
    nothing = context.program_group_create(miss=None)
    clear = context.program_group_create(miss=module["__miss__open"])
    leaf = context.program_group_create(closesthit=module["__closesthit__leaf"], anyhit=module["__anyhit__leaf"])
    leaf_shadow = context.program_group_create(anyhit=module["__anyhit__leaf_shadow"])
    solid = context.program_group_create(closesthit=module["__closesthit__solid"])
    empty = context.program_group_create(closesthit=None)
    groups = [raygen, nothing, clear, leaf, leaf_shadow, solid, empty]
    allowed = ox.PipelineCompileOptions(allow_opacity_micromaps=True)
    pipeline = context.pipeline_create(groups, max_trace_depth=1, options=allowed)

    picture = maple.picture()
    tree = maple.tree()
    leaves = [maple.hanging(tree, per_twig), maple.fallen(3000)]
    reach = 300.0
    lawn = np.array([[-reach, 0, -reach], [-reach, 0, reach], [reach, 0, reach], [reach, 0, -reach]], np.float32)
    solids = [maple.bark(tree), (lawn, np.array([[0, 1, 2], [0, 2, 3]], np.uint32))]
    start = time.perf_counter()
    baked = [micromaps(context, mesh, picture[..., 3], level) for mesh in leaves]
    print(f"  {len(leaves[0][0]) // 4} leaves; micromaps of level {level} baked in {time.perf_counter() - start:.2f} s")
    scenes = {"without micromaps": build_scene(context, leaves, solids, [None, None])}
    scenes["with micromaps"] = build_scene(context, leaves, solids, baked)

    texture = ox.Texture2D(picture)
    records = []
    for color, other, through in (((0.62, 0.05, 0.025), (0.85, 0.33, 0.04), 0.5), ((0.50, 0.06, 0.03), (0.70, 0.30, 0.05), 0.2)):
        data = shader.Leaves(uvs=leaf_uvs(), picture=texture, color=color, other=other, through=through)
        records += [leaf.record(data), leaf_shadow.record(data)]
    records += [solid.record(shader.Solid(color=(0.15, 0.12, 0.10), other=(0.28, 0.24, 0.20), is_lawn=0)), empty.record()]
    records += [solid.record(shader.Solid(color=(0.06, 0.13, 0.02), other=(0.16, 0.25, 0.05), is_lawn=1)), empty.record()]
    table = ox.ShaderBindingTable(raygen=raygen.record(), miss=[nothing.record(), clear.record()], hitgroup=records)
    image = np.zeros((height, width, 4), np.float32)
    counts = np.zeros((height, width, 2), np.uint32)
    params = shader.Params(
        image=image,
        counts=counts,
        scene=scenes["with micromaps"].accel,
        camera=pinhole(EYE, TARGET, VERTICAL_FOV, width / height),
        sample=0,
        samples=samples,
        sun_direction=SUN,
        sun_color=(4.6, 4.2, 3.5),
    )
    compare(pipeline, params, table, (width, height), scenes)
    image[:] = 0.0
    counts[:] = 0
    seconds = accumulate(pipeline, params, table, (width, height), "cut-outs")
    print(f"  {width} x {height} pixels, {samples} paths each")
    print_statistics(context, pipeline, scenes["with micromaps"].seconds, int(counts[..., 0].sum(dtype=np.uint64)), seconds)
    return image


def main() -> None:
    parser = options(__doc__, "cutouts.png", 640, 640, 48)
    parser.add_argument("--leaves", type=int, default=20, help="leaves of each twig")
    parser.add_argument("--level", type=int, default=6, help="subdivision level of the micromaps")
    arguments = parser.parse_args()
    print("a maple")
    image = render(arguments.width, arguments.height, arguments.samples, arguments.leaves, arguments.level)
    save(image, arguments)


if __name__ == "__main__":
    main()
