"""Wrong calls of the host surface: each gives a named error or a defined result, the process lives, the caller's data is untouched."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from shaders import host_checks as shader

import optixc as ox

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
INDICES = np.array([[0, 1, 2]], np.uint32)
BOX = np.array([[0, 0, 0, 1, 1, 1]], np.float32)


@dataclass
class Scene:
    """A context with a pipeline and everything for a launch."""

    context: ox.DeviceContext
    groups: dict[str, Any]
    pipeline: Any

    def table(self, raygen: str = "rays", hit: bool = True) -> ox.ShaderBindingTable:
        paint = self.groups["paint"].record(shader.Paint(2.0))
        return ox.ShaderBindingTable(
            raygen=self.groups[raygen].record(), miss=[self.groups["miss"].record()], hitgroup=[paint] if hit else []
        )

    def launch(self, scene: Any, size: int = 4, scale: float = 1.0, raygen: str = "rays", hit: bool = True) -> np.ndarray:
        hits = np.zeros(size, np.float32)
        self.pipeline.launch(shader.Params(hits, scene, scale), self.table(raygen, hit), size)
        return hits


def scene_of(context: ox.DeviceContext) -> Scene:
    module, create = context.module_create(shader), context.program_group_create
    groups = {name: create(raygen=module[f"__raygen__{name}"]) for name in ("rays", "endless", "empty")}
    groups["paint"] = create(closesthit=module["__closesthit__paint"])
    groups["miss"] = create(miss=module["__miss__nothing"])
    return Scene(context, groups, context.pipeline_create(list(groups.values())))


@pytest.fixture(scope="module")
def scene() -> Scene:
    return scene_of(ox.DeviceContext(threads=2))


@pytest.fixture(scope="module")
def checked() -> Scene:
    return scene_of(ox.DeviceContext(validation=True, threads=2, log_callback=lambda *message: None))


def triangle(scene: Scene, **more: Any) -> Any:
    return scene.context.accel_build([ox.BuildInputTriangles(CORNERS, INDICES)], **more)


def triangles(vertices: Any, indices: Any = INDICES, **more: Any) -> list[Any]:
    return [ox.BuildInputTriangles(vertices, indices, **more)]


WRONG_INPUTS: dict[str, tuple[Callable[[], Any], str]] = {
    "float64 vertices": (lambda: triangles(CORNERS.astype(np.float64)), r"astype\(numpy.float32\)"),
    "list of vertices": (lambda: triangles([[0.0, 0.0, 0.0]]), "motion|array"),
    "one axis": (lambda: triangles(np.zeros(9, np.float32)), r"shape \(n, 3\)"),
    "Fortran order": (lambda: triangles(np.asfortranarray(CORNERS)), "ascontiguousarray"),
    "every second column": (lambda: triangles(np.zeros((3, 6), np.float32)[:, ::2]), "ascontiguousarray"),
    "rows backwards": (lambda: triangles(CORNERS[::-1]), "ascontiguousarray"),
    "rows over each other": (lambda: triangles(np.lib.stride_tricks.as_strided(CORNERS, (3, 3), (4, 4))), "ascontiguousarray"),
    "index too large": (lambda: triangles(CORNERS, np.array([[0, 1, 3]], np.uint32)), "3 vertices"),
    "negative index": (lambda: triangles(CORNERS, np.array([[0, 1, -1]], np.int32)), "negative index -1"),
    "float indices": (lambda: triangles(CORNERS, np.zeros((1, 3), np.float32)), "uint32"),
    "int64 indices": (lambda: triangles(CORNERS, np.zeros((1, 3), np.int64)), r"astype\(numpy.uint32\)"),
    "no inputs": (list, "at least one build input"),
    "no list": (lambda: ox.BuildInputTriangles(CORNERS), "list of build inputs"),
    "mixed kinds": (lambda: [*triangles(CORNERS), ox.BuildInputCustomPrimitives(BOX)], "type|kind"),
    "too many flags": (lambda: triangles(CORNERS, flags=[0, 0], num_sbt_records=3), "flags"),
    "no records": (lambda: triangles(CORNERS, num_sbt_records=0), "num_sbt_records"),
    "offsets of another count": (lambda: triangles(CORNERS, num_sbt_records=2, sbt_index_offsets=np.zeros(3, np.uint32)), "primitives"),
    "boxes of five": (lambda: [ox.BuildInputCustomPrimitives(np.zeros((1, 5), np.float32))], r"\(n, 6\)"),
    "keys of two shapes": (lambda: triangles([CORNERS, CORNERS[:2]]), "one shape"),
    "NaN transform": (lambda: [ox.BuildInputInstances([ox.Instance(0, np.full((3, 4), np.nan))])], "not finite"),
    "transform of nine": (lambda: [ox.BuildInputInstances([ox.Instance(0, np.eye(3))])], "3x4"),
    "instance of text": (lambda: [ox.BuildInputInstances([ox.Instance("gas", np.eye(3, 4))])], "traversable"),
    "mask of nine bits": (lambda: [ox.BuildInputInstances([ox.Instance(0, np.eye(3, 4), visibility_mask=256)])], "visibility_mask"),
}


@pytest.mark.parametrize("name", list(WRONG_INPUTS))
def test_wrong_build_inputs_are_named(scene: Scene, name: str) -> None:
    make, message = WRONG_INPUTS[name]
    with pytest.raises(ox.OptixError, match=message) as caught:
        scene.context.accel_build(make())
    assert caught.value.code == ox.Result.ERROR_INVALID_VALUE
    assert scene.launch(triangle(scene)).tolist() == [2.0] * 4


def test_vertices_that_are_no_numbers_are_never_hit(scene: Scene) -> None:
    for value in (np.nan, np.inf, -np.inf):
        vertices = CORNERS.copy()
        vertices[1, 0] = value
        before = vertices.copy()
        broken = scene.context.accel_build(triangles(vertices))
        assert scene.launch(broken).tolist() == [-1.0] * 4
        np.testing.assert_array_equal(vertices, before)


def test_empty_structures_are_missed(scene: Scene) -> None:
    nothing = scene.context.accel_build(triangles(np.zeros((0, 3), np.float32), np.zeros((0, 3), np.uint32)))
    assert scene.launch(nothing).tolist() == [-1.0] * 4
    assert scene.launch(scene.context.accel_build([ox.BuildInputInstances([])])).tolist() == [-1.0] * 4


def test_a_singular_transform_hides_its_instance_only(scene: Scene) -> None:
    accel = triangle(scene)
    flat = ox.Instance(accel, np.zeros((3, 4), np.float32))
    world = scene.context.accel_build([ox.BuildInputInstances([flat, ox.Instance(accel)])])
    assert scene.launch(world).tolist() == [2.0] * 4


@pytest.mark.parametrize("size", [(0,), (4, 0), (4, 1, 0), (-1,), (1.5,), ("4",), (1 << 40,), (1 << 20, 1 << 20)])
def test_wrong_launch_sizes(scene: Scene, size: tuple[Any, ...]) -> None:
    hits = np.zeros(4, np.float32)
    with pytest.raises(ox.OptixError, match="launch size"):
        scene.pipeline.launch(shader.Params(hits, triangle(scene), 1.0), scene.table(), *size)
    assert hits.tolist() == [0.0] * 4


def test_parameters_of_another_struct(scene: Scene) -> None:
    hits = np.zeros(4, np.float32)
    for wrong in (shader.Other(hits, 1.0), None, shader.Params, {"hits": hits}):
        with pytest.raises(ox.InvalidValueError, match="launch parameters are a Params"):
            scene.pipeline.launch(wrong, scene.table(), 4)


def test_a_record_that_is_missing_runs_nothing(scene: Scene, checked: Scene) -> None:
    assert scene.launch(triangle(scene), hit=False).tolist() == [0.0] * 4
    with pytest.raises(ox.ValidationFailureError):
        checked.launch(triangle(checked), hit=False)
    assert checked.launch(triangle(checked)).tolist() == [2.0] * 4


def test_a_freed_accel_is_a_miss_and_an_error_in_validation(scene: Scene, checked: Scene) -> None:
    for one in (scene, checked):
        accel = triangle(one)
        handle = int(accel.handle)
        accel.destroy()
        with pytest.raises(ox.InvalidValueError, match="destroyed"):
            _ = accel.aabb
        if one is scene:
            assert one.launch(handle).tolist() == [-1.0] * 4
            assert one.launch(0).tolist() == [-1.0] * 4
        else:
            with pytest.raises(ox.ValidationFailureError):
                one.launch(handle)


def test_a_handle_keeps_its_accel_alive(scene: Scene) -> None:
    params = shader.Params(np.zeros(4, np.float32), triangle(scene).handle, 1.0)
    scene.pipeline.launch(params, scene.table(), 4)
    assert params.hits.tolist() == [2.0] * 4


def test_records_and_groups_in_the_wrong_place(scene: Scene) -> None:
    raygen, miss, paint = scene.groups["rays"], scene.groups["miss"], scene.groups["paint"]
    with pytest.raises(ox.InvalidValueError, match="raygen takes a record of a RAYGEN group"):
        ox.ShaderBindingTable(raygen=miss.record())
    with pytest.raises(ox.InvalidValueError, match="list of records"):
        ox.ShaderBindingTable(raygen=raygen.record(), miss=miss.record())
    with pytest.raises(ox.InvalidValueError, match="takes a Paint"):
        paint.record()
    with pytest.raises(ox.InvalidValueError, match="takes a Paint"):
        paint.record(shader.Other(np.zeros(1, np.float32), 1.0))
    with pytest.raises(ox.InvalidValueError, match="__closesthit__"):
        scene.context.program_group_create(anyhit=scene.groups["paint"].programs["closesthit"])
    with pytest.raises(ox.InvalidValueError, match="has no program"):
        scene.context.module_create(shader)["__raygen__nope"]


def test_data_of_a_record_changes_in_place(scene: Scene) -> None:
    table, accel = scene.table(), triangle(scene)
    params = shader.Params(np.zeros(4, np.float32), accel, 1.0)
    for change, expected in ((lambda: None, 2.0), (lambda: setattr(table.hitgroup[0], "data", shader.Paint(5.0)), 5.0)):
        change()
        scene.pipeline.launch(params, table, 4)
        assert params.hits.tolist() == [expected] * 4
    table.hitgroup[0].data.value = 7.0
    params.scale = 2.0
    scene.pipeline.launch(params, table, 4)
    assert params.hits.tolist() == [14.0] * 4


def test_two_threads_may_launch_one_pipeline(scene: Scene) -> None:
    accel, failures = triangle(scene), []

    def work() -> None:
        try:
            for _ in range(50):
                assert scene.launch(accel, 64).tolist() == [2.0] * 64
        except BaseException as error:
            failures.append(error)

    threads = [threading.Thread(target=work) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert failures == []


@pytest.fixture
def ctrl_c() -> Iterator[Callable[[], None]]:
    """Presses Ctrl-C in a moment. A process of a background job ignores the signal, so Python's own handler is set."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield lambda: threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
    signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("lanes", [1, 8, 16])
def test_ctrl_c_stops_an_endless_program(scene: Scene, ctrl_c: Callable[[], None], lanes: int) -> None:
    try:
        pipeline = scene.context.pipeline_create(list(scene.groups.values()), simd=lanes)
    except ox.NotSupportedError as error:
        pytest.skip(str(error))
    one = replace(scene, pipeline=pipeline)
    began = time.monotonic()
    ctrl_c()
    with pytest.raises(KeyboardInterrupt):
        one.launch(0, 64, raygen="endless")
    assert time.monotonic() - began < 1.3
    assert scene.launch(triangle(scene)).tolist() == [2.0] * 4


def test_a_forked_child_gets_a_named_error(scene: Scene) -> None:
    accel = triangle(scene)
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        said = []
        for call in (lambda: scene.launch(accel), lambda: triangle(scene), lambda: accel.aabb, scene.context.info):
            try:
                call()
                said.append("nothing")
            except ox.InvalidDeviceContextError as error:
                said.append("fork" if "fork" in str(error) else str(error))
        os.write(writer, ",".join(said).encode())
        os._exit(0)
    os.close(writer)
    _, status = os.waitpid(child, 0)
    assert status == 0
    assert os.read(reader, 4096).decode() == "fork,fork,fork,fork"
    os.close(reader)
    assert scene.launch(accel).tolist() == [2.0] * 4


def test_an_exception_in_a_log_callback_is_reported(capfd: pytest.CaptureFixture[str]) -> None:
    def callback(level: int, tag: str, message: str) -> None:
        raise RuntimeError("the callback's own fault")

    context = ox.DeviceContext(log_callback=callback)
    accel = context.accel_build(triangles(CORNERS))
    assert accel.primitive_count == 1
    assert "the callback's own fault" in capfd.readouterr().err


def test_a_destroyed_context_is_named() -> None:
    context = ox.DeviceContext()
    accel = context.accel_build(triangles(CORNERS))
    context.destroy()
    context.destroy()
    for call in (lambda: accel.aabb, lambda: context.accel_build(triangles(CORNERS)), lambda: context.module_create(shader)):
        with pytest.raises(ox.InvalidDeviceContextError, match="destroyed"):
            call()
    accel.destroy()


@pytest.mark.parametrize("options", [{"threads": 0}, {"threads": -1}, {"threads": 1.5}, {"log_callback": 3}])
def test_wrong_context_options(options: dict[str, Any]) -> None:
    with pytest.raises(ox.InvalidValueError):
        ox.DeviceContext(**options)


@pytest.mark.parametrize(
    "options",
    [
        {"simd": 4},
        {"simd": "16"},
        {"math": "exact"},
        {"max_trace_depth": 32},
        {"max_trace_depth": -1},
        {"bound_values": {"nothing": 1}},
        {"bound_values": {"hits": 1}},
        {"bound_values": {"scale": "x"}},
    ],
)
def test_wrong_pipeline_options(scene: Scene, options: dict[str, Any]) -> None:
    with pytest.raises(ox.InvalidValueError):
        scene.context.pipeline_create(list(scene.groups.values()), **options)


def test_bound_values_become_constants(scene: Scene) -> None:
    bound = scene.context.pipeline_create(list(scene.groups.values()), bound_values={"scale": 3.0})
    params = shader.Params(np.zeros(4, np.float32), triangle(scene), 3.0)
    bound.launch(params, scene.table(), 4)
    assert params.hits.tolist() == [6.0] * 4


def test_objects_say_what_they_are(scene: Scene) -> None:
    context = ox.DeviceContext(validation=True)
    table = scene.table()
    shown = [repr(one) for one in (context, scene.pipeline, table, table.raygen, table.hitgroup[0], context.module_create(shader))]
    context.destroy()
    assert repr(context) == "<DeviceContext with validation destroyed>"
    expected = ("<DeviceContext with validation>", "__raygen__rays", "1 miss, 1 hitgroup, 0 callables",
                "<Record of <ProgramGroup RAYGEN __raygen__rays>, data None>", "Paint(", "__closesthit__paint")
    for text, words in zip(shown, expected, strict=True):
        assert words in text
        assert "object at 0x" not in text


@pytest.mark.parametrize(("size", "index"), [(4, 2), ((4,), (2,)), ([4, 1], [2, 0]), (np.array([4, 1, 1]), np.array([2, 0, 0])),
                                             (ox.uint3(4, 1, 1), ox.uint3(2, 0, 0)), (np.int64(4), np.uint8(2))])
def test_ways_to_name_a_launch_index(scene: Scene, size: Any, index: Any) -> None:
    hits = np.zeros(4, np.float32)
    ox.interpret(scene.pipeline, shader.Params(hits, triangle(scene), 1.0), scene.table(), size, index)
    assert np.flatnonzero(hits).tolist() == np.flatnonzero(scene.launch(triangle(scene)) * (np.arange(4) == 2)).tolist() == [2]


@pytest.mark.parametrize(("size", "index"), [((), 0), ((1, 1, 1, 1), 0), (4.0, 1), ("x", 1), (None, 1), (4, -1), (4, 4), ([4, 0.5], 1)])
def test_no_launch_index(scene: Scene, size: Any, index: Any) -> None:
    with pytest.raises(ox.InvalidValueError):
        ox.interpret(scene.pipeline, shader.Params(np.zeros(4, np.float32), triangle(scene), 1.0), scene.table(), size, index)


def test_an_option_that_says_nothing_here_is_told(scene: Scene) -> None:
    options = ox.PipelineCompileOptions(pipeline_launch_params_variable_name="params")
    pipeline = scene.context.pipeline_create(list(scene.groups.values()), options=options)
    assert pipeline.report().ignored == ["pipeline_launch_params_variable_name"]
    with pytest.raises(ox.InvalidValueError, match="pipeline_launch_params_variable_name is a name or None, not 3"):
        ox.PipelineCompileOptions(pipeline_launch_params_variable_name=3)  # type: ignore[arg-type]


def test_a_shaders_errors_are_raised_without_the_compilers_frames(tmp_path: Path) -> None:
    path = tmp_path / "shader.py"
    path.write_text("import optixc as ox\n@ox.program\ndef __raygen__r():\n    x = y\n")
    with pytest.raises(ox.CompileError) as caught:
        ox.DeviceContext().module_create(path)
    assert {Path(frame.path).name for frame in caught.traceback} == {Path(__file__).name, "api.py"}


def test_the_longer_names_of_enumerations() -> None:
    assert ox.HitKind.TRIANGLE_BACK_FACE is ox.HitKind.BACK_FACE
    assert ox.TraversableGraphFlags.ALLOW_SINGLE_GAS is ox.TraversableGraphFlags.SINGLE_GAS
