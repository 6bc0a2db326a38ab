"""Numbers as C++ source text, exact to the last bit."""

from __future__ import annotations

import math
import struct

from optixc.ir.types import Scalar, ScalarKind

_INT_LOWEST = {32: -(2**31), 64: -(2**63)}


def number(value: bool | int | float, scalar: Scalar) -> str:
    """The C++ expression of one number of type `scalar`."""
    match scalar.kind:
        case ScalarKind.BOOL:
            return "true" if value else "false"
        case ScalarKind.FLOAT:
            return _floating(float(value), scalar.bits)
        case ScalarKind.INT | ScalarKind.UINT:
            return _integer(int(value), scalar)


def _integer(value: int, scalar: Scalar) -> str:
    is_signed = scalar.kind is ScalarKind.INT
    if scalar.bits < 32:
        return f"{'' if is_signed else 'u'}int{scalar.bits}_t({value})"
    if is_signed and value == _INT_LOWEST[scalar.bits]:
        return f"INT{scalar.bits}_MIN"
    if scalar.bits == 64:
        return f"INT64_C({value})" if is_signed else f"UINT64_C({value})"
    return str(value) if is_signed else f"{value}u"


def _floating(value: float, bits: int) -> str:
    if bits < 64:
        value = round_to_float32(value)
    if math.isnan(value):
        return '__builtin_nan("")' if bits == 64 else '__builtin_nanf("")'
    if math.isinf(value):
        text = "__builtin_inf()" if bits == 64 else "__builtin_inff()"
        return text if value > 0 else "-" + text
    text = repr(value) if bits == 64 else shortest_float32(value)
    if "e" not in text and "." not in text:
        text += ".0"
    text = text.replace("e+", "e")
    return text if bits == 64 else f"oxrt::half({text}f)" if bits == 16 else text + "f"


def round_to_float32(value: float) -> float:
    """The nearest binary32 number, infinite beyond its range."""
    try:
        rounded: float = struct.unpack("f", struct.pack("f", value))[0]
    except OverflowError:
        return math.copysign(math.inf, value)
    return rounded


def shortest_float32(value: float) -> str:
    """The fewest decimal digits that read back as the same finite binary32 number."""
    exact = round_to_float32(value)
    for digits in range(1, 10):
        text = f"{exact:.{digits}g}"
        if round_to_float32(float(text)) == exact:
            return repr(float(text))
    raise AssertionError(f"{value!r} has no float32 text")
