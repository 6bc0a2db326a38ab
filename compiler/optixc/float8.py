"""Floating-point numbers of 8 bits: what of a number FLOAT8_E4M3 and FLOAT8_E5M2 keep.

Nothing here stores them: a matrix in an optimal layout holds the numbers as float32.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from optixc.enums_extensions import CoopVecElemType as Element

_FORMATS = {Element.FLOAT8_E4M3: (3, -6, 448.0), Element.FLOAT8_E5M2: (2, -14, 57344.0)}
"""Bits behind the leading one, exponent of the smallest normal number, largest number."""


@cache
def _numbers(element: Element) -> NDArray[np.float64]:
    """All numbers from zero upwards, in the order of their codes."""
    mantissa, lowest, largest = _FORMATS[element]
    steps = 1 << mantissa
    small = np.arange(steps) * 2.0 ** (lowest - mantissa)
    normal = [(1.0 + i / steps) * 2.0**e for e in range(lowest, 17) for i in range(steps)]
    every = np.concatenate((small, np.array(normal)))
    return every[every <= largest]


def rounded(values: NDArray[np.float32], element: Element) -> NDArray[np.float32]:
    """The nearest numbers of the format, ties to even; beyond the largest that one, NaN stays."""
    numbers = _numbers(element)
    magnitude = np.minimum(np.abs(values.astype(np.float64)), numbers[-1])
    above = np.clip(np.searchsorted(numbers, magnitude), 1, len(numbers) - 1)
    low, high = numbers[above - 1], numbers[above]
    middle = (low + high) / 2.0
    takes_high = (magnitude > middle) | ((magnitude == middle) & (above % 2 == 0))
    nearest = np.where(takes_high, high, low)
    return np.where(np.isnan(values), values, np.copysign(nearest, values)).astype(np.float32)
