"""Triangles in files and pictures."""

from __future__ import annotations

import numpy as np
import pytest

import magshell as ms
from magshell.mesh import cylinder, split
from magshell.output.tessellation import Tessellation, element_edges
from magshell.output.vtu import VTK_QUADRATIC_QUAD, VTK_QUADRATIC_TRIANGLE, grid

RADIUS, LENGTH = 1.0, 0.6
MESHES = {
    "triangles": split(cylinder(RADIUS, LENGTH, (4, 2), angle=(0, 90)), "alternating"),
    "both": split(cylinder(RADIUS, LENGTH, (4, 2), angle=(0, 90)), "crossed", [1, 2, 7]),
}
each_mesh = pytest.mark.parametrize("mesh", MESHES.values(), ids=MESHES)


@each_mesh
@pytest.mark.parametrize("pieces", [1, 4])
def test_surface_of_small_triangles(mesh, pieces):
    """It has the cylinder's area, points and outward normals; values go with nodes and with elements."""
    cells = Tessellation(mesh.elements, pieces)
    surface = cells.surface(mesh.points)
    x = surface.points[surface.triangles]
    normals = np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0])
    area = 0.5 * np.linalg.norm(normals, axis=1).sum()
    assert area == pytest.approx(0.5 * np.pi * RADIUS * LENGTH, rel=0.01 if pieces == 4 else 0.05)
    assert (np.einsum("tk,tk->t", normals, surface.normals[surface.triangles[:, 0]]) > 0.0).all()
    outward = surface.points * [1.0, 1.0, 0.0]
    assert np.abs(surface.normals - outward / np.linalg.norm(outward, axis=1, keepdims=True)).max() < 0.02
    assert np.abs(cells.at_points(mesh.points[:, 2]) - surface.points[:, 2]).max() < 1e-15
    centres = mesh.points[mesh.elements].mean(axis=1)
    shown = cells.on_elements(centres)
    assert len(shown) == len(surface.points)
    assert np.linalg.norm(shown - surface.points, axis=1).max() < 0.5


@each_mesh
def test_edges_are_drawn_once_and_none_of_no_length(mesh):
    edges = element_edges(mesh.elements)
    assert len(edges) == len(mesh._edges.real)
    assert np.linalg.norm(mesh.points[edges[:, 0]] - mesh.points[edges[:, 1]], axis=1).min() > 0.1


@each_mesh
def test_vtu_has_six_nodes_of_a_triangle(mesh):
    shell = ms.Shell(mesh, 0.05, ms.MicropolarNeoHookean(1.0, 1.5, 0.1, 0.005))
    path = ms.solve(ms.Model(shell, [ms.Clamp("start")], loads=[ms.Force("end", (0, 1e-6, 0))]))
    made = grid(path.discretisation, path.steps[-1])
    types = np.where(mesh.triangles, VTK_QUADRATIC_TRIANGLE, VTK_QUADRATIC_QUAD)
    assert np.array_equal(made.celltypes, types)
    for number, row in enumerate(mesh.elements):
        expected = row[[0, 1, 2, 4, 5, 7]] if mesh.triangles[number] else row
        assert made.get_cell(number).point_ids == expected.tolist()
