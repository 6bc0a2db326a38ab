"""Nine materials, each a graph of direct callables: python examples/12_callables/host.py"""

from __future__ import annotations

import sys
from pathlib import Path

import network
import numpy as np
import shader

import optixc as ox
from optixc.stdlib import shapes
from optixc.stdlib.light import RectangleLight

sys.path.append(str(Path(__file__).resolve().parents[1]))
from rendering import accumulate, options, pinhole

EYE = (0.0, 3.5, 10.8)
TARGET = (0.0, 0.78, 0.1)
VERTICAL_FOV = 28.0


def lamp(center: tuple[float, float, float], width: float, height: float, radiance: tuple[float, float, float]) -> RectangleLight:
    """A rectangle that faces the origin, its upper edge horizontal."""
    inwards = -np.array(center)
    right = np.cross(inwards, [0.0, 1.0, 0.0])
    edge_u = width * right / np.linalg.norm(right)
    up = np.cross(edge_u, inwards)
    edge_v = height * up / np.linalg.norm(up)
    return RectangleLight(corner=center - 0.5 * (edge_u + edge_v), edge_u=edge_v, edge_v=edge_u, radiance=radiance)


def lamps() -> list[RectangleLight]:
    """A key light, a fill light and one from behind."""
    return [
        lamp((-5.5, 6.2, 5.6), 5.0, 4.0, (9.0, 8.5, 7.7)),
        lamp((8.6, 4.0, 3.2), 3.0, 5.0, (2.6, 3.0, 3.5)),
        lamp((1.5, 9.0, -4.5), 8.0, 2.5, (5.0, 5.0, 5.0)),
    ]


def placed(x: float, z: float, turn: float = 0.0, lean: float = 0.0, height: float = 1.0, scale: float = 1.0) -> np.ndarray:
    """Leans about x, turns about y (degrees), then stands at (x, z) with its middle at `height`."""
    a, b = np.radians([turn, lean])
    turned = np.array([[np.cos(a), 0, np.sin(a)], [0, 1, 0], [-np.sin(a), 0, np.cos(a)]])
    leaned = np.array([[1, 0, 0], [0, np.cos(b), -np.sin(b)], [0, np.sin(b), np.cos(b)]])
    return np.column_stack([scale * turned @ leaned, [x, height, z]])


def objects(net: network.Network) -> list[tuple[shapes.Mesh, int, float, np.ndarray]]:
    """Mesh, reflection node, roughness of its sharpest part, and place."""
    ball, cube = shapes.superellipsoid(1.0, 1.0), shapes.superellipsoid(0.28, 0.28)
    drum, crystal = shapes.superellipsoid(0.25, 1.0), shapes.superellipsoid(1.9, 1.9)
    ring = shapes.torus(0.72, 0.3)
    return [
        (shapes.backdrop(40.0, 30.0, -4.0, 4.5, 9.0), network.paper(net), 0.35, placed(0.0, 0.0, height=0.0)),
        (cube, network.marble(net), 0.12, placed(-2.75, -1.6, turn=28.0)),
        (ball, network.gilded(net), 0.16, placed(0.0, -2.0, turn=20.0, lean=20.0)),
        (drum, network.rusty(net), 0.3, placed(2.75, -1.6, turn=15.0)),
        (ring, network.candy(net), 0.15, placed(-1.45, 0.35, turn=-28.0, lean=78.0, height=1.02)),
        (ball, network.cloth(net), 0.6, placed(1.45, 0.35, height=0.85, scale=0.85)),
        (ball, network.wood(net), 0.2, placed(-3.3, 1.25, height=0.8, scale=0.8)),
        (cube, network.patina(net), 0.22, placed(0.0, 1.75, turn=40.0, height=0.62, scale=0.62)),
        (ball, network.jade(net), 0.12, placed(-1.65, 2.35, height=0.55, scale=0.55)),
        (ring, network.car_paint(net), 0.1, placed(3.1, 1.45, turn=10.0, height=0.33, scale=1.1)),
        (crystal, network.marble(net), 0.12, placed(1.6, 2.4, turn=20.0, height=0.75, scale=0.75)),
    ]


def render(width: int, height: int, samples: int) -> np.ndarray:
    """The picture as (height, width, 4) floats."""
    context = ox.DeviceContext()
    module = context.module_create(shader)
    raygen = context.program_group_create(raygen=module["__raygen__studio"])
    miss = context.program_group_create(miss=module["__miss__studio"])
    hit = context.program_group_create(closesthit=module["__closesthit__object"])
    net = network.Network(context, module)
    pipeline = context.pipeline_create([raygen, miss, hit, *net.groups.values()], max_trace_depth=1)

    instances, records = [], []
    for number, (mesh, reflection, roughness, transform) in enumerate(objects(net)):
        accel = context.accel_build([ox.BuildInputTriangles(mesh.vertices, mesh.indices)])
        instances.append(ox.Instance(accel, transform=transform, sbt_offset=number))
        records.append(hit.record(shader.Object(indices=mesh.indices, normals=mesh.normals, reflection=reflection, roughness=roughness)))
    scene = context.accel_build([ox.BuildInputInstances(instances)])
    table = ox.ShaderBindingTable(raygen=raygen.record(), miss=[miss.record()], hitgroup=records, callables=net.records)

    image = np.zeros((height, width, 4), np.float32)
    camera = pinhole(EYE, TARGET, VERTICAL_FOV, width / height)
    params = shader.Params(image=image, scene=scene, lamps=lamps(), camera=camera, sample=0, samples=samples)
    accumulate(pipeline, params, table, (width, height), "material network")
    print(f"{len(instances)} objects, {len(net.records)} nodes in {len(net.groups)} programs")
    return image


def main() -> None:
    arguments = options(__doc__, "materials.png", 960, 540, 64).parse_args()
    image = render(arguments.width, arguments.height, arguments.samples)
    ox.write_image(arguments.output, image, exposure=arguments.exposure)
    print(f"wrote {arguments.output}")


if __name__ == "__main__":
    main()
