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
}


def module_text() -> str:
    """All of them in one shader file."""
    head = "\n\n@ox.program\ndef __raygen__{}():\n    i = int32(ox.get_launch_index().x)\n    state = State(1, 0){}"
    return PRELUDE + "".join(head.format(name, body) for name, body in PROGRAMS.items())


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
