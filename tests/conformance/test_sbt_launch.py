"""Area H: shader binding table and launch."""

from __future__ import annotations

import threading
from typing import Any

import numpy as np
import pytest
from harness import SHADERS, Harness
from scenes import CORNER, calls, closest, gas, hitgroup, ias, instance, offsets, ray, trace, translation, triangles
from shaders import callable_arguments
from shaders import launch as shader

import optixc as ox
from optixc.host import library

CORNERS = np.array(CORNER, np.float32)


def groups_of(harness: Harness) -> dict[str, Any]:
    """The program groups of this file, made once."""
    if "launch groups" not in harness.kept:
        module, create = harness.module("launch.py"), harness.context.program_group_create
        harness.kept["launch groups"] = {
            "index": create(raygen=module["__raygen__index"]), "trace": create(raygen=module["__raygen__trace"]),
            "data": create(closesthit=module["__closesthit__data"]),
            "get": create(closesthit=module["__closesthit__get_sbt_data"]), "miss": create(miss=module["__miss__nothing"])}
    groups: dict[str, Any] = harness.kept["launch groups"]
    return groups


def pipeline_of(harness: Harness) -> Any:
    """The pipeline of this file."""
    return harness.pipeline("launch", groups_of(harness).values())


def launch_index(harness: Harness, width: int, height: int, depth: int, a: int = 0, value: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """What the index program wrote."""
    groups, pipeline = groups_of(harness), pipeline_of(harness)
    indices, dimensions = np.zeros(width * height * depth, np.uint32), np.zeros(3 * width * height * depth, np.uint32)
    sbt = ox.ShaderBindingTable(raygen=groups["index"].record(shader.Data(a, 0.0, (0, 0, 0))), miss=[groups["miss"].record()], hitgroup=[])
    params = shader.Params(indices=indices, dimensions=dimensions, scene=0, value=value)
    harness.launch(pipeline, params, sbt, width, height, depth)
    return indices, dimensions.reshape(-1, 3)


def traced(harness: Harness, records: list[Any], sbt_offset: int = 0) -> int:
    """What the closest-hit program of the first record gives."""
    groups, pipeline = groups_of(harness), pipeline_of(harness)
    indices = np.zeros(1, np.uint32)
    scene = harness.context.accel_build([ox.BuildInputTriangles(CORNERS)])
    sbt = ox.ShaderBindingTable(raygen=groups["trace"].record(), miss=[groups["miss"].record()], hitgroup=records)
    harness.launch(pipeline, shader.Params(indices=indices, dimensions=indices, scene=scene.handle, value=0), sbt, 1)
    return int(indices[0])


@pytest.mark.parametrize("program", ["data", "get"])
def test_T080_a_program_reads_its_record(harness: Harness, program: str) -> None:
    record = groups_of(harness)[program].record(shader.Data(7, 30.0, (100.0, 200.0, 300.0)))
    assert traced(harness, [record]) == 637


def test_T082_record_data_changes_between_launches(harness: Harness) -> None:
    groups, pipeline = groups_of(harness), pipeline_of(harness)
    indices = np.zeros(1, np.uint32)
    scene = harness.context.accel_build([ox.BuildInputTriangles(CORNERS)])
    sbt = ox.ShaderBindingTable(raygen=groups["trace"].record(), miss=[groups["miss"].record()],
                                hitgroup=[groups["data"].record(shader.Data(1, 0.0, (0, 0, 0)))])
    params = shader.Params(indices=indices, dimensions=indices, scene=scene.handle, value=0)
    harness.launch(pipeline, params, sbt, 1)
    first = int(indices[0])
    sbt.hitgroup[0].data = shader.Data(2, 0.0, (0, 0, 0))
    harness.launch(pipeline, params, sbt, 1)
    assert (first, int(indices[0])) == (1, 2)


def test_T083_the_worked_example_of_the_guide(harness: Harness) -> None:
    far = [[(x + 2 * k, y, z) for x, y, z in CORNER] for k in (1, 2)]
    scene = [gas(triangles(CORNER), triangles(far, (0, 0), **offsets([0, 1]))),
             ias(instance(sbt_offset=0), instance(transform=translation(0, 10, 0), sbt_offset=6))]
    rays = [ray((2 * k + 0.25, 10 * i + 0.25, 1.0), root="ias", sbt_offset=kind, sbt_stride=2)
            for i in range(2) for k in range(3) for kind in range(2)]
    results = trace(harness, scene, rays, [hitgroup(record) for record in range(12)])
    assert [closest(result)["rec"] for result in results] == list(range(12))


@pytest.mark.parametrize("size", [1, 2, 4])
def test_T084_T085_records_of_several_inputs(harness: Harness, size: int) -> None:
    rows = [[[(x + 2 * k, y + 5 * row, z) for x, y, z in CORNER] for k in range(4)] for row in range(3)]
    scene = [gas(triangles(rows[0], (0,) * 4, **offsets([2, 0, 1, 3], size)), triangles(rows[1]),
                 triangles(rows[2], (0, 0), **offsets([1, 0, 1, 0], size)))]
    rays = [ray((2 * k + 0.25, 5 * row + 0.25, 1.0)) for row in range(3) for k in range(4)]
    results = trace(harness, scene, rays, [hitgroup(record) for record in range(7)])
    assert [closest(result)["rec"] for result in results] == [2, 0, 1, 3, 4, 4, 4, 4, 6, 5, 6, 5]
    assert [closest(result)["gasIdx"] for result in results] == [closest(result)["rec"] for result in results]


def test_T087_T088_offsets_and_strides_of_the_trace(harness: Harness) -> None:
    far = [[(x + 2 * k, y, z) for x, y, z in CORNER] for k in range(3)]
    scene = [gas(triangles(far, (0, 0, 0), **offsets([0, 1, 2]))), ias(instance(sbt_offset=5))]
    groups = [hitgroup(record) for record in range(48)]
    for root, base in (("gas", 0), ("ias", 5)):
        for offset, stride in ((0, 1), (1, 2), (3, 0), (2, 15), (15, 1)):
            rays = [ray((2 * k + 0.25, 0.25, 1.0), root=root, sbt_offset=offset, sbt_stride=stride) for k in range(3)]
            found = [closest(result)["rec"] for result in trace(harness, scene, rays, groups)]
            assert found == [base + offset + k * stride for k in range(3)]


@pytest.mark.parametrize(("offset", "stride", "record"), [(18, 1, 3), (16, 1, 1), (0, 17, 2), (0, 31, 16), (0, 255, 30), (0, 256, 0)])
def test_T089_offset_and_stride_have_four_bits(harness: Harness, offset: int, stride: int, record: int) -> None:
    # Recorded: 01_sbt-sbt_offset_stride_over_4_bits; the stride's bits 4 to 7 spill into the offset.
    far = [[(x + 2 * k, y, z) for x, y, z in CORNER] for k in range(2)]
    scene = [gas(triangles(far, (0, 0), **offsets([0, 1])))]
    given = ray((2.25, 0.25, 1.0), sbt_offset=offset, sbt_stride=stride)
    (result,) = trace(harness, scene, [given], [hitgroup(index) for index in range(48)])
    assert closest(result)["rec"] == record


def test_T090_the_miss_index_selects_the_record(harness: Harness) -> None:
    results = trace(harness, [gas(triangles(CORNER))], [ray((5.0, 5.0, 1.0), miss=index) for index in range(3)], misses=3)
    assert [calls(result, "MS")[0]["rec"] for result in results] == [0, 1, 2]


@pytest.mark.parametrize("size", [(7, 5, 3), (1, 1, 1), (1000, 1, 1), (33, 17, 1), (1, 9, 2)])
def test_T091_every_launch_index_runs_once(harness: Harness, size: tuple[int, int, int]) -> None:
    indices, dimensions = launch_index(harness, *size, a=5)
    assert np.array_equal(indices, np.arange(indices.size) + 5)
    assert np.all(dimensions == size)


@pytest.mark.parametrize("size", [((1 << 30) + 1, 1, 1), (1 << 15, 1 << 15, 2), (0, 1, 1), (1, 0, 1), (1, 1, 0)])
def test_T092_launch_sizes_that_are_refused(harness: Harness, size: tuple[int, int, int]) -> None:
    if harness.mode == "interpreter":
        pytest.skip("the interpreter is given launch indices one by one")
    groups, pipeline = groups_of(harness), pipeline_of(harness)
    sbt = ox.ShaderBindingTable(raygen=groups["index"].record(shader.Data(0, 0.0, (0, 0, 0))), miss=[groups["miss"].record()], hitgroup=[])
    one = np.zeros(1, np.uint32)
    with pytest.raises(ox.OptixError):
        pipeline.launch(shader.Params(indices=one, dimensions=one, scene=0, value=0), sbt, width=size[0], height=size[1], depth=size[2])


def test_T093_launches_from_two_threads(harness: Harness) -> None:
    if harness.mode == "interpreter":
        pytest.skip("the interpreter runs in the calling thread")
    found: dict[int, np.ndarray] = {}

    def work(value: int) -> None:
        for _ in range(20):
            found[value] = launch_index(harness, 64, 16, 1, value=value)[0]
            assert np.array_equal(found[value], np.arange(1024) + value)

    threads = [threading.Thread(target=work, args=(value,)) for value in (1000, 2000)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(found[value], np.arange(1024) + value) for value in (1000, 2000))


def test_T086_offsets_of_nested_instances_add_up(harness: Harness) -> None:
    # Recorded: 05_instances, six levels with offsets 1 to 32 reach record 63.
    far = [[(x + 2 * k, y, z) for x, y, z in CORNER] for k in range(3)]
    scene = [gas(triangles(far, (0, 0, 0), **offsets([0, 1, 2]))), ias(instance(sbt_offset=5), name="inner"),
             ias(instance("inner", sbt_offset=3), name="outer")]
    given = ray((2 * 2 + 0.25, 0.25, 1.0), root="outer", sbt_offset=1, sbt_stride=1)
    (result,) = trace(harness, scene, [given], [hitgroup(index) for index in range(12)])
    assert closest(result)["rec"] == 3 + 5 + 2 + 1


def test_T069_one_group_in_two_tables_and_pipelines(harness: Harness) -> None:
    groups = groups_of(harness)
    shared = [groups["trace"], groups["data"], groups["miss"]]
    second = harness.pipeline("launch again", shared)
    scene = harness.context.accel_build([ox.BuildInputTriangles(CORNERS)])
    for number, pipeline in enumerate((pipeline_of(harness), second, pipeline_of(harness))):
        indices = np.zeros(1, np.uint32)
        table = ox.ShaderBindingTable(raygen=groups["trace"].record(), miss=[groups["miss"].record()],
                                      hitgroup=[groups["data"].record(shader.Data(number, 0.0, (0, 0, 0)))])
        params = shader.Params(indices=indices, dimensions=indices, scene=scene.handle, value=0)
        harness.launch(pipeline, params, table, 1)
        assert indices[0] == number
        # the same table with the other pipeline: its headers are written for both
        harness.launch(second if pipeline is not second else pipeline_of(harness), params, table, 1)
        assert indices[0] == number


TABLE_MISTAKES = {
    "base off by 8": (lambda table: setattr(table, "missRecords", table.missRecords + 8), "not aligned to 16 bytes"),
    "raygen off by 4": (lambda table: setattr(table, "raygenRecord", table.raygenRecord + 4), "not aligned to 16 bytes"),
    "stride 40": (lambda table: setattr(table, "hitgroupStride", 40), "multiple of 16 of at least 32"),
    "stride 0": (lambda table: setattr(table, "missStride", 0), "multiple of 16 of at least 32"),
    "stride 16": (lambda table: setattr(table, "callableStride", 16), "multiple of 16 of at least 32"),
    "count without base": (lambda table: setattr(table, "callableRecords", library.ffi().NULL), "but their pointer is NULL"),
    "no raygen record": (lambda table: setattr(table, "raygenRecord", library.ffi().NULL), "raygenRecord is NULL"),
    "another group's kind": (lambda table: setattr(table, "raygenRecord", table.missRecords), "another kind"),
}


@pytest.mark.parametrize("mistake", TABLE_MISTAKES)
def test_T081_tables_of_the_c_interface(mistake: str) -> None:
    # Python lays tables out itself, so these can be made through the C interface only.
    context = ox.DeviceContext()
    module, create = context.module_create(SHADERS / "callable_arguments.py"), context.program_group_create
    raygen = create(raygen=module["__raygen__call"])
    plus, miss, hit = create(direct_callable=module["__direct_callable__plus"]), create(miss=None), create(closesthit=None)
    pipeline = context.pipeline_create([raygen, plus, miss, hit])
    table = ox.ShaderBindingTable(raygen=raygen.record(), miss=[miss.record()] * 2, hitgroup=[hit.record()] * 3,
                                  callables=[plus.record(callable_arguments.Factor(1))] * 3)
    out = np.zeros(1, np.float32)
    params = callable_arguments.Params(out=out, records=np.zeros(1, np.uint32), x=7.0)
    handle, data, size, c_table = pipeline.launch_inputs(params, table)
    lib = library.lib()
    assert lib.oxrtLaunch(handle, data, size, c_table, 1, 1, 1) == 0
    assert out[0] == 8
    out[0] = 0
    change, message = TABLE_MISTAKES[mistake]
    change(ByteTable(c_table))
    assert lib.oxrtLaunch(handle, data, size, c_table, 1, 1, 1) == ox.InvalidValueError.code
    assert message in library.last_message()
    assert out[0] == 0


class ByteTable:
    """A table whose record pointers can be added to."""

    def __init__(self, table: Any) -> None:
        object.__setattr__(self, "_table", table)

    def __getattr__(self, name: str) -> Any:
        return library.ffi().cast("char*", getattr(self._table, name))

    def __setattr__(self, name: str, value: Any) -> None:
        setattr(self._table, name, value)
