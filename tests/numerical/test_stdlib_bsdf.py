"""BSDFs of the shader library: densities, reciprocity, energy, and furnaces of known brightness."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from chi_square import integral, sphere_cells
from test_stdlib_sampling import check, unit_square

DIRECTIONS = [(0.0, 0.0, 1.0), (0.6, 0.0, 0.8), (0.28, -0.9119210, 0.3)]
ROUGHNESS = [(0.5, 0.5), (0.8, 0.3)]
MATERIALS = [
    ((0.8, 0.4, 0.2, 0.0), (0.6, 0.5, 0.0, 0.0)),
    ((0.9, 0.9, 0.9, 1.0), (0.7, 0.5, 0.8, 0.0)),
    ((0.5, 0.5, 0.9, 0.3), (0.8, 1.0, 0.3, 1.0)),
]


def upper_directions(count: int) -> np.ndarray:
    random = np.random.default_rng(4)
    w = random.normal(size=(count, 3))
    w /= np.linalg.norm(w, axis=1, keepdims=True)
    w[:, 2] = np.abs(w[:, 2]) * 0.98 + 0.02
    return (w / np.linalg.norm(w, axis=1, keepdims=True)).astype(np.float32)


@pytest.mark.parametrize("wo", DIRECTIONS)
def test_lambert_density(library: Any, wo: tuple) -> None:
    check(library, "lambert", wo)


@pytest.mark.parametrize("roughness", ROUGHNESS)
@pytest.mark.parametrize("wo", DIRECTIONS)
def test_visible_normals_density(library: Any, wo: tuple, roughness: tuple) -> None:
    check(library, "visible_normal", wo, roughness, subdivisions=8)


@pytest.mark.parametrize("roughness", ROUGHNESS)
@pytest.mark.parametrize("wo", DIRECTIONS)
def test_conductor_density(library: Any, wo: tuple, roughness: tuple) -> None:
    check(library, "conductor", wo, roughness, subdivisions=8)


@pytest.mark.parametrize("index", [1.5, 1.0 / 1.5])
@pytest.mark.parametrize("roughness", ROUGHNESS)
@pytest.mark.parametrize("wo", [*DIRECTIONS, (0.6, 0.0, -0.8)])
def test_dielectric_density(library: Any, wo: tuple, roughness: tuple, index: float) -> None:
    check(library, "dielectric", (*wo, index), roughness, columns=3, subdivisions=16)


@pytest.mark.parametrize("roughness", ROUGHNESS)
@pytest.mark.parametrize("wo", DIRECTIONS)
def test_conductor_weights_integrate_the_brdf(library: Any, wo: tuple, roughness: tuple) -> None:
    points, cell = sphere_cells(8, 0.0, 1.0)
    values = library.run("pdf_conductor", points.astype(np.float32), wo, roughness)[:, 0]
    albedo = integral(values * points[:, 2], cell)
    weights = library.run("weight_conductor", unit_square(), wo, roughness)[:, 0].astype(np.float64)
    assert abs(weights.mean() - albedo) < 5.0 * weights.std() / np.sqrt(len(weights)) + 2e-3
    assert albedo < 1.0


@pytest.mark.parametrize("index", [1.5, 1.0 / 1.5])
@pytest.mark.parametrize("wo", DIRECTIONS)
def test_dielectric_weights_integrate_the_bsdf(library: Any, wo: tuple, index: float) -> None:
    points, cell = sphere_cells(16)
    values = library.run("pdf_dielectric", points.astype(np.float32), (*wo, index), (0.5, 0.5))[:, 0]
    albedo = integral(values * np.abs(points[:, 2]), cell)
    weights = library.run("weight_dielectric", unit_square(3), (*wo, index), (0.5, 0.5))[:, 0].astype(np.float64)
    assert abs(weights.mean() - albedo) < 5.0 * weights.std() / np.sqrt(len(weights)) + 5e-3
    assert albedo <= 1.0 + 1e-3


def test_nearly_smooth_glass_loses_nothing(library: Any) -> None:
    # Masking of a surface of roughness alpha takes about alpha squared; 1 - E < 1e-3 at alpha 0.01 away from grazing
    for wo in DIRECTIONS[:2]:
        weights = library.run("weight_dielectric", unit_square(3), (*wo, 1.5), (0.01, 0.01))[:, 0].astype(np.float64)
        assert abs(weights.mean() - 1.0) < 1e-3


@pytest.mark.parametrize("wo", DIRECTIONS)
def test_lambert_furnace(library: Any, wo: tuple) -> None:
    points, cell = sphere_cells(4, 0.0, 1.0)
    values = library.run("pdf_lambert", points.astype(np.float32), wo)[:, 0]
    # Midpoints of cells of equal height integrate a function that is linear in height exactly
    assert abs(integral(values * points[:, 2], cell) - 1.0) < 1e-5


@pytest.mark.parametrize("roughness", ROUGHNESS)
@pytest.mark.parametrize("wo", DIRECTIONS)
def test_conductor_reciprocity(library: Any, wo: tuple, roughness: tuple) -> None:
    wi = upper_directions(5000)
    forward = library.run("pdf_conductor", wi, wo, roughness)[:, 0]
    backward = library.run("reverse_conductor", wi, wo, roughness)[:, 0]
    assert (forward > 0.0).all()
    np.testing.assert_allclose(forward, backward, rtol=2e-4)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_dielectric_reciprocity(library: Any, side: float) -> None:
    wi = upper_directions(5000) * np.float32([1.0, 1.0, side])
    wo = (0.3, 0.1, np.sqrt(1.0 - 0.1))
    forward = library.run("pdf_dielectric", wi, (*wo, 1.5), (0.6, 0.6))[:, 0]
    backward = library.run("reverse_dielectric", wi, (*wo, 1.5), (0.6, 0.6))[:, 0]
    assert (forward > 0.0).any()
    np.testing.assert_allclose(forward, backward, rtol=2e-3, atol=1e-6)


@pytest.mark.parametrize(("a", "b"), MATERIALS)
@pytest.mark.parametrize("cosine", [1.0, 0.7, 0.2])
def test_principled(library: Any, a: tuple, b: tuple, cosine: float) -> None:
    wi = upper_directions(2000)
    rows = np.column_stack([wi, np.full(len(wi), cosine)]).astype(np.float32)
    forward = library.run("pdf_principled", rows, a, b)[:, :3]
    backward = library.run("reverse_principled", rows, a, b)[:, :3]
    assert (forward > 0.0).all()
    np.testing.assert_allclose(forward, backward, rtol=1e-3, atol=1e-6)

    # Energy, and that the weights integrate the BRDF
    points, cell = sphere_cells(8, 0.0, 1.0)
    rows = np.column_stack([points, np.full(len(points), cosine)]).astype(np.float32)
    evaluated = library.run("pdf_principled", rows, a, b)
    albedo = integral(evaluated[:, :3] * points[:, 2:], cell)
    u = np.column_stack([unit_square(3), np.full(len(unit_square(3)), cosine)]).astype(np.float32)
    weights = library.run("weight_principled", u, a, b)[:, :3].astype(np.float64)
    assert (np.abs(weights.mean(axis=0) - albedo) < 5.0 * weights.std(axis=0) / np.sqrt(len(weights)) + 0.01).all()
    assert albedo.max() < 1.0
    assert integral(evaluated[:, 3], cell) < 1.0 + 0.01


@pytest.mark.parametrize("index", [1.5, 1.0 / 1.5])
def test_smooth_glass_bends_by_snell(library: Any, index: float) -> None:
    wo = (0.6, 0.0, 0.8)
    drawn = library.run("smooth_dielectric", unit_square(1, 10000), (*wo, index)).astype(np.float64)
    refracted = drawn[drawn[:, 2] < 0.0]
    assert len(refracted) > 0
    np.testing.assert_allclose(refracted[:, 0], -0.6 / index, rtol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(drawn[:, :3], axis=1), 1.0, rtol=1e-6)
    # Fresnel's equations for 36.87 degrees
    cosine_t = np.sqrt(1.0 - (0.6 / index) ** 2)
    parallel = (index * 0.8 - cosine_t) / (index * 0.8 + cosine_t)
    perpendicular = (0.8 - index * cosine_t) / (0.8 + index * cosine_t)
    reflectance = 0.5 * (parallel**2 + perpendicular**2)
    assert abs((drawn[:, 2] > 0.0).mean() - reflectance) < 5.0 * np.sqrt(reflectance / len(drawn))
