"""Area Q: update, compaction, relocation."""

from __future__ import annotations

import numpy as np
import pytest
from harness import Harness
from scenes import CORNER, FAR, closest, missed, ray, trace

import optixc as ox

CORNERS = np.array(CORNER, np.float32)
UPDATE = ox.BuildFlags.ALLOW_UPDATE
EYE = np.eye(3, 4, dtype=np.float32)


def at_z(z: float) -> list[ox.BuildInputTriangles]:
    """The corner triangle at a height."""
    return [ox.BuildInputTriangles(CORNERS + np.array((0, 0, z), np.float32))]


def distance(harness: Harness, accel: ox.Accel, origin: tuple[float, ...] = (0.25, 0.25, 10.0)) -> float | None:
    """Where a ray straight down hits, None for a miss."""
    (result,) = trace(harness, [], [ray(origin, root="it", tmax=FAR)], made={"it": accel})
    return None if missed(result) else float(closest(result)["tmax"])


def test_T236_an_update_is_seen_through_the_same_handle(harness: Harness) -> None:
    accel = harness.context.accel_build(at_z(0.0), build_flags=UPDATE)
    handle = accel.handle
    before = distance(harness, accel)
    accel.update(at_z(1.0))
    assert (before, distance(harness, accel), accel.handle) == (10.0, 9.0, handle)


def test_T236_updates_need_the_flag(harness: Harness) -> None:
    accel = harness.context.accel_build(at_z(0.0))
    with pytest.raises(ox.OptixError):
        accel.update(at_z(1.0))
    assert distance(harness, accel) == 10.0


def test_T237_instances_follow_after_their_own_update(harness: Harness) -> None:
    accel = harness.context.accel_build(at_z(0.0), build_flags=UPDATE)
    instances = [ox.BuildInputInstances([ox.Instance(accel, EYE, instance_id=1)])]
    top = harness.context.accel_build(instances, build_flags=UPDATE)
    accel.update(at_z(50.0))
    top.update(instances)
    assert distance(harness, top, (0.25, 0.25, 100.0)) == 50.0


@pytest.mark.parametrize("inputs", [
    [ox.BuildInputTriangles(np.concatenate([CORNERS, CORNERS]))], [ox.BuildInputTriangles(CORNERS)] * 2,
    [ox.BuildInputTriangles(CORNERS, num_sbt_records=2)], [ox.BuildInputCustomPrimitives(np.zeros((1, 6), np.float32))]])
def test_T238_an_update_keeps_its_counts(harness: Harness, inputs: list[ox.BuildInput]) -> None:
    accel = harness.context.accel_build(at_z(0.0), build_flags=UPDATE)
    with pytest.raises(ox.OptixError):
        accel.update(inputs)
    assert distance(harness, accel) == 10.0


def test_T239_refits_hit_what_a_rebuild_hits(harness: Harness) -> None:
    random = np.random.default_rng(239)
    start = random.random((50, 1, 3)) * 4 + random.normal(0, 0.3, (50, 3, 3))
    accel = harness.context.accel_build([ox.BuildInputTriangles(start.reshape(-1, 3).astype(np.float32))], build_flags=UPDATE)
    origins, ends = random.random((100, 3)) * 6 - 1, random.random((100, 3)) * 4
    for _ in range(10):
        moved = (start + random.normal(0, 0.5, (50, 1, 3))).reshape(-1, 3).astype(np.float32)
        accel.update([ox.BuildInputTriangles(moved)])
        rebuilt = harness.context.accel_build([ox.BuildInputTriangles(moved)])
        rays = [ray(origin, direction, root="it") for origin, direction in zip(origins.tolist(), (ends - origins).tolist(), strict=True)]
        found = [[None if missed(result) else (closest(result)["prim"], closest(result)["tmax"])
                  for result in trace(harness, [], rays, made={"it": one})] for one in (accel, rebuilt)]
        for ours, theirs in zip(*found, strict=True):
            assert (ours is None) == (theirs is None)
            if ours and theirs:
                assert ours[0] == theirs[0]
                assert ours[1] == pytest.approx(theirs[1], rel=1e-5)


def test_T240_a_compacted_structure_traces_alike(harness: Harness) -> None:
    accel = harness.context.accel_build(at_z(0.0), build_flags=ox.BuildFlags.ALLOW_COMPACTION)
    handle, size = accel.handle, accel.memory_usage
    compacted = accel.compact()
    accel.destroy()
    assert compacted.handle != handle  # recorded: compaction changes the handle
    assert compacted.memory_usage <= size
    assert distance(harness, compacted) == 10.0


def test_T241_compaction_must_be_allowed(harness: Harness) -> None:
    with pytest.raises(ox.InvalidValueError, match="ALLOW_COMPACTION"):
        harness.context.accel_build(at_z(0.0)).compact()


def test_T242_compacted_structures_can_be_updated_on_their_own(harness: Harness) -> None:
    accel = harness.context.accel_build(at_z(0.0), build_flags=UPDATE | ox.BuildFlags.ALLOW_COMPACTION)
    compacted = accel.compact()
    compacted.update(at_z(2.0))
    assert (distance(harness, accel), distance(harness, compacted)) == (10.0, 8.0)


def test_T243_T244_relocated_structures(harness: Harness) -> None:
    low, high = harness.context.accel_build(at_z(0.0)), harness.context.accel_build(at_z(4.0))
    top = harness.context.accel_build([ox.BuildInputInstances([ox.Instance(low, EYE)])])
    moved, kept = low.relocate(), top.relocate()
    replaced = top.relocate([high])
    low.destroy()
    top.destroy()
    assert moved.handle != low.handle
    assert [distance(harness, one) for one in (moved, kept, replaced)] == [10.0, 10.0, 6.0]


def test_T245_relocation_takes_all_children_or_none(harness: Harness) -> None:
    low = harness.context.accel_build(at_z(0.0))
    top = harness.context.accel_build([ox.BuildInputInstances([ox.Instance(low, EYE), ox.Instance(low, EYE)])])
    with pytest.raises(ox.InvalidValueError, match="1 children for 2 instances"):
        top.relocate([low])
    with pytest.raises(ox.InvalidValueError, match="has none"):
        low.relocate([low])


def test_degenerate_triangles_become_valid_by_an_update(harness: Harness) -> None:
    # Recorded: 13_degenerate-degenerate_then_updated_valid.
    accel = harness.context.accel_build([ox.BuildInputTriangles(np.zeros((3, 3), np.float32))], build_flags=UPDATE)
    before = distance(harness, accel)
    accel.update(at_z(0.0))
    assert (before, distance(harness, accel)) == (None, 10.0)


def test_an_update_takes_new_instance_ids(harness: Harness) -> None:
    # Recorded: 13_degenerate, an IAS update takes new instance ids.
    accel = harness.context.accel_build(at_z(0.0))
    top = harness.context.accel_build([ox.BuildInputInstances([ox.Instance(accel, EYE, instance_id=1)])], build_flags=UPDATE)
    top.update([ox.BuildInputInstances([ox.Instance(accel, EYE, instance_id=9)])])
    (result,) = trace(harness, [], [ray((0.25, 0.25, 10.0), root="it")], made={"it": top})
    assert closest(result)["instId"] == 9
