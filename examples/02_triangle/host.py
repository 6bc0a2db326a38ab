"""Builds one triangle, compiles the shader, launches it: python examples/02_triangle/host.py"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import shader

import optixc as ox


def render(width: int, height: int) -> np.ndarray:
    """The triangle as (height, width, 4) floats."""
    context = ox.DeviceContext()

    # Programs: a module is a shader file, a group what one SBT record runs, a pipeline all of it compiled
    module = context.module_create(shader)
    raygen = context.program_group_create(raygen=module["__raygen__pinhole"])
    miss = context.program_group_create(miss=module["__miss__background"])
    hit = context.program_group_create(closesthit=module["__closesthit__barycentrics"])
    pipeline = context.pipeline_create([raygen, miss, hit], max_trace_depth=1)

    # Geometry
    vertices = np.array([[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.0, 0.5, 0.0]], np.float32)
    triangle = context.accel_build([ox.BuildInputTriangles(vertices)])

    # Which program, with which data, runs where
    table = ox.ShaderBindingTable(
        raygen=raygen.record(),
        miss=[miss.record(shader.Background(color=(0.02, 0.03, 0.05)))],
        hitgroup=[hit.record()],
    )
    image = np.zeros((height, width, 4), np.float32)
    half_height = 0.4142
    params = shader.Params(
        image=image,
        scene=triangle,
        eye=(0.0, 0.0, 1.7),
        u=(half_height * width / height, 0.0, 0.0),
        v=(0.0, half_height, 0.0),
        w=(0.0, 0.0, -1.0),
    )
    pipeline.launch(params, table, width=width, height=height)
    return image


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", type=int, default=512, help="width and height in pixels")
    parser.add_argument("--output", type=Path, default=Path("triangle.png"))
    arguments = parser.parse_args()
    ox.write_image(arguments.output, render(arguments.size, arguments.size))
    print(f"wrote {arguments.output}")


if __name__ == "__main__":
    main()
