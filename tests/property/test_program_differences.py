"""Programs in which scalar code, packets or the interpreter once differed, reduced to what mattered."""

from __future__ import annotations

from pathlib import Path

import pytest
from modules import PRELUDE
from ways_to_run import Ways, difference, interpret, params_class

PROGRAMS = {
    "counter_of_a_loop_that_lanes_leave_apart": """
    for k in range(5):
        if params.in_int32[i, 5] & 1 == 0:
            break
    params.out_int32[i, 0] = k
""",
    "counter_of_a_loop_in_a_loop": """
    total = 0
    for turn in range(3):
        for k in range(4):
            if params.in_int32[i, k] > turn:
                break
        total = total * 5 + k
        if total > 20:
            continue
        for k in range(2):
            total += k
    params.out_int32[i, 0] = total
""",
    "counter_that_one_way_sets_anew": """
    for k in range(7):
        if params.in_int32[i, k] & 3 == 0:
            break
    if params.in_int32[i, 0] > 3:
        k = 100
    params.out_int32[i, 0] = k
""",
    "items_that_a_helper_changes": """
    smalls = ox.FixedArray[Small, 2](Small(1, 2, 3, 4, 0.5, True), Small(6, 7, 8, 9, 1.5, False))
    rows = Rows(ox.copy(smalls), ox.FixedArray[float3, 4](), float3x4(float4(), float4(), float4()))
    value = stir(rows.items[0], 7) if params.in_int32[i, 0] > 3 else 4
    value += stir(rows.items[params.in_int32[i, 1] & 1], i)
    if mingle(rows.items[params.in_int32[i, 2] & 1], rows.items[params.in_int32[i, 3] & 1]):
        value += 1000 * tick(state, rows.items[1].a)
    params.out_int32[i, 0] = value + rows.items[0].a + 5 * rows.items[1].a + 7 * rows.items[0].c + 11 * rows.items[1].c
    params.out_uint32[i, 0] = rows.items[0].d + 100 * rows.items[1].d + 10000 * state.trail
""",
    "parts_of_storage_vectors": """
    packed = Packed(uchar4(250), half4(1.0), short2(7), char3(1, 2, 3), ushort3(4), longlong2(5))
    packed.c.x += 300
    packed.c[i & 3] = 513
    packed.b.y = -129
    packed.s = int2(100000, i)
    packed.h.z = 1.0 / 3.0
    packed.h[i & 3] += 0.1
    packed.u.x, packed.u.y = packed.u.y + 65536, packed.u.x - 5
    params.out_uint32[i, 0] = packed.c.x + 256 * packed.c.y + 65536 * packed.c.z + 7 * packed.c.w + packed.u.x + 3 * packed.u.y
    params.out_int32[i, 0] = packed.b.y + 1000 * packed.s.x + packed.s.y
    params.out_float32[i, 0] = packed.h.x + 2.0 * packed.h.y + 4.0 * packed.h.z + 8.0 * packed.h.w
""",
    "fixed_arrays_of_fixed_arrays": """
    grid = ox.FixedArray[ox.FixedArray[Small, 2], 2]()
    grid[i & 1][params.in_int32[i, 0] & 1] = Small(1, 2, 3, 4, 0.5, True)
    grid[params.in_int32[i, 1] & 1][i & 1].a += 5
    value = stir(grid[params.in_int32[i, 2] & 1][params.in_int32[i, 3] & 1], i)
    for row in range(2):
        for column in range(2):
            value = value * 31 + grid[row][column].a + 7 * grid[row][column].c
    params.out_int32[i, 0] = value
""",
    "uniform_wholes_in_varying_places": """
    smalls = ox.FixedArray[Small, 2](small_of(i, 0.5), small_of(3, 0.25))
    rows = Rows(ox.copy(smalls), ox.FixedArray[float3, 4](), float3x4(float4(), float4(), float4()))
    nested = Nested(small_of(i, 0.25), i, Wide(1, 2.0, float3(i), uint2(3)), ox.FixedArray[float32, 4](0.5 * i, 1.0, 2.0, 3.0))
    if i & 1:
        rows.items = ox.FixedArray[Small, 2]()
        rows.m = float3x4(float4(1.0), float4(2.0), float4(3.0))
    else:
        nested.list = ox.FixedArray[float32, 4]()
        nested.first = small_of(2, 1.0)
    rows.rows = ox.FixedArray[float3, 4]()
    params.out_int32[i, 0] = rows.items[0].a + 10 * rows.items[1].c + 100 * nested.first.c
    params.out_float32[i, 0] = nested.list[0] + nested.list[3] + rows.m[1].y + rows.rows[1].x + rows.items[1].e
""",
    "a_uniform_result_where_no_lane_asks": """
    value = patient(params.in_int32[i, 0]) if params.in_int32[i, 1] > 1000000 else 2.5
    params.out_float64[i, 0] = value
""",
    "items_by_a_name_that_differs": """
    items, vector, matrix = ox.FixedArray[int32, 32](), float4(1.0), float4x4()
    items[i] = 9
    k = i & 3
    vector[k] = 2.0
    matrix[k][k] = 3.0
    for turn in range(32):
        params.out_int32[i, turn & 7] += items[turn] * turn
    params.out_float32[i, 0] = vector.x + 10.0 * vector.w + matrix[1].y
""",
    "enum_in_the_index_of_a_target": """
    values = ox.FixedArray[int32, 8]()
    values[Mode.SECOND], values[Bits.A | Bits.BOTH], value = i, 2 * i, values[LIMIT]
    params.out_int32[i, Mode.FIRST], params.out_int32[i, 0] = values[2] + value, values[5]
""",
}


HELPERS = """
@ox.device
def patient(value: int32) -> float64:
    turns = 0
    while True:
        turns += 1
        if turns > 2 or value != 0:
            break
    return float64(-7.5)
"""


def module_text() -> str:
    """All of them in one shader file."""
    head = "\n\n@ox.program\ndef __raygen__{}():\n    i = int32(ox.get_launch_index().x)\n    state = State(1, 0){}"
    return PRELUDE + HELPERS + "".join(head.format(name, body) for name, body in PROGRAMS.items())


def test_ways_agree(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ways, params = Ways(tmp_path, monkeypatch), params_class()
    names = [f"__raygen__{name}" for name in PROGRAMS]
    scalar, tables, groups = ways.compile(ways.write(module_text()), names)
    others = {width: ways.pipeline(groups, lanes) for width, lanes in ways.lanes.items()}
    for name in names:
        expected = ways.run(scalar, tables[name], params, interpret)
        for way, pipeline in {"scalar": scalar, **others}.items():
            found = difference(expected, ways.run(pipeline, tables[name], params))
            assert not found, f"{name}: interpreted and {way} differ, {found}"
