"""Meshes made by code: closed, outside out, with normals of their surface."""

from __future__ import annotations

import numpy as np
import pytest

from optixc.stdlib import shapes

SOLIDS = {
    "sphere": (shapes.superellipsoid(1.0, 1.0, 64, 129), 4.0 / 3.0 * np.pi),
    "octahedron": (shapes.superellipsoid(2.0, 2.0, 65, 129), 4.0 / 3.0),
    "torus": (shapes.torus(2.0, 0.5, 65, 129), 2.0 * np.pi**2 * 2.0 * 0.25),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_solids_enclose_their_volume(name: str) -> None:
    mesh, volume = SOLIDS[name]
    a, b, c = (mesh.vertices[mesh.indices[:, corner]].astype(np.float64) for corner in range(3))
    # The signed volume is negative where triangles face inwards. Chords of 64 and 128 steps lose (2 pi / 64)**2 / 6 and a quarter of it
    assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0 == pytest.approx(volume, rel=0.003)
    assert (np.einsum("ij,ij->i", a, np.cross(b, c)).sum()) > 0.0


@pytest.mark.parametrize("name", SOLIDS)
def test_normals_are_unit_vectors_out_of_the_surface(name: str) -> None:
    mesh, _ = SOLIDS[name]
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1.0, atol=1e-6)
    corners = mesh.vertices[mesh.indices].astype(np.float64)
    facets = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(facets, axis=1)
    wide = area > 1e-3 * area.max()
    for corner in range(3):
        cosines = np.einsum("ij,ij->i", facets, mesh.normals[mesh.indices[:, corner]])[wide] / area[wide]
        # On an octahedron's edge the normal of one face may lie in the other, up to rounding
        assert cosines.min() > -1e-4


def test_derived_normals_agree_with_exact_ones() -> None:
    exact = shapes.torus(2.0, 0.5, 65, 129)
    # A vertex's normal is off by at most the step of the coarser grid
    derived = shapes.vertex_normals(exact.vertices, exact.indices)
    assert np.einsum("ij,ij->i", exact.normals, derived).min() > np.cos(2.0 * np.pi / 64)


def test_moving_keeps_normals_perpendicular() -> None:
    mesh = shapes.superellipsoid(1.0, 1.0, 33, 65)
    moved = mesh.moved([[1.0, 0.0, 0.0, 5.0], [0.0, 4.0, 0.0, 6.0], [0.0, 0.0, 1.0, 7.0]])
    np.testing.assert_allclose(moved.vertices, mesh.vertices * [1.0, 4.0, 1.0] + [5.0, 6.0, 7.0], atol=1e-6)
    gradient = (moved.vertices - [5.0, 6.0, 7.0]) / [1.0, 16.0, 1.0]
    np.testing.assert_allclose(moved.normals, gradient / np.linalg.norm(gradient, axis=1, keepdims=True), atol=1e-5)


def test_parts_and_merged_meshes_keep_every_triangle() -> None:
    mesh = shapes.torus(2.0, 0.5, 17, 33)
    right = mesh.centers()[:, 0] > 0.0
    both = shapes.merged([mesh.part(right), mesh.part(~right)])
    assert sorted(map(tuple, both.vertices[both.indices].reshape(-1, 9))) == sorted(map(tuple, mesh.vertices[mesh.indices].reshape(-1, 9)))


def test_flat_shapes_face_the_viewer() -> None:
    rectangle = shapes.rectangle((0.0, 2.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    backdrop = shapes.backdrop(3.0, 4.0, -2.0, 1.5, 6.0)
    for mesh, up in ((rectangle, -1.0), (backdrop, 1.0)):
        p, q, r = mesh.vertices[mesh.indices[0]]
        np.testing.assert_allclose(np.cross(q - p, r - p) / np.linalg.norm(np.cross(q - p, r - p)), [0.0, up, 0.0], atol=1e-6)
        np.testing.assert_allclose(mesh.normals[mesh.indices[0, 0]], [0.0, up, 0.0], atol=1e-6)
    assert backdrop.vertices[:, 1].max() == 6.0
    assert backdrop.vertices[:, 2].min() == pytest.approx(-3.5)
