"""Helpers called from plain Python, and what the interpreter says of programs that do wrong; agreement with kernels is tested elsewhere."""

from __future__ import annotations

import io
import math
from contextlib import redirect_stdout
from typing import Any

import numpy as np
import pytest

import optixc as ox
from optixc import Array, FixedArray, float3, uint32
from optixc.interpret import native
from optixc.ir.intrinsic_rows import INTRINSICS
from optixc.ir.intrinsics import Effect, State


@ox.struct
class Generator:
    state: uint32
    seen: float3


@ox.struct
class Params:
    out: Array[float]
    count: int


params = ox.launch_params(Params)


@ox.device
def mixed(x, y: float3):
    return x * 0.1 + y


@ox.device
def step(generator: Generator, turns: int):
    for _ in range(turns):
        generator.state = generator.state * 1664525 + 1013904223
        generator.seen.x += 0.1
    return generator.state


@ox.device
def divided(a, b):
    return a // b, a % b


@ox.device
def scaled(v: ox.CoopVec[ox.float16, 3], matrix: Array[ox.float16]):
    return ox.coop_vec_mat_mul(ox.CoopVec[ox.float16, 2], v, matrix)


@ox.device
def distance():
    return ox.get_ray_tmax()


@ox.program
def __raygen__writes():
    i = ox.get_launch_index().x
    values = FixedArray[float, 3](1.0, 2.0, 3.0)
    values[1] += float(i)
    print("index", i, float3(values[0], values[1], values[2]))
    assert params.count < 10, "too many"
    params.out[int(i) + params.count] = values[1] * 0.1


@pytest.fixture(scope="module")
def writer() -> tuple[Any, Any]:
    """A pipeline that writes one number for each launch index, and its table."""
    context = ox.DeviceContext()
    module = context.module_create([__raygen__writes])
    raygen = context.program_group_create(raygen=module["__raygen__writes"])
    return context.pipeline_create([raygen], simd=1), ox.ShaderBindingTable(raygen=raygen.record())


def test_cooperative_vectors_go_in_and_out_as_lists() -> None:
    matrix = np.array([1, 2, 0, 0, 0, 10], np.float16)
    assert scaled([1.0, 2.0, 0.1], matrix) == [5.0, float(np.float16(10 * np.float32(np.float16(0.1))))]


def test_floats_are_binary32() -> None:
    expected = np.float32(np.float32(3.0) * np.float32(0.1)) + np.float32(1.0)
    assert mixed(3.0, float3(1.0, 2.0, 3.0)).x == float(expected)


def test_a_struct_is_passed_by_reference() -> None:
    generator = Generator(state=1, seen=(0.0, 0.0, 0.0))
    state = 1
    for _ in range(3):
        state = (state * 1664525 + 1013904223) % 2**32
    assert step(generator, 3) == state == generator.state
    assert generator.seen.x == float(np.float32(0.1) + np.float32(0.1) + np.float32(0.1))


def test_division_floors_and_by_zero_gives_zero() -> None:
    assert divided(-7, 2) == (-4, 1)
    assert divided(7, 0) == (0, 0)
    assert divided(-7.5, 2.0) == (-4.0, 0.5)


def test_a_wrong_argument_is_a_type_error() -> None:
    with pytest.raises(TypeError, match="argument x of mixed takes a number"):
        mixed("x", float3(0.0))
    with pytest.raises(TypeError, match="argument y takes a float3"):
        mixed(1.0, 2 + 1j)


def test_a_helper_that_needs_a_ray_says_so() -> None:
    with pytest.raises(ox.InvalidOperationError, match="only inside a program"):
        distance()


def test_interpreted_and_compiled_write_the_same(writer: tuple[Any, Any]) -> None:
    pipeline, sbt = writer
    compiled, interpreted = np.zeros(8, np.float32), np.zeros(8, np.float32)
    pipeline.launch(Params(out=compiled, count=2), sbt, 6)
    text = io.StringIO()
    with redirect_stdout(text):
        for index in range(6):
            ox.interpret(pipeline, Params(out=interpreted, count=2), sbt, 6, index)
    assert compiled.view(np.uint32).tolist() == interpreted.view(np.uint32).tolist()
    assert text.getvalue().splitlines()[4] == "index 4 (1, 6, 3)"


def test_an_index_outside_of_an_array_names_itself(writer: tuple[Any, Any]) -> None:
    pipeline, sbt = writer
    with pytest.raises(IndexError, match=r"index \(9,\) is out of range of an array of shape \(8,\)"):
        ox.interpret(pipeline, Params(out=np.zeros(8, np.float32), count=4), sbt, 6, 5)


def test_an_assertion_is_raised_with_the_author_s_message(writer: tuple[Any, Any]) -> None:
    pipeline, sbt = writer
    with pytest.raises(AssertionError, match="too many"):
        ox.interpret(pipeline, Params(out=np.zeros(8, np.float32), count=10), sbt, 6, 0)


def test_a_launch_index_lies_in_the_launch(writer: tuple[Any, Any]) -> None:
    pipeline, sbt = writer
    with pytest.raises(ox.InvalidValueError, match="outside of the launch size"):
        ox.interpret(pipeline, Params(out=np.zeros(8, np.float32), count=0), sbt, (4, 4), (1, 4))


def test_invalid_operations_give_the_machine_s_nan() -> None:
    assert math.isnan(divided(0.0, 0.0)[1])


def test_getters_without_a_native_function_are_known() -> None:
    """A row with state that the runtime cannot evaluate by name would fail in the middle of a program."""
    special = ("get_payload_", "get_sbt_data", "hit_object_get_sbt_data")
    missing = [
        row.name
        for row in INTRINSICS.values()
        if row.effect is Effect.PURE and row.state is not State.NONE and not row.name.startswith(special) and not native.exists(row.name)
    ]
    assert missing == []
