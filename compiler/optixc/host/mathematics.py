"""The mathematics of shaders on plain Python values: numbers count as float32 (whole numbers as int32), vectors as what they are.

Sums, products, quotients and square roots are those of compiled code bit for bit; other functions are numpy's, within a few ulp.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import numpy as np

from optixc.host.matrices import Matrix, float3x3
from optixc.host.vectors import Vector, vector_class

_Array = np.ndarray[Any, Any]
_ONE = np.float32(1.0)


def _dot(a: _Array, b: _Array) -> Any:
    products = a * b
    total = products[0]
    for product in products[1:]:
        total = total + product
    return total


def _refract(i: _Array, n: _Array, eta: _Array) -> Any:
    cosine = _dot(n, i)
    k = _ONE - eta * eta * (_ONE - cosine * cosine)
    return np.zeros_like(i) if k < 0 else eta * i - (eta * cosine + np.sqrt(k)) * n


def _smoothstep(low: _Array, high: _Array, x: _Array) -> Any:
    t = np.clip((x - low) / (high - low), np.float32(0.0), _ONE)
    return t * t * (np.float32(3.0) - np.float32(2.0) * t)


_FLOAT_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "sqrt": np.sqrt,
    "rsqrt": lambda x: _ONE / np.sqrt(x),
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "asin": np.arcsin,
    "acos": np.arccos,
    "atan": np.arctan,
    "sinh": np.sinh,
    "cosh": np.cosh,
    "tanh": np.tanh,
    "exp": np.exp,
    "exp2": np.exp2,
    "log": np.log,
    "log2": np.log2,
    "log10": np.log10,
    "floor": np.floor,
    "ceil": np.ceil,
    "trunc": np.trunc,
    "round": np.rint,
    "rint": np.rint,
    "fract": lambda x: x - np.floor(x),
    "saturate": lambda x: np.clip(x, np.float32(0.0), _ONE),
    "radians": np.radians,
    "degrees": np.degrees,
    "atan2": np.arctan2,
    "pow": np.power,
    "fmod": np.fmod,
    "hypot": np.hypot,
    "copysign": np.copysign,
    "fma": lambda a, b, c: (a.astype(np.float64) * b + c).astype(a.dtype),
    "lerp": lambda a, b, t: a + t * (b - a),
    "mix": lambda a, b, t: a + t * (b - a),
    "step": lambda edge, x: np.where(x < edge, np.float32(0.0), _ONE),
    "smoothstep": _smoothstep,
    "dot": _dot,
    "cross": np.cross,
    "length": lambda v: np.sqrt(_dot(v, v)),
    "length_squared": lambda v: _dot(v, v),
    "distance": lambda a, b: np.sqrt(_dot(a - b, a - b)),
    "normalize": lambda v: v / np.sqrt(_dot(v, v)),
    "reflect": lambda i, n: i - np.float32(2.0) * _dot(n, i) * n,
    "refract": _refract,
    "faceforward": lambda n, i, reference: n if _dot(reference, i) < 0 else -n,
    "isnan": np.isnan,
    "isinf": np.isinf,
    "isfinite": np.isfinite,
}
_NUMBER_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "abs": np.abs,
    "sign": np.sign,
    "min": lambda *values: functools.reduce(lambda a, b: np.where(a < b, a, b), values),
    "max": lambda *values: functools.reduce(lambda a, b: np.where(a > b, a, b), values),
    "clamp": lambda x, low, high: np.where(low > np.where(x < high, x, high), low, np.where(x < high, x, high)),
}
_BIT_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "float_as_uint": lambda x: int(np.float32(x).view(np.uint32)),
    "float_as_int": lambda x: int(np.float32(x).view(np.int32)),
    "uint_as_float": lambda x: float(np.uint32(x).view(np.float32)),
    "int_as_float": lambda x: float(np.int32(x).view(np.float32)),
    "popcount": lambda x: (int(x) & 0xFFFFFFFF).bit_count(),
    "clz": lambda x: 32 - (int(x) & 0xFFFFFFFF).bit_length(),
    "ctz": lambda x: ((int(x) & -int(x)) & 0xFFFFFFFF).bit_length() - 1 if int(x) & 0xFFFFFFFF else 32,
    "reverse_bits": lambda x: int(f"{int(x) & 0xFFFFFFFF:032b}"[::-1], 2),
    "mul_hi": lambda a, b: (int(a) * int(b)) >> 32,
}
_MATRIX_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "transpose": lambda m: float3x3(np.asarray(m).T),
    "determinant": lambda m: float(np.float32(np.linalg.det(np.asarray(m)))),
    "inverse": lambda m: float3x3(np.linalg.inv(np.asarray(m))),
}


def evaluate(name: str, arguments: tuple[Any, ...]) -> Any:
    """The value of a pure function of mathematics; KeyError for any other device function."""
    if name in _BIT_FUNCTIONS:
        return _BIT_FUNCTIONS[name](*arguments)
    if name in _MATRIX_FUNCTIONS:
        return _MATRIX_FUNCTIONS[name](*arguments)
    whole = name in _NUMBER_FUNCTIONS
    function = _NUMBER_FUNCTIONS[name] if whole else _FLOAT_FUNCTIONS[name]
    vector = next((argument for argument in arguments if isinstance(argument, Vector)), None)
    if vector is not None:
        dtype: Any = vector.element
    else:
        dtype = np.int32 if whole and all(isinstance(argument, int) for argument in arguments) else np.float32
    values = [_as_array(argument, dtype) for argument in arguments]
    with np.errstate(all="ignore"):
        result = np.asarray(function(*values))
    if result.ndim == 0:
        return result.item()
    family = vector.family if vector is not None and result.dtype.kind != "b" else "bool"
    return vector_class(family, len(result))(*result.tolist())


def _as_array(value: Any, dtype: Any) -> _Array:
    if isinstance(value, Matrix) or not isinstance(value, Vector | int | float | np.number):
        raise TypeError(f"functions of mathematics take numbers and vectors, not {type(value).__name__}")
    return np.asarray(value, dtype)
