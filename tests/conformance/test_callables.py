"""Area T: callables."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from harness import Harness
from shaders import callable_arguments as shader
from shaders import mutual as mutual_shader

import optixc as ox

VALUES = ("plus", "times")
STRUCTS = ("argument_only", "argument_and_record", "argument_and_asked", "move")
HEAD = "import optixc as ox\n\n\n"


def group(harness: Harness, direct: str | None = None, continuation: str | None = None) -> Any:
    key = ("callables", direct, continuation)
    if key not in harness.kept:
        module = harness.module("callable_arguments.py")
        harness.kept[key] = harness.context.program_group_create(
            direct_callable=direct and module[f"__direct_callable__{direct}"],
            continuation_callable=continuation and module[f"__continuation_callable__{continuation}"])
    return harness.kept[key]


def run(harness: Harness, raygen: str, groups: list[Any], called: list[Any], records: list[int]) -> list[float]:
    """What each launch index got from the callables record that it names."""
    if ("raygen", raygen) not in harness.kept:
        module = harness.module("callable_arguments.py")
        harness.kept["raygen", raygen] = harness.context.program_group_create(raygen=module[f"__raygen__{raygen}"])
    start = harness.kept["raygen", raygen]
    pipeline = harness.pipeline(("callable arguments", raygen), [start, *groups])
    out = np.zeros(len(records), np.float32)
    params = shader.Params(out=out, records=np.array(records, np.uint32), x=7.0)
    harness.launch(pipeline, params, ox.ShaderBindingTable(raygen=start.record(), callables=called), len(records))
    return [float(value) for value in out]


def test_T266_record_data_gives_the_factor(harness: Harness) -> None:
    plus, times = (group(harness, name) for name in VALUES)
    table = [plus.record(shader.Factor(10)), plus.record(shader.Factor(10)), times.record(shader.Factor(2)),
             plus.record(shader.Factor(-10)), times.record(shader.Factor(3))]
    assert run(harness, "call", [plus, times], table, [0, 1, 2, 3, 4]) == [17, 17, 14, -3, 21]


def test_T271_one_record_holds_a_direct_and_a_continuation_callable(harness: Harness) -> None:
    both = group(harness, "plus", "minus")
    assert run(harness, "both", [both], [both.record(shader.Factor(3))], [0]) == [1004]


def test_T272_the_record_is_chosen_by_every_launch_index(harness: Harness) -> None:
    plus, times = (group(harness, name) for name in VALUES)
    table = [plus.record(shader.Factor(number)) for number in range(16)] + [times.record(shader.Factor(number)) for number in range(16)]
    wanted = [(index * 7) % 32 for index in range(100)]
    assert run(harness, "call", [plus, times], table, wanted) == [7 + n if n < 16 else 7 * (n - 16) for n in wanted]


def test_structs_are_arguments_where_a_call_passes_them(harness: Harness) -> None:
    groups = [group(harness, name) for name in STRUCTS]
    table = [groups[0].record(), groups[1].record(shader.Factor(10)), groups[2].record(shader.Factor(5)), *[groups[3].record()] * 3]
    assert run(harness, "structs", groups, table, [0, 1, 2]) == [2 + 0 + 7, 3 * 10 + 8, 1 + 5 + 9]


def test_a_record_without_the_struct_that_a_callable_reads(harness: Harness) -> None:
    groups = [group(harness, name) for name in STRUCTS]
    table = [groups[0].record(), groups[1].record(), groups[2].record(shader.Factor(5)), *[groups[3].record()] * 3]
    with pytest.raises(ox.InvalidValueError, match="argument_and_record takes a Factor as its record's data; none was given"):
        run(harness, "structs", groups, table, [0, 1, 2])


def test_a_call_that_no_callable_answers_is_named(harness: Harness, tmp_path: Path) -> None:
    path = tmp_path / "wrong.py"
    path.write_text(HEAD + "@ox.program\ndef __raygen__r():\n    x = ox.direct_call(0, 1, result=float)\n\n\n"
                    "@ox.program\ndef __direct_callable__f(x: float) -> float:\n    return x\n")
    module, create = harness.context.module_create(path), harness.context.program_group_create
    groups = [create(raygen=module["__raygen__r"]), create(direct_callable=module["__direct_callable__f"])]
    with pytest.raises(ox.PipelineLinkError) as caught:
        harness.context.pipeline_create(groups)
    assert "wrong.py:6" in str(caught.value)
    assert "(int32) -> float32" in str(caught.value)
    assert "__direct_callable__f is a direct callable (float32) -> float32" in str(caught.value)


# Which kinds of programs may make which call (guide, chapter 15).
MAY_CALL = {"direct": ["raygen", "intersection", "anyhit", "closesthit", "miss", "direct_callable", "continuation_callable"],
            "continuation": ["raygen", "closesthit", "miss", "continuation_callable"]}
KINDS = [*MAY_CALL["direct"], "exception"]


@pytest.mark.parametrize("call", MAY_CALL)
@pytest.mark.parametrize("kind", KINDS)
def test_T267_T268_who_may_call(call: str, kind: str, tmp_path: Path) -> None:
    result, tail = (" -> float", "\n    return x") if kind.endswith("callable") else ("", "")
    path = tmp_path / f"{kind}_{call}.py"
    path.write_text(HEAD + f"@ox.program\ndef __{kind}__p(){result}:\n    x = ox.{call}_call(0, result=float){tail}\n")
    context = ox.DeviceContext()
    if kind in MAY_CALL[call]:
        context.module_create(path)
        return
    with pytest.raises(ox.CompileError, match=rf"{call}_call\(\) is only allowed in"):
        context.module_create(path)


@pytest.mark.parametrize("through_helper", [False, True])
def test_T270_a_direct_callable_traverses_but_does_not_trace(tmp_path: Path, through_helper: bool) -> None:
    text = (HEAD + "from optixc import float3\n\n\n@ox.device\ndef shoot():\n    ox.{0}(ox.Traversable(0), float3(0.0), float3(1.0))\n\n\n"
            "@ox.program\ndef __direct_callable__f() -> float:\n    {1}\n    return 1.0\n")
    body = "shoot()" if through_helper else "ox.{0}(ox.Traversable(0), float3(0.0), float3(1.0))"
    path = tmp_path / "callable.py"
    path.write_text(text.format("traverse", body.format("traverse")))
    ox.DeviceContext().module_create(path)
    path.write_text(text.format("trace", body.format("trace")))
    with pytest.raises(ox.CompileError, match=r"trace\(\) is only allowed in"):
        ox.DeviceContext().module_create(path)


def test_a_callable_changes_only_copies_of_its_structs(tmp_path: Path) -> None:
    path = tmp_path / "changes.py"
    path.write_text(HEAD + "@ox.struct\nclass S:\n    x: float\n\n\n@ox.program\ndef __direct_callable__f(a: S, b: S) -> float:\n"
                    "    a.x = 1.0\n    return b.x\n")
    with pytest.raises(ox.CompileError, match="read-only"):
        ox.DeviceContext().module_create(path)


def mutual(harness: Harness, depths: list[int], limit: int) -> tuple[list[int], list[int]]:
    """What continuation callables, traces and closest hits that go through each other add up to, and the exceptions."""
    if "mutual" not in harness.kept:
        module, create = harness.module("mutual.py"), harness.context.program_group_create
        harness.kept["mutual"] = [create(raygen=module["__raygen__mutual"]), create(closesthit=module["__closesthit__again"]),
                                  create(continuation_callable=module["__continuation_callable__shoot"]),
                                  create(exception=module["__exception__note"])]
    raygen, hit, shoot, exception = groups = harness.kept["mutual"]
    options = ox.PipelineCompileOptions(exception_flags=ox.ExceptionFlags.TRACE_DEPTH)
    pipeline = harness.pipeline(("mutual", limit), groups, max_trace_depth=limit, options=options)
    scene = harness.context.accel_build([ox.BuildInputTriangles(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32))])
    out, codes = np.full(len(depths), 999, np.uint32), np.zeros(len(depths), np.int32)
    params = mutual_shader.Params(scene=scene, out=out, codes=codes, depth=np.array(depths, np.uint32))
    table = ox.ShaderBindingTable(raygen=raygen.record(), hitgroup=[hit.record()], exception=exception.record(),
                                  callables=[shoot.record(mutual_shader.Weight(weight)) for weight in (100, 1000)])
    harness.launch(pipeline, params, table, len(depths))
    return out.tolist(), codes.tolist()


def mutual_sum(depth: int) -> int:
    # the raygen program calls the record of the depth, and every closest hit but the deepest that of its own level
    return depth + sum((100, 1000)[level % 2] for level in [depth, *range(2, depth + 1)])


def test_T269_continuation_callables_and_traces_nest(harness: Harness) -> None:
    depths = [1 + index % 31 for index in range(62)]
    assert mutual(harness, depths, 31) == ([mutual_sum(depth) for depth in depths], [0] * 62)


def test_T269_deeper_than_the_pipeline_allows(harness: Harness) -> None:
    depths = [3, 4, 5, 6, 2, 9, 4]
    out, codes = mutual(harness, depths, 4)
    assert codes == [-2 if depth > 4 else 0 for depth in depths]
    assert out == [999 if depth > 4 else mutual_sum(depth) for depth in depths]
