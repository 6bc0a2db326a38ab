"""Ambient occlusion of a scene: python examples/04_ambient_occlusion/host.py [courtyard | sibenik | sponza]

`courtyard` is made by code. The other scenes are read from the folder that OXRT_SCENES_DIR names (default: ../shared/scenes), with
the cameras and radii of its benchmark_scenes.json.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import os
import sys
from pathlib import Path

import courtyard
import numpy as np
import shader

import optixc as ox

sys.path.append(str(Path(__file__).resolve().parents[1]))
from rendering import accumulate, pinhole, print_statistics, timed_build

SCENES_DIR = Path(os.environ.get("OXRT_SCENES_DIR", Path(__file__).resolve().parents[2] / ".." / "shared" / "scenes"))


@dataclasses.dataclass(frozen=True)
class Scene:
    """A mesh, where to look at it from, and how far occlusion reaches. The field of view is in degrees."""

    vertices: np.ndarray
    indices: np.ndarray
    eye: np.ndarray
    forward: np.ndarray
    vertical_fov: float
    radius: float


def load(name: str, camera: int) -> Scene:
    """The courtyard, or a scene of the folder; SystemExit where that folder does not have it."""
    if name == "courtyard":
        vertices, indices = courtyard.build()
        forward = np.subtract(courtyard.TARGET, courtyard.EYE)
        return Scene(vertices, indices, np.array(courtyard.EYE), forward, courtyard.VERTICAL_FOV, courtyard.RADIUS)
    description = SCENES_DIR / "benchmark_scenes.json"
    if not description.is_file():
        raise SystemExit(f"{name} needs {description}; set OXRT_SCENES_DIR, or render the courtyard")
    entry = json.loads(description.read_text())[name]
    arrays = np.load(SCENES_DIR / entry["file"])
    view = entry["cameras"][camera]
    return Scene(
        np.ascontiguousarray(arrays["vertices"], np.float32),
        np.ascontiguousarray(arrays["triangles"], np.uint32),
        np.array(view["position"]),
        np.array(view["forward"]),
        view["vertical_fov_deg"],
        entry["ao_radius"],
    )


def render(scene: Scene, width: int, height: int, samples: int, occlusion_rays: int, *, verbose: bool = False) -> np.ndarray:
    """The picture as (height, width, 4) floats; `verbose` prints what it took."""
    context = ox.DeviceContext()
    module = context.module_create(shader)
    raygen = context.program_group_create(raygen=module["__raygen__ambient_occlusion"])
    nothing = context.program_group_create(miss=None)
    clear = context.program_group_create(miss=module["__miss__open"])
    surface = context.program_group_create(closesthit=module["__closesthit__surface"])
    pipeline = context.pipeline_create([raygen, nothing, clear, surface], max_trace_depth=1)

    built = timed_build(context, [ox.BuildInputTriangles(scene.vertices, scene.indices)])

    table = ox.ShaderBindingTable(raygen=raygen.record(), miss=[nothing.record(), clear.record()], hitgroup=[surface.record()])
    image = np.zeros((height, width, 4), np.float32)
    ray_counts = np.zeros((height, width), np.uint32)
    params = shader.Params(
        image=image,
        ray_counts=ray_counts,
        scene=built.accel,
        camera=pinhole(scene.eye, scene.eye + scene.forward, scene.vertical_fov, width / height),
        sample=0,
        samples=samples,
        occlusion_rays=occlusion_rays,
        radius=scene.radius,
    )
    seconds = accumulate(pipeline, params, table, (width, height), "ambient occlusion")
    if verbose:
        rays = int(ray_counts.sum(dtype=np.uint64))
        print(f"  {len(scene.indices)} triangles, {width} x {height} pixels, {samples} x (1 + {occlusion_rays}) rays each")
        print_statistics(context, pipeline, built.seconds, rays, seconds)
    return image


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="?", default="courtyard", choices=["courtyard", "sibenik", "sponza", "dragon", "bunny"])
    parser.add_argument("--camera", type=int, default=0, help="number of the scene's camera")
    parser.add_argument("--size", type=int, default=512, help="width and height in pixels")
    parser.add_argument("--samples", type=int, default=8, help="primary rays per pixel")
    parser.add_argument("--occlusion-rays", type=int, default=4, help="occlusion rays per primary ray")
    parser.add_argument("--radius", type=float, help="how far occlusion reaches, in scene units")
    parser.add_argument("--output", type=Path, default=Path("ambient_occlusion.png"))
    arguments = parser.parse_args()

    scene = load(arguments.scene, arguments.camera)
    if arguments.radius is not None:
        scene = dataclasses.replace(scene, radius=arguments.radius)
    print(f"ambient occlusion, {arguments.scene}")
    image = render(scene, arguments.size, arguments.size, arguments.samples, arguments.occlusion_rays, verbose=True)
    ox.write_image(arguments.output, image)
    print(f"  picture  {arguments.output}")


if __name__ == "__main__":
    main()
