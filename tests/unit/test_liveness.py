"""Which words of a payload are live at a trace and in the programs that it runs, and which are written at all."""

from __future__ import annotations

from pathlib import Path

import pytest

from optixc import passes
from optixc.codegen.emit import emit
from optixc.frontend.compile import compile_file
from optixc.ir.nodes import Pipeline, PipelineOptions
from optixc.ir.text import print_module
from optixc.passes.drop_dead_words import unread_fields
from optixc.passes.features import features
from optixc.passes.live_notes import carried_words, live_notes
from optixc.passes.live_words import numbers
from optixc.passes.pipeline import link
from optixc.passes.traced_programs import traces_of

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
def both(one: Ray, other: Ray):
    one.a = 5.0
    other.inner.x = other.a


@ox.device
def brightness(ray: Ray) -> float:
    return ray.color.x + ray.color.y


@ox.device
def aside(x: float) -> float:
    params.out[2] = x
    return x


@ox.device
def whole(ray: Ray) -> Ray:
    return ox.copy(ray)


@ox.program
def __raygen__r():
    ray = Ray(1.0, uint64(2), float3(3.0), Inner(4.0, 5.0), 6)
    ox.trace(params.scene, float3(0.0), float3(0.0, 0.0, 1.0), payload=ray)
    {behind}


@ox.program
def __miss__m(ray: Ray):
    {body}
"""

# Words: a 0, wide 1 and 2, color 3 to 5, inner 6 and 7, last 8. What stands behind the trace, the miss program, words in, out, between.
CASES = {
    "nothing": ("pass", "pass", [], []),
    "read by the program": ("pass", "params.out[1] = ray.a", [0], []),
    "read behind": ("params.out[0] = ray.color.y", "pass", [4], [4]),
    "written by the program": ("params.out[0] = ray.a", "ray.a = 2.0", [0], [0]),
    "written for nobody": ("params.out[0] = ray.a", "ray.last = 3\n    ray.a = 1.0", [0], [0]),
    "kept from a word for another": ("params.out[0] = ray.a", "ray.a = ray.inner.y", [0, 7], [0]),
    "kept for nobody": ("params.out[0] = ray.a", "ray.wide = uint64(ray.last)", [0], [0]),
    "by a helper": ("params.out[0] = brightness(ray)", "brighten(ray, ray.a)", [0, 3, 4], [3, 4]),
    "around a helper of something else": ("aside(2.0)\n    params.out[0] = ray.a", "ray.a = 1.0\n    aside(3.0)", [0], [0]),
    "written before it is read": ("ray.a = 1.0\n    params.out[0] = ray.a", "pass", [], []),
    "in one branch": ("if ray.last > 3:\n        ray.a = 1.0\n    params.out[0] = ray.a", "pass", [0, 8], [0, 8]),
    "in a loop": ("for k in range(3):\n        params.out[k] = ray.a\n        ray.a = ray.inner.x", "pass", [0, 6], [0, 6]),
    "left by break": ("while True:\n        if ray.a > 1.0:\n            break\n        ray.a = 2.0", "pass", [0], [0]),
    "a copy": ("other = whole(ray)\n    params.out[1] = other.a", "pass", list(range(9)), list(range(9))),
    "a register": ("params.out[0] = ray.a", "ox.set_payload_8(ox.get_payload_7())", [0, 7], [0]),
    "traced on": ("pass", "ox.trace(params.scene, float3(0.0), float3(0.0, 0.0, 1.0), payload=ray)\n    params.out[0] = ray.a", [0], []),
    "one struct twice": ("both(ray, ray)\n    params.out[0] = ray.inner.x", "pass", list(range(9)), list(range(9))),
    "dead code": ("pass", "if False:\n        params.out[0] = ray.a", [], []),
}


def made(tmp_path: Path, behind: str, body: str, *, passed: bool, head: str = HEAD, **options: bool) -> Pipeline:
    path = tmp_path / "shader.py"
    path.write_text(head.replace("{behind}", behind).replace("{body}", body))
    module = compile_file(str(path)).module
    linked = link([module], [program.name for program in module.programs], PipelineOptions(max_trace_depth=2, **options))
    return passes.run(linked) if passed else linked


@pytest.mark.parametrize("name", CASES)
def test_words_of_a_trace(tmp_path: Path, name: str) -> None:
    behind, body, into, out_of = CASES[name]
    pipeline = made(tmp_path, behind, body, passed=True)
    _, trace = next(traces_of(pipeline))
    words = carried_words(pipeline)[id(trace)]
    assert (numbers(words.into), numbers(words.out_of), numbers(words.between)) == (into, out_of, [])
    assert numbers(words.dead) == sorted(set(range(9)) - {*into, *out_of})


def test_dead_words_are_not_written(tmp_path: Path) -> None:
    pipeline = made(tmp_path, "params.out[0] = ray.a", "ray.last = 3\n    ray.color = float3(7.0)\n    ray.a = ray.a + 1.0", passed=True)
    text = print_module(pipeline)
    assert "ray.last" not in text and "ray.color" not in text and "ray.a = " in text
    (ray,) = unread_fields(pipeline)
    assert unread_fields(pipeline)[ray] == {"wide", "color", "inner", "last"}
    struct = emit(pipeline, features(pipeline)).partition("struct Ray {")[2].partition("};")[0]
    assert struct.split() == "float a; /* Nobody reads wide, color, inner, last. */".split()


@pytest.mark.parametrize("option", ["debug", "validation"])
def test_checked_builds_keep_all_words(tmp_path: Path, option: str) -> None:
    pipeline = made(tmp_path, "params.out[0] = ray.a", "ray.last = 3", passed=True, **{option: True})
    assert "ray.last = " in print_module(pipeline)
    assert unread_fields(pipeline) == {}


def test_fields_stay_where_words_have_numbers_or_other_names(tmp_path: Path) -> None:
    assert unread_fields(made(tmp_path, "params.out[0] = ray.a", "ox.set_payload_0(uint32(1))", passed=True)) == {}
    alike = HEAD.replace("params = ox", "@ox.payload\nclass Alike:\n    a: float\n    wide: uint64\n    color: float3\n    inner: Inner\n"
                         "    rest: uint32\n\n\nparams = ox") + "\n\n@ox.program\ndef __miss__alike(ray: Alike):\n    ray.a = 2.0\n"
    fields = unread_fields(made(tmp_path, "params.out[0] = ray.a", "pass", passed=True, head=alike))
    assert not any(fields.values())


def test_semantics_say_what_passes(tmp_path: Path) -> None:
    head = HEAD.replace("a: float\n", 'a: float = ox.payload_word(caller="r", ms="w")\n').replace(
        "last: uint32", 'last: uint32 = ox.payload_word(caller="w", ms="r")').replace("one.a = 5.0", "pass").replace("other.a", "1.0")
    pipeline = made(tmp_path, "params.out[0] = ray.a", "ray.a = float(ray.last)", passed=False, head=head)
    _, trace = next(traces_of(pipeline))
    words = carried_words(pipeline)[id(trace)]
    assert (numbers(words.into), numbers(words.out_of)) == ([8], [0])


def test_values_live_across_a_trace(tmp_path: Path) -> None:
    head = HEAD.replace("    ray = Ray", "    i = ox.get_launch_index()\n    k = i.y\n    ray = Ray")
    pipeline = made(tmp_path, "params.out[i.x] = ray.a", "params.out[2] = ray.a", passed=False, head=head)
    _, trace = next(traces_of(pipeline))
    assert live_notes(pipeline)[id(trace)][1] == "live across: i (1 word, 4 bytes)"
