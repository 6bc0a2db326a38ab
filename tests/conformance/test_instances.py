"""Area L: instances, masks and transforms of one level."""

from __future__ import annotations

import math
import runpy
from pathlib import Path

import numpy as np
import pytest
from harness import MODES, Harness
from scenes import (
    CORNER,
    boxes,
    calls,
    closest,
    gas,
    hitgroup,
    ias,
    instance,
    kinds,
    missed,
    ray,
    reported,
    trace,
    translation,
    triangles,
)

import optixc as ox

ABOVE = (0.25, 0.25, 1.0)
NO_INSTANCE = 0xFFFFFFFF


def test_T146_the_instance_matrix_moves(harness: Harness) -> None:
    scene = [gas(triangles(CORNER)), ias(instance(transform=translation(3.0, 0.0, 0.0)))]
    results = trace(harness, scene, [ray((3.25, 0.25, 1.0), root="ias"), ray(ABOVE, root="ias")])
    assert closest(results[0])["u"] == pytest.approx(0.25, abs=1e-6)
    assert calls(results[0])[0]["oo"] == [0.25, 0.25, 1.0]
    assert missed(results[1])


def test_T147_visibility_masks(harness: Harness) -> None:
    masks = (1, 2, 3, 0)
    scene = [gas(triangles(CORNER)), ias(*(instance(transform=translation(3.0 * i, 0, 0), mask=mask) for i, mask in enumerate(masks)))]
    for ray_mask, seen in ((0x01, [0, 2]), (0x1FF, [0, 1, 2]), (0x100, []), (0x02, [1, 2]), (0x00, [])):
        results = trace(harness, scene, [ray((3.0 * i + 0.25, 0.25, 1.0), root="ias", mask=ray_mask) for i in range(4)])
        assert [i for i, result in enumerate(results) if not missed(result)] == seen, hex(ray_mask)
        assert all(event["mask"] == ray_mask & 0xFF for result in results for event in result.events)


def test_T148_a_lone_structure_has_the_mask_255(harness: Harness) -> None:
    # Recorded: 05_instances, ray mask 0 misses a bare GAS too (spec T148 says hit).
    results = trace(harness, [gas(triangles(CORNER))], [ray(ABOVE, mask=0), ray(ABOVE, mask=0x80)])
    assert [missed(result) for result in results] == [True, False]


def test_T150_instance_id_and_index(harness: Harness) -> None:
    scene = [gas(triangles(CORNER)), ias(*(instance(transform=translation(3.0 * i, 0, 0), instance_id=75 + i) for i in range(3)))]
    results = trace(harness, scene, [ray((6.25, 0.25, 1.0), root="ias"), ray(ABOVE)])
    assert [(event["instId"], event["instIdx"]) for event in results[0].events] == [(77, 2), (77, 2)]
    assert [(event["instId"], event["instIdx"]) for event in results[1].events] == [(NO_INSTANCE, 0)] * 2


def test_T151_the_closest_hit_keeps_its_instance(harness: Harness) -> None:
    for order in ((0, 1), (1, 0)):
        instances = [instance(transform=translation(0, 0, -2.0 * place), instance_id=10 + place) for place in order]
        (result,) = trace(harness, [gas(triangles(CORNER)), ias(*instances)], [ray(ABOVE, root="ias")])
        hit = closest(result)
        assert (hit["instId"], hit["instIdx"], hit["tmax"], hit["o2w"][11]) == (10, order.index(0), 1.0, 0.0)


def test_T153_the_object_space_ray(harness: Harness) -> None:
    matrix = [2.0, 0, 0, 10.0, 0, 2.0, 0, 0, 0, 0, 2.0, 0]
    scene = [gas(boxes([[-1, -1, -1, 1, 1, 1]])), ias(instance(transform=matrix))]
    (result,) = trace(harness, scene, [ray((10.0, 0.0, 5.0), root="ias")], [hitgroup(kind="custom", reports=[reported(4.0)])])
    seen = calls(result, "IS")[0]
    assert (seen["oo"], seen["od"], seen["wo"]) == ([0, 0, 2.5], [0, 0, -0.5], [10, 0, 5])
    assert seen["o2w"] == [2, 0, 0, 10, 0, 2, 0, 0, 0, 0, 2, 0]
    assert seen["w2o"] == [0.5, 0, 0, -5, 0, 0.5, 0, 0, 0, 0, 0.5, 0]
    assert closest(result)["tmax"] == 4.0


def test_T156_without_transforms_everything_is_the_identity(harness: Harness) -> None:
    (result,) = trace(harness, [gas(triangles(CORNER))], [ray(ABOVE)])
    hit = calls(result)[0]
    assert hit["transformList"] == []
    assert hit["o2w"] == hit["w2o"] == [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]
    assert (hit["oo"], hit["od"]) == (hit["wo"], hit["wd"])


def test_T157_the_transform_list_of_one_instance(harness: Harness) -> None:
    scene = [gas(triangles(CORNER)), ias(instance(), instance(transform=translation(3, 0, 0)))]
    results = trace(harness, scene, [ray(ABOVE, root="ias"), ray((3.25, 0.25, 1.0), root="ias")])
    lists = [closest(result)["transformList"] for result in results]
    assert [[entry["type"] for entry in one] for one in lists] == [[ox.TransformType.INSTANCE]] * 2
    assert lists[0] != lists[1]
    assert all(closest(result)["gasHandle"] == "gas" for result in results)


def test_T161_singular_instances_are_never_hit(harness: Harness) -> None:
    scene = [gas(triangles(CORNER)), ias(instance(transform=[0.0] * 12), instance(transform=translation(3, 0, 0)))]
    results = trace(harness, scene, [ray(ABOVE, root="ias"), ray((3.25, 0.25, 1.0), root="ias")])
    assert [missed(result) for result in results] == [True, False]


def test_T164_geometry_is_shared(harness: Harness) -> None:
    random = np.random.default_rng(164)
    corners = random.random((60000, 3)).astype(np.float32)
    accel = harness.context.accel_build([ox.BuildInputTriangles(corners)])
    top = harness.context.accel_build([ox.BuildInputInstances([ox.Instance(accel, np.eye(3, 4, dtype=np.float32))] * 1000)])
    assert top.memory_usage < accel.memory_usage


def test_T165_the_null_handle_runs_the_miss_program(harness: Harness) -> None:
    (result,) = trace(harness, [gas(triangles(CORNER))], [ray(ABOVE, root="nothing", miss=0)])
    assert kinds(result) == ["MS"]


def test_T165_a_stale_handle_misses(harness: Harness) -> None:
    scene = [gas(triangles(CORNER))]
    (before,) = trace(harness, scene, [ray(ABOVE)])
    assert not missed(before)
    accel = harness.context.accel_build([ox.BuildInputTriangles(np.array(CORNER, np.float32))])
    handle = accel.handle
    accel.destroy()
    again = harness.context.accel_build([ox.BuildInputTriangles(np.array(CORNER, np.float32))])
    assert again.handle != handle


def test_X09_a_null_child_is_skipped(harness: Harness) -> None:
    scene = [gas(triangles(CORNER)), ias(instance("nothing"), instance(transform=translation(3, 0, 0)))]
    results = trace(harness, scene, [ray(ABOVE, root="ias"), ray((3.25, 0.25, 1.0), root="ias")])
    assert [missed(result) for result in results] == [True, False]


@pytest.mark.parametrize(("field", "value"), [("visibility_mask", 0x100), ("instance_id", 1 << 28), ("sbt_offset", 1 << 28)])
def test_X08_values_out_of_range_are_refused(harness: Harness, field: str, value: int) -> None:
    # Recorded: the build dies with a CUDA error there; a named error is better.
    accel = harness.context.accel_build([ox.BuildInputTriangles(np.array(CORNER, np.float32))])
    with pytest.raises(ox.InvalidValueError):
        given = ox.Instance(accel, np.eye(3, 4, dtype=np.float32), **{field: value})
        harness.context.accel_build([ox.BuildInputInstances([given])])


def test_transforms_of_many_instances_agree_with_numpy(harness: Harness) -> None:
    random = np.random.default_rng(146)
    angles = random.random(20) * 2 * math.pi
    matrices = []
    for i, angle in enumerate(angles):
        c, s, scale = math.cos(angle), math.sin(angle), 0.5 + random.random()
        matrices.append([scale * c, -scale * s, 0, 4.0 * i, scale * s, scale * c, 0, 0, 0, 0, scale, 0])
    scene = [gas(triangles(CORNER)), ias(*(instance(transform=matrix, instance_id=i) for i, matrix in enumerate(matrices)))]
    rays = []
    for matrix in matrices:
        full = np.array(matrix, np.float32).astype(np.float64).reshape(3, 4)
        target = full[:, :3] @ (0.25, 0.25, 0.0) + full[:, 3]
        rays.append(ray((target + np.array((0.1, 0.2, 2.0))).tolist(), (-0.1, -0.2, -2.0), root="ias"))
    for index, result in enumerate(trace(harness, scene, rays)):
        hit = closest(result)
        assert hit["instId"] == hit["instIdx"] == index
        assert (hit["tmax"], hit["u"], hit["v"]) == pytest.approx((1.0, 0.25, 0.25), abs=1e-5)
        to_world, to_object = (np.array(hit[key]).reshape(3, 4) for key in ("o2w", "w2o"))
        assert np.allclose(to_world, np.array(matrices[index]).reshape(3, 4), atol=1e-6)
        assert np.allclose(to_world[:, :3] @ to_object[:, :3], np.eye(3), atol=1e-5)



SCENE_PARAMS = """
import optixc as ox

@ox.struct
class Graph:
    top: ox.Traversable

@ox.struct
class Params:
    graph: Graph
    other: ox.Traversable

params = ox.launch_params(Params)

@ox.program
def __raygen__nothing():
    pass
"""


def test_the_report_tells_who_walks_through_a_graph(harness: Harness, tmp_path: Path) -> None:
    if harness.mode == "interpreter":
        pytest.skip("interpreted launches are not the pipeline's own")
    context = harness.context
    flat = context.accel_build([ox.BuildInputTriangles(np.float32(CORNER))])
    one_level = context.accel_build([ox.BuildInputInstances([flat])])
    nested = context.accel_build([ox.BuildInputInstances([one_level])])
    moved = context.static_transform(flat, np.eye(3, 4))
    assert [accel.has_native_instances for accel in (flat, one_level, nested)] == [False, True, False]

    file = tmp_path / "graph.py"
    file.write_text(SCENE_PARAMS)
    module = context.module_create(file)
    group = context.program_group_create(raygen=module["__raygen__nothing"])
    pipeline = context.pipeline_create([group], simd=MODES[harness.mode])
    names = runpy.run_path(str(file))
    sbt = ox.ShaderBindingTable(raygen=group.record(), miss=[], hitgroup=[])
    assert pipeline.report().has_native_instances == {}
    for top, other, expected in ((flat, one_level, (True, True)), (nested, moved, (False, False)), (0, int(flat.handle), None)):
        params = names["Params"](names["Graph"](top), other)
        pipeline.launch(params, sbt, 1)
        found = pipeline.report().has_native_instances
        assert found == ({} if expected is None else {"graph.top": expected[0], "other": expected[1]})
        assert ("graph graph.top: walked through by" in str(pipeline.report())) == bool(found)
    del params
    assert pipeline.report().has_native_instances == {}
