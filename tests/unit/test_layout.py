"""The natural C layout, computed twice: from IR types and from the host's struct classes."""

from __future__ import annotations

import numpy as np
import pytest

import optixc as ox
from optixc.ir import layout
from optixc.ir import types as t

INNER = t.Struct("Inner", t.StructKind.PLAIN, (t.StructField("flag", t.BOOL), t.StructField("color", t.FLOAT3)))
OUTER = t.Struct(
    "Outer",
    t.StructKind.PLAIN,
    (
        t.StructField("small", t.UINT8),
        t.StructField("image", t.Array(t.FLOAT4, 2)),
        t.StructField("ready", t.BOOL),
        t.StructField("inner", INNER),
        t.StructField("matrix", t.Matrix(3, 4)),
        t.StructField("wide", t.FLOAT64),
        t.StructField("weights", t.FixedArray(t.FLOAT32, 3)),
        t.StructField("scene", t.TRAVERSABLE),
        t.StructField("inners", t.Array(INNER, 1)),
    ),
)


@ox.struct
class Inner:
    flag: bool
    color: ox.float3


@ox.struct
class Outer:
    small: ox.uint8
    image: ox.Array2[ox.float4]
    ready: bool
    inner: Inner
    matrix: ox.float3x4
    wide: ox.float64
    weights: ox.FixedArray[ox.float32, 3]
    scene: ox.Traversable
    inners: ox.Array[Inner]


def test_natural_alignment() -> None:
    assert layout.struct_layout(INNER) == layout.StructLayout(16, 4, (0, 4))
    assert layout.struct_layout(OUTER).offsets == (0, 8, 32, 36, 52, 104, 112, 128, 136)
    assert layout.size_of(OUTER) == 152
    assert layout.alignment_of(t.FLOAT4) == 4


def test_host_classes_have_the_same_layout() -> None:
    assert Outer.__optixc_layout__.text == layout.describe(OUTER)
    assert Outer.dtype == layout.dtype_of(OUTER)
    assert Outer.nbytes == layout.size_of(OUTER)


def test_dtype_has_no_hidden_padding_rule() -> None:
    dtype = layout.dtype_of(OUTER)
    assert dtype.itemsize == 152
    assert dtype.fields is not None
    assert dtype.fields["scene"][1] == 128
    assert layout.dtype_of(t.Array(t.FLOAT4, 2)).itemsize == 24
    assert layout.dtype_of(t.BOOL) == np.dtype(np.bool_)


@pytest.mark.parametrize(
    ("type_", "words"),
    [
        (t.BOOL, 1),
        (t.UINT8, 1),
        (t.FLOAT32, 1),
        (t.FLOAT64, 2),
        (t.FLOAT3, 3),
        (t.TRAVERSABLE, 2),
        (INNER, 4),
        (t.FixedArray(t.INT64, 2), 4),
    ],
)
def test_payload_words(type_: t.Type, words: int) -> None:
    assert layout.payload_words(type_) == words


def test_void_and_tuples_have_no_layout() -> None:
    for type_ in (t.VOID, t.Tuple((t.FLOAT32,))):
        with pytest.raises(AssertionError):
            layout.size_of(type_)
