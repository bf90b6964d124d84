"""The built-in problems with rigid bodies, hinges and joints, against rods, beams and the kinematics of a fold."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from scipy.optimize import brentq

import magshell as ms
from magshell import problem
from magshell.evaluation.converged import converged
from magshell.shell import rotation

# (E = 2 mu, nu = 0.)
EI_OVER_MU = 2.0 / 12.0


@cache
def solved(name):
    """Path of a built-in problem as it is written."""
    built = problem.load(name)
    return ms.solve(built.model, built.settings)


def bending_stiffness(shell, width):
    """EI and the share of the couple stress, mu l² A."""
    material, h = shell.material, shell.thickness
    return material.shear_modulus * width * (EI_OVER_MU * h**3 + material.length_scale**2 * h)


def test_tip_magnet():
    """θ = Q cos θ, Q = m B a / D, at Q = 1 and Q = 5."""
    path = solved("tip-magnet")
    shell, (magnet,) = path.model.shell, path.model.shell.rigid
    width, free = np.ptp(shell.mesh.points[:, 1]), shell.mesh.points[shell.mesh.nodes_of(magnet.group), 0].min()
    found = {}
    for step in path.steps:
        B = step.flux_density[2]
        q = step.state.q[shell.body_row("magnet")]
        Q = np.linalg.norm(magnet.moment) * B * free / bending_stiffness(shell, width)
        expected = brentq(lambda θ, Q=Q: θ - Q * np.cos(θ), 0.0, 0.5 * np.pi)
        assert 2.0 * np.arctan2(-q[2], q[0]) == pytest.approx(expected, rel=3e-3, abs=1e-6), f"{1e3 * B:.4g} mT"
        found[round(1e3 * B, 5)] = expected
    assert {3.90625, 19.53125} <= set(found)
    assert found[19.53125] == pytest.approx(1.306440, rel=1e-3)


def test_rolled_strip():
    """A circle that is walked twice; the handle has turned twice, and gives the moment D 4 π / L."""
    path = solved("rolled-strip")
    shell, step = path.model.shell, path.steps[-1]
    mesh = shell.mesh
    length, width = np.ptp(mesh.points[:, 0]), np.ptp(mesh.points[:, 1])
    radius = length / (4.0 * np.pi)
    x = mesh.points + step.state.displacement(len(mesh.points))
    corners = mesh.corner_nodes
    s = mesh.points[corners, 0] / radius
    circle = radius * np.column_stack([np.sin(s), 1.0 - np.cos(s)])
    error = np.linalg.norm(x[corners][:, [0, 2]] - circle, axis=1).max() / radius
    assert error < 2e-3, f"{error:.1e}"
    reached = converged(path.discretisation, step)
    assert step.state.q[shell.body_row("handle")] == pytest.approx([1.0, 0.0, 0.0, 0.0], abs=1e-9)
    ((force, torque),) = reached.body_forces
    moment = bending_stiffness(shell, width) / radius
    assert torque[1] == pytest.approx(-moment, rel=2e-3)
    assert np.linalg.norm(force) * radius < 1e-6 * moment


def panel_normals(mesh, x):
    """Mean unit normals of the four panels."""
    normals = {}
    for name in mesh.element_groups:
        rows = mesh.elements[mesh.elements_of(name)]
        total = np.cross(x[rows[:, 1]] - x[rows[:, 0]], x[rows[:, 3]] - x[rows[:, 0]]).sum(axis=0)
        normals[name] = total / np.linalg.norm(total)
    return normals


def between(normals, one, other):
    """Degrees."""
    return np.degrees(np.arccos(normals[one] @ normals[other]))


def test_origami():
    """It folds from 60° at the zigzag to more than 100°, and the other creases follow as in an ideal cell."""
    path = solved("origami")
    mesh = path.model.shell.mesh
    for step in path.steps:
        found = panel_normals(mesh, mesh.points + step.state.displacement(len(mesh.points)))
        zigzag = between(found, "panel-1-1", "panel-1-2")
        ideal = ms.mesh.miura((10e-3, 10e-3), 60.0, 0.5 * zigzag, (1, 1), (1, 1))
        rigid = panel_normals(ideal, ideal.points)
        for pair in (("panel-2-1", "panel-2-2"), ("panel-1-1", "panel-2-1"), ("panel-1-2", "panel-2-2")):
            assert between(found, *pair) == pytest.approx(between(rigid, *pair), abs=1.0), f"{pair} at {zigzag:.0f}°"
    assert 100.0 < zigzag < 120.0


def test_ribbed_plate():
    """At small loads a beam with the section's EI and the shear stiffness of its ribs, within 1.5 %."""
    path = solved("ribbed-plate")
    shell, step = path.model.shell, path.steps[1]
    mesh, mu, t = shell.mesh, shell.material.shear_modulus, shell.thickness
    length, (wide, high) = np.ptp(mesh.points[:, 1]), np.ptp(mesh.points[:, [0, 2]], axis=0)
    areas, heights = np.array([wide, high, high]) * t, np.array([0.0, 0.5 * high, 0.5 * high])
    own = np.array([wide * t**3, t * high**3, t * high**3]) / 12.0
    stiffness = 2.0 * mu * (own.sum() + areas @ (heights - areas @ heights / areas.sum()) ** 2)
    q = step.load_factor * 10.0 * 20e-3
    expected = q * length**4 / (8.0 * stiffness) + q * length**2 / (2.0 * 5.0 / 6.0 * mu * areas[1:].sum())
    found = step.state.u[path.model.probe_nodes["end"], 2]
    assert found == pytest.approx(expected, rel=1.5e-2)
    assert expected < 0.01 * length


def test_the_ribs_stay_at_right_angles():
    """One rotation carries the directors of all sheets at a joint, at any load."""
    path = solved("ribbed-plate")
    rows, step = path.model.rows, path.steps[-1]
    joint = rows.joined[np.argmax(path.model.shell.mesh.points[rows.joined, 1])]
    own = np.flatnonzero(rows.of == joint)
    directors = np.einsum("ij,nj->ni", rotation.matrix(step.state.q[joint]), rows.normals[own])
    assert len(own) == 2
    assert rows.normals[own] + step.state.w[own] == pytest.approx(directors, abs=1e-12)


def test_compass_needle():
    """Uniformly magnetised it stays straight, along the field: at 60°, and as far on as the field has turned."""
    path = solved("compass-needle")
    along = path.probe("tip").u - path.probe("tail").u + np.array([20e-3, 0.0, 0.0])
    angles = np.unwrap(np.arctan2(along[:, 1], along[:, 0]))
    turned = path.history.columns.index("field.angle")
    assert turned == len(path.history.columns) - 1
    expected = np.radians([60.0 + 90.0 * step.load_factor * step.stage for step in path.steps[1:]])
    np.testing.assert_allclose(angles[1:], expected, atol=1e-7)
    np.testing.assert_allclose(np.linalg.norm(along, axis=1), 20e-3, rtol=1e-4)
