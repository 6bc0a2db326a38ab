"""Area U: exceptions."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from harness import Harness
from shaders import exceptions as shader

import optixc as ox

USER, DEPTH = ox.ExceptionFlags.USER, ox.ExceptionFlags.TRACE_DEPTH
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
HEAD = "import optixc as ox\n\n\n"


def run(harness: Harness, count: int, modes: Any, flags: int = USER, depth: int = 2, program: bool = True) -> Any:
    """What the launch left: values by index, codes, details, exception record's number."""
    module, create = harness.module("exceptions.py"), harness.context.program_group_create
    if "exceptions" not in harness.kept:
        harness.kept["exceptions"] = [create(raygen=module["__raygen__r"]), create(closesthit=module["__closesthit__c"]),
                                      create(exception=module["__exception__e"])]
    raygen, hit, exception = groups = harness.kept["exceptions"]
    pipeline = harness.pipeline(("exceptions", flags, depth), groups, max_trace_depth=depth,
                                options=ox.PipelineCompileOptions(exception_flags=flags))
    scene = harness.context.accel_build([ox.BuildInputTriangles(CORNERS)])
    params = shader.Params(out=np.zeros(count, np.uint32), codes=np.zeros(count, np.int32), details=np.zeros((count, 8), np.uint32),
                           modes=np.broadcast_to(np.asarray(modes, np.uint32), count).copy(), scene=scene)
    table = ox.ShaderBindingTable(raygen=raygen.record(), hitgroup=[hit.record()],
                                  exception=exception.record(shader.Number(5)) if program else None)
    harness.launch(pipeline, params, table, count)
    return params


def test_T273_code_and_eight_details(harness: Harness) -> None:
    params = run(harness, 1, shader.THROW)
    assert params.codes.tolist() == [42]
    assert params.details.tolist() == [[100, 101, 102, 103, 104, 105, 106, 107]]
    # nothing after the throw: closest hit wrote 1, the exception program added its record's number
    assert params.out.tolist() == [1 + 5]


def test_T274_the_other_indices_go_on(harness: Harness) -> None:
    modes = np.zeros(1000, np.uint32)
    modes[[0, 3, 17, 500, 501, 999]] = shader.THROW
    params = run(harness, 1000, modes)
    assert params.codes.tolist() == [42 if mode else 0 for mode in modes]
    assert params.out.tolist() == [6 if mode else 1 + 10 + 100 for mode in modes]


def test_T276_without_the_flag_nothing_is_thrown(harness: Harness) -> None:
    params = run(harness, 4, shader.THROW, flags=0)
    assert params.codes.tolist() == [0] * 4
    assert params.out.tolist() == [111] * 4


def test_T277_without_a_program_the_first_five_are_printed(harness: Harness, capfd: pytest.CaptureFixture[str]) -> None:
    if harness.mode == "interpreter":
        pytest.skip("the interpreter runs one launch index at a time")
    run(harness, 100, shader.THROW, program=False)
    assert len([line for line in capfd.readouterr().out.splitlines() if "42" in line]) == 5


def test_T278_traces_that_nest_too_deep(harness: Harness) -> None:
    modes = [2, 3, 1, 4]
    params = run(harness, 4, [shader.RECURSE + mode for mode in modes], flags=DEPTH, depth=2)
    assert params.codes.tolist() == [-2 if mode > 2 else 0 for mode in modes]


def test_T279_the_exception_program_has_no_ray(tmp_path: Path) -> None:
    path = tmp_path / "exception.py"
    path.write_text(HEAD + "@ox.program\ndef __exception__e():\n    t = ox.get_ray_tmax()\n")
    with pytest.raises(ox.CompileError, match="is only allowed in"):
        ox.DeviceContext().module_create(path)


KINDS = ("raygen", "intersection", "anyhit", "closesthit", "miss", "direct_callable", "continuation_callable", "exception")


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("code", [0, (1 << 30) - 1, 1 << 30, -1])
def test_T275_T280_who_may_throw_and_which_codes(tmp_path: Path, kind: str, code: int) -> None:
    path = tmp_path / "throws.py"
    path.write_text(HEAD + f"@ox.program\ndef __{kind}__p():\n    ox.throw_exception({code})\n")
    if kind != "exception" and 0 <= code < 1 << 30:
        ox.DeviceContext().module_create(path)
        return
    with pytest.raises(ox.CompileError, match="exception code is 0 to" if kind != "exception" else "programs other than exception"):
        ox.DeviceContext().module_create(path)
