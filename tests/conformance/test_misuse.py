"""Every misuse of the host interface that OptiX's reference names an error for: OptiX's code, and a sentence with the remedy.

One row for each: the OptiX function, what is wrong, the call, the code, what the sentence says. What OptiX leaves undefined has rows as
well, because nothing may crash the process or touch the caller's data.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from shaders import host_checks as shader

import optixc as ox

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
BOX = np.array([[0, 0, 0, 1, 1, 1]], np.float32)
EYE = np.eye(3, 4, dtype=np.float32)
CUBIC = ox.PrimitiveType.ROUND_CUBIC_BSPLINE
POINTS, RADII, FIRST = np.zeros((4, 3), np.float32), np.ones(4, np.float32), np.zeros(1, np.uint32)
INVALID = ox.Result.ERROR_INVALID_VALUE


class Made:
    """One object of each kind."""

    def __init__(self) -> None:
        self.context = ox.DeviceContext(threads=2, log_callback=lambda *message: None)
        self.module = self.context.module_create(shader)
        self.create = self.context.program_group_create
        self.raygen = self.create(raygen=self.module["__raygen__rays"])
        self.miss = self.create(miss=self.module["__miss__nothing"])
        self.hit = self.create(closesthit=self.module["__closesthit__paint"])
        self.pipeline = self.context.pipeline_create([self.raygen, self.miss, self.hit])
        self.gas = self.build(ox.BuildInputTriangles(CORNERS))
        self.updatable = self.context.accel_build([ox.BuildInputTriangles(CORNERS)], build_flags=ox.BuildFlags.ALLOW_UPDATE)
        self.table = ox.ShaderBindingTable(raygen=self.raygen.record(), miss=[self.miss.record()],
                                           hitgroup=[self.hit.record(shader.Paint(1.0))])
        self.out = np.zeros(4, np.float32)
        self.params = shader.Params(self.out, self.gas, 1.0)

    def build(self, *inputs: Any, **options: Any) -> Any:
        return self.context.accel_build(list(inputs), **options)

    def triangles(self, **options: Any) -> Any:
        return self.build(ox.BuildInputTriangles(CORNERS, **options))

    def instance(self, **options: Any) -> Any:
        return self.build(ox.BuildInputInstances([ox.Instance(self.gas, **options)]))

    def curves(self, kind: Any = CUBIC, points: Any = POINTS, radii: Any = RADII, first: Any = FIRST, **options: Any) -> Any:
        return self.build(ox.BuildInputCurves(kind, points, radii, first, **options))

    def launch(self, *size: Any) -> None:
        self.pipeline.launch(self.params, self.table, *size)


@pytest.fixture(scope="module")
def made() -> Made:
    return Made()


Row = tuple[str, str, Callable[[Made], Any], int, str]
PIPELINE_ROWS: list[Row] = [
    ("optixDeviceContextCreate", "no threads", lambda m: ox.DeviceContext(threads=0), INVALID, "threads is None or at least 1"),
    ("optixDeviceContextCreate", "cache in a number", lambda m: ox.DeviceContext(cache_dir=3), INVALID, "takes a folder"),
    ("optixDeviceContextGetProperty", "no property", lambda m: m.context.get_property(7), INVALID, "take one of ox.DeviceProperty"),
    ("optixDeviceContextSetLogCallback", "no function", lambda m: m.context.set_log_callback(3), INVALID, "callable or None"),
    ("optixDeviceContextSetLogCallback", "level 5", lambda m: m.context.set_log_callback(None, 5), INVALID, "0 to 4"),
    ("optixDeviceContextSetLogCallback", "level True", lambda m: m.context.set_log_callback(None, True), INVALID, "0 to 4"),
    ("optixDeviceContextSetCacheLocation", "empty", lambda m: m.context.set_cache_location(""), INVALID, "takes a folder"),
    ("optixDeviceContextSetCacheLocation", "None", lambda m: m.context.set_cache_location(None), INVALID, "takes a folder"),
    ("optixDeviceContextSetCacheLocation", "a zero", lambda m: m.context.set_cache_location("a\0b"), INVALID, "takes a folder"),
    ("optixDeviceContextSetCacheDatabaseSizes", "high below low",
     lambda m: m.context.set_cache_database_sizes(10, 5), INVALID, "below the low"),
    ("optixModuleCreate", "input None", lambda m: m.context.module_create(None), INVALID, "a Python module, a path, or a list"),
    ("optixModuleCreate", "a folder", lambda m: m.context.module_create("/"), 7004, "cannot be read"),
    ("optixModuleCreate", "no such file", lambda m: m.context.module_create("/none.py"), 7004, "cannot be read"),
    ("optixModuleCreate", "folders as text", lambda m: m.context.module_create(shader, include_dirs="/"), INVALID, "list of folders"),
    ("optixModuleCreate", "bound values as a list", lambda m: m.context.module_create(shader, bound_values=[1]), INVALID, "takes a dict"),
    ("optixModuleCreate", "bound field unknown",
     lambda m: m.context.module_create(shader, bound_values={"x": 1}), INVALID, "is no field of"),
    ("optixModuleCreate", "bound twice", lambda m: m.context.module_create(shader, bound_values={"a": 1, "a.b": 1}), INVALID, "overlap"),
    ("optixModuleCreate", "nothing bound", lambda m: m.context.module_create(shader, bound_values={"scale": ()}), INVALID, "no bytes"),
    ("optixModuleCreate", "a matrix bound",
     lambda m: m.context.module_create(shader, bound_values={"scale": EYE}), INVALID, "takes a number"),
    ("optixTaskExecute", "no additional tasks", lambda m: m.context.module_create_with_tasks(shader)[1].execute(0), INVALID, "at least 1"),
    ("optixModuleGetCompilationState", "programs of a module that waits",
     lambda m: m.context.module_create_with_tasks(shader)[0]["__raygen__rays"], 7003, "execute its tasks"),
    ("optixProgramGroupCreate", "nothing", lambda m: m.create(), INVALID, "a program group is one of"),
    ("optixProgramGroupCreate", "two kinds", lambda m: m.create(raygen=None, miss=None), INVALID, "a program group is one of"),
    ("optixProgramGroupCreate", "raygen None", lambda m: m.create(raygen=None), INVALID, "needs a program"),
    ("optixProgramGroupCreate", "callables None", lambda m: m.create(direct_callable=None), INVALID, "needs a program"),
    ("optixProgramGroupCreate", "a name", lambda m: m.create(raygen="__raygen__rays"), INVALID, r'module\["__raygen__..."\]'),
    ("optixProgramGroupCreate", "another prefix", lambda m: m.create(miss=m.module["__raygen__rays"]), INVALID, "begins with __miss__"),
    ("optixProgramGroupCreate", "an absent entry", lambda m: m.module["__miss__x"], INVALID, "it has __raygen__rays"),
    ("optixProgramGroupGetStackSize", "another pipeline",
     lambda m: m.create(miss=None).get_stack_size(m.pipeline), INVALID, "created with the group"),
    ("optixPipelineCreate", "no groups", lambda m: m.context.pipeline_create([]), INVALID, "at least one"),
    ("optixPipelineCreate", "no raygen", lambda m: m.context.pipeline_create([m.miss]), INVALID, "needs a raygen group"),
    ("optixPipelineCreate", "depth 32", lambda m: m.context.pipeline_create([m.raygen], 32), INVALID, "0 to 31"),
    ("optixPipelineCreate", "options as a dict",
     lambda m: m.context.pipeline_create([m.raygen], options={}), INVALID, "ox.PipelineCompileOptions"),
    ("optixPipelineCreate", "seven lanes", lambda m: m.context.pipeline_create([m.raygen], simd=7), INVALID, '"auto", 1, 8 or 16'),
    ("OptixPipelineCompileOptions", "33 payload values", lambda m: ox.PipelineCompileOptions(num_payload_values=33), INVALID, "0 to 32"),
    ("OptixPipelineCompileOptions", "9 attributes", lambda m: ox.PipelineCompileOptions(num_attribute_values=9), INVALID, "0 to 8"),
    ("OptixPipelineCompileOptions", "flag 8", lambda m: ox.PipelineCompileOptions(exception_flags=8), INVALID, "0 to 7"),
    ("OptixPipelineCompileOptions", "graph flag 4", lambda m: ox.PipelineCompileOptions(traversable_graph_flags=4), INVALID, "0 to 3"),
    ("OptixPipelineCompileOptions", "primitives as text", lambda m: ox.PipelineCompileOptions(uses_primitive_type_flags="x"), INVALID,
     "combines PrimitiveTypeFlags"),
    ("optixPipelineSetStackSize", "negative", lambda m: m.pipeline.set_stack_size(-1, 0, 0), INVALID, "bytes"),
    ("optixPipelineSetStackSize", "graph depth 0", lambda m: m.pipeline.set_stack_size(0, 0, 0, 0), INVALID, "1 to 31"),
    ("optixUtilComputeStackSizes", "sizes None", lambda m: ox.util_compute_stack_sizes(None, 1, 0, 0), INVALID, r"ox.StackSizes\(\)"),
    ("optixUtilAccumulateStackSizes", "sizes None", lambda m: ox.util_accumulate_stack_sizes(m.raygen, None), INVALID, "ox.StackSizes"),
    ("optixSbtRecordPackHeader", "no data", lambda m: m.hit.record(), INVALID, "takes a Paint as its record's data"),
    ("optixSbtRecordPackHeader", "another struct", lambda m: m.hit.record(shader.Other(m.out, 1.0)), INVALID, "takes a Paint"),
    ("optixSbtRecordPackHeader", "a dict", lambda m: m.hit.record({"value": 1.0}), INVALID, "@ox.struct"),
    ("OptixShaderBindingTable", "raygen None", lambda m: ox.ShaderBindingTable(raygen=None), INVALID, r"group.record\(data\)"),
    ("OptixShaderBindingTable", "one record as section",
     lambda m: ox.ShaderBindingTable(raygen=m.raygen.record(), miss=m.miss.record()), INVALID, "list of records"),
    ("OptixShaderBindingTable", "a miss record as hit group",
     lambda m: ox.ShaderBindingTable(raygen=m.raygen.record(), hitgroup=[m.miss.record()]), INVALID, "record of a HITGROUP group"),
    ("optixLaunch", "a zero", lambda m: m.launch(4, 0), INVALID, "use 1 for unused dimensions"),
    ("optixLaunch", "2^31 indices", lambda m: m.launch(1 << 31), 7050, "launch in parts"),
    ("optixLaunch", "a fraction", lambda m: m.launch(4.0), INVALID, "whole numbers"),
    ("optixLaunch", "table None", lambda m: m.pipeline.launch(m.params, None, 4), INVALID, "takes a ShaderBindingTable"),
    ("optixLaunch", "params None", lambda m: m.pipeline.launch(None, m.table, 4), INVALID, "parameters are a Params"),
    ("optixLaunch", "other params", lambda m: m.pipeline.launch(shader.Paint(1.0), m.table, 4), INVALID, "parameters are a Params"),
    ("optixLaunch", "an array of another type", lambda m: shader.Params(np.zeros(4), m.gas, 1.0), INVALID, r"astype\(numpy.float32\)"),
    ("optixLaunch", "a list for an array", lambda m: shader.Params("text", m.gas, 1.0), INVALID, "numpy array"),
    ("optixLaunch", "a name for a scene", lambda m: shader.Params(m.out, "gas", 1.0), INVALID, r"an object with .handle"),
]
SCENE_ROWS: list[Row] = [
    ("optixAccelBuild", "no inputs", lambda m: m.build(), INVALID, "at least one build input"),
    ("optixAccelBuild", "inputs None", lambda m: m.context.accel_build(None), INVALID, "list of build inputs"),
    ("optixAccelBuild", "unknown flag",
     lambda m: m.build(ox.BuildInputTriangles(CORNERS), build_flags=1 << 20), INVALID, "combine BuildFlags"),
    ("optixAccelBuild", "flags as text",
     lambda m: m.build(ox.BuildInputTriangles(CORNERS), build_flags="x"), INVALID, "combines BuildFlags"),
    ("optixAccelBuild", "fast trace and fast build",
     lambda m: m.build(ox.BuildInputTriangles(CORNERS), build_flags=12), INVALID, "choose one"),
    ("optixAccelBuild", "two kinds", lambda m: m.build(ox.BuildInputTriangles(CORNERS), ox.BuildInputCustomPrimitives(BOX)), INVALID,
     "one accel per type"),
    ("optixAccelBuild", "two inputs of instances", lambda m: m.build(*[ox.BuildInputInstances([])] * 2), INVALID, "exactly one"),
    ("optixAccelBuild", "motion as a number", lambda m: m.build(ox.BuildInputTriangles(CORNERS), motion_options=3), INVALID,
     "takes a MotionOptions"),
    ("OptixMotionOptions", "keys and arrays differ",
     lambda m: m.build(ox.BuildInputTriangles(CORNERS), motion_options=ox.MotionOptions(3)), INVALID, "one array for each key"),
    ("OptixMotionOptions", "begin after end",
     lambda m: m.build(ox.BuildInputTriangles([CORNERS] * 2), motion_options=ox.MotionOptions(2, 1.0, 0.0)), INVALID, "is after"),
    ("OptixMotionOptions", "NaN", lambda m: m.build(ox.BuildInputTriangles([CORNERS] * 2), motion_options=ox.MotionOptions(2, np.nan, 0.0)),
     INVALID, "finite|NaN|nan"),
    ("OptixMotionOptions", "flag 4", lambda m: m.build(ox.BuildInputTriangles([CORNERS] * 2), motion_options=ox.MotionOptions(2, flags=4)),
     INVALID, "combines MotionFlags"),
    ("OptixMotionOptions", "negative keys",
     lambda m: m.build(ox.BuildInputTriangles(CORNERS), motion_options=ox.MotionOptions(-1)), INVALID,
     "num_keys must be"),
    ("OptixBuildInputTriangleArray", "geometry flag 8", lambda m: m.triangles(flags=8), INVALID, "combine GeometryFlags"),
    ("OptixBuildInputTriangleArray", "negative flags", lambda m: m.triangles(flags=-1), INVALID, "combines GeometryFlags"),
    ("OptixBuildInputTriangleArray", "no records", lambda m: m.triangles(num_sbt_records=0), INVALID, "from 1 to 16777216"),
    ("OptixBuildInputTriangleArray", "2^24 + 1 records",
     lambda m: m.triangles(num_sbt_records=(1 << 24) + 1), INVALID, "from 1 to 16777216"),
    ("OptixBuildInputTriangleArray", "records without offsets",
     lambda m: m.triangles(num_sbt_records=2), INVALID, "one offset per primitive"),
    ("OptixBuildInputTriangleArray", "float offsets",
     lambda m: m.triangles(num_sbt_records=2, sbt_index_offsets=np.zeros(1, np.float32)), INVALID, r"astype\(numpy.uint32\)"),
    ("OptixBuildInputTriangleArray", "offset of primitives",
     lambda m: m.triangles(primitive_index_offset=(1 << 32) - 1), INVALID, "from 0 to 4294967294"),
    ("OptixBuildInputTriangleArray", "4x4 transform", lambda m: m.triangles(pre_transform=np.eye(4)), INVALID, "3x4"),
    ("OptixBuildInputTriangleArray", "NaN transform", lambda m: m.triangles(pre_transform=np.full((3, 4), np.nan)), INVALID, "not finite"),
    ("OptixBuildInputTriangleArray", "vertices None", lambda m: m.build(ox.BuildInputTriangles(None)), INVALID, "ascontiguousarray"),
    ("OptixBuildInputTriangleArray", "an index too large",
     lambda m: m.build(ox.BuildInputTriangles(CORNERS, np.array([[0, 1, 3]], np.uint32))), INVALID, "3 vertices"),
    ("OptixBuildInputSphereArray", "radii None", lambda m: m.build(ox.BuildInputSpheres(CORNERS, None)), INVALID, "ascontiguousarray"),
    ("OptixBuildInputSphereArray", "two radii for three", lambda m: m.build(ox.BuildInputSpheres(CORNERS, np.ones(2, np.float32))), INVALID,
     "one for each, or one for all"),
    ("OptixBuildInputCurveArray", "type of triangles", lambda m: m.curves(ox.PrimitiveType.TRIANGLE), INVALID, "takes one of ROUND_LINEAR"),
    ("OptixBuildInputCurveArray", "no indices", lambda m: m.curves(first=None), INVALID, "indices takes"),
    ("OptixBuildInputCurveArray", "radii None", lambda m: m.curves(radii=None), INVALID, "radii takes"),
    ("OptixBuildInputCurveArray", "a segment beyond the end", lambda m: m.curves(first=np.ones(1, np.uint32)), INVALID, "4 control points"),
    ("OptixBuildInputCurveArray", "end cap 2", lambda m: m.curves(endcap_flags=2), INVALID, "one of DEFAULT, ON"),
    ("OptixBuildInputCurveArray", "normals of a tube", lambda m: m.curves(normals=POINTS), INVALID, "normals are for ribbons"),
    ("OptixBuildInputCustomPrimitiveArray", "boxes of five numbers",
     lambda m: m.build(ox.BuildInputCustomPrimitives(np.zeros((1, 5), np.float32))), INVALID, r"\(n, 6\)"),
    ("OptixInstance", "id of 29 bits", lambda m: m.instance(instance_id=1 << 28), INVALID, "below 268435456"),
    ("OptixInstance", "offset of 29 bits", lambda m: m.instance(sbt_offset=1 << 28), INVALID, "below 268435456"),
    ("OptixInstance", "mask of nine bits", lambda m: m.instance(visibility_mask=256), INVALID, "below 256"),
    ("OptixInstance", "negative id", lambda m: m.instance(instance_id=-1), INVALID, "whole numbers"),
    ("OptixInstance", "transform of three", lambda m: m.instance(transform=[1, 2, 3]), INVALID, "3x4"),
    ("OptixInstance", "a number as child", lambda m: m.build(ox.BuildInputInstances([3.5])), INVALID, "accel or a traversable handle"),
    ("optixAccelBuild (update)", "without the flag", lambda m: m.gas.update([ox.BuildInputTriangles(CORNERS)]), INVALID, "ALLOW_UPDATE"),
    ("optixAccelBuild (update)", "other counts",
     lambda m: m.updatable.update([ox.BuildInputTriangles(np.concatenate([CORNERS, CORNERS]))]), INVALID, "an update keeps"),
    ("optixAccelCompact", "without the flag", lambda m: m.gas.compact(), INVALID, "ALLOW_COMPACTION"),
    ("optixAccelRelocate", "children of a GAS", lambda m: m.gas.relocate([m.gas]), INVALID, "which has none"),
    ("optixConvertPointerToTraversableHandle", "3x3", lambda m: m.context.static_transform(m.gas, np.eye(3)), INVALID, "3x4"),
    ("optixConvertPointerToTraversableHandle", "no child",
     lambda m: m.context.static_transform(3.5, EYE), INVALID, "accel or a traversable"),
    ("OptixMatrixMotionTransform", "one key", lambda m: m.context.matrix_motion_transform(m.gas, EYE[None]), INVALID, "at least 2"),
    ("OptixMatrixMotionTransform", "begin equals end",
     lambda m: m.context.matrix_motion_transform(m.gas, np.stack([EYE, EYE]), ox.MotionOptions(2, 1.0, 1.0)), INVALID, "must be before"),
    ("OptixSRTMotionTransform", "15 numbers",
     lambda m: m.context.srt_motion_transform(m.gas, np.zeros((2, 15), np.float32)), INVALID, r"\(num_keys, 16\)"),
    ("optixOpacityMicromapArrayBuild", "a number", lambda m: m.context.opacity_micromap_array_build(3), INVALID, "list of OpacityMicromap"),
    ("optixOpacityMicromapArrayBuild", "format 0",
     lambda m: m.context.opacity_micromap_array_build(np.zeros(1, np.uint8), np.zeros((1, 3))), INVALID, "FORMAT_2_STATE"),
]
ROWS = PIPELINE_ROWS + SCENE_ROWS


@pytest.mark.parametrize("row", ROWS, ids=[f"{row[0]}: {row[1]}" for row in ROWS])
def test_misuse_is_named(made: Made, row: Row) -> None:
    _, _, call, code, remedy = row
    before = made.out.copy(), CORNERS.copy()
    with pytest.raises(ox.OptixError, match=remedy) as caught:
        call(made)
    assert caught.value.code == code
    np.testing.assert_array_equal(made.out, before[0])
    np.testing.assert_array_equal(CORNERS, before[1])


def test_everything_works_after_all_of_it(made: Made) -> None:
    made.launch(4)
    assert made.out.tolist() == [1.0] * 4


@pytest.mark.parametrize("data", [b"\x7fELF\0\0", b"\xff\xfe\0a", b"", b"\xc3\x28", b"def f(:", b"x = 1\0"], ids=repr)
def test_files_that_are_no_shaders(made: Made, tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "no_shader.py"
    path.write_bytes(data)
    with pytest.raises(ox.OptixError, match="no_shader"):
        made.context.module_create(path)


def test_what_two_contexts_share(made: Made) -> None:
    """Groups and modules go with any context; accels and pipelines belong to theirs."""
    other = ox.DeviceContext(validation=True, threads=1, log_callback=lambda *message: None)
    pipeline = other.pipeline_create([made.raygen, made.miss, made.hit])
    pipeline.launch(shader.Params(made.out, 0, 1.0), made.table, 4)
    assert made.out.tolist() == [-1.0] * 4
    foreign = made.build(ox.BuildInputTriangles(CORNERS), ox.BuildInputTriangles(CORNERS + 5))
    for wrong in (lambda: other.accel_build([ox.BuildInputInstances([ox.Instance(foreign)])]),
                  lambda: pipeline.launch(shader.Params(made.out, foreign, 1.0), made.table, 4)):
        with pytest.raises(ox.OptixError, match=r"context|stale|destroyed"):
            wrong()
    unwatched = ox.DeviceContext().pipeline_create([made.raygen, made.miss, made.hit])
    with pytest.raises(ox.InvalidValueError, match="`scene` of Params is of another context than the pipeline"):
        unwatched.launch(shader.Params(made.out, foreign, 1.0), made.table, 4)
    made.launch(4)
    assert made.out.tolist() == [1.0] * 4
