"""Spheres of metal, glass and plastic over a checkered floor: python examples/05_whitted_spheres/host.py"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np
import shader

import optixc as ox

sys.path.append(str(Path(__file__).resolve().parents[1]))
from rendering import Build, accumulate, pinhole, print_statistics, save, timed_build

EYE = (7.0, 2.7, -6.2)
TARGET = (2.9, 1.05, 1.2)
VERTICAL_FOV = 40.0
LIGHT_POSITION = (26.0, 26.0, 2.0)
LIGHT_COLOR = (0.85, 0.82, 0.75)
AMBIENT_COLOR = (0.30, 0.33, 0.38)


def sphere_boxes(centers: np.ndarray, radii: np.ndarray) -> np.ndarray:
    """Bounding boxes as custom primitives want them: (n, 6), lower corner first."""
    reach = np.reshape(radii, (-1, 1))
    return np.concatenate([centers - reach, centers + reach], axis=1).astype(np.float32)


def plastic_balls() -> shader.PlasticBalls:
    """Small balls scattered on the floor, none inside another or inside the two big ones."""
    random = np.random.default_rng(7)
    placed = [(4.0, 1.5, 1.2), (0.9, 2.6, 1.05)]
    while len(placed) < 42:
        x, z, radius = random.uniform(-3.5, 8.0), random.uniform(-4.0, 10.0), random.uniform(0.16, 0.42)
        if all(np.hypot(x - other[0], z - other[1]) > radius + other[2] + 0.1 for other in placed):
            placed.append((x, z, radius))
    spheres = np.array([(x, radius, z, radius) for x, z, radius in placed[2:]], np.float32)
    hue = random.uniform(0.0, 2.0 * np.pi, (len(spheres), 1))
    colors = (0.08 + 0.7 * (0.5 + 0.5 * np.cos(hue + np.array([0.0, 2.1, 4.2]))) ** 1.5).astype(np.float32)
    return shader.PlasticBalls(spheres=spheres, colors=colors)


def objects() -> tuple[shader.Floor, shader.MetalBall, shader.GlassShell, shader.PlasticBalls]:
    """What stands in the scene: the data of the hit groups' records."""
    floor = shader.Floor(
        anchor=(-16.0, 0.0, -16.0),
        edge_u=(0.0, 0.0, 40.0),
        edge_v=(40.0, 0.0, 0.0),
        light_color=(0.80, 0.76, 0.62),
        dark_color=(0.42, 0.06, 0.05),
        checks=32.0,
    )
    metal = shader.MetalBall(center=(4.0, 1.2, 1.5), radius=1.2, reflectance=(0.80, 0.79, 0.77))
    glass = shader.GlassShell(center=(0.9, 1.05, 2.6), inner_radius=0.98, outer_radius=1.05, refractive_index=1.5, tint=(0.97, 0.99, 0.98))
    return floor, metal, glass, plastic_balls()


def build_scene(
    context: ox.DeviceContext,
    floor: shader.Floor,
    metal: shader.MetalBall,
    glass: shader.GlassShell,
    plastic: shader.PlasticBalls,
) -> Build:
    """One acceleration structure of four build inputs; each has two records, one per type of rays."""
    corners = np.array([floor.anchor + a * floor.edge_u + b * floor.edge_v for a in (0.0, 1.0) for b in (0.0, 1.0)])
    boxes = [
        np.concatenate([corners.min(axis=0) - 1e-3, corners.max(axis=0) + 1e-3])[np.newaxis].astype(np.float32),
        sphere_boxes(np.array([metal.center]), np.array([metal.radius])),
        sphere_boxes(np.array([glass.center]), np.array([glass.outer_radius])),
        sphere_boxes(plastic.spheres[:, :3], plastic.spheres[:, 3]),
    ]
    return timed_build(context, [ox.BuildInputCustomPrimitives(box) for box in boxes])


def render(width: int, height: int, samples: int, *, verbose: bool = False) -> np.ndarray:
    """The picture as (height, width, 4) floats; `verbose` prints what it took."""
    context = ox.DeviceContext()
    module = context.module_create(shader)
    raygen = context.program_group_create(raygen=module["__raygen__pinhole"])
    misses = [context.program_group_create(miss=module["__miss__sky"]), context.program_group_create(miss=None)]
    kinds = [
        ("__intersection__floor", "__closesthit__checker", "__anyhit__opaque"),
        ("__intersection__metal_ball", "__closesthit__metal", "__anyhit__opaque"),
        ("__intersection__glass_shell", "__closesthit__glass", "__anyhit__glass"),
        ("__intersection__plastic_balls", "__closesthit__plastic", "__anyhit__opaque"),
    ]
    radiance = [context.program_group_create(intersection=module[i], closesthit=module[c]) for i, c, _ in kinds]
    shadow = [context.program_group_create(intersection=module[i], anyhit=module[a]) for i, _, a in kinds]
    pipeline = context.pipeline_create([raygen, *misses, *radiance, *shadow], max_trace_depth=shader.MAX_DEPTH + 2)

    floor, metal, glass, plastic = objects()
    built = build_scene(context, floor, metal, glass, plastic)

    records = []
    for radiance_group, shadow_group, data in zip(radiance, shadow, [floor, metal, glass, plastic], strict=True):
        records += [radiance_group.record(data), shadow_group.record(data)]
    table = ox.ShaderBindingTable(raygen=raygen.record(), miss=[miss.record() for miss in misses], hitgroup=records)
    image = np.zeros((height, width, 4), np.float32)
    ray_counts = np.zeros((height, width), np.uint32)
    params = shader.Params(
        image=image,
        ray_counts=ray_counts,
        scene=built.accel,
        camera=pinhole(EYE, TARGET, VERTICAL_FOV, width / height),
        sample=0,
        samples=samples,
        light_position=LIGHT_POSITION,
        light_color=LIGHT_COLOR,
        ambient_color=AMBIENT_COLOR,
    )
    seconds = accumulate(pipeline, params, table, (width, height), "Whitted's spheres")
    if verbose:
        rays = int(ray_counts.sum(dtype=np.uint64))
        print(f"  {len(plastic.spheres) + 3} custom primitives, {width} x {height} pixels, {samples} samples each")
        print_statistics(context, pipeline, built.seconds, rays, seconds)
    return image


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", type=int, default=512, help="width and height in pixels")
    parser.add_argument("--samples", type=int, default=8, help="primary rays per pixel")
    parser.add_argument("--exposure", type=float, default=0.0, help="stops")
    parser.add_argument("--output", type=Path, default=Path("whitted_spheres.png"))
    arguments = parser.parse_args()
    print("Whitted's spheres")
    image = render(arguments.size, arguments.size, arguments.samples, verbose=True)
    save(image, arguments)


if __name__ == "__main__":
    main()
