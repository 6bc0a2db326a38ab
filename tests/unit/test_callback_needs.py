"""What callbacks over lanes keep for programs of a payload class: attributes and the hit only where a program asks for them."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from optixc import driver
from optixc.frontend.compile import compile_file
from optixc.options import CompileOptions

SOURCE = """import optixc as ox
from optixc import float3


@ox.struct
class Params:
    scene: ox.Traversable
    out: ox.Array[float]


@ox.payload
class Ray:
    value: float


@ox.attributes
class Surface:
    n: float3


params = ox.launch_params(Params)


@ox.program
def __raygen__r():
    ray = Ray(1.0)
    {trace}
    params.out[0] = ray.value


@ox.program
def __intersection__s():
    ox.report_intersection(float(ox.get_primitive_index()), 0, Surface(float3(1.0)))


@ox.program
def __anyhit__a(ray: Ray{surface}):
    ray.value = {anyhit}


@ox.program
def __closesthit__c(ray: Ray{surface}):
    ray.value = {closesthit}
"""
RAY = "params.scene, float3(0.0), float3(0.0, 0.0, 1.0)"
TRACE, TRAVERSE = f"ox.trace({RAY}, payload=ray)", f"ox.traverse({RAY}, payload=ray)\n    ox.invoke(ray)"


def callback_needs(folder: Path, anyhit: str, closesthit: str, trace: str = TRACE) -> tuple[bool, bool]:
    """Whether the emitted class keeps attributes, and whether its callbacks enter the hit."""
    surface = ", surface: Surface" if "surface" in anyhit + closesthit else ""
    path = folder / "shader.py"
    path.write_text(SOURCE.format(anyhit=anyhit, closesthit=closesthit, trace=trace, surface=surface))
    module = compile_file(str(path)).module
    text = driver.emit([module], [program.name for program in module.programs], CompileOptions(simd=16)).text
    [lane_class] = re.findall(r"struct RayProgramsLanes .*?};", text, re.DOTALL)
    return "attributeWords = 3" in lane_class, "callbacksReadHit = true" in lane_class


@pytest.mark.parametrize(
    "anyhit, closesthit, trace, keeps_attributes, reads_hit",
    [
        ("0.5", "2.0", TRACE, False, False),
        ("0.5", "surface.n.x", TRACE, True, False),
        ("surface.n.y", "2.0", TRACE, True, False),
        ("0.5", "float(ox.get_attribute_0())", TRACE, True, False),
        ("float(ox.get_primitive_index())", "2.0", TRACE, False, True),
        ("ox.get_ray_tmax()", "float(ox.get_primitive_index())", TRACE, False, False),
        ("0.5", "2.0", TRAVERSE, True, False),
    ],
    ids=["nothing", "closest hit", "any hit", "by number", "primitive", "distance", "hit object"],
)
def test_kept_where_asked_for(tmp_path: Path, anyhit: str, closesthit: str, trace: str, keeps_attributes: bool, reads_hit: bool) -> None:
    assert callback_needs(tmp_path, anyhit, closesthit, trace) == (keeps_attributes, reads_hit)
