"""The differences that the comparison with recorded results accepts are all told in the documentation, in the same words."""

from __future__ import annotations

from pathlib import Path

import pytest
from harness import Harness
from oracle_differences import REASONS
from oracle_not_copied import NOT_COPIED
from scenes import closest, gas, hitgroup, missed, ray, trace, triangles
from test_spheres import spheres

PAGE = (Path(__file__).parents[2] / "docs" / "differences.md").read_text()
NEXT_TO_ZERO = 2.0**-64


@pytest.mark.parametrize("name", REASONS)
def test_every_difference_is_told(name: str) -> None:
    assert f"| {name} | {REASONS[name]} |" in PAGE


@pytest.mark.parametrize("there", NOT_COPIED)
def test_what_is_not_copied_is_told(there: str) -> None:
    assert f"| {there} | {NOT_COPIED[there]} |" in PAGE


def test_hits_next_to_the_origin_begin_at_two_to_the_minus_64(harness: Harness) -> None:
    rays = [ray((0.25, 0.25, z)) for z in (NEXT_TO_ZERO / 4, NEXT_TO_ZERO * 4)]
    below, above = trace(harness, [gas(triangles(((0, 0, 0), (1, 0, 0), (0, 1, 0))))], rays)
    assert missed(below)
    assert closest(above)["tmax"] == NEXT_TO_ZERO * 4
    below, above = trace(harness, [gas(spheres([(0, 0, -1)], [1]))], [ray((0, 0, 0)), ray((0, 0, 0.5))], [hitgroup(kind="sphere")])
    assert missed(below)
    assert closest(above)["tmax"] == 0.5


@pytest.mark.parametrize("unit", [1e-14, 1e12])
def test_any_unit_of_length_will_do(harness: Harness, unit: float) -> None:
    assert "edges and distances from 1e-14 to 1e12 are hit alike" in PAGE
    corners = [[coordinate * unit for coordinate in corner] for corner in ((0, 0, 0), (1, 0, 0), (0, 1, 0))]
    (result,) = trace(harness, [gas(triangles(corners))], [ray((0.25 * unit, 0.25 * unit, 3.0 * unit))])
    assert closest(result)["tmax"] == pytest.approx(3.0 * unit, rel=1e-6)


@pytest.mark.parametrize("length", [1e-17, 1e18])
def test_any_length_of_direction_will_do(harness: Harness, length: float) -> None:
    (result,) = trace(harness, [gas(triangles(((0, 0, 0), (1, 0, 0), (0, 1, 0))))], [ray((0.25, 0.25, 3.0), (0, 0, -length), tmax=1e30)])
    assert closest(result)["tmax"] == pytest.approx(3.0 / length, rel=1e-6)
