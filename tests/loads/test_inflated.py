"""Shells under pressure: a balloon by the theory of membranes, and the symmetry of the tangent where a rim is held."""

from __future__ import annotations

import numpy as np
import pytest
from battery import with_points
from scipy.optimize import brentq

import magshell as ms
from magshell.equations.instant import Instant
from magshell.mesh import Mesh
from magshell.shell.elements import PAPER, QUADRATIC

MU, LAMBDA = 1.0, 2.0
each_type = pytest.mark.parametrize("element", [QUADRATIC, PAPER], ids=["quadratic", "paper"])
HEIGHT = 0.02
CLASSICAL = ms.MicropolarNeoHookean(MU, LAMBDA, 0.0, 0.0)


def octant(count):
    """An eighth of a sphere of radius 1: three sides of a cube, so many elements along half an edge, blown up."""
    side = np.array([[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
    corners = {f"side {axis}": np.roll(side, axis, axis=1) for axis in range(3)}
    mesh = ms.mesh.blocks(corners, (count, count))
    for axis in range(3):
        mesh = mesh.select_edges(f"plane {axis}", **{f"x{axis + 1}": 0.0})
    mesh = Mesh(mesh.points, mesh.elements, {"all": np.arange(len(mesh.elements))}, mesh.edge_groups)
    return on_the_sphere(mesh)


def on_the_sphere(mesh):
    return with_points(mesh, mesh.points / np.linalg.norm(mesh.points, axis=1, keepdims=True))


def balloon(mesh, element, pressure=0.5 * HEIGHT):
    planes = [ms.SymmetryPlane(f"plane {axis}", np.eye(3)[axis]) for axis in range(3)]
    shell = ms.Shell(mesh, HEIGHT, CLASSICAL, element=element, micro_rotation=False)
    return ms.solve(ms.Model(shell, planes, loads=[ms.Pressure("all", pressure)]))


def membrane_radius(pressure):
    """Radius of a balloon of radius 1: p λ² = 2 h P(λ), with P33 = 0 across it, of the neo-Hookean law."""

    def stresses(stretch, across):
        log_J = np.log(stretch**2 * across)
        return [MU * (x - 1.0 / x) + LAMBDA * log_J / x for x in (stretch, across)]

    def excess(stretch):
        across = brentq(lambda x: stresses(stretch, x)[1], 0.2, 1.5, xtol=1e-14)
        return 2.0 * HEIGHT * stresses(stretch, across)[0] - pressure * stretch**2

    return brentq(excess, 1.0, 1.2, xtol=1e-14)


@pytest.mark.parametrize(
    ("element", "cut", "round_to"),
    [(QUADRATIC, None, 0.01), (PAPER, None, 0.01), (QUADRATIC, "crossed", 0.02)],
    ids=["quadratic", "paper", "triangles"],
)
def test_balloon(element, cut, round_to):
    """Blown up by 8 %: the error falls with the mesh, and the sphere becomes round (triangles: corners lie outside)."""
    exact = membrane_radius(0.5 * HEIGHT)
    errors, deviations = [], []
    for count in (2, 4):
        mesh = octant(count)
        path = balloon(mesh if cut is None else on_the_sphere(ms.mesh.split(mesh, cut)), element)
        radii = np.linalg.norm(path.model.shell.mesh.points + path.steps[-1].state.u, axis=1)
        errors.append(abs(radii.mean() - exact) / (exact - 1.0))
        deviations.append(radii.std() / (exact - 1.0))
    assert errors[1] < errors[0] / 3.0, errors
    assert errors[1] < 0.01, errors
    assert deviations[1] < deviations[0] / 4.0, deviations
    assert deviations[1] < round_to, deviations


def square(supports, pressure):
    """A square of side 1."""
    mesh = ms.mesh.rectangle(1.0, 1.0, (4, 4))
    mesh = Mesh(mesh.points, mesh.elements, {"all": np.arange(16)}, mesh.edge_groups)
    shell = ms.Shell(mesh, HEIGHT, CLASSICAL, micro_rotation=False)
    return ms.Model(shell, supports, loads=[ms.Pressure("all", pressure)])


def skew(path):
    """Largest entry of K - Kᵀ over that of K at the end of a path."""
    assembly = path.discretisation.assemble(Instant(path.steps[-1].state, path.model.loading(1.0)))
    K = assembly.matrix.toarray()
    return np.abs(K - K.T).max() / np.abs(K).max()


def test_tangent_of_an_inflated_square():
    """Symmetric where the rim is clamped, here at a height of several thicknesses; not where three sides are free."""
    sides = ("left", "right", "bottom", "top")
    clamped = ms.solve(square([ms.Clamp(side) for side in sides], 3e-3))
    assert clamped.steps[-1].state.u[:, 2].max() > 4.0 * HEIGHT
    assert skew(clamped) < 1e-14, f"{skew(clamped):.1e}"
    flag = ms.solve(square([ms.Clamp("left")], 3e-6))
    assert skew(flag) > 1e-9, f"{skew(flag):.1e}"


@each_type
def test_tangent_of_a_balloon_is_symmetric(element):
    """Its rim glides in planes through which the mirror image closes the surface."""
    path = balloon(octant(2), element)
    assert skew(path) < 1e-14, f"{skew(path):.1e}"
