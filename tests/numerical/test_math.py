"""The maths of device code: measured errors against long double, the same bits for scalars and lanes, Python's rules for integers.

The bounds are the promises: 1 ulp in precise mode, 4 ulp with `math="fast"`.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from math_kernels import FROM_FLOAT, INTEGERS, ONE, SPECIAL, TWO, Kernels, build_kernels, errors, exact, pairs, samples

from optixc.toolchain import find_compiler, processor_lanes

TRANSCENDENTAL = "sqrt rsqrt sin cos tan asin acos atan sinh cosh tanh exp exp2 log log2 log10".split()
COUNT = 200_000
WIDTHS = [lanes for lanes in (1, 8, 16) if lanes <= processor_lanes()]


@pytest.fixture(scope="module")
def build(tmp_path_factory: pytest.TempPathFactory) -> Callable[[int, bool], Kernels]:
    """Kernels by lanes and mode, built once."""
    folder, built = tmp_path_factory.mktemp("math"), dict[tuple[int, bool], Kernels]()

    def of(lanes: int, is_fast: bool) -> Kernels:
        if (lanes, is_fast) not in built:
            built[lanes, is_fast] = build_kernels(folder, find_compiler(), lanes, is_fast)
        return built[lanes, is_fast]

    return of


@pytest.mark.parametrize("name", TRANSCENDENTAL)
@pytest.mark.parametrize(("is_fast", "bound"), [(False, 1.0), (True, 4.0)], ids=["precise", "fast"])
def test_functions_of_one_argument(build: Callable[[int, bool], Kernels], name: str, is_fast: bool, bound: float) -> None:
    x = samples(COUNT)
    found = errors(build(1, is_fast).call(name, x), exact(name, x))
    worst = int(np.argmax(found))
    assert found[worst] <= bound, f"{name}({x[worst]!r}) is {found[worst]:.3f} ulp off"


@pytest.mark.parametrize("name", ["pow", "atan2", "hypot", "fmod"])
@pytest.mark.parametrize(("is_fast", "bound"), [(False, 1.0), (True, 4.0)], ids=["precise", "fast"])
def test_functions_of_two_arguments(build: Callable[[int, bool], Kernels], name: str, is_fast: bool, bound: float) -> None:
    x, y = pairs(COUNT)
    found = errors(build(1, is_fast).call(name, x, y), exact(name, x, y))
    worst = int(np.argmax(found))
    assert found[worst] <= bound, f"{name}({x[worst]!r}, {y[worst]!r}) is {found[worst]:.3f} ulp off"


@pytest.mark.parametrize("lanes", [lanes for lanes in WIDTHS if lanes > 1])
@pytest.mark.parametrize("is_fast", [False, True], ids=["precise", "fast"])
def test_lanes_give_the_bits_of_scalars(build: Callable[[int, bool], Kernels], lanes: int, is_fast: bool) -> None:
    scalar, wide = build(1, is_fast), build(lanes, is_fast)
    x, y = pairs(COUNT)
    for name in (*ONE, *TWO):
        arguments = (x,) if name in ONE else (x, y)
        a, b = scalar.call(name, *arguments), wide.call(name, *arguments)
        differs = (a.view(np.uint32) != b.view(np.uint32)) & ~(np.isnan(a) & np.isnan(b))
        assert not differs.any(), f"{name}{tuple(v[differs][0] for v in arguments)}: {a[differs][0]!r} and {b[differs][0]!r}"


# ---- conversions and integers --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("lanes", WIDTHS)
@pytest.mark.parametrize("name", list(FROM_FLOAT))
def test_floats_become_integers_truncated_and_saturated(build: Callable[[int, bool], Kernels], name: str, lanes: int) -> None:
    x = np.concatenate([samples(2000), np.array([2.0**31, 2.0**32, 2.0**63, 2.0**64, -(2.0**31), -(2.0**63)], np.float32)])
    limits = np.iinfo(FROM_FLOAT[name])
    wanted = [0 if math.isnan(v) else int(np.clip(v, limits.min, limits.max)) if math.isinf(v) else int(v) for v in map(float, x)]
    got = build(lanes, False).call(f"to_{name}", x, result=FROM_FLOAT[name])
    assert got.tolist() == [min(max(v, limits.min), limits.max) for v in wanted]


def wrapped(value: int, bits: int, is_signed: bool) -> int:
    """The value modulo 2^bits, in the type's range."""
    value &= (1 << bits) - 1
    return value - (1 << bits) if is_signed and value >> (bits - 1) else value


def python_integer(name: str, a: int, b: int, bits: int, is_signed: bool) -> int:
    """What a program must get: Python's rules, wrapping; 0 for division by zero."""
    match name:
        case "floorDivide":
            result = a // b if b else 0
        case "modulo":
            result = a % b if b else 0
        case "shiftLeft":
            result = a << b if 0 <= b < bits else 0
        case "shiftRight":
            result = a >> b if 0 <= b < bits else (-1 if a < 0 else 0)
        case "power":
            result = pow(a, b, 1 << bits) if b >= 0 else {1: 1, -1: -1 if b & 1 else 1}.get(a, 0)
        case _:
            result = min(a, b) if name == "min" else max(a, b)
    return wrapped(result, bits, is_signed)


@pytest.mark.parametrize("lanes", WIDTHS)
@pytest.mark.parametrize("type_name", ["int32_t", "uint32_t", "int64_t", "uint64_t"])
def test_integers_follow_python(build: Callable[[int, bool], Kernels], type_name: str, lanes: int) -> None:
    dtype = FROM_FLOAT[type_name]
    limits = np.iinfo(dtype)
    generator = np.random.default_rng(4)
    candidates = (0, 1, -1, 2, -2, 3, 7, -7, 31, 32, 33, 63, 64, 65, limits.min, limits.min + 1, limits.max)
    edges = np.array([v for v in candidates if limits.min <= v <= limits.max], dtype)
    a, b = (grid.ravel() for grid in np.meshgrid(edges, edges))
    a = np.concatenate([a, generator.integers(limits.min, limits.max, 3000, dtype, endpoint=True)])
    small = generator.integers(max(limits.min, -40), 40, 1500, dtype)
    b = np.concatenate([b, small, generator.integers(limits.min, limits.max, 1500, dtype)])
    for name in INTEGERS:
        wanted = [python_integer(name, int(p), int(q), limits.bits, limits.min < 0) for p, q in zip(a, b, strict=True)]
        got = build(lanes, False).call(f"{type_name}_{name}", a, b)
        wrong = np.nonzero(got != np.array(wanted, dtype))[0]
        assert not len(wrong), f"{name}({a[wrong[0]]}, {b[wrong[0]]}) = {got[wrong[0]]}, not {wanted[wrong[0]]}"


# ---- floats as in Python -----------------------------------------------------------------------------------------------------------


def to_float32(value: float) -> float:
    return float(np.float32(value))


finite = st.floats(width=32, allow_nan=False, allow_infinity=False)


@settings(max_examples=300, deadline=None)
@given(a=finite, b=finite.filter(lambda v: v != 0.0))
def test_modulo_of_floats_is_pythons(build: Callable[[int, bool], Kernels], a: float, b: float) -> None:
    got = float(build(1, False).call("modulo", np.array([a], np.float32), np.array([b], np.float32))[0])
    rest = math.fmod(a, b)
    shifted = to_float32(np.float32(rest) + np.float32(b)) if (rest < 0) != (b < 0) else rest
    wanted = math.copysign(0.0, b) if rest == 0.0 else shifted
    assert struct.pack("f", got) == struct.pack("f", wanted)


def test_smaller_and_larger_are_the_conditional_expressions(build: Callable[[int, bool], Kernels]) -> None:
    a, b = (grid.ravel().astype(np.float32) for grid in np.meshgrid(SPECIAL, SPECIAL))
    for lanes in WIDTHS:
        with np.errstate(invalid="ignore"):
            assert (build(lanes, False).call("min", a, b).view(np.uint32) == np.where(a < b, a, b).view(np.uint32)).all()
            assert (build(lanes, False).call("max", a, b).view(np.uint32) == np.where(a > b, a, b).view(np.uint32)).all()


def test_round_is_to_even(build: Callable[[int, bool], Kernels]) -> None:
    x = np.array([0.5, 1.5, 2.5, -0.5, -1.5, 3.49999], np.float32)
    for lanes in WIDTHS:
        assert build(lanes, False).call("round", x).tolist() == [float(round(float(v))) for v in x]
