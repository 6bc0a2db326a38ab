"""Stacks that are used up by large locals: an exception or a named error in every mode, on every worker thread, never a crash."""

from __future__ import annotations

import importlib.util
import sys
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import optixc as ox

SHADER = '''
import optixc as ox
from optixc import Array, FixedArray, float3, float4, int32, uint32


@ox.struct
class Params:
    scene: ox.Traversable
    out: Array[uint32]
    codes: Array[int32]
    depth: Array[uint32]


@ox.payload
class Level:
    left: uint32
    reached: uint32


@ox.payload
class Once:
    value: float


params = ox.launch_params(Params)


@ox.device
def shoot(level: Level):
    ox.trace(params.scene, float3(0.25, 0.25, 1.0), float3(0.0, 0.0, -1.0), payload=level)


@ox.device
def used(numbers: FixedArray[float4, {size}], start: uint32) -> float:
    """Reads an item that only the run knows, so that no compiler leaves the array out."""
    numbers[int((start * 7919) % {size})].y += 1.0
    return numbers[int((start * 104729 + params.depth[0]) % {size})].y


@ox.program
def __raygen__deep():
    i = ox.get_launch_index().x
    level = Level(params.depth[i], 0)
    shoot(level)
    params.out[i] = level.reached


@ox.program
def __closesthit__deep(level: Level):
    numbers = FixedArray[float4, {size}]()
    before = used(numbers, level.left)
    if level.left > 1:
        inner = Level(level.left - 1, 0)
        shoot(inner)
        level.reached = inner.reached
    level.reached += uint32(1 if used(numbers, level.reached) + before >= 0.0 else 0)


@ox.program
def __raygen__flat():
    i = ox.get_launch_index().x
    once = Once(0.0)
    ox.trace(params.scene, float3(0.25, 0.25, 1.0), float3(0.0, 0.0, -1.0), payload=once)
    params.out[i] = uint32(once.value)


@ox.program
def __closesthit__flat(once: Once):
    a, b = FixedArray[float4, {size}](), FixedArray[float4, {size}]()
    c, d = FixedArray[float4, {size}](), FixedArray[float4, {size}]()
    i = ox.get_launch_index().x
    once.value = used(a, i) + used(b, i) + used(c, i) + used(d, i) + 5.0


@ox.program
def __exception__note():
    params.codes[ox.get_launch_index().x] = ox.get_exception_code()
'''
LARGEST = 65536
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
MODES = [1, 8, 16]


class Deep:
    """The programs with local arrays of `size` items, in a context of `threads` threads."""

    def __init__(self, folder: Path, kind: str, simd: int, size: int, threads: int | None = None, flags: int = 0) -> None:
        path = folder / "deep_shader.py"
        path.write_text(SHADER.replace("{size}", str(size)))
        spec = importlib.util.spec_from_file_location("deep_shader", path)
        assert spec is not None and spec.loader is not None
        self.shader = sys.modules["deep_shader"] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(self.shader)
        self.context = ox.DeviceContext(threads=threads)
        module, create = self.context.module_create(path), self.context.program_group_create
        self.raygen = create(raygen=module[f"__raygen__{kind}"])
        self.hit, self.exception = create(closesthit=module[f"__closesthit__{kind}"]), create(exception=module["__exception__note"])
        groups = [self.raygen, self.hit, self.exception]
        options = ox.PipelineCompileOptions(exception_flags=flags)
        self.pipeline = self.context.pipeline_create(groups, max_trace_depth=31, simd=simd, options=options)
        self.scene = self.context.accel_build([ox.BuildInputTriangles(CORNERS)])

    def run(self, depths: list[int]) -> tuple[list[int], list[int]]:
        out, codes = np.full(len(depths), 999, np.uint32), np.zeros(len(depths), np.int32)
        params = self.shader.Params(scene=self.scene, out=out, codes=codes, depth=np.array(depths, np.uint32))
        table = ox.ShaderBindingTable(raygen=self.raygen.record(), hitgroup=[self.hit.record()], exception=self.exception.record())
        self.pipeline.launch(params, table, len(depths))
        return out.tolist(), codes.tolist()


def in_small_thread(run: Any) -> Any:
    """What `run()` gives in a thread with a stack of 64 KiB."""
    found: list[Any] = []
    threading.stack_size(1 << 16)
    try:
        thread = threading.Thread(target=lambda: found.append(run()))
        thread.start()
        thread.join()
    finally:
        threading.stack_size(0)
    return found[0]


@pytest.mark.parametrize("threads", [1, 2, 24])
@pytest.mark.parametrize("simd", MODES)
def test_overflow_on_every_thread(tmp_path: Path, simd: int, threads: int) -> None:
    """Locals of 3 MiB a level: a thread's 64 MiB end before depth 31. The other launch indices go on."""
    deep = Deep(tmp_path, "deep", simd, size=3 * LARGEST // (max(simd, 3)), threads=threads, flags=ox.ExceptionFlags.STACK_OVERFLOW)
    depths = [31 if index % 96 == 0 else 1 for index in range(24 * 256)]
    expected = [999 if depth == 31 else depth for depth in depths], [-1 if depth == 31 else 0 for depth in depths]
    if simd == 1:
        # 1 MiB a level fits, as all that a program of one lane can hold here does
        expected = depths, [0] * len(depths)
    assert deep.run(depths) == expected
    few = slice(0, 200)
    assert in_small_thread(lambda: deep.run(depths[few])) == tuple(part[few] for part in expected)


@pytest.mark.parametrize("simd", MODES)
def test_depth_31_with_locals_that_fit(tmp_path: Path, simd: int) -> None:
    deep = Deep(tmp_path, "deep", simd, size=LARGEST // (2 * simd), threads=3)
    depths = [1 + index % 31 for index in range(1000)]
    assert deep.run(depths) == (depths, [0] * len(depths))
    assert in_small_thread(lambda: deep.run(depths))[0] == depths


@pytest.mark.parametrize("simd", [8, 16])
def test_overflow_without_exceptions_is_a_named_error(tmp_path: Path, simd: int) -> None:
    deep = Deep(tmp_path, "deep", simd, size=3 * LARGEST // simd)
    with pytest.raises(ox.LaunchFailureError, match=r"deep_shader\.py:\d+: shoot, launch index .*the stack is used up") as caught:
        deep.run([1, 31, 1])
    assert caught.value.fault_code == -1
    assert deep.run([1, 2, 3])[0] == [1, 2, 3]


def test_programs_that_no_stack_holds_are_refused(tmp_path: Path) -> None:
    """Four arrays of a mebibyte are nothing to one lane, and 64 MiB for sixteen."""
    assert Deep(tmp_path, "flat", 1, size=LARGEST).run([1, 1]) == ([5, 5], [0, 0])
    text = r"bytes of stack a trace in 16 lanes, and 1 traces may nest; that may be \d+ MiB, and threads have 64\. Keep large FixedArrays"
    with pytest.raises(ox.InvalidValueError, match=text):
        Deep(tmp_path, "flat", 16, size=LARGEST)
