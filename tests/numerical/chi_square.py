"""Chi-square tests of samplers of directions, and quadrature over the sphere."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

Density = Callable[[np.ndarray], np.ndarray]
LATITUDES, LONGITUDES = 32, 64


def sphere_cells(subdivisions: int, lower: float = -1.0, upper: float = 1.0) -> tuple[np.ndarray, float]:
    """Midpoints (n, 3) of a grid of equal solid angle between two heights, cell by cell, and the solid angle of one of them."""
    rows, columns = LATITUDES * subdivisions, LONGITUDES * subdivisions
    z = lower + (upper - lower) * (np.arange(rows) + 0.5) / rows
    phi = 2.0 * np.pi * (np.arange(columns) + 0.5) / columns
    z, phi = np.meshgrid(z, phi, indexing="ij")
    radius = np.sqrt(1.0 - z * z)
    points = np.stack([radius * np.cos(phi), radius * np.sin(phi), z], axis=-1)
    blocks = points.reshape(LATITUDES, subdivisions, LONGITUDES, subdivisions, 3).transpose(0, 2, 1, 3, 4)
    return blocks.reshape(-1, 3), 2.0 * np.pi * (upper - lower) / (rows * columns)


def integral(values: np.ndarray, cell: float) -> np.ndarray:
    """Integral over the sphere of values at `sphere_cells`."""
    return values.astype(np.float64).sum(axis=0) * cell


def probabilities(density: Density, subdivisions: int, lower: float = -1.0, upper: float = 1.0) -> np.ndarray:
    """What share of the samples each cell should get."""
    points, cell = sphere_cells(subdivisions, lower, upper)
    return density(points).astype(np.float64).reshape(LATITUDES * LONGITUDES, -1).sum(axis=1) * cell


def histogram(directions: np.ndarray, lower: float = -1.0, upper: float = 1.0) -> np.ndarray:
    """How many directions fall into each cell."""
    row = np.clip(((directions[:, 2] - lower) / (upper - lower) * LATITUDES).astype(int), 0, LATITUDES - 1)
    phi = np.arctan2(directions[:, 1], directions[:, 0]) % (2.0 * np.pi)
    column = np.clip((phi / (2.0 * np.pi) * LONGITUDES).astype(int), 0, LONGITUDES - 1)
    return np.bincount(row * LONGITUDES + column, minlength=LATITUDES * LONGITUDES)


def p_value(observed: np.ndarray, expected: np.ndarray) -> float:
    """Probability of a deviation at least this large; cells that expect fewer than five are put together.

    Wilson and Hilferty's normal approximation of the chi-square distribution, good to a percent at these degrees of freedom.
    """
    order = np.argsort(expected)
    observed, expected = observed[order].astype(np.float64), expected[order]
    small = int(np.searchsorted(expected, 5.0))
    pooled_observed, pooled_expected = observed[:small].sum(), expected[:small].sum()
    observed, expected = observed[small:], expected[small:]
    if pooled_expected >= 5.0:
        observed, expected = np.append(observed, pooled_observed), np.append(expected, pooled_expected)
    elif pooled_observed > pooled_expected + 6.0 * math.sqrt(pooled_expected) + 6.0:
        return 0.0
    degrees = len(expected) - 1
    statistic = float((((observed - expected) ** 2) / expected).sum())
    spread = 2.0 / (9.0 * degrees)
    z = ((statistic / degrees) ** (1.0 / 3.0) - (1.0 - spread)) / math.sqrt(spread)
    return 0.5 * math.erfc(z / math.sqrt(2.0))
