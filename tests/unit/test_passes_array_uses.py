"""Which arrays a pipeline reads and writes, in place or by views that go through locals, helpers, callables, structs and records."""

from __future__ import annotations

from pathlib import Path

import pytest

from optixc import passes
from optixc.frontend.compile import compile_file
from optixc.ir.nodes import PipelineOptions
from optixc.passes.array_uses import ArrayUse, array_uses
from optixc.passes.pipeline import link

HEAD = """import optixc as ox
from optixc import Array, Array2, float3, uint32


@ox.struct
class Cell:
    x: float
    p: float3


@ox.struct
class Inner:
    out: Array[float]
    source: Array[float]


@ox.struct
class Params:
    image: Array2[float3]
    a: Array[float]
    b: Array[float]
    cells: Array[Cell]
    counts: Array[uint32]
    inner: Inner
    choose: bool


@ox.struct
class Data:
    written: Array[float]
    read: Array[float]


@ox.payload
class Ray:
    x: float


params = ox.launch_params(Params)


@ox.device
def put(array: Array[float], x: float):
    array[0] = x


@ox.device
def put_inner(inner: Inner, x: float):
    inner.out[0] = x + inner.source[0]


@ox.device
def choose(flag: bool) -> Array[float]:
    return params.a if flag else params.b


@ox.program
def __raygen__r(data: Data):
    ray = Ray(params.a[0] + params.cells[1].x)
{body}


@ox.program
def __closesthit__c(ray: Ray, data: Data):
    ray.x = data.read[0]


@ox.program
def __direct_callable__d(inner: Inner) -> float:
    inner.out[1] = 2.0
    return 1.0
"""
BODIES: dict[str, tuple[str, set[str]]] = {
    "nothing": ("x = params.b[1] + data.read[0]", set()),
    "a store": ("params.image[1, 2] = float3(1.0)", {"params.image"}),
    "a component": ("params.image[1, 2].x = 1.0", {"params.image"}),
    "an augmented store": ("params.a[0] += params.b[0]", {"params.a"}),
    "a field of an element": ("params.cells[2].p.y = params.b[0]", {"params.cells"}),
    "an atomic": ("ox.atomic_add(params.counts, 0, uint32(1))", {"params.counts"}),
    "a local": ("view = params.a\n    view[0] = params.b[0]", {"params.a"}),
    "one of two": ("view = params.a if params.choose else params.b\n    view[0] = 1.0", {"params.a", "params.b"}),
    "a helper": ("put(params.b, params.a[0])", {"params.b"}),
    "a struct to a helper": ("put_inner(params.inner, 1.0)", {"params.inner.out"}),
    "a struct made here": ("made = Inner(params.b, params.a)\n    put_inner(made, 1.0)", {"params.b"}),
    "a field set later": ("made = Inner(params.b, params.b)\n    made.out = params.a\n    made.out[0] = 1.0", {"params.a", "params.b"}),
    "a result": ("view = choose(params.choose)\n    view[0] = 1.0", {"params.a", "params.b"}),
    "a callable": ("x = ox.direct_call(0, params.inner, result=float)", {"params.inner.out"}),
    "the record": ("data.written[0] = params.b[0]", {"record __raygen__r.written"}),
    "the record through a helper": ("put(data.written, 1.0)", {"record __raygen__r.written"}),
    "asked data": ("asked = ox.get_sbt_data(Data)\n    put(asked.written, 1.0)", {"record __raygen__r.written"}),
    "a local that is no view": ("x = params.a[0]\n    x += 1.0\n    ray.x = x", set()),
    "dead code": ("if False:\n        params.a[0] = 1.0", set()),
}


ALWAYS = {"params.a", "params.cells", "record __closesthit__c.read"}
READ: dict[str, tuple[str, set[str]]] = {
    "a read": ("ray.x = params.b[1]", {"params.b"}),
    "the shape": ("ray.x = float(params.b.shape[0] + params.image.shape[1])", set()),
    "an index": ("ray.x = params.a[int(params.b[0])]", {"params.b"}),
    "a written element": ("params.b[0] = 1.0", {"params.b"}),
    "a condition": ("while params.b[0] > 1.0 or params.inner.source[2] < 1.0:\n        ray.x += 1.0", {"params.b", "params.inner.source"}),
    "an atomic": ("ox.atomic_add(params.counts, 0, uint32(1))", {"params.counts"}),
    "one of two": ("view = params.inner.out if params.choose else params.b\n    ray.x = view[0]", {"params.inner.out", "params.b"}),
    "a result": ("ray.x = choose(params.choose)[0]", {"params.b"}),
    "a struct to a helper": ("put_inner(params.inner, 1.0)", {"params.inner.out", "params.inner.source"}),
    "a callable": ("x = ox.direct_call(0, params.inner, result=float)", {"params.inner.out"}),
    "the record": ("ray.x = data.read[0]", {"record __raygen__r.read"}),
    "dead code": ("if False:\n        ray.x = params.b[0]", set()),
}


def uses(tmp_path: Path, body: str) -> tuple[ArrayUse, ...]:
    path = tmp_path / "shader.py"
    path.write_text(HEAD.replace("{body}", f"    {body}"))
    module = compile_file(str(path)).module
    names = [program.name for program in module.programs if "direct_call" in body or "direct_callable" not in program.name]
    return array_uses(passes.run(link([module], names, PipelineOptions())))


@pytest.mark.parametrize("name", BODIES)
def test_arrays_that_a_pipeline_writes(tmp_path: Path, name: str) -> None:
    body, expected = BODIES[name]
    assert {".".join(one.path) for one in uses(tmp_path, body) if one.written is not None} == expected


@pytest.mark.parametrize("name", READ)
def test_arrays_that_a_pipeline_uses(tmp_path: Path, name: str) -> None:
    body, expected = READ[name]
    found = uses(tmp_path, f"{body}\n    print(ray.x)")
    assert {".".join(one.path) for one in found} == expected | ALWAYS
    assert len(found) == len({one.path for one in found})


def test_the_first_use_is_told(tmp_path: Path) -> None:
    found = {".".join(one.path): one for one in uses(tmp_path, "ray.x = params.b[0]\n    params.b[1] = 2.0\n    print(ray.x)")}
    first = found["params.a"].used.line
    assert (found["params.b"].used.line, found["params.b"].written.line) == (first + 1, first + 2)
    assert found["params.a"].written is None
