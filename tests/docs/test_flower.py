"""The worked example of a flower: its mesh is that of its geometry, and it is as symmetric as it looks."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

import magshell as ms
from magshell.errors import InputError

FLOWER = Path(__file__).parents[2] / "docs" / "gallery" / "flower"
SIXTH = np.array([[0.5, -np.sqrt(0.75), 0], [np.sqrt(0.75), 0.5, 0], [0, 0, 1]])


@pytest.fixture(scope="module")
def flower():
    return ms.problem.load(FLOWER / "flower.toml")


def centres(mesh):
    x = mesh.points[mesh.elements]
    return 0.5 * x[:, 4:].sum(axis=1) - 0.25 * x[:, :4].sum(axis=1)


def turned_petals(mesh):
    """Elements of each petal, and those of the next petal that a sixth of a turn brings them to."""
    x = centres(mesh)
    for number in range(1, 7):
        these, those = mesh.elements_of(f"petal-{number}"), mesh.elements_of(f"petal-{number % 6 + 1}")
        gap = np.linalg.norm((x[these] @ SIXTH.T)[:, None] - x[those], axis=2)
        assert gap.min(axis=1).max() < 1e-9, gap.min(axis=1).max()
        yield these, those[gap.argmin(axis=1)]


def test_committed_mesh_is_that_of_the_geometry(flower):
    try:
        mesh = ms.mesh.from_cad(FLOWER / "flower.geo", size=0.8e-3, unit="mm")
    except InputError as error:
        if "magshell[gmsh]" not in str(error):
            raise
        pytest.skip(str(error))
    committed = flower.model.shell.mesh
    assert np.array_equal(mesh.elements, committed.elements)
    assert np.abs(mesh.points - committed.points).max() < 1e-9
    assert mesh.groups == committed.groups


def test_six_petals_remember_the_same(flower):
    shell = flower.model.shell
    b = shell.remanence(shell.mesh, centres(shell.mesh)[:, None])[:, 0]
    assert np.abs(np.linalg.norm(b, axis=1) - 60e-3).max() < 1e-15
    for these, those in turned_petals(shell.mesh):
        assert np.abs(b[these] @ SIXTH.T - b[those]).max() < 1e-9
    angle = np.degrees(np.arccos(b[:, 2] / 60e-3))
    assert angle.max() == pytest.approx(115, rel=0.05)


def test_petals_close_alike_and_towards_the_bud(flower):
    """A third of a turn maps the mesh onto itself, a sixth all but the three rhombi of the post."""
    model = replace(flower.model, field=ms.UniformField((0, 0, 0.2e-3)))
    path = ms.solve(model, replace(flower.settings, first_step=0.5))
    mesh, u = model.shell.mesh, path.steps[-1].state.u
    largest = np.abs(u).max()
    gap, onto = cKDTree(mesh.points).query(mesh.points @ (SIXTH @ SIXTH).T)
    assert gap.max() < 1e-12, gap.max()
    off = np.abs(u @ (SIXTH @ SIXTH).T - u[onto]).max() / largest
    assert off < 1e-9, off
    moved = u[mesh.elements].mean(axis=1)
    off = max(np.abs(moved[these] @ SIXTH.T - moved[those]).max() for these, those in turned_petals(mesh)) / largest
    assert off < 1e-3, off
    there = ms.remanence.placed(model.shell.remanence, mesh, mesh.points[mesh.elements])
    flat, now = (np.linalg.norm(there - x[mesh.elements], axis=2).max() for x in (mesh.points, mesh.points + u))
    assert now < 0.95 * flat, (now, flat)
