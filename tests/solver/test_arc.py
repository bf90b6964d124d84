"""Paths with limit points: the load factor as an unknown."""

from __future__ import annotations

import numpy as np
import pytest
from battery import MATERIAL, example

import magshell as ms
from magshell.mesh import Mesh
from magshell.shell.state import State
from magshell.solver.arc import Cylinder, NoRoot, distance

SPAN, RISE = 10.0, 0.25
THICKNESS = 0.1


def shallow_arch(force, elements=6, **settings):
    """Half a clamped shallow arch, pushed down at its crown by a dead force: it snaps through."""
    mesh = ms.mesh.rectangle(SPAN / 2, 1.0, (elements, 1))
    points = mesh.points.copy()
    points[:, 2] = 0.5 * RISE * (1.0 - np.cos(2.0 * np.pi * points[:, 0] / SPAN))
    mesh = Mesh(points, mesh.elements, mesh.element_groups, mesh.edge_groups, mesh.node_groups)
    material = example(MATERIAL)._replace(length_scale=0.1 * THICKNESS)
    supports = [ms.Clamp("left"), ms.SymmetryPlane("right", (1, 0, 0))]
    crown = {"crown": (SPAN / 2, 0.5, RISE)}
    model = ms.Model(
        ms.Shell(mesh, THICKNESS, material), supports, probes=crown, loads=[ms.Force("right", (0, 0, -force))]
    )
    return ms.solve(model, ms.Settings(**settings))


@pytest.fixture(scope="module")
def snapped():
    return shallow_arch(4e-5)


def test_the_path_falls_and_rises_again(snapped):
    load = np.array([step.load_factor for step in snapped.steps])
    turns = np.flatnonzero(np.diff(np.sign(np.diff(load))))
    assert snapped.converged
    assert load[-1] == 1.0
    assert len(turns) == 2, f"load factors {np.round(load, 4).tolist()}"
    assert load[turns[1] + 1] < load[turns[0] + 1]


def test_every_state_is_in_balance(snapped):
    worst = max(step.balance.force_imbalance for step in snapped.steps[1:])
    assert worst < 1e-8, f"{worst:.1e}"


def test_arc_length_adds_up(snapped):
    """Of the displacements over the body's size."""
    size = snapped.model.shell.mesh.size
    for before, step in zip(snapped.steps, snapped.steps[1:], strict=False):
        length = distance(before.state, step.state, size)
        assert step.arc_length == pytest.approx(before.arc_length + length, rel=1e-12)


def test_other_steps_lead_to_the_same_curve(snapped):
    """The load at both limit points (of a parabola, whose error is that of the spacing to the third), and the end."""
    other = shallow_arch(4e-5, first_step=0.02, target_iterations=4)
    assert other.probe("crown").u3[-1] == pytest.approx(snapped.probe("crown").u3[-1], rel=1e-7)
    loads = list(limit_loads(snapped))
    for one, two in zip(loads, limit_loads(other), strict=True):
        assert abs(one - two) < 1e-3 * loads[0], f"{one:.6f} and {two:.6f}"


def limit_loads(path):
    """Load factors of the limit points, from parabolas through three states."""
    u, load = path.probe("crown").u3, path.probe("crown").load_factor
    turns = np.flatnonzero(np.diff(np.sign(np.diff(load)))) + 1
    for turn in turns:
        a, b, c = np.polyfit(u[turn - 1 : turn + 2], load[turn - 1 : turn + 2], 2)
        yield c - b**2 / (4 * a)


def test_displacement_control_meets_the_same_curve(snapped):
    """The crown's edge prescribed as it is between the limit points: the same state, though load control cannot."""
    load = snapped.probe("crown").load_factor
    turns = np.flatnonzero(np.diff(np.sign(np.diff(load)))) + 1
    step = snapped.steps[int(turns.mean())]
    model = snapped.model
    mesh = model.shell.mesh
    edge = mesh.nodes_of("right")
    moves = [ms.Prescribe(f"node {node}", "u", 3, step.state.u[node, 2]) for node in edge]
    groups = {f"node {node}": np.array([node]) for node in edge}
    mesh = Mesh(mesh.points, mesh.elements, mesh.element_groups, mesh.edge_groups, groups)
    shell = ms.Shell(mesh, THICKNESS, model.shell.material)
    held = ms.solve(ms.Model(shell, [*model.supports, *moves]))
    difference = np.abs(held.steps[-1].state.u - step.state.u).max() / np.abs(step.state.u).max()
    assert difference < 1e-6, f"{difference:.1e} at load factor {step.load_factor:.4f}"


def test_cylinder():
    """The corrected state is as far away as the trial state, on its side; one that misses says so."""
    rng = np.random.default_rng(5)
    start = State.undeformed(4, 1, 0)
    ahead = rng.normal(size=(4, 3))
    cylinder = Cylinder(start.u, ahead)
    trial = start._replace(u=start.u + ahead)
    increment, per_load = (0.05 * rng.normal(size=(4, 10)) for _ in range(2))
    d_load = cylinder.d_load(trial, increment, per_load)
    moved = trial._replace(u=trial.u + (increment + d_load * per_load)[:, :3])
    assert distance(start, moved, 2.0) == pytest.approx(np.linalg.norm(ahead) / 4.0, rel=1e-12)
    assert np.sum((moved.u - start.u) * ahead) > 0.0
    with pytest.raises(NoRoot):
        cylinder.d_load(trial, np.full((4, 10), 100.0), per_load)
