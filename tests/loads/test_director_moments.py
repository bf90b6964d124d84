"""Moments on shells without micro-rotation: their torque, and their work in a turn of the directors."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from battery import each_element

import magshell as ms
from loads.cases import applied, at_rest, crumpled, each_patch, shell_of
from magshell.shell.normals import nodal_normals

M = np.array([0.3, -0.2, 0.5])


def couples(mesh, element, state):
    """Directors and forces on them (nodes, 3), at the nodes that have some."""
    load = applied(ms.Moment("top", M), shell_of(mesh, element, micro_rotation=False))
    forces = load.forces(state)
    assert not np.any(forces[:, :3])
    assert not np.any(forces[:, 6:])
    nodes = np.flatnonzero(np.any(forces, axis=1))
    return (nodal_normals(mesh.points, mesh.elements) + state.w)[nodes], forces[nodes, 3:6], nodes


@each_element
@each_patch
def test_torque_is_the_moment_but_for_its_part_along_the_director(mesh, element):
    """d × f = M_I - (M_I · n) n with the share M_I of the node, however the director lies and is stretched."""
    d, f, nodes = couples(mesh, element, crumpled(mesh, 1))
    mixed = applied(ms.Moment("top", M), shell_of(mesh, element))
    share = mixed.forces(at_rest(mesh))[nodes, 7:10]
    n = d / np.linalg.norm(d, axis=1, keepdims=True)
    expected = share - np.sum(share * n, axis=1, keepdims=True) * n
    error = np.abs(np.cross(d, f) - expected).max()
    assert error < 1e-15, f"{error:.1e}"
    assert np.abs(np.sum(d * f, axis=1)).max() < 1e-16


def test_work_in_full_turns_about_the_axis():
    """Directors normal to the moment, turned about it and stretched on the way: the work is |M| times the angle."""
    turns, steps = 2.0, 400
    mesh = ms.mesh.rectangle(1.0, 1.0, (2, 2))
    load = applied(ms.Moment("right", (0.0, 0.7, 0.0)), shell_of(mesh, micro_rotation=False))
    angle = np.linspace(0.0, 2.0 * np.pi * turns, steps + 1)
    length = 1.0 + 0.3 * np.sin(3.0 * angle)
    directors = length[:, None] * np.column_stack([np.sin(angle), np.zeros_like(angle), np.cos(angle)])
    state, work = at_rest(mesh), 0.0
    for before, after in pairwise(directors):
        middle = np.broadcast_to(0.5 * (before + after) - [0.0, 0.0, 1.0], state.w.shape)
        work += np.sum(load.forces(state._replace(w=middle))[:, 3:6] @ (after - before))
    step = angle[1]
    # the midpoint rule sees the angle of a chord, 2 tan(step/2) for a circle, and as much again of the stretch
    assert abs(work / (0.7 * angle[-1]) - 1.0) < step**2, f"{work / (0.7 * angle[-1]) - 1.0:.1e}"
