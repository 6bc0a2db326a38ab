"""Area H: tables explained, checked before a launch, and laid out by ray types and materials; the index formula of the guide, 7.3."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from harness import Harness
from hypothesis import given, settings
from hypothesis import strategies as st
from shaders import launch, recorder
from shaders import two_rays as shader

import optixc as ox
from optixc.host.sbt_reach import Child, Geometry, places

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
BOX = np.array([[0, 0, 0, 1, 1, 1]], np.float32)


class Scene:
    """The groups and the pipeline of two ray types, and two instances of a GAS."""

    def __init__(self, harness: Harness) -> None:
        module, create = harness.module("two_rays.py"), harness.context.program_group_create
        if "two rays" not in harness.kept:
            harness.kept["two rays"] = {
                "raygen": create(raygen=module["__raygen__both"]), "shade": create(closesthit=module["__closesthit__shade"]),
                "shadow": create(closesthit=module["__closesthit__shadow"]), "empty": create(closesthit=None),
                "box": create(closesthit=module["__closesthit__shade"], intersection=module["__intersection__box"]),
                "miss": create(miss=module["__miss__radiance"]), "miss shadow": create(miss=module["__miss__shadow"])}
        self.groups = harness.kept["two rays"]
        self.pipeline = harness.pipeline("two rays", self.groups.values())
        self.build = harness.context.accel_build

    def record(self, name: str, value: float | None = None) -> Any:
        return self.groups[name].record(None if value is None else shader.Shade(value))

    def table(self, hitgroup: list[Any], miss: list[Any] | None = None) -> Any:
        misses = [self.record("miss"), self.record("miss shadow")] if miss is None else miss
        return ox.ShaderBindingTable(raygen=self.record("raygen"), miss=misses, hitgroup=hitgroup)

    def instances(self, *offsets: int, gas: Any = None) -> Any:
        below = gas or self.build([ox.BuildInputTriangles(CORNERS)])
        moves = [np.array([[1, 0, 0, 2 * number], [0, 1, 0, 0], [0, 0, 1, 0]], np.float32) for number in range(len(offsets))]
        return self.build([ox.BuildInputInstances([ox.Instance(below, move, sbt_offset=offset)
                                                   for move, offset in zip(moves, offsets, strict=True)])])


@pytest.fixture
def scene(harness: Harness) -> Scene:
    return Scene(harness)


def pair(scene: Scene, value: float) -> list[Any]:
    return [scene.record("shade", value), scene.record("shadow", value)]


def test_layout_from_ray_types_and_materials(harness: Harness, scene: Scene) -> None:
    table = ox.ShaderBindingTable.from_materials(
        scene.record("raygen"), {"radiance": scene.record("miss"), "shadow": scene.record("miss shadow")},
        [{"radiance": scene.record("shade", value), "shadow": scene.record("shadow", value)} for value in (1.0, 2.0, 3.0)])
    assert (table.stride, table.ray_type("radiance"), table.ray_type("shadow"), table.instance_offset(2)) == (2, 0, 1, 4)
    top = scene.instances(*(table.instance_offset(material) for material in (2, 0, 1)))
    assert table.check(scene.pipeline, top) == []
    out = np.zeros(4, np.float32)
    harness.launch(scene.pipeline, shader.Params(out=out, scene=top.handle, x=0.0), table, 4)
    assert out.tolist() == [3003, 1001, 2002, -1001]
    with pytest.raises(ox.InvalidValueError, match="no ray type 'shadows'"):
        table.ray_type("shadows")
    with pytest.raises(ox.InvalidValueError, match=r"materials\[0\] has a record for 'glow'"):
        ox.ShaderBindingTable.from_materials(scene.record("raygen"), {"radiance": None}, [{"glow": None}])


def test_a_good_table_has_no_problems(scene: Scene) -> None:
    table = scene.table([*pair(scene, 1.0), *pair(scene, 2.0)])
    assert table.check(scene.pipeline, scene.instances(0, 2)) == []
    assert table.check(scene.pipeline, scene.build([ox.BuildInputTriangles(CORNERS)]).handle) == []


def test_records_out_of_range_empty_and_of_the_wrong_kind(scene: Scene) -> None:
    top = scene.instances(0, 6)
    problems = scene.table([*pair(scene, 1.0), None]).check(scene.pipeline, top)
    assert any("instance 1 (sbt_offset 6), build input 0 (triangles), record 0" in one and "needs hitgroup[7]" in one
               and "two_rays.py:" in one and "the table has 3 hit group records" in one for one in problems)
    many = scene.table(pair(scene, 1.0)).check(scene.pipeline, scene.instances(*range(0, 2000, 2)))
    assert [("hitgroup[2], and the table has 2 hit group records (998 more places need records up to hitgroup[1998])" in one)
            for one in many] == [True, False]
    assert "hitgroup[3], and the table has 2 hit group records (998 more places need records up to hitgroup[1999])" in many[1]
    (empty,) = scene.table([scene.record("shade", 1.0), None]).check(scene.pipeline, scene.instances(0))
    assert "needs hitgroup[1], which is empty" in empty
    boxes = scene.build([ox.BuildInputCustomPrimitives(BOX)])
    problems = scene.table(pair(scene, 1.0)).check(scene.pipeline, boxes)
    assert any("no intersection program" in one for one in problems)
    problems = scene.table([scene.record("box", 1.0), scene.record("shadow", 1.0)]).check(scene.pipeline, scene.instances(0))
    assert any("__intersection__box never runs for triangles" in one for one in problems)


def test_payloads_and_misses(scene: Scene) -> None:
    swapped = scene.table(list(reversed(pair(scene, 1.0)))).check(scene.pipeline, scene.instances(0))
    assert any("__closesthit__shadow takes a Shadow" in one and "carries Radiance" in one for one in swapped)
    both = scene.table([*reversed(pair(scene, 1.0))] * 20).check(scene.pipeline, scene.instances(*range(0, 40, 2)))
    assert [one.split(":")[0] for one in both] == ["hitgroup[0, 2, 4, 6, 8, 10, 12, 14, 16, 18, ...]",
                                                   "hitgroup[1, 3, 5, 7, 9, 11, 13, 15, 17, 19, ...]"]
    assert "(sbt_offset 1, sbt_stride 2) carries Shadow" in both[1]
    misses = [scene.record("miss shadow"), scene.record("miss")]
    assert [one.split(":")[0] for one in scene.table(pair(scene, 1.0), misses).check(scene.pipeline)] == ["miss[0]", "miss[1]"]
    (hole,) = scene.table(pair(scene, 1.0), [scene.record("miss"), None]).check(scene.pipeline)
    assert "needs miss[1], which is empty; if nothing is to run" in hole
    few = scene.table(pair(scene, 1.0), [scene.record("miss")]).check(scene.pipeline)
    assert few == [one for one in few if "needs miss[1], and the table has 1 miss records" in one]
    assert len(few) == 1


def test_a_group_that_the_pipeline_does_not_have(harness: Harness, scene: Scene) -> None:
    alone = harness.context.pipeline_create([scene.groups["raygen"]])
    problems = scene.table(pair(scene, 1.0)).check(alone)
    other = harness.context.program_group_create(raygen=harness.module("launch.py")["__raygen__index"])
    table = ox.ShaderBindingTable(raygen=other.record(launch.Data(0, 0.0, (0, 0, 0))))
    assert table.check(alone)[0] == "raygen: __raygen__index is not in the pipeline; add its group to pipeline_create"
    assert "hitgroup[0]: __closesthit__shade is not in the pipeline; add its group to pipeline_create" in problems


def test_the_table_in_words(scene: Scene, capsys: pytest.CaptureFixture[str]) -> None:
    table = scene.table([*pair(scene, 1.0), None, scene.record("empty")])
    text = table.explain(scene.pipeline, scene.instances(0))
    assert capsys.readouterr().out == text + "\n"
    assert "hitgroup[0] closesthit __closesthit__shade; 4 bytes Shade(value=1.0)  <- instance 0 (sbt_offset 0)" in text
    assert "hitgroup[2] empty  <- nobody reaches it" in text
    assert "hitgroup 4 x 48 bytes" in text
    assert "miss[1]   miss __miss__shadow; 0 bytes  <- trace at" in text


def test_traces_that_are_known_in_a_launch_only(harness: Harness, scene: Scene) -> None:
    groups, pipeline = harness.recorder(("tri",), False, False)
    record = groups["tri", True, True].record(recorder.Record(*[0] * 4, *[recorder.Report(0.0, 0.0, 0, [0] * 8)] * 4))
    table = ox.ShaderBindingTable(raygen=groups["raygen"].record(), hitgroup=[record])
    assert table.check(pipeline, scene.instances(0)) == []
    (line,) = [line for line in table.explain(pipeline).splitlines() if line.startswith("not judged")]
    assert line.startswith("not judged: sbt_offset and sbt_stride and miss_sbt_index of the trace at")


def test_questions_about_no_table_and_no_pipeline(scene: Scene) -> None:
    table, record = scene.table(pair(scene, 1.0)), scene.record("raygen")
    for wrong in (lambda: table.check(None), lambda: table.explain(3), lambda: table.check(scene.groups["raygen"])):
        with pytest.raises(ox.InvalidValueError, match="give the pipeline that is to be launched"):
            wrong()
    for thing in (3, "scene", CORNERS):
        with pytest.raises(ox.InvalidValueError, match="give the accel or transform itself"):
            table.check(scene.pipeline, thing)
    make = ox.ShaderBindingTable.from_materials
    for wrong, message in ((lambda: make(record, ["radiance"], []), "ray_types takes a dict"),
                           (lambda: make(record, {"a": None}, [3]), r"materials\[0\] takes a dict"),
                           (lambda: make(record, {"a": None}, 3), "materials takes a list"),
                           (lambda: make(record, {"a": None}, {"a": None}), "materials takes a list"),
                           (lambda: make(record, {"a": None}, [{}]).instance_offset(1), "material is 0 to 0, not 1"),
                           (lambda: table.instance_offset(-1), "at least 0"), (lambda: table.instance_offset("a"), "at least 0")):
        with pytest.raises(ox.InvalidValueError, match=message):
            wrong()


@settings(max_examples=500, deadline=None)
@given(st.data())
def test_random_layouts_against_the_formula(data: st.DataObject) -> None:
    """Sum of the instances' offsets + GAS index x stride + offset, for twenty traces over each of 500 random graphs."""
    class Node:
        def __init__(self, parts: tuple[Any, ...]) -> None:
            self.parts = parts

    small = st.integers(0, 9)
    records = data.draw(st.lists(st.lists(st.integers(1, 4), min_size=1, max_size=3), min_size=1, max_size=3))
    leaves = [Node(tuple(Geometry("triangles", count) for count in counts)) for counts in records]
    middle = [Node(tuple(Child(leaves[data.draw(st.integers(0, len(leaves) - 1))], data.draw(small)) for _ in range(2))) for _ in range(2)]
    top = Node(tuple(Child(data.draw(st.sampled_from([*leaves, *middle])), data.draw(small)) for _ in range(3)))

    def expected(node: Node, above: int) -> set[tuple[int, int]]:
        if isinstance(node.parts[0], Geometry):
            return {(above, index) for index in range(sum(part.records for part in node.parts))}
        return set().union(*(expected(part.traversable, above + part.sbt_offset) for part in node.parts))

    found = list(places(top))
    assert {(place.offset, place.gas_index) for place in found} == expected(top, 0)
    for _ in range(20):
        offset, stride = data.draw(st.integers(0, 15)), data.draw(st.integers(0, 15))
        assert [place.index(offset, stride) for place in found] == [place.offset + place.gas_index * stride + offset for place in found]
