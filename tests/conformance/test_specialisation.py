"""Area E: launch parameters and specialisation."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from harness import SHADERS, Harness
from shaders import bound as shader

import optixc as ox
from optixc.cli import main

SHADER = SHADERS / "bound.py"
LIGHT = shader.Light((10.0, 0.5, 0.0), True)


def make(context: ox.DeviceContext, module_values: Any = None, **options: Any) -> tuple[Any, Any]:
    module = context.module_create(SHADER, bound_values=module_values)
    group = context.program_group_create(raygen=module["__raygen__branch"])
    return group, context.pipeline_create([group], **options)


def run(group: Any, pipeline: Any, k: int, light: Any = LIGHT) -> float:
    out = np.zeros(1, np.float32)
    pipeline.launch(shader.Params(out=out, k=k, light=light), ox.ShaderBindingTable(raygen=group.record()), 1)
    return float(out[0])


@pytest.mark.parametrize("k", [3, 4])
def test_T042_each_launch_sees_its_own_parameters(harness: Harness, k: int) -> None:
    module = harness.module("bound.py")
    group = harness.context.program_group_create(raygen=module["__raygen__branch"])
    pipeline = harness.pipeline("bound", [group])
    out = np.zeros(1, np.float32)
    harness.launch(pipeline, shader.Params(out=out, k=k, light=LIGHT), ox.ShaderBindingTable(raygen=group.record()), 1)
    assert out[0] == pytest.approx((math.sin(0.5) + 1000 if k == 3 else math.cos(0.5) + 2000) + 10, rel=1e-6)


@pytest.mark.parametrize("values", [{"k": 3}, {"light": LIGHT}, {"k": 3, "light.enabled": True, "light.color": (10.0, 0.5, 0.0)}])
def test_T046_the_result_is_that_of_the_unbound_pipeline(values: dict[str, Any]) -> None:
    context = ox.DeviceContext()
    assert run(*make(context, bound_values=values), 3) == run(*make(context), 3)


def test_T046_the_dead_branch_is_gone_from_ir_and_cpp(capsys: pytest.CaptureFixture[str]) -> None:
    for form in (["--emit", "ir", "--print-after", "remove_unused"], ["--emit", "cpp"]):
        assert main([str(SHADER), *form]) == 0
        assert "only_other" in capsys.readouterr().out
        assert main([str(SHADER), *form, "--bind", "k=3"]) == 0
        text = capsys.readouterr().out
        assert "only_three" in text
        assert "only_other" not in text
        assert "k ==" not in text


@pytest.mark.parametrize(("values", "message"), [
    ({"m": 1}, "no field"), ({"light.size": 1}, "no field"), ({"k": ()}, "no bytes"), ({"k": 1.5}, "takes a int32"),
    ({"light": LIGHT, "light.enabled": False}, "overlap"), ({"out": 3}, "can be bound"), ({"k": (1, 2)}, "takes a int32"),
    ({"light.color": (1.0, 2.0)}, "takes 3 numbers"), ({"k.": 1}, "no field name"),
])
def test_T047_wrong_bound_values(values: dict[str, Any], message: str) -> None:
    context = ox.DeviceContext()
    with pytest.raises(ox.InvalidValueError, match=message):
        make(context, values)
    with pytest.raises(ox.InvalidValueError, match=message):
        make(context, bound_values=values)


def test_T047_modules_that_bind_one_field(tmp_path: Path) -> None:
    other = tmp_path / "other.py"
    other.write_text(SHADER.read_text().replace("__raygen__branch", "__raygen__other"))
    context = ox.DeviceContext()

    def both(a: Any, b: Any) -> Any:
        first, second = context.module_create(SHADER, bound_values=a), context.module_create(other, bound_values=b)
        groups = [context.program_group_create(raygen=first["__raygen__branch"]),
                  context.program_group_create(raygen=second["__raygen__other"])]
        return groups[0], context.pipeline_create(groups)

    with pytest.raises(ox.InvalidValueError, match=r"bound value 'k' is 1 in bound and 2 in other"):
        both({"k": 1}, {"k": 2})
    assert run(*both({"k": 3}, {"k": 3}), 3) == run(*both({"k": 3}, None), 3) == run(*both(None, None), 3)


def test_T048_the_log_names_each_bound_value() -> None:
    messages: list[tuple[int, str, str]] = []
    context = ox.DeviceContext(log_callback=lambda level, tag, text: messages.append((level, tag, text)))
    make(context, bound_values={"k": ox.BoundValue(3, annotation="samples"), "light.enabled": True})
    told = [text for level, tag, text in messages if (level, tag) == (4, "COMPILER") and text.startswith("bound value")]
    assert told == ["bound value k = 3 (samples) replaces 1 reads", "bound value light.enabled = True (No annotation) replaces 1 reads"]


def test_T049_parameters_passed_on_are_read_as_they_are(tmp_path: Path) -> None:
    text = SHADER.read_text().replace("def only_three() -> float:\n    return ox.sin(params.light.color.y)",
                                      "def only_three(light: Light) -> float:\n    return ox.sin(light.color.y)")
    path = tmp_path / "passed.py"
    path.write_text(text.replace("only_three()", "only_three(params.light)"))
    context = ox.DeviceContext()
    module = context.module_create(path)
    group = context.program_group_create(raygen=module["__raygen__branch"])
    pipeline = context.pipeline_create([group], bound_values={"k": 3, "light": LIGHT})
    assert run(group, pipeline, 3) == run(*make(context), 3)


def test_T015_a_launch_with_another_value_than_the_bound_one() -> None:
    context = ox.DeviceContext(validation=True)
    group, pipeline = make(context, bound_values={"k": 3, "light.color": (10.0, 0.5, 0.0)})
    assert run(group, pipeline, 3) == pytest.approx(math.sin(0.5) + 1010, rel=1e-6)
    with pytest.raises(ox.ValidationFailureError, match="launch parameter `k` is bound to 3"):
        run(group, pipeline, 4)
    with pytest.raises(ox.ValidationFailureError, match=r"launch parameter `light.color` is bound to"):
        run(group, pipeline, 3, shader.Light((1.0, 0.5, 0.0), True))
    assert run(group, pipeline, 3) == pytest.approx(math.sin(0.5) + 1010, rel=1e-6)


def test_T043_a_pipeline_without_parameters_ignores_them(tmp_path: Path) -> None:
    path = tmp_path / "none.py"
    path.write_text("import optixc as ox\n\n\n@ox.program\ndef __raygen__r():\n    i = ox.get_launch_index()\n")
    context = ox.DeviceContext()
    group = context.program_group_create(raygen=context.module_create(path)["__raygen__r"])
    context.pipeline_create([group]).launch(LIGHT, ox.ShaderBindingTable(raygen=group.record()), 1)


def test_T044_parameters_of_another_size() -> None:
    group, pipeline = make(ox.DeviceContext())
    with pytest.raises(ox.InvalidValueError, match="launch parameters are a Params"):
        pipeline.launch(LIGHT, ox.ShaderBindingTable(raygen=group.record()), 1)


def test_T045_modules_with_different_parameters(tmp_path: Path) -> None:
    other = tmp_path / "other.py"
    other.write_text(SHADER.read_text().replace("__raygen__branch", "__raygen__other").replace("k: ox.int32", "k: ox.int64"))
    context = ox.DeviceContext()
    groups = [context.program_group_create(raygen=context.module_create(SHADER)["__raygen__branch"]),
              context.program_group_create(raygen=context.module_create(other)["__raygen__other"])]
    with pytest.raises(ox.PipelineLinkError, match="share one struct of launch parameters"):
        context.pipeline_create(groups)


PLAIN = """import optixc as ox
from optixc import Array, float3


@ox.struct
class Params:
    out: Array[float]
    scene: ox.Traversable


@ox.payload
class Ray:
    t: float


params = ox.launch_params(Params)


@ox.program
def __raygen__r():
    ray = Ray(0.0)
    ox.trace(params.scene, float3(0.0), float3(0.0, 0.0, 1.0), payload=ray)
    params.out[ox.get_launch_index().x] = ray.t


@ox.program
def __closesthit__c(ray: Ray):
    ray.t = ox.get_ray_tmax()
"""


@pytest.mark.parametrize("simd", ["1", "8", "16"])
def test_T293_what_no_program_uses_is_not_compiled_in(tmp_path: Path, capsys: pytest.CaptureFixture[str], simd: str) -> None:
    path = tmp_path / "plain.py"
    words = ("usesTime", "usesMicromaps", "hasAnyHit", "hasIntersection", "hasMiss", "countsDepth", "mayThrow", "throwException",
             "takeException", "isCancelled", "print(", "ToWorld", "HitObject", "findCallable")
    path.write_text(PLAIN)
    assert main([str(path), "--emit", "cpp", "--simd", simd]) == 0
    text = capsys.readouterr().out
    assert [word for word in words if word in text] == []
    more = ("\n\n@ox.program\ndef __anyhit__a():\n    ox.throw_exception(3)\n\n\n@ox.program\ndef __miss__m(ray: Ray):\n"
            "    ray.t = ox.direct_call(0, result=float)\n\n\n@ox.program\ndef __direct_callable__d() -> float:\n    print('called')\n"
            "    return 1.0\n")
    path.write_text(PLAIN + more)
    assert main([str(path), "--emit", "cpp", "--simd", simd]) == 0
    text = capsys.readouterr().out
    assert {"hasAnyHit", "hasMiss", "findCallable", "print("} - {word for word in words if word in text} == set()
