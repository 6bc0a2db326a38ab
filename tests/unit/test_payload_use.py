"""Words of a payload that the programs behind a trace look at."""

from __future__ import annotations

from pathlib import Path

import pytest

from optixc import passes
from optixc.codegen.payload_use import used_words
from optixc.codegen.program_classes import traces_of
from optixc.frontend.compile import compile_file
from optixc.ir.nodes import PipelineOptions
from optixc.passes.pipeline import link

HEAD = """import optixc as ox
from optixc import float3, uint32, uint64


@ox.struct
class Params:
    scene: ox.Traversable
    out: ox.Array[float]


@ox.struct
class Inner:
    x: float
    y: float


@ox.payload
class Ray:
    a: float
    wide: uint64
    color: float3
    inner: Inner
    last: uint32


params = ox.launch_params(Params)


@ox.device
def brighten(ray: Ray, by: float):
    ray.color.y += by


@ox.device
def whole(ray: Ray) -> Ray:
    return ox.copy(ray)


@ox.program
def __raygen__r():
    ray = Ray(1.0, uint64(2), float3(3.0), Inner(4.0, 5.0), 6)
    ox.trace(params.scene, float3(0.0), float3(0.0, 0.0, 1.0), payload=ray)
    params.out[0] = ray.a + ray.color.x + ray.inner.x + float(ray.last)


@ox.program
def __miss__m(ray: Ray):
    {body}
"""
BODIES = {
    "nothing": ("pass", set()),
    "a read": ("params.out[1] = ray.a", {0}),
    "two words": ("ray.wide = uint64(1)", {1, 2}),
    "a component": ("ray.color.x = 1.0", {3, 4, 5}),
    "a struct inside": ("ray.inner.y = 1.0", {6, 7}),
    "a helper": ("brighten(ray, ray.a)", {0, 3, 4, 5}),
    "all": ("other = whole(ray)\n    params.out[1] = other.a", set(range(9))),
    "a register": ("ox.set_payload_8(uint32(3))", {8}),
    "a trace that goes on": ("ox.trace(params.scene, float3(0.0), float3(0.0, 0.0, 1.0), payload=ray)", set(range(9))),
    "dead code": ("if False:\n        ray.a = 1.0", set()),
}


@pytest.mark.parametrize("name", BODIES)
def test_words_that_programs_use(tmp_path: Path, name: str) -> None:
    body, expected = BODIES[name]
    path = tmp_path / "shader.py"
    path.write_text(HEAD.replace("{body}", body))
    module = compile_file(str(path)).module
    pipeline = passes.run(link([module], [program.name for program in module.programs], PipelineOptions(max_trace_depth=2)))
    _, trace = next(traces_of(pipeline))
    assert trace.payload_type is not None
    assert used_words(pipeline, trace.payload_type) == expected
