"""A cell is what it is among others: one against four, jumps held, loaded and free; two directions and their corner."""

from __future__ import annotations

import numpy as np
import pytest

import magshell as ms
from magshell import solve
from magshell.evaluation.converged import converged
from magshell.mesh import Mesh, rectangle
from magshell.solver.settings import Settings
from repeated.bodies import copied, remanence, shell

SIDES = {"x": ("left", "right", "x"), "y": ("bottom", "top", "y")}
HELD = {
    "stretched": ([("x", 1, 0.1), ("y", 2, 0.0)], []),
    "pulled": ([], [("x", (3e-3, 0.0, 0.0)), ("y", (0.0, -1e-3, 0.0))]),
    "sheared": ([("x", 1, 0.0), ("x", 2, 0.05), ("y", 2, 0.0)], []),
    "free": ([], []),
}
STILL = [("x", 2, 0.0), ("x", 3, 0.0), ("y", 3, 0.0)]
"""What is held against rigid rotations."""


def cell():
    """A wavy square with a stiffer half, distorted inside."""
    mesh = rectangle(1.0, 1.0, (3, 3))
    x, y = mesh.points[:, :2].T
    bump = 0.05 * np.sin(np.pi * x) * np.sin(np.pi * y)
    height = 0.04 * np.cos(2.0 * np.pi * x) + 0.03 * np.sin(2.0 * np.pi * (x + y))
    points = np.column_stack([x + bump, y - 0.7 * bump, height])
    stiff = np.flatnonzero(mesh.points[mesh.elements].mean(axis=1)[:, 0] < 0.4)
    return Mesh(points, mesh.elements, {"stiff": stiff}, mesh.edge_groups)


def solved(mesh, vectors, held, loads, times=1):
    """Cells in both directions, `times` of them to the part."""
    pin = int(np.argmin(np.linalg.norm(mesh.points[:, :2], axis=1)))
    mesh = Mesh(mesh.points, mesh.elements, mesh.element_groups, mesh.edge_groups, {"pin": [pin]})
    repeated = [ms.Periodic(group, image, name) for group, image, name in SIDES.values()]
    made = shell(mesh, {"regions": [ms.Region("stiff", thickness=0.1)]}, vectors, repeated=repeated)
    given = {(name, axis): value for name, axis, value in [*STILL, *held]}
    supports = [ms.SimpleSupport("pin")]
    supports += [ms.Prescribe(name, "u", axis, times * value) for (name, axis), value in given.items()]
    pulls = [ms.Force(name, tuple(times * np.array(total))) for name, total in loads]
    model = ms.Model(made, supports, ms.UniformField((0.0, 2e-8, 4e-8)), loads=pulls)
    return solve(model, Settings(tolerance=1e-11))


@pytest.mark.parametrize(("held", "loads"), HELD.values(), ids=HELD)
def test_cell_is_part_of_four(held, loads):
    mesh = cell()
    vectors = remanence(mesh)
    one = solved(mesh, vectors, held, loads)
    many, nodes = copied(mesh, [(np.eye(3), np.array([i, j, 0.0])) for i in range(2) for j in range(2)])
    many = bounded(many)
    four = solved(many, np.tile(vectors, (4, 1)), held, loads, times=2)
    here, there = one.steps[-1], four.steps[-1]
    size = np.abs(there.state.u).max()
    assert size > 3e-3
    assert np.abs(here.state.u[: len(mesh.points)] - there.state.u[nodes[0]]).max() < 1e-8 * size
    jumps, of_four = (converged(path.discretisation, path.steps[-1]).jumps for path in (one, four))
    np.testing.assert_allclose(2.0 * jumps, of_four, atol=1e-9 * np.abs(of_four).max())
    for name, total in loads:
        free = [axis for axis in range(3) if (name, axis + 1) not in {(jump, axis) for jump, axis, _ in STILL}]
        np.testing.assert_allclose(jumps[list(SIDES).index(name), 1][free], np.array(total)[free], atol=1e-10)
    for step in (here, there):
        assert step.balance.force_imbalance < 1e-8
        assert step.balance.moment_imbalance < 1e-8


def bounded(mesh):
    """The mesh with the sides of the whole."""
    for name, (axis, value) in {"left": (0, 0.0), "right": (0, 2.0), "bottom": (1, 0.0), "top": (1, 2.0)}.items():
        edges = mesh.boundary_edges
        at = np.abs(mesh.points[edges][..., axis] - value).max(axis=1) < 1e-9
        mesh = Mesh(mesh.points, mesh.elements, mesh.element_groups, {**mesh.edge_groups, name: edges[at]})
    return mesh


def test_strip_in_tension_is_uniform():
    """A flat cell: the force is Young's modulus times the section, and the width follows Poisson's ratio."""
    mesh = rectangle(1.0, 0.5, (2, 2))
    rubber = ms.MicropolarNeoHookean(1.0, 1.0)
    made = ms.Shell(mesh, 0.05, rubber, repeated=[ms.Periodic("left", "right", "pull")])
    held = [ms.SymmetryPlane("bottom", (0, 1, 0)), ms.Prescribe("pull", "u", 1, 1e-6), ms.Prescribe("pull", "u", 3)]
    held += [ms.Prescribe("left", "u", 1), ms.Prescribe("left", "u", 3)]
    path = solve(ms.Model(made, held), Settings(tolerance=1e-12))
    jump, force = converged(path.discretisation, path.steps[-1]).jumps[0]
    young, poisson = 5.0 / 2.0, 0.25
    assert force[0] == pytest.approx(young * 0.05 * 0.5 * jump[0], rel=1e-5)
    top = path.steps[-1].state.u[mesh.nodes_of("top"), 1]
    np.testing.assert_allclose(top, -poisson * 0.5 * jump[0], rtol=1e-4)
