"""Vectors, matrices and mathematics in plain Python: binary32, wrapping integers, shader meanings of the operators."""

from __future__ import annotations

import math

import numpy as np
import pytest

import optixc as ox
from optixc import float2, float3, float4, int2, int3, uint2


def test_floats_are_binary32() -> None:
    assert float3(0.1).x == float(np.float32(0.1))
    assert (float2(0.1, 0.2) + float2(0.2, 0.1)).x == float(np.float32(0.1) + np.float32(0.2))
    assert (float2(1.0) / 3.0).y == float(np.float32(1) / np.float32(3))


def test_construction_swizzles_and_comparison() -> None:
    v = float4(float2(1, 2), 3.0, 4)
    assert v == float4(1, 2, 3, 4)
    assert v.wzyx == float4(4, 3, 2, 1)
    assert v.xy == float2(1, 2)
    assert v != float4(0)
    assert list(v) == [1.0, 2.0, 3.0, 4.0]
    with pytest.raises(TypeError, match="takes 3 numbers"):
        float3(1, 2)
    with pytest.raises(AttributeError, match="no component 'w'"):
        _ = float3(1).w
    with pytest.raises(AttributeError, match="are values"):
        v.x = 3.0


def test_integers_floor_wrap_and_divide_truly() -> None:
    assert int3(7, -7, 2) // 2 == int3(3, -4, 1)
    assert int2(-7, 7) % 4 == int2(1, 3)
    assert int2(5, 0) // 0 == int2(0, 0)
    assert uint2(0) - 1 == uint2(0xFFFFFFFF)
    assert int2(1, 3) / 2 == float2(0.5, 1.5)
    assert int2(2**31 - 1) + 1 == int2(-(2**31))
    assert ox.int32(2**31) == -(2**31)
    assert ox.uint32(-1) == 2**32 - 1


def test_float_to_int_truncates_and_saturates() -> None:
    assert int2(-1.9, 1.9) == int2(-1, 1)
    assert int2(3e10, math.nan) == int2(2**31 - 1, 0)


def test_division_by_zero_gives_infinity() -> None:
    assert float2(1.0, -1.0) / 0.0 == float2(math.inf, -math.inf)


def test_mixing_types_is_refused() -> None:
    with pytest.raises(TypeError):
        float3(1) + int3(1)


def test_matrices_multiply() -> None:
    m = ox.float3x4([[1, 0, 0, 5], [0, 2, 0, 6], [0, 0, 3, 7]])
    assert m @ float4(1, 1, 1, 1) == float3(6, 8, 10)
    assert m[1] == float4(0, 2, 0, 6)
    assert ox.float3x3(np.eye(3)) @ m == m
    with pytest.raises(TypeError, match="12 numbers"):
        ox.float3x4(1, 2, 3)


def test_mathematics_on_plain_values() -> None:
    assert ox.dot(float3(1, 2, 3), float3(4, 5, 6)) == 32.0
    assert ox.cross(float3(1, 0, 0), float3(0, 1, 0)) == float3(0, 0, 1)
    assert ox.length(float3(3, 4, 0)) == 5.0
    assert ox.normalize(float3(0, 0, 2)) == float3(0, 0, 1)
    assert ox.clamp(float2(-1, 2), 0.0, 1.0) == float2(0, 1)
    assert ox.max(3, 4) == 4
    assert ox.max(3, 1, 4) == 4 and ox.min(3.0, 1.0, 2.0) == 1.0
    assert ox.clamp(-5.0, high=1.0, low=0.0) == 0.0
    with pytest.raises(TypeError, match=r"clamp\(\): got an unexpected keyword argument 'top'"):
        ox.clamp(-5.0, 0.0, 1.0, top=1.0)
    assert ox.sqrt(2.0) == float(np.sqrt(np.float32(2)))
    assert ox.uint_as_float(ox.float_as_uint(1.5)) == 1.5
    assert ox.popcount(0xFF) == 8
    assert ox.refract(float3(0, 0, -1), float3(0, 0, 1), 1.0) == float3(0, 0, -1)


def test_what_needs_a_launch_raises() -> None:
    with pytest.raises(ox.InvalidOperationError, match="inside a program"):
        ox.get_launch_index()
    with pytest.raises(AttributeError):
        _ = ox.no_such_function
