"""The shaders of benchmarks/shaders as optixc pipelines over the same arrays that the hand-written kernels read."""

from __future__ import annotations

import importlib
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any, Literal

import numpy as np

import optixc as ox
from benchmarks.handwritten import floor_box, sphere_boxes
from benchmarks.measure import LaunchContender
from benchmarks.scenes import GLASS, MATERIALS, METAL, QUAD_TRIANGLES, SUN, Floats, Scene
from benchmarks.workloads import Workload

SHADERS = Path(__file__).resolve().parent / "shaders"
TRACE_DEPTHS = {"primary": 1, "ambient_occlusion": 1, "path": 2, "heavy": 2, "whitted": 8, "cutouts": 2, "shapes": 1}


@dataclass
class Programs:
    """What a workload gives a launch: program groups, the records of the table, fields of the parameters besides image and camera."""

    raygen: ox.ProgramGroup
    misses: list[ox.ProgramGroup]
    hits: list[tuple[ox.ProgramGroup, Any]]
    params: dict[str, Any]
    inputs: list[Any]


@dataclass
class Ours(LaunchContender):
    """A workload compiled by optixc, ready to run."""

    image: Floats
    keep: tuple[Any, ...]


@contextmanager
def compiling_with(compiler: str | None) -> Iterator[None]:
    """Chooses the C++ compiler of optixc for what happens inside."""
    before = os.environ.get("OPTIXC_CXX")
    if compiler is not None:
        os.environ["OPTIXC_CXX"] = compiler
    try:
        yield
    finally:
        if compiler is not None:
            os.environ.pop("OPTIXC_CXX")
            if before is not None:
                os.environ["OPTIXC_CXX"] = before


def shader_module(name: str) -> ModuleType:
    """The shader file `name` as a Python module: host code makes its parameters and records."""
    if str(SHADERS) not in sys.path:
        sys.path.insert(0, str(SHADERS))
    return importlib.import_module(name)


def _vec(values: Floats) -> tuple[float, ...]:
    return tuple(float(v) for v in values)


class _Maker:
    """Program groups by short names."""

    def __init__(self, context: ox.DeviceContext, shader: ModuleType) -> None:
        self.context = context
        self.shader = shader
        self.module = context.module_create(shader)

    def group(self, **names: str | None) -> ox.ProgramGroup:
        """`closesthit="matte"` means `__closesthit__matte`."""
        programs = {kind: None if name is None else self.module[f"__{kind}__{name}"] for kind, name in names.items()}
        return self.context.program_group_create(**programs)


def _primary(make: _Maker, scene: Scene) -> Programs:
    mesh = make.shader.Mesh(triangles=scene.triangles, normals=scene.normals)
    hits = [(make.group(closesthit="normal"), mesh)]
    inputs = [ox.BuildInputTriangles(scene.vertices, scene.triangles)]
    return Programs(make.group(raygen="primary"), [make.group(miss="black")], hits, {}, inputs)


def _ambient_occlusion(make: _Maker, scene: Scene) -> Programs:
    params = {"width": 1024, "radius": scene.radius, "offset": scene.offset}
    misses = [make.group(miss="nothing"), make.group(miss="visible")]
    hits = [(make.group(closesthit="surface"), None)]
    return Programs(make.group(raygen="ambient_occlusion"), misses, hits, params, [ox.BuildInputTriangles(scene.vertices, scene.triangles)])


def _tracer(make: _Maker, scene: Scene, heavy: bool) -> Programs:
    light = scene.light
    surface = make.group(closesthit="principled" if heavy else "matte")
    hits: list[tuple[ox.ProgramGroup, Any]] = []
    for color, values in zip(scene.colors[:4], scene.surfaces[:4], strict=True):
        record = make.shader.Principled(_vec(color), *map(float, values)) if heavy else make.shader.Matte(_vec(color))
        hits.append((surface, record))
    hits.append((make.group(closesthit="light"), None))
    lamp = make.shader.Light(
        corner=_vec(light.corner),
        edge_u=_vec(light.edge_u),
        edge_v=_vec(light.edge_v),
        n=_vec(light.n),
        radiance=_vec(light.radiance),
        area=light.area,
    )
    params = {"light": lamp, "sky": _vec(scene.sky), "width": 1024, "offset": scene.offset, "noise_scale": scene.noise_scale}
    inputs = [
        ox.BuildInputTriangles(scene.vertices, scene.triangles, num_sbt_records=4, flags=[0] * 4, sbt_index_offsets=scene.material_of),
        ox.BuildInputTriangles(light.vertices, QUAD_TRIANGLES),
    ]
    return Programs(make.group(raygen="path"), [make.group(miss="sky"), make.group(miss="visible")], hits, params, inputs)


def _whitted(make: _Maker, scene: Scene) -> Programs:
    names = {GLASS: "glass", METAL: "metal"}
    opaque = make.group(intersection="sphere", anyhit="opaque_shadow")
    glass = make.group(intersection="sphere", anyhit="glass_shadow")
    kinds = {name: make.group(intersection="sphere", closesthit=name) for name in ("glass", "metal", "paint")}
    hits: list[tuple[ox.ProgramGroup, Any]] = []
    for color, kind in zip(scene.colors[:-1], scene.kinds[:-1], strict=True):
        data = make.shader.Material(_vec(color))
        hits += [(kinds[names.get(int(kind), "paint")], data), (glass if kind == GLASS else opaque, None)]
    hits += [(make.group(intersection="floor", closesthit="checker"), make.shader.Material(_vec(scene.colors[-1])))]
    hits += [(make.group(intersection="floor", anyhit="opaque_shadow"), None)]
    params = {"spheres": scene.spheres, "floor_size": scene.floor_size, "light": _vec(scene.light.corner)}
    params |= {"sky": _vec(scene.sky), "offset": scene.offset}
    boxes, records = sphere_boxes(scene.spheres), MATERIALS - 1
    inputs = [
        ox.BuildInputCustomPrimitives(boxes, num_sbt_records=records, flags=[0] * records, sbt_index_offsets=scene.material_of),
        ox.BuildInputCustomPrimitives(floor_box(scene.floor_size)),
    ]
    return Programs(make.group(raygen="whitted"), [make.group(miss="sky"), make.group(miss="lit")], hits, params, inputs)


def _cutouts(make: _Maker, scene: Scene) -> Programs:
    leaves = make.shader.Leaves(triangles=scene.triangles, uvs=scene.uvs, texels=scene.texels)
    hits = [(make.group(closesthit="leaf", anyhit="alpha"), leaves), (make.group(anyhit="alpha"), leaves)]
    params = {"sun": _vec(SUN), "sky": _vec(scene.sky), "offset": scene.offset}
    inputs = [ox.BuildInputTriangles(scene.vertices, scene.triangles)]
    return Programs(make.group(raygen="cutouts"), [make.group(miss="sky"), make.group(miss="visible")], hits, params, inputs)


def _shapes(make: _Maker, scene: Scene) -> Programs:
    places, radii = np.ascontiguousarray(scene.points[:, :3]), np.ascontiguousarray(scene.points[:, 3])
    curves = ox.BuildInputCurves(ox.PrimitiveType.ROUND_LINEAR, places, radii, scene.segments)
    built = curves if len(scene.segments) else ox.BuildInputSpheres(places, radii)
    return Programs(make.group(raygen="shapes"), [make.group(miss="nothing")], [(make.group(closesthit="shape"), None)], {}, [built])


_SETUPS: dict[str, Callable[[_Maker, Scene], Programs]] = {
    "primary": _primary,
    "ambient_occlusion": _ambient_occlusion,
    "path": lambda make, scene: _tracer(make, scene, heavy=False),
    "heavy": lambda make, scene: _tracer(make, scene, heavy=True),
    "whitted": _whitted,
    "cutouts": _cutouts,
    "shapes": _shapes,
}


def ours(
    context: ox.DeviceContext, scene: Scene, workload: Workload, lanes: int | Literal["auto"], compiler: str | None = None
) -> Ours:
    """A workload at `lanes` lanes, compiled with `compiler` or the one that optixc chooses."""
    shader = shader_module(workload.source)
    programs = _SETUPS[workload.name](_Maker(context, shader), scene)
    groups = [programs.raygen, *programs.misses, *(group for group, _ in programs.hits)]
    with compiling_with(compiler):
        pipeline = context.pipeline_create(list(dict.fromkeys(groups)), max_trace_depth=TRACE_DEPTHS[workload.name], simd=lanes)
    width, height = workload.launch_size
    image = np.zeros((height, width, 4), np.float32)
    eye, u, v, w = (_vec(getattr(scene.camera, name)) for name in ("eye", "u", "v", "w"))
    camera = shader_module("camera").Camera(eye=eye, u=u, v=v, w=w, pixel=(2.0 / width, 2.0 / width), skip=workload.skip)
    accel = context.accel_build(programs.inputs)
    params = shader.Params(image=image, scene=accel, camera=camera, **programs.params)
    table = ox.ShaderBindingTable(
        raygen=programs.raygen.record(),
        miss=[group.record() for group in programs.misses],
        hitgroup=[group.record() if data is None else group.record(data) for group, data in programs.hits],
    )
    name = f"ours {lanes}{'' if compiler is None else ' ' + compiler}"
    return Ours(name, pipeline, table, params, width, height, image, (accel, context))
