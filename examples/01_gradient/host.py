"""Runs the gradient shader and writes a picture: python examples/01_gradient/host.py"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import shader

import optixc as ox


def render(width: int, height: int) -> np.ndarray:
    """The gradient as (height, width, 4) floats."""
    context = ox.DeviceContext()
    module = context.module_create(shader)
    raygen = context.program_group_create(raygen=module["__raygen__gradient"])
    pipeline = context.pipeline_create([raygen])
    table = ox.ShaderBindingTable(raygen=raygen.record())
    image = np.zeros((height, width, 4), np.float32)
    pipeline.launch(shader.Params(image=image), table, width=width, height=height)
    return image


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", type=int, default=512, help="width and height in pixels")
    parser.add_argument("--output", type=Path, default=Path("gradient.png"))
    arguments = parser.parse_args()
    ox.write_image(arguments.output, render(arguments.size, arguments.size))
    print(f"wrote {arguments.output}")


if __name__ == "__main__":
    main()
