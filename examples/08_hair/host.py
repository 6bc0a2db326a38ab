"""Three tresses of hair under studio lights: python examples/08_hair/host.py"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import shader
import tresses

import optixc as ox
from optixc.stdlib.hair import Hair
from optixc.stdlib.light import RectangleLight

sys.path.append(str(Path(__file__).resolve().parents[1]))
from rendering import Build, accumulate, options, pinhole, print_statistics, save, timed_build

EYE, TARGET, VERTICAL_FOV = (0.0, -1.18, 7.2), (0.0, -1.18, 0.0), 26.0
# Absorption per radius by its melanins: eumelanin makes hair dark, pheomelanin red
BROWN, RED, BLOND = (1.0, 0.15), (0.08, 0.85), (0.10, 0.06)
STYLES = [(tresses.STRAIGHT, BROWN), (tresses.WAVY, RED), (tresses.CURLY, BLOND)]


def hair(eumelanin: float, pheomelanin: float) -> Hair:
    """A human hair with that much colour in it."""
    absorption = eumelanin * np.array([0.419, 0.697, 1.37]) + pheomelanin * np.array([0.187, 0.4, 1.05])
    return Hair(
        absorption=absorption, longitudinal_roughness=0.28, azimuthal_roughness=0.4, scale_tilt=np.radians(2.5), refractive_index=1.55
    )


def lights() -> list[RectangleLight]:
    """A large one in front, to the left and above; a narrow one behind, to the right, for light that comes through."""
    return [
        RectangleLight(corner=(-4.4, 1.0, 3.6), edge_u=(0.0, 2.2, -1.4), edge_v=(2.6, 0.0, 1.9), radiance=(21.0, 19.6, 18.0)),
        RectangleLight(corner=(3.2, -1.6, -2.4), edge_u=(0.0, 3.6, 0.0), edge_v=(-1.2, 0.0, -0.7), radiance=(9.5, 10.3, 11.5)),
    ]


def build_scene(context: ox.DeviceContext, strands: int) -> Build:
    """An instance for every tress, and one for the wall and the clips; instance k has record k."""
    curves = [tresses.tress(style, x, strands, seed) for seed, ((style, _), x) in enumerate(zip(STYLES, (-1.15, 0.0, 1.15), strict=True))]
    inputs = [ox.BuildInputCurves(ox.PrimitiveType.ROUND_CUBIC_BSPLINE, *one) for one in curves]
    built = [timed_build(context, [one]) for one in inputs]
    wall = tresses.box((-40.0, -40.0, -4.1), (40.0, 40.0, -4.0))
    clips = [tresses.box((x - 0.50, -0.13, -0.14), (x + 0.50, 0.08, 0.14)) for x in (-1.15, 0.0, 1.15)]
    surfaces = timed_build(context, [ox.BuildInputTriangles(*wall), *(ox.BuildInputTriangles(*clip) for clip in clips)])
    instances = [ox.Instance(one.accel, sbt_offset=number) for number, one in enumerate([*built, surfaces])]
    scene = timed_build(context, [ox.BuildInputInstances(instances)])
    return Build(scene.accel, sum(one.seconds for one in [*built, surfaces, scene]))


def render(width: int, height: int, samples: int, strands: int) -> np.ndarray:
    """The picture as (height, width, 4) floats; prints what it took."""
    context = ox.DeviceContext()
    module = context.module_create(shader)
    raygen = context.program_group_create(raygen=module["__raygen__paths"])
    nothing = context.program_group_create(miss=None)
    clear = context.program_group_create(miss=module["__miss__open"])
    fibre = context.program_group_create(closesthit=module["__closesthit__hair"])
    surface = context.program_group_create(closesthit=module["__closesthit__surface"])
    pipeline = context.pipeline_create([raygen, nothing, clear, fibre, surface], max_trace_depth=1)

    built = build_scene(context, strands)
    records = [fibre.record(shader.Tress(hair=number)) for number in range(len(STYLES))]
    records.append(surface.record(shader.Surface(albedo=(0.20, 0.23, 0.28))))
    records += [surface.record(shader.Surface(albedo=(0.06, 0.06, 0.07)))] * len(STYLES)
    table = ox.ShaderBindingTable(raygen=raygen.record(), miss=[nothing.record(), clear.record()], hitgroup=records)
    image = np.zeros((height, width, 4), np.float32)
    ray_counts = np.zeros((height, width), np.uint32)
    hairs = [hair(*melanins) for _, melanins in STYLES]
    params = shader.Params(
        image=image,
        ray_counts=ray_counts,
        scene=built.accel,
        camera=pinhole(EYE, TARGET, VERTICAL_FOV, width / height),
        sample=0,
        samples=samples,
        max_depth=48,
        hairs=hairs,
        lights=lights(),
        ambient=(0.34, 0.36, 0.40),
    )
    seconds = accumulate(pipeline, params, table, (width, height), "hair")
    segments = len(STYLES) * strands * (tresses.POINTS - 3)
    print(f"  {len(STYLES) * strands} hairs of {segments} segments, {width} x {height} pixels, {samples} paths each")
    print_statistics(context, pipeline, built.seconds, int(ray_counts.sum(dtype=np.uint64)), seconds)
    return image


def main() -> None:
    parser = options(__doc__, "hair.png", 768, 576, 64)
    parser.add_argument("--strands", type=int, default=6000, help="hairs of each tress")
    arguments = parser.parse_args()
    print("three tresses")
    image = render(arguments.width, arguments.height, arguments.samples, arguments.strands)
    save(image, arguments)


if __name__ == "__main__":
    main()
