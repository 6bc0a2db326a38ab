"""Areas B to D: what a faulty source says, modules and their programs, compile rules, linking, destroyed modules."""

from __future__ import annotations

import threading
import warnings
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from harness import SHADERS, Harness

import optixc as ox
from optixc import api
from optixc.options import CompileOptions

HEAD = "import optixc as ox\nfrom optixc import float3, uint32\n\n\n"
KINDS = ("raygen", "intersection", "anyhit", "closesthit", "miss", "exception", "direct_callable", "continuation_callable")


def written(folder: Path, text: str, name: str = "shader.py") -> Path:
    path = folder / name
    path.write_text(HEAD + text)
    return path


def program(name: str, body: str = "pass") -> str:
    return f"@ox.program\ndef {name}():\n    {body}\n\n\n"


def test_T010_the_log_holds_the_whole_text(tmp_path: Path) -> None:
    heard: list[tuple[int, str, str]] = []
    context = ox.DeviceContext(log_callback=lambda *message: heard.append(message))
    heard.clear()
    faults = "\n    ".join(f"unknown_name_{number}" for number in range(200))
    with pytest.raises(ox.CompileError) as caught:
        context.module_create(written(tmp_path, program("__raygen__r", faults)))
    # No buffer has to be large enough: the exception and the callback hold the same text, every error in it.
    assert [(level, text) for level, _, text in heard] == [(2, str(caught.value))]
    assert all(f"unknown_name_{number}" in str(caught.value) for number in range(200))
    heard.clear()
    context.set_log_callback(None)
    with pytest.raises(ox.CompileError):
        context.module_create(tmp_path / "shader.py")
    assert heard == []


def test_T011_a_warning_is_no_error(tmp_path: Path) -> None:
    heard: list[int] = []
    (tmp_path / "file").write_text("")
    context = ox.DeviceContext(log_callback=lambda level, tag, text: heard.append(level), cache_dir=tmp_path / "file" / "inside")
    heard.clear()
    module = context.module_create(written(tmp_path, program("__raygen__r")))
    assert "__raygen__r" in module
    assert heard == [3]
    heard.clear()
    context.module_create(tmp_path / "shader.py")
    assert heard == []
    silent = ox.DeviceContext(cache_dir=tmp_path / "file" / "inside")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        silent.module_create(tmp_path / "shader.py")
    assert [one.category for one in caught] == [ox.OptixcWarning]


def test_T024_programs_of_all_eight_kinds(tmp_path: Path) -> None:
    context = ox.DeviceContext()
    module = context.module_create(written(tmp_path, "".join(program(f"__{kind}__p") for kind in KINDS)))
    assert set(module) == {f"__{kind}__p" for kind in KINDS}
    for kind in KINDS:
        group = context.program_group_create(**{kind: module[f"__{kind}__p"]})
        assert group.programs[kind].name == f"__{kind}__p"


@pytest.mark.parametrize("source", [None, [], "", 3, {"a": 1}])
def test_T025_sources_that_are_none(source: Any) -> None:
    with pytest.raises(ox.OptixError) as caught:
        ox.DeviceContext().module_create(source)
    assert caught.value.code in (ox.Result.ERROR_INVALID_VALUE, ox.Result.ERROR_FILE_IO_ERROR)


def test_T025_options_that_are_none() -> None:
    context = ox.DeviceContext()
    module = context.module_create(SHADERS / "bound.py")
    group = context.program_group_create(raygen=module["__raygen__branch"])
    for call in (lambda: context.pipeline_create(None), lambda: context.pipeline_create([None]), lambda: context.pipeline_create([]),
                 lambda: context.pipeline_create([group], options={"uses_motion_blur": True}),
                 lambda: context.program_group_create(raygen=None), lambda: context.module_create(SHADERS / "bound.py", bound_values=3)):
        with pytest.raises(ox.InvalidValueError):
            call()


def test_a_module_is_a_mapping(tmp_path: Path) -> None:
    path = tmp_path / "shader.py"
    path.write_text("import optixc as ox\n@ox.program\ndef __miss__sky():\n    pass\n")
    module = ox.DeviceContext().module_create(path)
    assert list(module) == ["__miss__sky"]
    assert "__miss__sky" in module
    assert "__miss__none" not in module
    assert module.get("__miss__none") is None
    with pytest.raises(ox.InvalidValueError, match=r"^the module has no program '__miss__none'; it has __miss__sky$"):
        module["__miss__none"]


def test_T026_entries_that_are_absent_or_of_another_kind(tmp_path: Path) -> None:
    context = ox.DeviceContext()
    module = context.module_create(written(tmp_path, "".join(program(f"__{kind}__p") for kind in KINDS)))
    with pytest.raises(ox.InvalidValueError, match="has no program '__raygen__q'; it has __raygen__p"):
        module["__raygen__q"]
    for slot in KINDS:
        for kind in KINDS:
            if kind != slot:
                with pytest.raises(ox.InvalidValueError, match=rf"{slot}= takes a program whose name begins with __{slot}__"):
                    context.program_group_create(**{slot: module[f"__{kind}__p"]})


def test_T029_recursion_of_helpers_that_trace(tmp_path: Path) -> None:
    helper = ("@ox.device\ndef shoot(n: int) -> int:\n    ox.trace(ox.Traversable(0), float3(0.0), float3(1.0))\n"
              "    return shoot(n - 1) if n > 0 else 0\n\n\n")
    with pytest.raises(ox.CompileError, match=r"calls itself and uses the device function trace\(\)"):
        ox.DeviceContext().module_create(written(tmp_path, helper + program("__raygen__r", "n = shoot(3)")))


@pytest.mark.parametrize("body", [
    "f = helper\n    x = f()", "x = id(helper)", "x = [helper]", "ox.syncthreads()", "ox.shared_array(4)", "import threading",
    "global counter\n    counter = 1",
])
def test_T030_addresses_of_functions_and_shared_memory(tmp_path: Path, body: str) -> None:
    text = "counter = 0\n\n\n@ox.device\ndef helper() -> int:\n    return 1\n\n\n" + program("__raygen__r", body)
    with pytest.raises(ox.CompileError) as caught:
        ox.DeviceContext().module_create(written(tmp_path, text))
    assert caught.value.diagnostics[0].span.line == 15


def linked(folder: Path, text: str, **options: Any) -> Any:
    context = ox.DeviceContext()
    module = context.module_create(written(folder, text))
    groups = [context.program_group_create(**{name.split("__")[1]: module[name]}) for name in module]
    return context.pipeline_create(groups, options=ox.PipelineCompileOptions(**options))


def test_T031_attribute_words_beyond_the_limit(tmp_path: Path) -> None:
    start = program("__raygen__r")
    for limit, name in ((2, "get_attribute_5"), (0, "get_attribute_2")):
        with pytest.raises(ox.InvalidAttributeAccessError, match=rf"shader.py:12: {name}\(\) uses . attribute words") as caught:
            linked(tmp_path, start + program("__closesthit__c", f"x = ox.{name}()"), num_attribute_values=limit)
        assert caught.value.code == 7203
    for limit in (0, 1, 2):
        linked(tmp_path, start + program("__closesthit__c", "x = ox.get_attribute_1()"), num_attribute_values=limit)
    linked(tmp_path, start + program("__closesthit__c", "x = ox.get_attribute_7()"))
    report = program("__intersection__i", "b = ox.report_intersection(1.0, 0, uint32(1), uint32(2), uint32(3))")
    with pytest.raises(ox.InvalidAttributeAccessError, match="uses 3 attribute words"):
        linked(tmp_path, start + report, num_attribute_values=2)
    linked(tmp_path, start + report, num_attribute_values=3)


def test_T032_payload_words_beyond_the_limit(tmp_path: Path) -> None:
    start = program("__raygen__r")
    said = r"set_payload_2\(\) uses 3 payload words, and num_payload_values is 2"
    with pytest.raises(ox.InvalidPayloadAccessError, match=said) as caught:
        linked(tmp_path, start + program("__miss__m", "ox.set_payload_2(uint32(1))"), num_payload_values=2)
    assert caught.value.code == 7202
    linked(tmp_path, start + program("__miss__m", "ox.set_payload_2(uint32(1))"), num_payload_values=3)
    payload = "@ox.payload\nclass Ray:\n    a: float3\n\n\n@ox.program\ndef __miss__m(ray: Ray):\n    ray.a = float3(1.0)\n"
    with pytest.raises(ox.InvalidPayloadAccessError, match="the payload Ray of __miss__m uses 3 payload words"):
        linked(tmp_path, start + payload, num_payload_values=2)


@pytest.mark.parametrize("word", ["1.5 + 2j", "'text'", "ox.float64(1.0)", "ox.uint64(1)", "float3(1.0)", "None"])
def test_T032_payload_words_of_another_type(tmp_path: Path, word: str) -> None:
    body = f"words = ox.trace(ox.Traversable(0), float3(0.0), float3(1.0), payload=({word},))"
    with pytest.raises(ox.CompileError, match=r"shader.py:7:[78][0-9]: error"):
        ox.DeviceContext().module_create(written(tmp_path, program("__raygen__r", body)))


@pytest.mark.parametrize("optimization", [0, 1, 2, 3])
@pytest.mark.parametrize("debug", [False, True])
def test_T033_results_do_not_depend_on_levels(monkeypatch: pytest.MonkeyPatch, optimization: int, debug: bool) -> None:
    monkeypatch.setattr(api, "CompileOptions", partial(CompileOptions, optimization=optimization))
    context = ox.DeviceContext()
    module = context.module_create(SHADERS / "memory.py")
    groups = {name.strip("_").split("__")[0]: context.program_group_create(**{name.strip("_").split("__")[0]: module[name]})
              for name in ("__raygen__write_and_trace", "__closesthit__read")}
    pipeline = context.pipeline_create(list(groups.values()), debug=debug)
    assert memory_test(pipeline, groups, context, pipeline.launch) == expected_memory()


def expected_memory() -> list[int]:
    return [(7 * index + 1) * 3 for index in range(100)]


def memory_test(pipeline: Any, groups: dict[str, Any], context: ox.DeviceContext, launch: Any) -> list[int]:
    """What the closest-hit program of every launch index read of what its raygen program had written."""
    from_memory = np.zeros(100, np.uint32)
    gas = context.accel_build([ox.BuildInputTriangles(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32))])
    params = memory_params(gas, np.zeros(100, np.uint32), from_memory)
    table = ox.ShaderBindingTable(raygen=groups["raygen"].record(), hitgroup=[groups["closesthit"].record()])
    launch(params, table, 100)
    return [int(value) for value in from_memory]


def memory_params(gas: Any, scratch: np.ndarray, out: np.ndarray) -> Any:
    @ox.struct
    class Params:
        scene: ox.Traversable
        scratch: ox.Array[ox.uint32]
        out: ox.Array[ox.uint32]

    return Params(gas, scratch, out)


def test_T040_a_hit_program_reads_what_its_caller_wrote(harness: Harness) -> None:
    if "memory" not in harness.kept:
        module, create = harness.module("memory.py"), harness.context.program_group_create
        harness.kept["memory"] = {"raygen": create(raygen=module["__raygen__write_and_trace"]),
                                  "closesthit": create(closesthit=module["__closesthit__read"]),
                                  "count": create(raygen=module["__raygen__count"])}
    groups = harness.kept["memory"]
    pipeline = harness.pipeline("memory", groups.values())
    found = memory_test(pipeline, groups, harness.context, lambda *launch: harness.launch(pipeline, *launch))
    assert found == expected_memory()


def test_T041_atomic_additions_of_every_index_add_up(harness: Harness) -> None:
    test_T040_a_hit_program_reads_what_its_caller_wrote(harness)
    groups, count = harness.kept["memory"], 1_000_000 if harness.mode != "interpreter" else 500
    scratch = np.zeros(1, np.uint32)
    table = ox.ShaderBindingTable(raygen=groups["count"].record())
    harness.launch(harness.pipeline("memory", []), memory_params(0, scratch, scratch), table, count)
    assert scratch[0] == count


def test_T034_modules_have_no_pipeline_options() -> None:
    # The options are the pipeline's alone, so that no two modules of a pipeline can disagree.
    for name in ("options", "max_trace_depth", "simd"):
        with pytest.raises(TypeError, match=name):
            ox.DeviceContext().module_create(SHADERS / "bound.py", **{name: 1})


def test_T035_helpers_of_another_file(tmp_path: Path) -> None:
    text = "from tools import twice\n\n\n" + program("__raygen__r", "x = twice(3)")
    path = written(tmp_path, text)
    context = ox.DeviceContext()
    with pytest.raises(ox.CompileError, match=r"tools"):
        context.module_create(path)
    written(tmp_path, "@ox.device\ndef thrice(n: int) -> int:\n    return 3 * n\n", "tools.py")
    with pytest.raises(ox.CompileError, match="twice"):
        context.module_create(path)
    written(tmp_path, "@ox.device\ndef twice(n: int) -> int:\n    return 2 * n\n", "tools.py")
    module = context.module_create(path)
    context.pipeline_create([context.program_group_create(raygen=module["__raygen__r"])])


def test_T035_a_program_that_two_files_define(tmp_path: Path) -> None:
    context = ox.DeviceContext()
    groups = []
    for name, body in (("one.py", "x = 1"), ("two.py", "x = 2")):
        module = context.module_create(written(tmp_path, program("__raygen__r") + program("__miss__m", body), name))
        groups.append(context.program_group_create(miss=module["__miss__m"]))
    groups.append(context.program_group_create(raygen=module["__raygen__r"]))
    with pytest.raises(ox.PipelineLinkError, match=r"__miss__m is defined more than once: in .*one\.py and .*two\.py") as caught:
        context.pipeline_create(groups)
    assert caught.value.code == 7251


@pytest.mark.parametrize("simd", [1, 8, 16])
def test_files_of_one_pipeline_keep_their_helpers_apart(tmp_path: Path, simd: int) -> None:
    common = ("@ox.struct\nclass Params:\n    out: ox.Array[ox.float32]\n\n\n@ox.payload\nclass Ray:\n    x: float\n\n\n"
              "params = ox.launch_params(Params)\n\n\n")
    helper = "def value(x: float) -> float:\n    return x * {}\n\n\n"
    raygen = ("@ox.program\ndef __raygen__r():\n    ray = Ray(value(1.0))\n"
              "    ox.trace(ox.Traversable(0), float3(0.0), float3(1.0), payload=ray)\n    params.out[ox.get_launch_index().x] = ray.x\n")
    miss = "@ox.program\ndef __miss__m(ray: Ray):\n    ray.x = value(ray.x) + both(ray.x)\n"
    written(tmp_path, "@ox.device\ndef both(x: float) -> float:\n    return x + 100.0\n", "tools.py")
    context = ox.DeviceContext()
    first = context.module_create(written(tmp_path, common + helper.format("2.0") + raygen, "first.py"))
    second = context.module_create(written(tmp_path, "from tools import both\n\n\n" + common + helper.format("10.0") + miss, "second.py"))
    start, end = context.program_group_create(raygen=first["__raygen__r"]), context.program_group_create(miss=second["__miss__m"])
    pipeline = context.pipeline_create([start, end], simd=simd)

    @ox.struct
    class Params:
        out: ox.Array[ox.float32]

    out = np.zeros(20, np.float32)
    pipeline.launch(Params(out), ox.ShaderBindingTable(raygen=start.record(), miss=[end.record()]), 20)
    assert out.tolist() == [2.0 * 10.0 + 2.0 + 100.0] * 20


def test_T009_a_callback_is_never_called_with_the_level_of_another(tmp_path: Path) -> None:
    """Callbacks that accept other levels are swapped while threads log."""
    context = ox.DeviceContext(log_callback=lambda *message: None)
    wrong: list[tuple[int, int]] = []

    def callback(highest: int) -> Any:
        return lambda level, tag, text: wrong.append((highest, level)) if level > highest else None

    stop = threading.Event()

    def work() -> None:
        while not stop.is_set():
            for level in (1, 2, 3, 4):
                context.log(level, "TEST", "text")

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for number in range(2000):
        level = 1 + number % 4
        context.set_log_callback(callback(level), level)
    stop.set()
    for thread in threads:
        thread.join()
    assert wrong == []


def test_an_exception_in_a_callback_stops_nothing(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    def callback(level: int, tag: str, text: str) -> None:
        raise ValueError(f"thrown for {tag}")

    context = ox.DeviceContext(log_callback=callback)
    with pytest.raises(ox.CompileError, match="is not defined"):
        context.module_create(written(tmp_path, program("__raygen__r", "x = unknown_name")))
    module = context.module_create(SHADERS / "bound.py")
    context.pipeline_create([context.program_group_create(raygen=module["__raygen__branch"])], bound_values={"k": 3})
    told = capfd.readouterr().err
    assert told.count("optixc: exception in a log callback, ignored:") >= 3
    assert "ValueError: thrown for COMPILER" in told
