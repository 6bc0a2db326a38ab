"""Toy cars in an evening garage, path traced: python examples/13_path_tracer/host.py --samples 256"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np
import scene
import shader
from tqdm import tqdm

import optixc as ox

sys.path.append(str(Path(__file__).resolve().parents[1]))
from rendering import options


class Renderer:
    """A pipeline with two ray generation programs, each with a table of its own: one adds samples, one develops the picture."""

    def __init__(self, width: int, height: int, bounces: int, exposure: float) -> None:
        context = ox.DeviceContext()
        module = context.module_create(shader)
        path = context.program_group_create(raygen=module["__raygen__path"])
        develop = context.program_group_create(raygen=module["__raygen__develop"])
        hit = context.program_group_create(closesthit=module["__closesthit__part"])
        self.pipeline = context.pipeline_create([path, develop, hit], max_trace_depth=1)

        objects = scene.objects()
        structures = {
            id(one.mesh): context.accel_build([ox.BuildInputTriangles(one.mesh.vertices, one.mesh.indices)])
            for one in {id(one.mesh): one for one in objects}.values()
        }
        instances = [
            ox.Instance(structures[id(one.mesh)], transform=one.place, sbt_offset=k, instance_id=one.instance_id)
            for k, one in enumerate(objects)
        ]
        records = [
            hit.record(shader.Part(indices=one.mesh.indices, normals=one.mesh.normals, material=one.material)) for one in objects
        ]
        self.tables = [ox.ShaderBindingTable(raygen=group.record(), hitgroup=records) for group in (path, develop)]
        self.size = (width, height)
        self.ray_counts = np.zeros((height, width), np.uint32)
        self.params = shader.Params(
            sums=np.zeros((height, width, 4), np.float32),
            image=np.zeros((height, width, 4), np.float32),
            ray_counts=self.ray_counts,
            scene=context.accel_build([ox.BuildInputInstances(instances)]),
            camera=scene.camera(width / height),
            lamp=scene.lamp(),
            sky=scene.sky(),
            sample=0,
            max_bounces=bounces,
            max_indirect=3.0,
            exposure=exposure,
        )

    def add(self, sample: int) -> None:
        """One more path per pixel."""
        self.params.sample = sample
        self.pipeline.launch(self.params, self.tables[0], *self.size)

    def image(self) -> np.ndarray:
        """The mean of all samples so far, tone mapped: (height, width, 4), linear."""
        self.pipeline.launch(self.params, self.tables[1], *self.size)
        result: np.ndarray = self.params.image
        return result


def main() -> None:
    parser = options(__doc__, "garage.png", 960, 540, 64)
    parser.add_argument("--bounces", type=int, default=8, help="surfaces on a path at most")
    parser.add_argument("--every", type=int, default=0, help="write the picture after every so many samples, to look at its progress")
    arguments = parser.parse_args()

    renderer = Renderer(arguments.width, arguments.height, arguments.bounces, arguments.exposure)
    start = time.perf_counter()
    for sample in tqdm(range(arguments.samples), desc="path tracer", unit="sample", delay=2.0, disable=None, leave=False):
        renderer.add(sample)
        if arguments.every > 0 and (sample + 1) % arguments.every == 0:
            ox.write_image(arguments.output, renderer.image())
    seconds = time.perf_counter() - start
    ox.write_image(arguments.output, renderer.image())
    rays = int(renderer.ray_counts.sum(dtype=np.uint64))
    print(f"{rays / 1e6:.1f} million rays in {seconds:.1f} s: {rays / seconds / 1e6:.2f} Mrays/s; wrote {arguments.output}")


if __name__ == "__main__":
    main()
