"""What an index writes: a target is never a copy, a fixed array is read after its index, a vector is taken before it."""

from __future__ import annotations

from pathlib import Path

from optixc.frontend.compile import compile_file
from optixc.ir.text import print_module

SHADER = """
import optixc as ox
from optixc import float2

@ox.struct
class State:
    count: int
    place: float2
    items: ox.FixedArray[int, 4]

@ox.device
def tick(state: State) -> int:
    state.count += 1
    state.items[0] = state.count
    return state.count & 1

@ox.program
def __raygen__main():
    state = State(0, float2(0.0), ox.FixedArray[int, 4]())
    {}
    ox.get_launch_index()
    print(state.count, state.items[0], state.place)
"""


def lowered(folder: Path, line: str) -> str:
    """The IR of the line."""
    (folder / "shader.py").write_text(SHADER.format(line))
    return print_module(compile_file(str(folder / "shader.py")).module)


def test_a_target_is_no_copy(tmp_path: Path) -> None:
    assert "state.items[result] = int32(3)" in lowered(tmp_path, "state.items[tick(state)] = 3")
    assert "state.place[result] = " in lowered(tmp_path, "state.place[tick(state)] = 3.0")


def test_a_fixed_array_is_read_after_its_index(tmp_path: Path) -> None:
    assert "x = state.items[result]" in lowered(tmp_path, "x = state.items[tick(state)]")


def test_a_vector_is_taken_before_its_index(tmp_path: Path) -> None:
    text = lowered(tmp_path, "x = state.place[tick(state)]")
    assert "value = state.place" in text
    assert "x = value[result]" in text
