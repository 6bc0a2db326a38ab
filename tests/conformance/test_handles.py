"""Areas L, M, Q and R: what handles lead to without a ray, and what a structure must have been built for to be asked."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from harness import SHADERS, Harness
from oracle_instances import ask
from scenes import CORNER
from shaders import handle_questions as shader

import optixc as ox
from optixc.host import library

CORNERS = np.array(CORNER, np.float32)
VERTICES, INSTANCES = ox.BuildFlags.ALLOW_RANDOM_VERTEX_ACCESS, ox.BuildFlags.ALLOW_RANDOM_INSTANCE_ACCESS
COUNT = 40
Question = tuple[Any, int, int]


def parameters(questions: list[Question]) -> Any:
    """Launch parameters with a row for each question: handle, index, SBT GAS index."""
    count = len(questions)
    rows = np.zeros(count, shader.Query.dtype)
    for row, (handle, index, gas_index) in zip(rows, questions, strict=True):
        row["handle"], row["index"], row["gas_index"] = int(handle), index, gas_index
    return shader.Params(queries=rows, children=np.zeros(count, np.uint64), addresses=np.zeros(count, np.uint64),
                         options=np.zeros((count, 4), np.float32), numbers=np.zeros((count, 16), np.float32))


def questioned(harness: Harness, what: str, questions: list[Question]) -> Any:
    """The parameters after a launch of one of the programs."""
    module = harness.module("handle_questions.py")
    raygen = harness.kept.setdefault(("handles", what), harness.context.program_group_create(raygen=module[f"__raygen__{what}"]))
    params = parameters(questions)
    table = ox.ShaderBindingTable(raygen=raygen.record(), miss=[], hitgroup=[])
    harness.launch(harness.pipeline(("handles", what), [raygen]), params, table, len(questions))
    return params


def matrices(count: int) -> np.ndarray:
    return np.random.default_rng(count).normal(size=(count, 3, 4)).astype(np.float32)


def test_T158_what_the_handle_of_an_instance_leads_to(harness: Harness) -> None:
    context = harness.context
    gas = context.accel_build([ox.BuildInputTriangles(CORNERS)])
    turned = np.float32([[0, -2, 0, 3], [2, 0, 0, 5], [0, 0, 2, 7]])
    ias = context.accel_build([ox.BuildInputInstances([ox.Instance(gas, instance_id=4), ox.Instance(gas, turned, instance_id=77)])],
                              build_flags=INSTANCES)
    answers, found = ask(harness, [(int(ias.handle), 1)])
    assert (int(answers[0]["id"]), int(answers[0]["child"])) == (77, int(gas.handle))
    assert int(answers[0]["type"]) == ox.TransformType.INSTANCE
    assert found[0, :12].reshape(3, 4).tolist() == turned.tolist()
    assert found[0, 12:24].reshape(3, 4).tolist() == [[0, 0.5, 0, -2.5], [-0.5, 0, 0, 1.5], [0, 0, 0.5, -3.5]]


def test_T158_handles_of_another_kind_lead_to_nothing(harness: Harness) -> None:
    context = harness.context
    gas = context.accel_build([ox.BuildInputTriangles(CORNERS)])
    ias = context.accel_build([ox.BuildInputInstances([gas])], build_flags=INSTANCES)
    static = context.static_transform(gas, np.eye(3, 4))
    moving = context.matrix_motion_transform(gas, matrices(2))
    turning = context.srt_motion_transform(gas, np.tile(np.float32([1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0]), (2, 1)))
    stale = context.accel_build([ox.BuildInputTriangles(CORNERS)])
    dead = int(stale.handle)
    stale.destroy()
    others = [int(gas.handle), int(ias.handle), int(moving.handle), int(turning.handle), 0, dead, 2**64 - 1]
    answers, found = ask(harness, [(handle, None) for handle in others])
    assert [int(answer["id"]) for answer in answers] == [int(answer["child"]) for answer in answers] == [0] * len(others)
    assert [int(answer["static_child"]) for answer in answers] == [0] * len(others)
    assert not found.any()
    _, of_static = ask(harness, [(int(static.handle), None)])
    assert not of_static[0, :24].any()
    assert of_static[0, 24:].any()
    instance = questioned(harness, "instance", [(ias.handle, 0, 0), (ias.handle, 1, 0), (gas.handle, 0, 0), (static.handle, 0, 0)])
    assert instance.children[0] != 0
    assert instance.children[1:].tolist() == [0, 0, 0]
    for what, own in (("matrix_key", moving), ("srt_key", turning)):
        strangers = [handle for handle in [*others, int(static.handle), int(instance.children[0])] if handle != int(own.handle)]
        seen = questioned(harness, what, [(handle, 0, 0) for handle in strangers])
        assert not seen.children.any()
        assert not seen.options.any()
        assert not seen.numbers.any()


def test_T159_instances_of_a_structure_by_number(harness: Harness) -> None:
    context = harness.context
    structures = [context.accel_build([ox.BuildInputTriangles(CORNERS + np.float32(number))]) for number in range(3)]
    places = matrices(COUNT)
    ids = np.arange(1000, 1000 + COUNT, dtype=np.uint32)
    children = np.array([int(structures[number % 3].handle) for number in range(COUNT)], np.uint64)
    source, names, list_of = places.copy(), ids.copy(), children.copy()
    ias = context.accel_build([ox.BuildInputInstances(list_of, transforms=source, instance_ids=names)], build_flags=INSTANCES)
    source[:], names[:], list_of[:] = 0, 0, 0
    del source, names, list_of
    answers, found = ask(harness, [(int(ias.handle), number) for number in range(COUNT)])
    assert answers["id"].tolist() == ids.tolist()
    assert answers["child"].tolist() == children.tolist()
    assert found[:, :12].tolist() == places.reshape(COUNT, 12).tolist()
    assert len(set(answers["handle"].tolist())) == COUNT


def test_T184_all_keys_of_motion_transforms_are_kept(harness: Harness) -> None:
    gas = harness.context.accel_build([ox.BuildInputTriangles(CORNERS)])
    options = ox.MotionOptions(4, -1.0, 2.5, ox.MotionFlags.START_VANISH)
    keys = matrices(4)
    rows = np.random.default_rng(2).normal(size=(4, 16)).astype(np.float32)
    moving = harness.context.matrix_motion_transform(gas, keys, options)
    turning = harness.context.srt_motion_transform(gas, rows, options)
    for what, made, expected in (("matrix_key", moving, keys.reshape(4, 12)), ("srt_key", turning, rows)):
        seen = questioned(harness, what, [(made.handle, key, 0) for key in (0, 1, 2, 3, 4, 2**32 - 1)])  # the last two: the nearest key
        assert seen.numbers[:, :expected.shape[1]].tolist() == [*expected.tolist(), expected[3].tolist(), expected[3].tolist()]
        assert seen.options.tolist() == [[4.0, 1.0, -1.0, 2.5]] * 6
        assert seen.children.tolist() == [int(gas.handle)] * 6


def test_T185_keys_may_lie_at_any_address(harness: Harness) -> None:
    # OptiX wants its structs 64-aligned; here the numbers are copied, wherever they are.
    gas = harness.context.accel_build([ox.BuildInputTriangles(CORNERS)])
    keys = matrices(2)
    unaligned = np.zeros(keys.nbytes + 1, np.uint8)
    unaligned[1:] = keys.view(np.uint8).ravel()
    moving = harness.context.matrix_motion_transform(gas, unaligned[1:].view(np.float32).reshape(2, 3, 4))
    seen = questioned(harness, "matrix_key", [(moving.handle, key, 0) for key in range(2)])
    assert seen.numbers[:, :12].tolist() == keys.reshape(2, 12).tolist()


def test_T248_the_address_of_a_structure(harness: Harness) -> None:
    context = harness.context
    first, second = (context.accel_build([ox.BuildInputTriangles(CORNERS)]) for _ in range(2))
    ias, static = context.accel_build([ox.BuildInputInstances([first])]), context.static_transform(first, np.eye(3, 4))
    handles = (first.handle, second.handle, first.handle, ias.handle, static.handle, 0)
    seen = questioned(harness, "address", [(handle, 0, 0) for handle in handles])
    one, two, again, *others = seen.addresses.tolist()
    assert one != 0 != two
    assert one == again != two
    assert others == [0, 0, 0]


def test_T250_corners_by_handle(harness: Harness) -> None:
    random = np.random.default_rng(250)
    points, indices = random.normal(size=(30, 3)).astype(np.float32), random.integers(0, 30, (COUNT, 3)).astype(np.uint32)
    gas = harness.context.accel_build([ox.BuildInputTriangles(points, indices, primitive_index_offset=100)], build_flags=VERTICES)
    seen = questioned(harness, "corners", [(gas.handle, 100 + number, 0) for number in range(COUNT)])
    assert seen.numbers[:, :9].tolist() == points[indices].reshape(COUNT, 9).tolist()


def test_T251_a_triangle_without_area_has_its_corners(harness: Harness) -> None:
    # The guide allows NaN; recorded are the true corners (13_degenerate).
    points = np.float32([[0, 0, 0], [1, 2, 3], [1, 2, 3], [0, 0, 0], [1, 1, 1], [2, 2, 2]])
    gas = harness.context.accel_build([ox.BuildInputTriangles(points)], build_flags=VERTICES)
    seen = questioned(harness, "corners", [(gas.handle, number, 0) for number in range(2)])
    assert seen.numbers[:, :9].tolist() == points.reshape(2, 9).tolist()


def test_T252_corners_of_the_second_input(harness: Harness) -> None:
    inputs = [ox.BuildInputTriangles(CORNERS + np.float32(10 * number), num_sbt_records=records, sbt_index_offsets=np.zeros(1, np.uint8))
              for number, records in enumerate((1, 3, 2))]
    gas = harness.context.accel_build(inputs, build_flags=VERTICES)
    seen = questioned(harness, "corners", [(gas.handle, 0, gas_index) for gas_index in range(7)])
    assert seen.numbers[:, 0].tolist() == [0, 10, 10, 10, 20, 20, 0]  # behind the last record there is nothing


@pytest.fixture(scope="module", params=[1, 8, 16])
def validated(request: pytest.FixtureRequest) -> Any:
    """Launches one program of the module over questions in validation mode."""
    context = ox.DeviceContext(validation=True, threads=1, log_callback=lambda *message: None)
    module = context.module_create(SHADERS / "handle_questions.py")

    def launch(what: str, questions: list[Question]) -> Any:
        raygen = context.program_group_create(raygen=module[f"__raygen__{what}"])
        pipeline = context.pipeline_create([raygen], simd=request.param)
        params = parameters(questions)
        pipeline.launch(params, ox.ShaderBindingTable(raygen=raygen.record(), miss=[], hitgroup=[]), len(questions))
        return params
    return context, launch


@pytest.mark.parametrize(("what", "flag"), [("corners", VERTICES), ("sphere", VERTICES), ("instance", INSTANCES)])
def test_T250_validation_asks_for_the_build_flag(validated: Any, what: str, flag: ox.BuildFlags) -> None:
    context, launch = validated
    gas = ox.BuildInputSpheres(CORNERS, np.ones(3, np.float32)) if what == "sphere" else ox.BuildInputTriangles(CORNERS)
    below = context.accel_build([ox.BuildInputTriangles(CORNERS)])
    given = ox.BuildInputInstances([below]) if what == "instance" else gas
    allowed, closed = context.accel_build([given], build_flags=flag), context.accel_build([given])
    launch(what, [(allowed.handle, 0, 0)] * COUNT)
    guilty = 17
    asked = [(closed.handle if number == guilty else allowed.handle, 0, 0) for number in range(COUNT)]
    with pytest.raises(ox.ValidationFailureError, match=rf"(?s)handle_questions.py:\d+.*{flag.name}") as failed:
        launch(what, asked)
    assert failed.value.launch_index == (guilty, 0, 0)
    asked[guilty] = (allowed.handle, 1000, 0)
    with pytest.raises(ox.ValidationFailureError, match="1000 is not below"):
        launch(what, asked)


def test_T246_only_structures_can_be_relocated(harness: Harness) -> None:
    context, ffi, lib = harness.context, library.ffi(), library.lib()
    gas = context.accel_build([ox.BuildInputTriangles(CORNERS)])
    transform = context.static_transform(gas, np.eye(3, 4))
    made = ffi.new("OxrtAccel*")
    result = lib.oxrtAccelRelocate(ffi.cast("OxrtAccel", transform._transform), ffi.NULL, 0, made)
    assert result != 0
    assert made[0] == ffi.NULL
    ias = context.accel_build([ox.BuildInputInstances([gas])], build_flags=INSTANCES)
    (instance,) = questioned(harness, "instance", [(ias.handle, 0, 0)]).children.tolist()
    with pytest.raises(ox.InvalidValueError, match="instance"):
        ias.relocate([instance])


def test_T247_structures_go_with_their_own_context(harness: Harness) -> None:
    gas = harness.context.accel_build([ox.BuildInputTriangles(CORNERS)])
    ias = harness.context.accel_build([ox.BuildInputInstances([gas])])
    assert ias.relocate([gas.relocate()]).handle != ias.handle
    stranger = ox.DeviceContext(threads=1).accel_build([ox.BuildInputTriangles(CORNERS)])
    with pytest.raises(ox.InvalidValueError, match="context"):
        ias.relocate([stranger])


def test_T108_results_that_do_not_fit_leave_memory_alone(harness: Harness) -> None:
    # Structures make their own memory; the one result that callers make room for is an emitted property.
    ffi, lib = library.ffi(), library.lib()
    gas = harness.context.accel_build([ox.BuildInputTriangles(CORNERS)], build_flags=ox.BuildFlags.ALLOW_COMPACTION)
    for kind, size in ((ox.AccelPropertyType.COMPACTED_SIZE, 8), (ox.AccelPropertyType.AABBS, 24)):
        room = ffi.new("uint8_t[]", b"\x5a" * 64)
        for wrong in (0, size - 1, size + 1, 64):
            assert lib.oxrtAccelEmitProperty(gas._accel, kind, room, wrong) != 0
        assert bytes(ffi.buffer(room))[:64] == b"\x5a" * 64
        assert lib.oxrtAccelEmitProperty(gas._accel, kind, room, size) == 0
        assert bytes(ffi.buffer(room))[size:64] == b"\x5a" * (64 - size)
