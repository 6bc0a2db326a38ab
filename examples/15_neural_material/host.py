"""A material learned by a small network, beside the material itself: python examples/15_neural_material/host.py --samples 32"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np
import shader
from network import Network
from tqdm import tqdm

import optixc as ox
from optixc.stdlib import shapes

sys.path.append(str(Path(__file__).resolve().parents[1]))
from rendering import accumulate, options, pinhole, save

RADIUS, TUBE = 1.0, 0.45
CENTERS = ((-1.6, TUBE, 0.0), (1.6, TUBE, 0.0))
LIGHT = np.array([-0.35, 0.8, 0.5]) / np.linalg.norm([-0.35, 0.8, 0.5])
RATE, LAST_RATE = 0.01, 0.0005


class Studio:
    """Two tori on a floor, the left one shaded by the network; and the launches that train it."""

    def __init__(self, width: int, height: int, samples: int, batch: int) -> None:
        context = ox.DeviceContext()
        module = context.module_create(shader)
        create = context.program_group_create
        learn, camera = create(raygen=module["__raygen__learn"]), create(raygen=module["__raygen__camera"])
        torus, floor = create(closesthit=module["__closesthit__torus"]), create(closesthit=module["__closesthit__floor"])
        miss = create(miss=module["__miss__sky"])
        self.pipeline = context.pipeline_create([learn, camera, torus, floor, miss], max_trace_depth=2)

        mesh = shapes.torus(RADIUS, TUBE)
        ground = shapes.rectangle((-40.0, 0.0, 40.0), (80.0, 0.0, 0.0), (0.0, 0.0, -80.0))
        moved = [mesh.moved(np.c_[np.eye(3), center]) for center in CENTERS]
        scene = context.accel_build([ox.BuildInputTriangles(one.vertices, one.indices) for one in (*moved, ground)])
        records = [torus.record(shader.Torus(center, RADIUS, k == 0)) for k, center in enumerate(CENTERS)]
        hits = [*records, floor.record()]
        self.tables = [ox.ShaderBindingTable(one.record(), miss=[miss.record()], hitgroup=hits) for one in (learn, camera)]
        self.network, self.errors = Network(context), np.zeros(batch, np.float32)
        self.image = np.zeros((height, width, 4), np.float32)
        self.params = shader.Params(
            network=self.network.memory,
            gradients=self.network.gradients,
            bias_gradients=self.network.bias_gradients,
            matrices=self.network.matrices,
            biases=self.network.biases,
            errors=self.errors,
            step=0,
            image=self.image,
            scene=scene,
            camera=pinhole((0.0, 3.4, 6.2), (0.0, 0.2, 0.0), 31.5, width / height),
            light=LIGHT,
            sample=0,
            samples=samples,
        )

    def learn(self, steps: int) -> tuple[float, float]:
        """Trains with one launch for each step; the mean squared errors of the first and the last."""
        mean_errors = []
        for step in tqdm(range(steps), desc="learning", unit="step", delay=2.0, disable=None, leave=False):
            self.params.step = step
            self.pipeline.launch(self.params, self.tables[0], len(self.errors))
            mean_errors.append(float(self.errors.mean()))
            self.network.learn(len(self.errors), RATE * (LAST_RATE / RATE) ** (step / steps))
        return mean_errors[0], mean_errors[-1]

    def render(self) -> float:
        """The picture; the seconds that it took."""
        height, width = self.image.shape[:2]
        return accumulate(self.pipeline, self.params, self.tables[1], (width, height), "samples")


def main() -> None:
    parser = options(__doc__, "neural_material.png", 960, 540, 32)
    parser.add_argument("--steps", type=int, default=4000, help="launches that train the network")
    parser.add_argument("--batch", type=int, default=4096, help="samples of each")
    arguments = parser.parse_args()
    studio = Studio(arguments.width, arguments.height, arguments.samples, arguments.batch)
    start = time.perf_counter()
    first, last = studio.learn(arguments.steps)
    print(f"  learned  {arguments.steps} steps of {arguments.batch} samples in {time.perf_counter() - start:.1f} s")
    print(f"  error    {first:.5f} at first, {last:.5f} at last")
    print(f"  rendered {arguments.samples} samples in {studio.render():.1f} s")
    save(studio.image, arguments)


if __name__ == "__main__":
    main()
