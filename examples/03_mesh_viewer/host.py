"""Renders a mesh file, or a torus knot without one: python examples/03_mesh_viewer/host.py [model.glb]"""

from __future__ import annotations

import argparse
from pathlib import Path

import meshes
import numpy as np
import shader
from tqdm import tqdm

import optixc as ox


def camera(low: np.ndarray, high: np.ndarray, azimuth: float, elevation: float, aspect: float) -> dict[str, np.ndarray]:
    """A pinhole camera that sees the whole box; angles in degrees."""
    phi, theta = np.radians([azimuth, elevation])
    away = np.array([np.sin(phi) * np.cos(theta), np.sin(theta), np.cos(phi) * np.cos(theta)])
    tangent = np.tan(np.radians(20.0))
    w = -0.5 * np.linalg.norm(high - low) / min(1.0, aspect) / np.sin(np.radians(20.0)) * away
    right = np.cross(w, [0.0, 1.0, 0.0])
    right /= np.linalg.norm(right)
    half_height = np.linalg.norm(w) * tangent
    up = np.cross(right, w) / np.linalg.norm(w)
    return {"eye": 0.5 * (low + high) - w, "u": half_height * aspect * right, "v": half_height * up, "w": w}


def render(parts: list[meshes.Mesh], view: dict[str, np.ndarray], width: int, height: int, samples: int) -> np.ndarray:
    """The picture as (height, width, 4) floats; each part is an instance with a record of its own."""
    context = ox.DeviceContext()
    module = context.module_create(shader)
    raygen = context.program_group_create(raygen=module["__raygen__pinhole"])
    sky = context.program_group_create(miss=module["__miss__sky"])
    sun = context.program_group_create(miss=module["__miss__sun"])
    hit = context.program_group_create(closesthit=module["__closesthit__mesh"])
    pipeline = context.pipeline_create([raygen, sky, sun, hit], max_trace_depth=2)

    accels = [context.accel_build([ox.BuildInputTriangles(part.vertices, part.indices)]) for part in parts]
    scene = context.accel_build([ox.BuildInputInstances([ox.Instance(accel, sbt_offset=k) for k, accel in enumerate(accels)])])
    table = ox.ShaderBindingTable(
        raygen=raygen.record(),
        miss=[sky.record(), sun.record()],
        hitgroup=[hit.record(shader.Mesh(indices=part.indices, normals=part.normals, colors=part.colors)) for part in parts],
    )
    image = np.zeros((height, width, 4), np.float32)
    sun_direction = np.array([0.45, 0.8, 0.4]) / np.linalg.norm([0.45, 0.8, 0.4])
    params = shader.Params(
        image=image, scene=scene, sun_direction=sun_direction, sun_color=(1.15, 1.08, 0.95), sample=0, samples=samples, **view
    )
    for sample in tqdm(range(samples), desc="mesh", unit="sample", delay=2.0, disable=None, leave=False):
        params.sample = sample
        pipeline.launch(params, table, width=width, height=height)
    return image


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("mesh", type=Path, nargs="?", help="OBJ, PLY, glTF, ... (needs trimesh); without it: a torus knot")
    parser.add_argument("--width", type=int, default=768)
    parser.add_argument("--height", type=int, default=768)
    parser.add_argument("--samples", type=int, default=16, help="rays per pixel")
    parser.add_argument("--azimuth", type=float, default=30.0, help="degrees around the mesh")
    parser.add_argument("--elevation", type=float, default=14.0, help="degrees above the horizon")
    parser.add_argument("--exposure", type=float, default=0.0, help="stops")
    parser.add_argument("--output", type=Path, default=Path("mesh.png"))
    arguments = parser.parse_args()

    mesh = meshes.load(arguments.mesh) if arguments.mesh else meshes.torus_knot()
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    floor = meshes.ground(float(low[1]), 40.0 * float(np.linalg.norm(high - low)))
    view = camera(low, high, arguments.azimuth, arguments.elevation, arguments.width / arguments.height)
    image = render([mesh, floor], view, arguments.width, arguments.height, arguments.samples)
    ox.write_image(arguments.output, image, exposure=arguments.exposure)
    print(f"{len(mesh.indices)} triangles; wrote {arguments.output}")


if __name__ == "__main__":
    main()
