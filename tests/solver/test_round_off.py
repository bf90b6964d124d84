"""Where round-off is what is left: a very thin shell on a graded mesh, and forces that vanish in pure bending."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_bvp

import magshell as ms
from magshell.mesh import Mesh
from magshell.solver.newton import _stalled

YOUNG, WIDTH, THICKNESS, LOAD = 21e6, 0.2, 5e-4, 3.0


def graded():
    """A strip of length 1 with elements that get narrower towards its sides."""
    mesh = ms.mesh.rectangle(1.0, WIDTH, (8, 12))
    points, corners = mesh.points.copy(), mesh.elements[:, :4]
    side = 2.0 * points[:, 1] / WIDTH - 1.0
    y = 0.5 * WIDTH * (1.0 + np.sign(side) * (1.0 - np.clip(1.0 - np.abs(side), 0.0, 1.0) ** 2))
    points[:, 1] = y
    points[mesh.elements[:, 4:], 1] = 0.5 * (y[corners] + y[np.roll(corners, -1, axis=1)])
    return Mesh(points, mesh.elements, mesh.element_groups, mesh.edge_groups, mesh.node_groups)


def elastica():
    """End displacement of an inextensible line under a dead force across it, in lengths; P L² / (E I) = LOAD."""
    s = np.linspace(0.0, 1.0, 41)
    guess = np.vstack([s, np.ones_like(s), s, 0.5 * s**2])

    def slopes(s, y):
        return np.vstack([y[1], -LOAD * np.cos(y[0]), np.cos(y[0]), np.sin(y[0])])

    solved = solve_bvp(slopes, lambda a, b: np.array([a[0], b[1], a[2], a[3]]), s, guess, tol=1e-8)
    assert solved.success
    return solved.y[2, -1] - 1.0, solved.y[3, -1]


def test_a_strip_two_thousand_times_as_long_as_thick():
    material = ms.MicropolarStVenantKirchhoff(YOUNG / 2, 0.0, 0.0, 0.0)
    shell = ms.Shell(graded(), THICKNESS, material, micro_rotation=False)
    force = LOAD * YOUNG * WIDTH * THICKNESS**3 / 12
    model = ms.Model(shell, [ms.Clamp("left")], loads=[ms.Force("right", (0, 0, force))], probes={"end": (1.0, 0, 0)})
    path = ms.solve(model)
    assert max(step.residual for step in path.steps) > path.settings.tolerance, "nothing stalls here any more"
    u1, u3 = elastica()
    assert path.probe("end").u3[-1] == pytest.approx(u3, rel=2e-3)
    assert path.probe("end").u1[-1] == pytest.approx(u1, rel=5e-3)


def test_pure_bending_on_a_mesh_of_more_elements_than_needed():
    """A strip rolled into a circle by a moment: the forces of u vanish, and are no measure of their residual."""
    young, length, thickness = 1.2e6, 12.0, 0.1
    material = ms.MicropolarStVenantKirchhoff(young / 2, 0.0, 0.0, 0.0)
    shell = ms.Shell(ms.mesh.rectangle(length, 1.0, (48, 1)), thickness, material, micro_rotation=False)
    moment = 2.0 * np.pi * young * thickness**3 / 12.0 / length
    loads, stages = [ms.Moment("right", (0, -moment, 0))], [ms.Stage(stops=np.arange(1, 20) / 20)]
    model = ms.Model(shell, [ms.Clamp("left")], loads=loads, stages=stages, probes={"end": (length, 0, 0)})
    end = ms.solve(model).probe("end").u[-1]
    np.testing.assert_allclose(end, [-length, 0.0, 0.0], atol=2e-3 * length)


def test_only_an_iteration_that_has_come_close_stalls():
    assert _stalled([1.0, 1e-3, 2e-9, 1.5e-9, 1.1e-9])
    assert not _stalled([1.0, 1e-3, 1e-6, 1e-9])
    assert not _stalled([2e-3, 1e-3, 9e-4, 1.1e-3])
    assert not _stalled([1e-9, 1e-9])
