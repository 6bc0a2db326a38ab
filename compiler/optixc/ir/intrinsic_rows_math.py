"""Rows: mathematics on scalars and vectors, matrices, bits, textures and atomic operations on arrays.

Where a row says SAME, numbers are spread over the vectors beside them: `max(v, 0.0)`.
"""

from __future__ import annotations

from optixc.ir import types as t
from optixc.ir.intrinsic_naming import maths
from optixc.ir.intrinsics import Effect, Generic, Intrinsic, IntrinsicParameter, State

_F, _N, _I, _V, _SAME, _ELEMENT = (
    Generic.FLOATS,
    Generic.NUMBERS,
    Generic.INTEGERS,
    Generic.FLOAT_VECTOR,
    Generic.SAME,
    Generic.ELEMENT,
)

_ONE_FLOAT: tuple[tuple[str, str], ...] = (
    ("sqrt", "Square root."),
    ("rsqrt", "1 / sqrt(x)."),
    ("sin", "Sine of an angle in radians."),
    ("cos", "Cosine of an angle in radians."),
    ("tan", "Tangent of an angle in radians."),
    ("asin", "Arc sine in radians."),
    ("acos", "Arc cosine in radians."),
    ("atan", "Arc tangent in radians."),
    ("sinh", "Hyperbolic sine."),
    ("cosh", "Hyperbolic cosine."),
    ("tanh", "Hyperbolic tangent."),
    ("exp", "e to the power of x."),
    ("exp2", "2 to the power of x."),
    ("log", "Natural logarithm."),
    ("log2", "Logarithm to base 2."),
    ("log10", "Logarithm to base 10."),
    ("floor", "The largest whole number not above x, as a float."),
    ("ceil", "The smallest whole number not below x, as a float."),
    ("trunc", "x without its fraction."),
    ("round", "The nearest whole number, halves to even, as a float."),
    ("fract", "x - floor(x)."),
    ("saturate", "x limited to [0, 1]."),
    ("radians", "Degrees to radians."),
    ("degrees", "Radians to degrees."),
)

_FLOATS: tuple[Intrinsic, ...] = (
    *(maths(name, (("x", _F),), _SAME, doc) for name, doc in _ONE_FLOAT),
    maths("rint", (("x", _F),), _SAME, "The nearest whole number, halves to even, as a float.", cpp="oxrt::round"),
    maths("atan2", (("y", _F), ("x", _SAME)), _SAME, "Angle of the point (x, y) in radians."),
    maths("pow", (("x", _F), ("y", _SAME)), _SAME, "x to the power of y."),
    maths("fmod", (("x", _F), ("y", _SAME)), _SAME, "Remainder of C: it has the sign of x."),
    maths("hypot", (("x", _F), ("y", _SAME)), _SAME, "sqrt(x*x + y*y) without overflow."),
    maths("copysign", (("x", _F), ("sign", _SAME)), _SAME, "x with the sign of the other."),
    maths("fma", (("a", _F), ("b", _SAME), ("c", _SAME)), _SAME, "a * b + c, rounded once."),
    maths("lerp", (("a", _F), ("b", _SAME), ("t", _SAME)), _SAME, "a + t * (b - a)."),
    maths("mix", (("a", _F), ("b", _SAME), ("t", _SAME)), _SAME, "The same as lerp."),
    maths("step", (("edge", _F), ("x", _SAME)), _SAME, "0 below the edge, else 1."),
    maths("smoothstep", (("edge0", _F), ("edge1", _SAME), ("x", _SAME)), _SAME, "Hermite step between two edges."),
    maths("isnan", (("x", _F),), t.BOOL, "Whether x is not a number."),
    maths("isinf", (("x", _F),), t.BOOL, "Whether x is infinite."),
    maths("isfinite", (("x", _F),), t.BOOL, "Whether x is neither infinite nor NaN."),
)

_NUMBERS: tuple[Intrinsic, ...] = (
    maths("abs", (("x", _N),), _SAME, "Absolute value."),
    maths("sign", (("x", _N),), _SAME, "-1, 0 or 1."),
    maths("min", (("a", _N), ("b", _SAME)), _SAME, "The smaller: a if a < b else b."),
    maths("max", (("a", _N), ("b", _SAME)), _SAME, "The larger: a if a > b else b."),
    maths("clamp", (("x", _N), ("low", _SAME), ("high", _SAME)), _SAME, "max(low, min(x, high))."),
    maths("dot", (("a", Generic.FLOAT_VECTOR), ("b", _SAME)), _ELEMENT, "Scalar product."),
    maths("cross", (("a", t.FLOAT3), ("b", t.FLOAT3)), t.FLOAT3, "Vector product."),
    maths("length", (("v", _V),), _ELEMENT, "Euclidean length."),
    maths("length_squared", (("v", _V),), _ELEMENT, "Square of the Euclidean length."),
    maths("distance", (("a", _V), ("b", _SAME)), _ELEMENT, "Length of a - b."),
    maths("normalize", (("v", _V),), _SAME, "v divided by its length."),
    maths("reflect", (("i", _V), ("n", _SAME)), _SAME, "i - 2 dot(n, i) n."),
    maths("refract", (("i", _V), ("n", _SAME), ("eta", _ELEMENT)), _SAME, "Direction after refraction, zero if there is none."),
    maths("faceforward", (("n", _V), ("i", _SAME), ("reference", _SAME)), _SAME, "n, turned against i."),
)

_BITS: tuple[Intrinsic, ...] = (
    maths("float_as_uint", (("x", t.FLOAT32),), t.UINT32, "The bits of a float."),
    maths("float_as_int", (("x", t.FLOAT32),), t.INT32, "The bits of a float."),
    maths("uint_as_float", (("x", t.UINT32),), t.FLOAT32, "The float of these bits."),
    maths("int_as_float", (("x", t.INT32),), t.FLOAT32, "The float of these bits."),
    maths("popcount", (("x", _I),), _SAME, "How many bits are set."),
    maths("clz", (("x", _I),), _SAME, "How many zero bits stand above the highest set bit."),
    maths("ctz", (("x", _I),), _SAME, "How many zero bits stand below the lowest set bit."),
    maths("reverse_bits", (("x", t.UINT32),), t.UINT32, "Bit 0 becomes bit 31, and so on."),
    maths("mul_hi", (("a", t.UINT32), ("b", t.UINT32)), t.UINT32, "The upper word of the 64-bit product."),
)

_MATRICES: tuple[Intrinsic, ...] = (
    maths("transpose", (("m", t.Matrix(3, 3)),), t.Matrix(3, 3), "Rows become columns."),
    maths("determinant", (("m", t.Matrix(3, 3)),), t.FLOAT32, "Determinant."),
    maths("inverse", (("m", t.Matrix(3, 3)),), t.Matrix(3, 3), "Inverse; infinite or NaN where there is none."),
)

_TEXTURES: tuple[Intrinsic, ...] = (
    Intrinsic(
        "tex2d",
        "",
        (IntrinsicParameter("texture", t.TEXTURE), IntrinsicParameter("u", t.FLOAT32), IntrinsicParameter("v", t.FLOAT32)),
        t.FLOAT4,
        "oxrt::tex2d",
        "The filtered texel at (u, v) in [0, 1]; missing channels are 0, alpha 1.",
        state=State.THREAD,
    ),
)


def _atomic(name: str, doc: str, *more: str) -> Intrinsic:
    camel = "".join(part.capitalize() if i else part for i, part in enumerate(name.split("_")))
    values = tuple(IntrinsicParameter(parameter, Generic.ELEMENT) for parameter in (more or ("value",)))
    return Intrinsic(
        name,
        "",
        (IntrinsicParameter("array", Generic.ARRAY), IntrinsicParameter("index", t.UINT32), *values),
        Generic.ELEMENT,
        f"oxrt::{camel}",
        doc,
        effect=Effect.WRITES,
    )


ATOMICS: tuple[Intrinsic, ...] = (
    _atomic("atomic_add", "Add to an element; gives the value before."),
    _atomic("atomic_sub", "Subtract from an element; gives the value before."),
    _atomic("atomic_exch", "Replace an element; gives the value before."),
    _atomic("atomic_min", "Make an element the smaller of it and the value; gives the value before."),
    _atomic("atomic_max", "Make an element the larger of it and the value; gives the value before."),
    _atomic("atomic_and", "Bitwise and with an integer element; gives the value before."),
    _atomic("atomic_or", "Bitwise or with an integer element; gives the value before."),
    _atomic("atomic_xor", "Bitwise exclusive or with an integer element; gives the value before."),
    _atomic("atomic_inc", "Add 1, or go to 0 from the value on; gives the value before."),
    _atomic("atomic_dec", "Subtract 1, or go to the value from 0 and above it; gives the value before."),
    _atomic("atomic_cas", "Replace an element by `value` if it is `compare`; gives the value before.", "compare", "value"),
)

ROWS: tuple[Intrinsic, ...] = (*_FLOATS, *_NUMBERS, *_BITS, *_MATRICES, *_TEXTURES, *ATOMICS)
