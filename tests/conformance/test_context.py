"""Areas A to D: context, properties, log, cache settings, modules and their tasks."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from harness import SHADERS
from shaders import bound as shader
from shaders import host_checks

import optixc as ox

SHADER = SHADERS / "bound.py"
FAULTY = "import optixc as ox\n\n\n@ox.program\ndef __raygen__r():\n    x = ox.get_primitive_index()\n"
LIGHT = shader.Light((1.0, 0.5, 0.0), False)


def run(context: ox.DeviceContext, module: Any) -> float:
    group = context.program_group_create(raygen=module["__raygen__branch"])
    out = np.zeros(1, np.float32)
    context.pipeline_create([group]).launch(shader.Params(out=out, k=3, light=LIGHT), ox.ShaderBindingTable(raygen=group.record()), 1)
    return float(out[0])


def test_T001_a_context_without_options() -> None:
    context = ox.DeviceContext()
    assert not context.validation
    assert context.get_cache_enabled()


PROPERTIES = {0x2001: 31, 0x2002: 31, 0x2003: 1 << 29, 0x2004: 1 << 28, 0x2006: (1 << 28) - 1, 0x2007: 8, 0x2008: 1 << 24,
              0x2009: (1 << 28) - 1}


def test_T003_properties() -> None:
    context = ox.DeviceContext()
    assert {number: context.get_property(number) for number in PROPERTIES} == PROPERTIES
    assert context.get_property(ox.DeviceProperty.LIMIT_MAX_TRACE_DEPTH) == 31
    assert all(isinstance(context.get_property(one), int) for one in ox.DeviceProperty)
    with pytest.raises(ox.InvalidValueError, match="is no device property"):
        context.get_property(7)


def test_T004_a_destroyed_context_takes_everything_with_it() -> None:
    context = ox.DeviceContext()
    module = context.module_create(SHADER)
    run(context, module)
    group = context.program_group_create(raygen=module["__raygen__branch"])
    pipeline = context.pipeline_create([group])
    context.destroy()
    out = np.zeros(1, np.float32)
    for use in (lambda: pipeline.launch(shader.Params(out=out, k=3, light=LIGHT), ox.ShaderBindingTable(raygen=group.record()), 1),
                lambda: context.module_create(SHADER), lambda: context.pipeline_create([group]), lambda: context.get_property(0x2001)):
        with pytest.raises(ox.InvalidDeviceContextError, match="destroyed"):
            use()


def test_a_context_ends_with_its_block() -> None:
    with ox.DeviceContext(threads=np.int64(1)) as context:
        accel = context.accel_build([ox.BuildInputTriangles(np.zeros((3, 3), np.float32))])
        assert context.info()["threads"] == 1
    with pytest.raises(ox.InvalidDeviceContextError):
        context.accel_build([ox.BuildInputTriangles(np.zeros((3, 3), np.float32))])
    accel.destroy()
    with pytest.raises(ox.InvalidDeviceContextError), context:
        pass


def test_errors_are_raised_and_not_printed_as_well(capfd: pytest.CaptureFixture[str]) -> None:
    instance = ox.Instance(1 << 40)
    with pytest.raises(ox.OptixError), ox.DeviceContext() as context:
        context.accel_build([ox.BuildInputInstances([instance])])
    assert capfd.readouterr().err == ""


def test_T008_levels_of_the_log(tmp_path: Path) -> None:
    path = tmp_path / "faulty.py"
    path.write_text(FAULTY)
    for level, expected in ((0, set()), (1, {1}), (2, {1, 2}), (3, {1, 2, 3}), (4, {1, 2, 3, 4})):
        heard: list[int] = []
        context = ox.DeviceContext(log_callback=lambda level, tag, text, heard=heard: heard.append(level))
        context.set_log_callback(lambda level, tag, text, heard=heard: heard.append(level), level)
        heard.clear()
        for told in (1, 2, 3, 4):
            context.log(told, "TEST", "text")
        assert set(heard) == expected
        heard.clear()
        with pytest.raises(ox.CompileError):
            context.module_create(path)
        assert (2 in heard) == (level >= 2)


def test_T009_callbacks_are_swapped_whole(tmp_path: Path) -> None:
    path = tmp_path / "faulty.py"
    path.write_text(FAULTY)
    context = ox.DeviceContext(log_callback=lambda level, tag, text: None)
    context.set_log_callback(None)
    with pytest.raises(ox.CompileError):
        context.module_create(path)
    with pytest.raises(ox.InvalidValueError):
        context.set_log_callback("print")
    with pytest.raises(ox.InvalidValueError):
        context.set_log_callback(None, 5)


def test_T018_the_environment_beats_the_calls(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("OPTIXC_CACHE_MAXSIZE", "0")
    context = ox.DeviceContext(cache_dir=tmp_path)
    context.set_cache_enabled(True)
    assert (context.get_cache_enabled(), context.get_cache_location(), context.get_cache_database_sizes()) == (False, "", (0, 0))
    run(context, context.module_create(SHADER))
    assert list(tmp_path.iterdir()) == []
    monkeypatch.setenv("OPTIXC_CACHE_MAXSIZE", "1000000")
    assert ox.DeviceContext(cache_dir=tmp_path).get_cache_database_sizes() == (500000, 1000000)
    for ignored in ("-5", "abc"):
        monkeypatch.setenv("OPTIXC_CACHE_MAXSIZE", ignored)
        assert ox.DeviceContext(cache_dir=tmp_path).get_cache_database_sizes() == (1 << 29, 1 << 30)


def test_T019_water_marks() -> None:
    context = ox.DeviceContext()
    with pytest.raises(ox.InvalidValueError, match="below the low one"):
        context.set_cache_database_sizes(10, 5)
    context.set_cache_database_sizes(0, 5)
    assert context.get_cache_database_sizes() == (0, 5)
    with pytest.raises(ox.InvalidValueError, match="at least 0"):
        context.set_cache_database_sizes(-1, 5)


def test_T020_a_location_that_cannot_be_made(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_text("")
    context = ox.DeviceContext(cache_dir=tmp_path / "good")
    with pytest.raises(ox.DiskCacheInvalidPathError, match="cannot be made"):
        context.set_cache_location(file / "inside")
    assert not context.get_cache_enabled()
    assert run(context, context.module_create(SHADER)) > 1000
    context.set_cache_enabled(False)
    context.set_cache_location(file / "inside")
    with pytest.raises(ox.DiskCacheInvalidPathError):
        context.set_cache_enabled(True)
    context.set_cache_location(tmp_path / "other")
    context.set_cache_enabled(True)
    assert context.get_cache_location() == str(tmp_path / "other")
    run(context, context.module_create(SHADER))
    assert any((tmp_path / "other").glob("*.so"))


def test_T022_the_folder_stays_below_the_high_mark(tmp_path: Path) -> None:
    context = ox.DeviceContext(cache_dir=tmp_path)
    run(context, context.module_create(SHADER))
    size = sum(path.stat().st_size for path in tmp_path.iterdir() if path.name != "compilers.json")
    context.set_cache_database_sizes(2 * size, 3 * size)
    group = context.program_group_create(raygen=context.module_create(SHADER)["__raygen__branch"])
    for k in range(6):
        context.pipeline_create([group], bound_values={"k": k})
        assert sum(path.stat().st_size for path in tmp_path.iterdir()) <= 3.2 * size
    heard: list[str] = []
    context.set_log_callback(lambda level, tag, text: heard.append(text))
    context.set_cache_database_sizes(10, 10)
    context.pipeline_create([group], debug=True)
    assert any("larger than the cache limit" in text for text in heard)


def test_T036_a_destroyed_module_leaves_pipelines_alone() -> None:
    context = ox.DeviceContext()
    module = context.module_create(SHADER)
    group = context.program_group_create(raygen=module["__raygen__branch"])
    pipeline = context.pipeline_create([group])
    module.destroy()
    out = np.zeros(1, np.float32)
    pipeline.launch(shader.Params(out=out, k=3, light=LIGHT), ox.ShaderBindingTable(raygen=group.record()), 1)
    assert out[0] > 1000
    with pytest.raises(ox.InvalidOperationError, match="was destroyed"):
        module["__raygen__branch"]


def test_T037_T038_states_of_a_module_with_tasks(tmp_path: Path) -> None:
    context = ox.DeviceContext()
    states = ox.ModuleCompileState
    module, task = context.module_create_with_tasks(SHADER)
    assert module.get_compilation_state() is states.NOT_STARTED
    with pytest.raises(ox.InvalidOperationError, match="execute its tasks"):
        module["__raygen__branch"]
    pending = [task]
    while pending:
        pending += pending.pop().execute(1)
    assert module.get_compilation_state() is states.COMPLETED
    assert run(context, module) == run(context, context.module_create(SHADER))
    assert context.module_create(SHADER).get_compilation_state() is states.COMPLETED
    path = tmp_path / "faulty.py"
    path.write_text(FAULTY)
    faulty, task = context.module_create_with_tasks(path)
    with pytest.raises(ox.CompileError, match="get_primitive_index"):
        task.execute()
    assert faulty.get_compilation_state() is states.FAILED
    assert task.execute() == []
    faulty.destroy()


def test_T038_tasks_of_many_modules_on_many_threads() -> None:
    context = ox.DeviceContext()
    made = [context.module_create_with_tasks(SHADER) for _ in range(8)]
    threads = [threading.Thread(target=task.execute) for _, task in reversed(made)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert {next(iter(module)) for module, _ in made} == {"__raygen__branch"}


def test_T038_one_task_on_many_threads_is_done_once() -> None:
    """Every thread sees states that only go forward; whoever comes second waits, and finds the module complete."""
    module, task = ox.DeviceContext().module_create_with_tasks(SHADER)
    states, opened, begun = ox.ModuleCompileState, [], threading.Barrier(6)
    open_source, seen = module._open, [[] for _ in range(6)]

    def counted() -> Any:
        opened.append(module.get_compilation_state())
        return open_source()

    module._open = counted

    def execute(found: list[Any]) -> None:
        begun.wait(30)
        found.append(module.get_compilation_state())
        found.append(task.execute())
        found.append(module.get_compilation_state())

    threads = [threading.Thread(target=execute, args=(found,)) for found in seen]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert opened == [states.STARTED]
    assert all(found[0] in (states.NOT_STARTED, states.STARTED, states.COMPLETED) for found in seen)
    assert [found[1:] for found in seen] == [[[], states.COMPLETED]] * 6
    assert next(iter(module)) == "__raygen__branch"


def test_T038_a_task_that_fails_tells_one_thread(tmp_path: Path) -> None:
    context, path = ox.DeviceContext(), tmp_path / "faulty.py"
    path.write_text(FAULTY)
    made = [context.module_create_with_tasks(path if number == 2 else SHADER) for number in range(4)]
    begun, errors = threading.Barrier(8), []

    def execute(task: ox.Task) -> None:
        begun.wait(30)
        try:
            task.execute()
        except ox.CompileError as error:
            errors.append(str(error))

    threads = [threading.Thread(target=execute, args=(task,)) for _, task in (*made, *made)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(errors) == 1 and "get_primitive_index" in errors[0]
    states = ox.ModuleCompileState
    wanted = [states.COMPLETED, states.COMPLETED, states.FAILED, states.COMPLETED]
    assert [module.get_compilation_state() for module, _ in made] == wanted
    with pytest.raises(ox.InvalidOperationError, match="its task failed"):
        next(iter(made[2][0]))
    assert next(iter(made[3][0])) == "__raygen__branch"


def test_T039_a_module_whose_task_executes_is_not_destroyed() -> None:
    module, _ = ox.DeviceContext().module_create_with_tasks(SHADER)
    entered, leave = threading.Event(), threading.Event()

    def slow() -> Any:
        entered.set()
        leave.wait(10)
        raise ox.InvalidValueError("stop")

    module._open = slow

    def execute() -> None:
        with pytest.raises(ox.InvalidValueError, match="stop"):
            module.compile()

    thread = threading.Thread(target=execute)
    thread.start()
    assert entered.wait(10)
    assert module.get_compilation_state() is ox.ModuleCompileState.STARTED
    with pytest.raises(ox.IllegalDuringTaskExecuteError):
        module.destroy()
    leave.set()
    thread.join()
    module.destroy()


def test_T065_T068_groups_of_all_kinds(tmp_path: Path) -> None:
    kinds = ("raygen", "miss", "exception", "closesthit", "direct_callable")
    path = tmp_path / "kinds.py"
    path.write_text("import optixc as ox\n" + "".join(f"\n\n@ox.program\ndef __{kind}__p():\n    pass\n" for kind in kinds))
    context = ox.DeviceContext()
    module = context.module_create(path)
    groups = [context.program_group_create(**{kind: module[f"__{kind}__p"]}) for kind in kinds]
    assert [group.kind.name for group in groups] == ["RAYGEN", "MISS", "EXCEPTION", "HITGROUP", "CALLABLES"]
    context.pipeline_create(groups)
    neither = {"direct_callable": None, "continuation_callable": None}
    for empty in ({"direct_callable": None}, neither, {"raygen": None}, {"exception": None}):
        with pytest.raises(ox.InvalidValueError, match="needs a program"):
            context.program_group_create(**empty)
    for mixed in ({"raygen": module["__raygen__p"], "miss": module["__miss__p"]}, {}):
        with pytest.raises(ox.InvalidValueError, match="a program group is one of"):
            context.program_group_create(**mixed)


def test_T070_trace_depths() -> None:
    context = ox.DeviceContext()
    module = context.module_create(SHADER)
    group = context.program_group_create(raygen=module["__raygen__branch"])
    for depth in (32, -1, 1.5, "1", None, True):
        with pytest.raises(ox.InvalidValueError, match="max_trace_depth must be 0 to 31"):
            context.pipeline_create([group], max_trace_depth=depth)
    for depth in (0, 31):
        out = np.zeros(1, np.float32)
        pipeline = context.pipeline_create([group], max_trace_depth=depth)
        pipeline.launch(shader.Params(out=out, k=3, light=LIGHT), ox.ShaderBindingTable(raygen=group.record()), 1)
        assert out[0] > 1000


@pytest.mark.parametrize("simd", [1, 8, 16])
def test_T070_depth_0_traces_nothing(simd: int) -> None:
    context = ox.DeviceContext()
    module, create = context.module_create(SHADERS / "host_checks.py"), context.program_group_create
    raygen, miss = create(raygen=module["__raygen__rays"]), create(miss=module["__miss__nothing"])
    pipeline = context.pipeline_create([raygen, miss], max_trace_depth=0, simd=simd)
    table = ox.ShaderBindingTable(raygen=raygen.record(), miss=[miss.record()])
    with pytest.raises(ox.LaunchFailureError, match="traces nest deeper than max_trace_depth"):
        pipeline.launch(host_checks.Params(np.zeros(4, np.float32), 0, 1.0), table, 4)
