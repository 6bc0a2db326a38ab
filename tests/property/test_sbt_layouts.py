"""Random SBT layouts against the guide's formula (7.3): instances in up to three levels, build inputs, offsets of primitives, ray types,
strides, and tables with empty records, records of two sizes and too few of them. Scalar code and packets, one pipeline each.

A few hundred layouts with every test run, 10,000 with --fuzz.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sbt_layout_shader as shader

import optixc as ox

LAYOUTS, LONG_LAYOUTS = 300, 10_000
LANES = (1, 8, 16)
TABLE_SIZES = (0, 1, 17, 64, 200, 700)
MISSES = 5
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
OFFSET_TYPES = (np.uint8, np.uint16, np.uint32)


@dataclass(frozen=True)
class Spot:
    """A primitive as rays meet it: where, the offsets of all instances above, its SBT index inside its GAS."""

    position: tuple[float, float]
    instance_offset: int
    gas_index: int

    def record(self, offset: int, stride: int) -> int:
        """The formula; strides have four bits, and their next four spill into the offset (recorded: 01_sbt)."""
        return self.instance_offset + self.gas_index * (stride & 15) + ((offset | stride >> 4) & 15)


class Table:
    """A table and what a ray writes that asks for record `index`."""

    def __init__(self, groups: dict[str, Any], size: int, random: np.random.Generator, boxes: bool) -> None:
        kinds = random.choice(["short", "tall", "empty", "no record"], size, p=[0.45, 0.45, 0.05, 0.05])
        suffix = " box" if boxes else ""
        self.expected = [{"short": number, "tall": shader.TALL + number}.get(kind, shader.NOTHING) for number, kind in enumerate(kinds)]
        data = {"short": shader.Short, "tall": lambda number: shader.Tall(np.zeros(9, np.uint32), number)}
        records = [None if kind == "no record" else
                   groups[kind + suffix].record(data[kind](number) if kind in data else None) for number, kind in enumerate(kinds)]
        misses = [groups["miss"].record(shader.Short(number)) for number in range(MISSES)]
        self.sbt = ox.ShaderBindingTable(raygen=groups["raygen"].record(), miss=misses, hitgroup=records)

        self.absent = {number for number, kind in enumerate(kinds) if kind == "no record"}
        self.boxes = boxes

    def written(self, index: int, miss_index: int) -> int:
        """Without a record nothing runs; a box without one has no intersection program, so that the ray goes past it."""
        is_there = index < len(self.expected) and index not in self.absent
        if not is_there and self.boxes:
            return missed(miss_index)
        return self.expected[index] if is_there else shader.NOTHING


def missed(miss_index: int) -> int:
    return shader.MISS + miss_index if miss_index < MISSES else shader.NOTHING


class Scenes:
    """Random scenes; every primitive of every instance has a place of its own."""

    def __init__(self, context: ox.DeviceContext, random: np.random.Generator) -> None:
        self.build = context.accel_build
        self.random = random

    def gas(self, boxes: bool) -> tuple[Any, list[Spot], float]:
        """A structure, its primitives and how wide it is."""
        random, inputs, spots, base = self.random, [], [], 0
        for _ in range(random.integers(1, 4)):
            count, records = int(random.integers(1, 4)), int(random.choice([1, 1, 2, 3, 5]))
            # An offset beyond the last record means the last one (recorded: 01_sbt).
            offsets = random.integers(0, records + 2, count) if records > 1 or random.random() < 0.5 else None
            x = 2.0 * (len(spots) + np.arange(count))
            options = {"num_sbt_records": records,
                       "sbt_index_offsets": None if offsets is None else offsets.astype(random.choice(np.array(OFFSET_TYPES, object)))}
            if boxes:
                bounds = [[one, 0, -1, one + 1, 1, 0] for one in x]
                inputs.append(ox.BuildInputCustomPrimitives(np.array(bounds, np.float32), **options))
            else:
                corners = np.concatenate([CORNERS + np.float32([one, 0, 0]) for one in x])
                inputs.append(ox.BuildInputTriangles(corners, **options))
            chosen = [min(int(offset), records - 1) for offset in (offsets if offsets is not None else [0] * count)]
            spots += [Spot((float(one), 0.0), 0, base + offset) for one, offset in zip(x, chosen, strict=True)]
            base += records
        return self.build(inputs), spots, 2.0 * len(spots)

    def level(self, below: list[tuple[Any, list[Spot], float]], step: float) -> tuple[Any, list[Spot], float]:
        """Instances of some of the structures below, side by side along y."""
        instances, spots = [], []
        for number in range(self.random.integers(1, 4)):
            child, inner, _ = below[self.random.integers(len(below))]
            offset, move = int(self.random.choice([0, 1, 2, 5, 6, 30])), step * number
            matrix = np.array([[1, 0, 0, 0], [0, 1, 0, move], [0, 0, 1, 0]], np.float32)
            instances.append(ox.Instance(child, matrix, sbt_offset=offset))
            spots += [Spot((one.position[0], one.position[1] + move), one.instance_offset + offset, one.gas_index) for one in inner]
        return self.build([ox.BuildInputInstances(instances)]), spots, 0.0

    def scene(self, boxes: bool) -> tuple[Any, list[Spot]]:
        """A root of nought to two levels of instances and the primitives below it."""
        found = [self.gas(boxes) for _ in range(self.random.integers(1, 3))]
        for level in range(self.random.integers(0, 3)):
            found = [self.level(found, 2.0 * 4**level) for _ in range(self.random.integers(1, 3))]
        return found[0][:2]


@pytest.fixture(scope="module")
def context() -> Iterator[ox.DeviceContext]:
    yield ox.DeviceContext(threads=1)


def groups_of(context: ox.DeviceContext) -> dict[str, Any]:
    module, create = context.module_create(Path(shader.__file__)), context.program_group_create
    groups = {"raygen": create(raygen=module["__raygen__rays"]), "miss": create(miss=module["__miss__short"]),
              "empty": create(closesthit=None), "empty box": create(intersection=module["__intersection__box"])}
    for name in ("short", "tall"):
        groups[name] = create(closesthit=module[f"__closesthit__{name}"])
        groups[f"{name} box"] = create(closesthit=module[f"__closesthit__{name}"], intersection=module["__intersection__box"])
    return groups


def rays_at(spots: list[Spot], random: np.random.Generator) -> np.ndarray:
    """Two rays at every primitive and some beside them, each with SBT arguments of its own; every fifth breaks the four bits."""
    rays = np.zeros(2 * len(spots) + 5, shader.Ray.dtype)
    rays["origin"] = [(*(one.position), 1.0) for one in spots for _ in range(2)] + [(-9.0, -9.0, 1.0)] * 5
    rays["origin"] += np.float32([0.25, 0.25, 0.0])
    wide = random.random(len(rays)) < 0.2
    rays["sbt_offset"] = np.where(wide, random.integers(0, 300, len(rays)), random.integers(0, 16, len(rays)))
    rays["sbt_stride"] = np.where(wide, random.integers(0, 300, len(rays)), random.integers(0, 16, len(rays)))
    rays["miss_index"] = random.integers(0, MISSES + 2, len(rays))
    return rays


@pytest.mark.parametrize("boxes", [False, True], ids=["triangles", "boxes"])
def test_every_ray_reaches_the_record_of_the_formula(request: pytest.FixtureRequest, context: ox.DeviceContext, boxes: bool) -> None:
    layouts = (LONG_LAYOUTS if request.config.getoption("--fuzz") else LAYOUTS) // 2
    random = np.random.default_rng(5 + boxes)
    groups = groups_of(context)
    used = [group for name, group in groups.items() if boxes or "box" not in name]
    pipelines = {lanes: context.pipeline_create(used, simd=lanes) for lanes in LANES}
    tables = [Table(groups, size, random, boxes) for size in TABLE_SIZES]
    scenes, reached_records = Scenes(context, random), set()
    for _ in range(layouts):
        root, spots = scenes.scene(boxes)
        table, rays = tables[random.integers(len(tables))], rays_at(spots, random)
        indices = [spots[number // 2].record(int(ray["sbt_offset"]), int(ray["sbt_stride"])) for number, ray in enumerate(rays[:-5])]
        miss_indices = rays["miss_index"].tolist()
        expected = [table.written(index, miss_index) for index, miss_index in zip(indices, miss_indices[:-5], strict=True)]
        expected += [missed(miss_index) for miss_index in miss_indices[-5:]]
        for lanes, pipeline in pipelines.items():
            reached = np.full(len(rays), 77, np.uint32)
            pipeline.launch(shader.Params(root, rays, reached), table.sbt, len(rays))
            assert reached.tolist() == expected, (lanes, rays.tolist(), [vars(spot) for spot in spots])
        reached_records.update(index for index in indices if index < len(table.expected))
    assert len(reached_records) > 100
