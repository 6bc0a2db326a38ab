"""What the examples that render share: their options, a camera, launches that add up samples, and what all that took."""

from __future__ import annotations

import argparse
import resource
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

import optixc as ox
from optixc.stdlib.camera import Pinhole

Point = Sequence[float] | np.ndarray


def options(description: str | None, output: str, width: int, height: int, samples: int) -> argparse.ArgumentParser:
    """A parser with the size of the picture, the samples of a pixel, the exposure and the file."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--width", type=int, default=width, help="pixels")
    parser.add_argument("--height", type=int, default=height, help="pixels")
    parser.add_argument("--samples", type=int, default=samples, help="paths or rays that start in each pixel")
    parser.add_argument("--exposure", type=float, default=0.0, help="stops")
    parser.add_argument("--output", type=Path, default=Path(output))
    return parser


def save(image: np.ndarray, arguments: argparse.Namespace) -> None:
    """Writes the picture as the options say, and tells where it is."""
    ox.write_image(arguments.output, image, exposure=arguments.exposure)
    print(f"  picture  {arguments.output}")


def pinhole(eye: Point, target: Point, vertical_fov: float, aspect: float) -> Pinhole:
    """A camera as half axes of its image plane; y is up, the field of view in degrees, `aspect` is width over height."""
    w = np.subtract(target, eye)
    right = np.cross(w, [0.0, 1.0, 0.0])
    right /= np.linalg.norm(right)
    up = np.cross(right, w) / np.linalg.norm(w)
    half_height = np.linalg.norm(w) * np.tan(np.radians(0.5 * vertical_fov))
    return Pinhole(eye=eye, u=half_height * aspect * right, v=half_height * up, w=w)


@dataclass
class Build:
    """An acceleration structure and the seconds that it took."""

    accel: ox.Accel
    seconds: float


def timed_build(context: ox.DeviceContext, inputs: list[Any], **settings: Any) -> Build:
    """`context.accel_build` with its time."""
    start = time.perf_counter()
    accel = context.accel_build(inputs, **settings)
    return Build(accel, time.perf_counter() - start)


def accumulate(pipeline: ox.Pipeline, params: Any, table: ox.ShaderBindingTable, size: tuple[int, int], title: str) -> float:
    """One launch of (width, height) for each of `params.samples`; gives the seconds of all."""
    start = time.perf_counter()
    for sample in tqdm(range(params.samples), desc=title, unit="sample", delay=2.0, disable=None, leave=False):
        params.sample = sample
        pipeline.launch(params, table, width=size[0], height=size[1])
    return time.perf_counter() - start


def print_statistics(context: ox.DeviceContext, pipeline: ox.Pipeline, build_seconds: float, rays: int, seconds: float) -> None:
    """What the compiler, the build and the launches took."""
    report = pipeline.report()
    print(f"  compile  {report.compile_seconds:.3f} s{' (from the cache)' if report.cache_hit else ''}")
    print(f"  build    {build_seconds:.3f} s")
    rate = f"{rays / seconds / 1e6:.2f} Mrays/s on {context.info()['threads']} threads"
    print(f"  trace    {rays / 1e6:.1f} million rays in {seconds:.2f} s: {rate}")
    print(f"  memory   {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0:.0f} MiB at most")
