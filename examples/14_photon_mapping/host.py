"""Caustics of a ring and of glass by photon mapping: python examples/14_photon_mapping/host.py --samples 64"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import photon_map
import scene
import shader
from tqdm import tqdm

import optixc as ox

sys.path.append(str(Path(__file__).resolve().parents[1]))
from rendering import options, pinhole

SHRINKING = 0.7


class Renderer:
    """Each sample is a photon pass, a grid and a camera pass, with a radius that shrinks: their mean has neither noise nor blur in the end.

    C. Knaus, M. Zwicker, "Progressive Photon Mapping: A Probabilistic Approach", 2011.
    """

    def __init__(self, width: int, height: int, samples: int, photons: int, radius: float) -> None:
        context = ox.DeviceContext()
        module = context.module_create(shader)
        emit = context.program_group_create(raygen=module["__raygen__photons"])
        see = context.program_group_create(raygen=module["__raygen__camera"])
        miss = context.program_group_create(miss=None)
        hit = context.program_group_create(closesthit=module["__closesthit__part"])
        self.pipeline = context.pipeline_create([emit, see, miss, hit], max_trace_depth=1)

        objects = scene.objects()
        inputs = [ox.BuildInputTriangles(one.mesh.vertices, one.mesh.indices) for one in objects]
        records = [hit.record(shader.Part(one.mesh.indices, one.mesh.normals, int(one.kind), one.color)) for one in objects]
        self.tables = [ox.ShaderBindingTable(group.record(), miss=[miss.record()], hitgroup=records) for group in (emit, see)]
        self.size, self.radius = (width, height), radius
        self.emitted = np.zeros(photons, shader.Photon)
        self.taken = np.zeros((photons, 3), np.float32)
        self.image = np.zeros((height, width, 4), np.float32)
        light = scene.lamp()
        self.power = (scene.power(light) / photons).astype(np.float32)
        self.params = shader.Params(
            emitted=self.emitted,
            taken=self.taken,
            image=self.image,
            grid=photon_map.grid(self.emitted[:0], radius),
            scene=context.accel_build(inputs),
            camera=pinhole(scene.EYE, scene.TARGET, scene.VERTICAL_FOV, width / height),
            lamp=light,
            photon_power=self.power,
            sample=0,
            samples=samples,
        )

    def add(self, sample: int) -> photon_map.Account:
        """One photon pass and one camera pass."""
        self.params.sample = sample
        self.pipeline.launch(self.params, self.tables[0], len(self.emitted))
        self.params.grid = photon_map.grid(self.emitted, self.radius)
        self.pipeline.launch(self.params, self.tables[1], *self.size)
        self.radius *= float(np.sqrt((sample + 1 + SHRINKING) / (sample + 2)))
        return photon_map.account(self.emitted, self.taken, self.power)


def main() -> None:
    parser = options(__doc__, "caustics.png", 960, 540, 32)
    parser.add_argument("--photons", type=int, default=400_000, help="photons of each sample")
    parser.add_argument("--radius", type=float, default=0.09, help="from where photons are gathered at first")
    arguments = parser.parse_args()
    renderer = Renderer(arguments.width, arguments.height, arguments.samples, arguments.photons, arguments.radius)
    samples = tqdm(range(arguments.samples), desc="photons", unit="sample", delay=2.0, disable=None, leave=False)
    accounts = [renderer.add(sample) for sample in samples]
    ox.write_image(arguments.output, renderer.image, exposure=arguments.exposure)
    last = accounts[-1]
    print(f"{last.photons} photons a pass: {last.kept_photons} kept, {last.caustic_photons} of them in caustics")
    for name in ("emitted", "kept", "escaped", "taken"):
        print(f"  {name:8} {np.array2string(getattr(last, name), precision=4)} W")
    worst = max(one.error() for one in accounts)
    print(f"  missing  {worst:.1e} of the power, rounding may lose {photon_map.rounding_bound():.1e}")
    print(f"wrote {arguments.output}")


if __name__ == "__main__":
    main()
