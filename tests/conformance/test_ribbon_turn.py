"""Ribbons without normals lie as OptiX turns them: normals on the axis that were recorded from OptiX 9.0 (driver 580.159.04)."""

from __future__ import annotations

import numpy as np
import pytest
from harness import Harness
from oracle_compare import RIBBON_NORMAL
from shaders import curve_access as shader

import optixc as ox

# name, control points, normals on the axis where each segment begins and where the last one ends
RECORDED: list[tuple[str, list[tuple[float, ...]], list[tuple[float, ...]]]] = [
    ("wavy", [(0, 0, 0), (1, 1, 0), (2, 0, 0.5), (3, -1, 0), (4, 0, 0), (5, 0.5, 0), (6, 0, 0.25)], [(0.942809, -0.942809, 0.4714046),
     (-0.8579844, -0.2562823, 1.203404), (0.972509, 0.4470669, 1.050884), (-0.9949887, 0.9949887, 0.1414025), (-0.4990991, 0.9981982,
     -0.06708635), (0.52896, 1.012074, -0.09169206)]),
    ("curly", [(0, 0, 0), (1, 2, 0), (2, -1, 1), (3, 2, -1), (4, -2, 0), (5, 1, 1), (6, 0, 0)], [(1.954233, -0.9771165, 0.4756213),
     (-3.161968, -0.9339108, 0.3602352), (3.575385, -1.093004, 0.1481868), (-4.122378, -0.9506453, 0.319797), (3.16221, -0.9417936,
     -0.3368292), (-1.397589, -0.8860358, -0.511553)]),
    ("helix", [(1, 0, 0), (0.8253356, 0.5646425, 0.3), (0.3623578, 0.9320391, 0.6), (-0.2272021, 0.9738476, 0.9), (-0.7373937, 0.6754632,
     1.2), (-0.9899925, 0.14112, 1.5), (-0.8967584, -0.4425204, 1.8), (-0.4902608, -0.8715758, 2.1), (0.08749899, -0.9961646, 2.4)],
     [(-0.5893666, -0.2627662, 0.1514255), (-0.385897, -0.5355166, 0.06028418), (-0.03727061, -0.6614988, 0.01894363), (0.3371863,
     -0.5706133, 0.00589183), (0.5996293, -0.282436, 0.001826294), (0.6554208, 0.09785049, -0.01332679), (0.5007929, 0.4293958,
     -0.06445538), (0.2101894, 0.610098, -0.1514253)]),
    ("straight, then bent", [(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0), (4, 0, 0), (5, 0, 0), (6, 0, 0.3), (7, 0, 1.2), (8, 0, 2.7)],
     [(0, 0, 1), (0, 0, 1), (0, 0, 0.9999999), (0, 0, 0.9999999), (0, 0, 0.9999999), (-0.3, 0, 0.9999999), (-0.9000001, 0, 1), (-1.5, 0,
     1)]),
    ("edges of a grid", [(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0), (3, 1, 0), (3, 2, 0), (3, 2, 1), (3, 2, 2), (3, 2, 3), (3, 2, 4)],
     [(-0, 1, 0), (-0, 1, 0), (-0, 0.9999999, 0), (-0.8664026, 0, 0.499346), (-0.4931726, 0, 0.8699314), (0, -0.9999999, 0), (0, -1, 0),
     (0, -1, 0), (0, -0.9999999, 0)]),
    ("slowly turning", [(0, 0, 0), (0.9327864, 0, 0), (1.796001, 0.08437222, 0), (2.708985, 0.5728999, 0.06706719), (3.319183, 1.304717,
     0.1806609), (3.542328, 2.117255, 0.2988613), (3.546395, 2.904937, 0.4999287), (3.259357, 3.782596, 0.7494401), (2.764127, 4.650515,
     1.01232), (2.179096, 5.442728, 1.225051), (1.361849, 6.229869, 1.466174), (0.321866, 6.709581, 1.677634)], [(-0, 0.9241962,
     0.1263008), (-0.08349553, 0.8542451, 0.1247063), (-0.4928208, 0.8991399, 0.1592881), (-0.7393803, 0.5936231, 0.1474073), (-0.8166405,
     0.2068894, 0.1194929), (-0.8082747, -0.01759095, 0.08526134), (-0.9081176, -0.3002111, 0.01129538), (-0.902856, -0.4999782,
     -0.05013753), (-0.8173255, -0.5851295, -0.06869848), (-0.8168178, -0.817679, -0.09917235), (-0.509388, -1.035716, -0.1556275)]),
    ("long planes", [(-1.106807, -0.2695652, -0.2270871), (-0.9406832, 0.001883405, -0.4406991), (0.1962031, -2.137493, -0.4408636),
     (-0.5183814, -2.004979, -0.2201038), (-1.43021, -2.645928, 0.5724829)], [(0.2908989, -0.237757, -0.07590146), (-1.836108, -0.9758221,
     1.24335), (0.0408335, 0.7013218, -0.2888009), (-0.8402177, 1.074691, -0.09754542)]),
    ("straight along y", [(0, 0, 0), (0, 1, 0), (0, 2, 0), (0, 3, 0), (0, 4, 0)], [(1, 0, 0), (1, 0, 0), (1, 0, 0), (1, 0, 0)]),
    ("straight down", [(0, 0, -0), (0, 0, -1), (0, 0, -2), (0, 0, -3), (0, 0, -4)], [(1, -0, 0), (1, -0, 0), (1, -0, 0), (1, -0, 0)]),
]

# a strand whose normals swap where it bends sharply; recorded like the others
SWAPPING_POINTS = [(-0.2150334, -1.163199, 0.3800486), (-2.085107, -1.942502, 1.128806), (-2.009658, -2.433467, 2.079546), (-3.048292,
    -2.148766, 1.58166), (-3.895662, -1.68537, 0.5887808), (-1.993656, -2.270087, 2.578601), (-3.087627, -1.664136, 1.379025)]
SWAPPING_NORMALS = [(-0.8875564, 0.1056936, 0.448411), (-0.6658756, 0.6187848, -0.4167913), (0.182837, 0.5291588, 0.8285902),
    (-0.7239195, 0.6517416, 0.2262155), (-0.2101882, -0.5057998, -0.8366526), (-0.9042535, 0.3619466, -0.2265399), (-0.5654445,
    -0.2633215, 0.7816229)]
SWAPPING_RECORDED = [(-0.5614102, 1.979207, 0.6577862), (-0.9256018, 0.4482455, 0.3049295), (-0.1931177, 0.7962256, 0.8581579),
    (-0.6692784, 0.774884, 0.9328467), (0.7766622, -2.302624, -1.419023), (-1.216552, 0.2107981, 1.215935)]

@pytest.mark.parametrize(("points", "recorded"), [row[1:] for row in RECORDED], ids=[row[0] for row in RECORDED])
def test_recorded_normals_of_ribbons_without_normals(
    harness: Harness, points: list[tuple[float, ...]], recorded: list[tuple[float, ...]]
) -> None:
    found = _normals(harness, np.array(points, np.float32), [len(points) - 2])
    sizes = np.linalg.norm(recorded, axis=1, keepdims=True)
    assert np.abs((found - recorded) / sizes).max() < RIBBON_NORMAL


def test_sides_swap_where_the_given_normals_do(harness: Harness) -> None:
    found = _normals(harness, np.array(SWAPPING_POINTS, np.float32), [len(SWAPPING_POINTS) - 2], np.array(SWAPPING_NORMALS, np.float32))
    sizes = np.linalg.norm(SWAPPING_RECORDED, axis=1, keepdims=True)
    assert np.abs((found - SWAPPING_RECORDED) / sizes).max() < RIBBON_NORMAL


def test_strands_of_one_input_do_not_turn_each_other(harness: Harness) -> None:
    wavy, curly = (np.array(row[1], np.float32) for row in RECORDED[:2])
    together = _normals(harness, np.concatenate([wavy, curly]), [len(wavy) - 2, len(curly) - 2])
    apart = [_normals(harness, points, [len(points) - 2]) for points in (wavy, curly)]
    assert together.tolist() == np.concatenate(apart).tolist()


def test_a_ribbon_of_equal_points_has_finite_normals(harness: Harness) -> None:
    points = np.float32([(0, 0, 0), (1, 1, 0), (1, 1, 0), (2, 0, 1), (2, 0, 1), (2, 0, 1), (3, 0, 0)])
    assert np.isfinite(_normals(harness, points, [5])).all()


def _normals(harness: Harness, points: np.ndarray, segments: list[int], given: np.ndarray | None = None) -> np.ndarray:
    """Of strands that follow each other in the array of points."""
    firsts, asked = [], []
    for count in segments:
        start, first = len(firsts), firsts[-1] + 3 if firsts else 0
        firsts += range(first, first + count)
        asked += [(start + i, 0.0) for i in range(count)] + [(start + count - 1, 1.0)]
    curves = ox.BuildInputCurves(ox.PrimitiveType.FLAT_QUADRATIC_BSPLINE, points, 0.1, np.array(firsts, np.uint32),
                                 normals=given)
    gas = harness.context.accel_build([curves], build_flags=ox.BuildFlags.ALLOW_RANDOM_VERTEX_ACCESS)
    module = harness.module("curve_access.py")
    raygen = harness.kept.setdefault("curve access", harness.context.program_group_create(raygen=module["__raygen__points"]))
    queries = np.zeros(len(asked), shader.Query.dtype)
    for row, (primitive, u) in zip(queries, asked, strict=True):
        row["gas"], row["primitive"], row["u"], row["is_ribbon"] = int(gas.handle), primitive, u, True
    points, normals = np.zeros((len(asked), 16), np.float32), np.zeros((len(asked), 3), np.float32)
    sbt = ox.ShaderBindingTable(raygen=raygen.record(), miss=[], hitgroup=[])
    harness.launch(harness.pipeline("curve access", [raygen]), shader.Params(queries=queries, points=points, normals=normals), sbt,
                   len(asked))
    return normals
