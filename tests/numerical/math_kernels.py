"""Loops over the maths of oxrt/math.h as a small library: one function of arrays per function of numbers, for scalars and for lanes."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optixc.installation import include_folder
from optixc.toolchain import Build, Compiler, compile_shared

ONE = "sqrt rsqrt sin cos tan asin acos atan sinh cosh tanh exp exp2 log log2 log10 floor ceil round trunc fract abs sign".split()
TWO = "pow atan2 hypot fmod modulo floorDivide min max copysign".split()
INTEGERS = "floorDivide modulo shiftLeft shiftRight power min max".split()
FROM_FLOAT = {"int32_t": np.int32, "uint32_t": np.uint32, "int64_t": np.int64, "uint64_t": np.uint64}

Floats = NDArray[np.float32]

_HEAD = """
#include <oxrt/device.h>
{include}
namespace {{
template <class T> using Value = {value};
enum {{ STEP = {lanes} }};
template <class T> Value<T> at(const T* values) {{
    Value<T> result;
    __builtin_memcpy(&result, values, sizeof(result));
    return result;
}}
template <class T> void put(T* values, const Value<T>& value) {{ __builtin_memcpy(values, &value, sizeof(value)); }}
}}
#define KERNEL extern "C" __attribute__((visibility("default"))) void
"""
_ONE = "KERNEL {name}(const float* x, float* y, long n) {{ for (long i = 0; i < n; i += STEP) put(y + i, oxrt::{name}(at(x + i))); }}\n"
_TWO = (
    "KERNEL {prefix}{name}(const {type}* x, const {type}* z, {type}* y, long n)"
    " {{ for (long i = 0; i < n; i += STEP) put(y + i, oxrt::{name}(at(x + i), at(z + i))); }}\n"
)
_CONVERT = (
    "KERNEL to_{type}(const float* x, {type}* y, long n)"
    " {{ for (long i = 0; i < n; i += STEP) put(y + i, oxrt::convert<{type}>(at(x + i))); }}\n"
)


@dataclass
class Kernels:
    """One built library; `lanes` is 1, 8 or 16."""

    lanes: int
    is_fast: bool
    library: ctypes.CDLL

    def call(self, name: str, *arguments: NDArray[Any], result: Any = None) -> NDArray[Any]:
        """The function applied to whole arrays of one length."""
        count = len(arguments[0])
        padded = [np.concatenate([a, np.ones(-count % 16, a.dtype)]) for a in arguments]
        output = np.empty(len(padded[0]), result or arguments[0].dtype)
        pointers = [a.ctypes.data_as(ctypes.c_void_p) for a in (*padded, output)]
        getattr(self.library, name)(*pointers, ctypes.c_long(len(output)))
        return output[:count]


def build_kernels(folder: Path, compiler: Compiler, lanes: int, is_fast: bool) -> Kernels:
    """Compiles the kernels for `lanes` numbers at once."""
    include = "#include <oxrt/lanes.h>" if lanes > 1 else ""
    value = f"oxrt::Lanes<T, {lanes}>" if lanes > 1 else "T"
    text = ("#define OXRT_FAST_MATH\n" if is_fast else "") + _HEAD.format(include=include, value=value, lanes=lanes)
    text += "".join(_ONE.format(name=name) for name in ONE)
    text += "".join(_TWO.format(prefix="", name=name, type="float") for name in TWO)
    for type_ in ("int32_t", "uint32_t", "int64_t", "uint64_t"):
        text += "".join(_TWO.format(prefix=f"{type_}_", name=name, type=type_) for name in INTEGERS)
        text += _CONVERT.format(type=type_)
    output = folder / f"math_{lanes}{'_fast' if is_fast else ''}.so"
    target = {1: "native", 8: "x86-64-v3", 16: "x86-64-v4"}[lanes]
    compile_shared(text, output, compiler, Build(include_folder(), target, 2, False, False))
    return Kernels(lanes, is_fast, ctypes.CDLL(str(output)))


# ---- samples and errors -------------------------------------------------------------------------------------------------------------

SPECIAL = np.array(
    [0.0, -0.0, 1.0, -1.0, np.inf, -np.inf, np.nan, 1e-45, -1e-45, 1e-40, 3.4028235e38, -3.4028235e38, 0.5, -0.5, 2.0, -2.0, 3.0, -3.0,
     1.5, 1e6, 1e7, 1.17549435e-38, 88.8, -104.0, 8388608.0, 0.99999994, 1.0000001],
    np.float32,
)  # fmt: skip


def samples(count: int, seed: int = 1) -> Floats:
    """Any bit pattern, the ranges that programs use, and special values."""
    generator = np.random.default_rng(seed)
    anything = generator.integers(0, 2**32, count, dtype=np.uint32).view(np.float32)
    ranges = [generator.uniform(low, high, count // 2) for low, high in ((-1.0, 1.0), (-10.0, 10.0), (-110.0, 110.0), (0.5, 2.0))]
    return np.concatenate([SPECIAL, anything, *(values.astype(np.float32) for values in ranges)])


def pairs(count: int) -> tuple[Floats, Floats]:
    """First and second arguments: every pair of special values, and samples beside samples in another order."""
    values = samples(count)
    first, second = (grid.ravel() for grid in np.meshgrid(SPECIAL, SPECIAL))
    positive = np.random.default_rng(2).uniform(0.0, 10.0, count).astype(np.float32)
    other = np.random.default_rng(3).permutation(values)
    return np.concatenate([first, values, positive]), np.concatenate([second, other, other[:count]])


REFERENCES: dict[str, Any] = {
    "rsqrt": lambda x: 1 / np.sqrt(x), "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan, "pow": np.power, "atan2": np.arctan2,
}  # fmt: skip


def exact(name: str, *arguments: Floats) -> NDArray[np.longdouble]:
    """The function in long double, which has 11 bits more than double."""
    function = REFERENCES.get(name) or getattr(np, name)
    with np.errstate(all="ignore"):
        result: NDArray[np.longdouble] = function(*(argument.astype(np.longdouble) for argument in arguments))
    return result


def errors(got: Floats, wanted: NDArray[np.longdouble]) -> NDArray[np.float64]:
    """Errors in units in the last place of the exact result; infinite where NaN, infinity or a zero's sign is wrong."""
    with np.errstate(all="ignore"):
        rounded = wanted.astype(np.float32)
        same = (np.isnan(got) & np.isnan(rounded)) | ((got == rounded) & (np.signbit(got) == np.signbit(rounded)))
        unit = 2.0 ** (np.floor(np.log2(np.maximum(np.abs(wanted).astype(np.float64), 2.0**-126))) - 23)
        distance = np.abs(got.astype(np.longdouble) - wanted).astype(np.float64) / unit
    is_number = np.isfinite(got) & np.isfinite(rounded)
    return np.where(same, np.where(is_number, np.minimum(distance, 0.5), 0.0), np.where(is_number, distance, np.inf))
