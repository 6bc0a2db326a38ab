"""Every sampler of the shader library draws from the density that stands beside it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from chi_square import histogram, p_value, probabilities

from optixc.stdlib.environment import environment_map

COUNT = 200_000
SIGNIFICANCE = 1e-4


def unit_square(columns: int = 2, count: int = COUNT) -> np.ndarray:
    return np.random.default_rng(20).random((count, columns)).astype(np.float32).clip(0.0, 1.0 - 2.0**-24)


def check(library: Any, name: str, a: tuple = (), b: tuple = (), record: object = None, columns: int = 2, subdivisions: int = 4) -> None:
    """Directions follow the density; the density at each of them is what the sampler said; it integrates to the share drawn."""
    drawn = library.run(f"sample_{name}", unit_square(columns), a, b, record)
    directions = drawn[:, :3]
    valid = (directions != 0.0).any(axis=1)
    assert np.abs(np.linalg.norm(directions[valid].astype(np.float64), axis=1) - 1.0).max() < 1e-5

    def density(points: np.ndarray) -> np.ndarray:
        return library.run(f"pdf_{name}", points.astype(np.float32), a, b, record)[:, 3]

    expected = probabilities(density, subdivisions)
    assert p_value(histogram(directions[valid]), expected * COUNT) > SIGNIFICANCE
    # The share drawn is binomial; quadrature adds its own part
    share = valid.mean()
    assert abs(expected.sum() - share) < 5.0 * np.sqrt(share * (1.0 - share) / COUNT) + 0.01


@pytest.mark.parametrize("name", ["cosine_hemisphere", "uniform_hemisphere", "uniform_sphere"])
def test_hemispheres_and_sphere(library: Any, name: str) -> None:
    check(library, name)


@pytest.mark.parametrize("cosine", [0.0, 0.5, -0.5])
def test_cone(library: Any, cosine: float) -> None:
    # The boundaries lie between rows of cells, where quadrature is exact
    check(library, "uniform_cone", (cosine,))


@pytest.mark.parametrize("sphere", [(0.0, 0.0, 2.0, 1.5), (3.0, 1.0, -2.0, 3.0)])
def test_visible_sphere(library: Any, sphere: tuple) -> None:
    check(library, "visible_sphere", sphere, subdivisions=32)


def test_rectangle_light(library: Any) -> None:
    # A rectangle in front of and above the origin, facing it
    check(library, "rectangle_light", (-0.5, 0.6, 1.0), (1.5, 0.2, 0.1, -1.2), subdivisions=32)


def test_disk(library: Any) -> None:
    drawn = library.run("uniform_disk", unit_square())
    radius_squared = (drawn[:, :2].astype(np.float64) ** 2).sum(axis=1)
    assert radius_squared.max() <= 1.0 + 1e-6
    assert np.allclose(drawn[:, 3], 1.0 / np.pi)
    angle = np.arctan2(drawn[:, 1], drawn[:, 0]) % (2.0 * np.pi)
    cells = np.minimum((radius_squared * 16).astype(int), 15) * 32 + np.minimum((angle / (2.0 * np.pi) * 32).astype(int), 31)
    assert p_value(np.bincount(cells, minlength=512), np.full(512, COUNT / 512)) > SIGNIFICANCE


def test_triangle(library: Any) -> None:
    drawn = library.run("uniform_triangle", unit_square()).astype(np.float64)
    x, y = drawn[:, 0], drawn[:, 1]
    assert min(x.min(), y.min()) >= 0.0
    assert (x + y).max() <= 1.0 + 1e-6
    assert np.allclose(drawn[:, 3], 2.0)
    # A triangle's uniform points: 1 - sqrt(1 - x) ... in x and the place between the axes are uniform and independent
    first = 1.0 - (1.0 - x) ** 2
    second = np.clip(y / np.maximum(1.0 - x, 1e-12), 0.0, 1.0)
    cells = np.minimum((first * 20).astype(int), 19) * 20 + np.minimum((second * 20).astype(int), 19)
    assert p_value(np.bincount(cells, minlength=400), np.full(400, COUNT / 400)) > SIGNIFICANCE


def test_environment(library: Any) -> None:
    random = np.random.default_rng(5)
    rgb = random.random((16, 32, 3)).astype(np.float32) ** 4
    rgb[3] = 0.0
    rgb[5, 20] = 40.0
    check(library, "environment", record=environment_map(rgb), subdivisions=16)


def test_a_black_environment_is_drawn_all_over(library: Any) -> None:
    check(library, "environment", record=environment_map(np.zeros((8, 16, 3), np.float32)), subdivisions=16)
