"""The hair model of the shader library: its density, its energy, the symmetry of its fibre; and points and tangents of curves."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from chi_square import integral, sphere_cells
from test_stdlib_sampling import check, unit_square

TILT = 0.035
FIBRES = [(0.4, 0.3, 0.0), (0.3, 0.5, TILT), (0.9, 0.9, TILT)]
VIEWS = [(0.0, 1.0, 0.0, 0.0), (0.6, 0.0, 0.8, 0.7), (-0.28, -0.9119210, 0.3, -0.95)]


@pytest.mark.parametrize("fibre", FIBRES)
@pytest.mark.parametrize("view", VIEWS)
def test_density(library: Any, view: tuple, fibre: tuple) -> None:
    check(library, "hair", view, (*fibre, 0.4), columns=4, subdivisions=8)


@pytest.mark.parametrize("fibre", FIBRES)
@pytest.mark.parametrize("view", VIEWS)
def test_clear_fibres_scatter_everything(library: Any, view: tuple, fibre: tuple) -> None:
    points, cell = sphere_cells(8)
    values = library.run("pdf_hair", points.astype(np.float32), view, (*fibre, 0.0))
    # The longitudinal density is normalised over the sphere, the azimuthal one cut off and rescaled: what is left is quadrature
    assert abs(integral(values[:, 0], cell) - 1.0) < 5e-3
    # Without colour each mode is drawn in proportion to what it carries, so every weight is 1
    weights = library.run("weight_hair", unit_square(4), view, (*fibre, 0.0))[:, 0]
    np.testing.assert_allclose(weights, 1.0, atol=2e-5)


@pytest.mark.parametrize("view", VIEWS)
def test_weights_integrate_the_scattering(library: Any, view: tuple) -> None:
    fibre = (*FIBRES[1], 0.8)
    points, cell = sphere_cells(8)
    albedo = integral(library.run("pdf_hair", points.astype(np.float32), view, fibre)[:, 0], cell)
    weights = library.run("weight_hair", unit_square(4), view, fibre)[:, 0].astype(np.float64)
    assert albedo < 0.9
    assert abs(weights.mean() - albedo) < 5.0 * weights.std() / np.sqrt(len(weights)) + 5e-3


def test_the_two_halves_of_a_fibre_mirror_each_other(library: Any) -> None:
    points, _ = sphere_cells(1)
    mirrored = points * [1.0, 1.0, -1.0]
    fibre = (*FIBRES[1], 0.2)
    one = library.run("pdf_hair", points.astype(np.float32), (0.6, 0.8, 0.0, 0.5), fibre)
    other = library.run("pdf_hair", mirrored.astype(np.float32), (0.6, 0.8, 0.0, -0.5), fibre)
    np.testing.assert_allclose(one, other, rtol=2e-4, atol=1e-6)


@pytest.mark.parametrize("basis", [0.0, 1.0])
def test_curve_tangents_are_derivatives(library: Any, basis: float) -> None:
    step = 2.0**-8
    u = np.linspace(0.0, 1.0, 65, dtype=np.float32)[:, np.newaxis]
    points = [library.run("cubic_bspline", (u + offset).astype(np.float32), (0.0, basis)) for offset in (-step, step)]
    tangents = library.run("cubic_bspline", u, (1.0, basis))[:, :3]
    # The third derivative of a cubic is a constant of at most 3 here, so the difference quotient errs by at most step**2 / 2 and rounding
    np.testing.assert_allclose((points[1] - points[0])[:, :3] / (2.0 * step), tangents, atol=0.5 * step**2 * 3.0 + 2.0**-23 / step * 4.0)


def test_curves_begin_where_their_bases_say(library: Any) -> None:
    ends = np.array([[0.0], [1.0]], np.float32)
    bspline = library.run("cubic_bspline", ends, (0.0, 0.0))
    np.testing.assert_allclose(bspline, [[5 / 6, 1 / 6, 0, 2], [1, 5 / 6, 1 / 6, 3]], atol=1e-6)
    np.testing.assert_allclose(library.run("cubic_bspline", ends, (0.0, 1.0)), [[1, 0, 0, 2], [1, 1, 0, 3]], atol=1e-6)
