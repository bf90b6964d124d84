"""Moments on sections: their torque, what of it works on directors, their work in a turn, moments that are refused."""

from __future__ import annotations

import re
from itertools import pairwise

import numpy as np
import pytest
from battery import each_element
from scipy.spatial.transform import Rotation

import magshell as ms
from loads.cases import MESHES, applied, at_rest, crumpled, each_patch, shell_of, torques
from magshell.shell.normals import nodal_normals

M = np.array([0.3, -0.2, 0.5])
FLAT, CURVED = MESHES["flat patch"], MESHES["curved patch"]
each_group = pytest.mark.parametrize("group", ["top", "half", "scattered"])


@each_group
@each_element
@each_patch
@pytest.mark.parametrize("follower", [False, True], ids=["axis fixed", "turning"])
def test_torque_is_the_moment(mesh, element, group, follower):
    """d × f + c = M_I with the share M_I of the node, however the director lies and is stretched, or R̃ M_I."""
    load = applied(ms.Moment(group, M, follower), shell_of(mesh, element))
    share, state = torques(mesh, at_rest(mesh), load.forces(at_rest(mesh))), crumpled(mesh, 1)
    expected = share
    if follower:
        expected = Rotation.from_quat(state.q, scalar_first=True).apply(share)
    error = np.abs(torques(mesh, state, load.forces(state)) - expected).max()
    assert error < 1e-15, f"{error:.1e}"
    assert share.sum(axis=0) == pytest.approx(M, rel=1e-14)


@each_element
@each_patch
def test_couples_are_along_the_directors_and_forces_normal_to_them(mesh, element):
    state = crumpled(mesh, 2)
    forces = applied(ms.Moment("half", M), shell_of(mesh, element)).forces(state)
    d = nodal_normals(mesh.points, mesh.elements) + state.w
    f, c = forces[:, 3:6], forces[:, 7:10]
    assert np.abs(np.sum(d * f, axis=1)).max() < 1e-16
    assert np.abs(np.cross(d, c)).max() < 1e-16
    assert np.abs(c).max() > 0.1 * np.abs(f).max()
    assert not np.any(np.delete(forces, [3, 4, 5, 7, 8, 9], axis=1))


@each_group
@each_element
def test_without_micro_rotation_the_forces_are_those_with_it(element, group):
    """Of the moment in the surface."""
    state, total = crumpled(FLAT, 3), (0.3, -0.2, 0.0)
    with_it, without = (
        applied(ms.Moment(group, total), shell_of(FLAT, element, micro_rotation)).forces(state)
        for micro_rotation in (True, False)
    )
    assert np.array_equal(with_it[:, :6], without[:, :6])
    assert np.any(with_it[:, 7:10])
    assert not np.any(without[:, 6:])


@each_element
@pytest.mark.parametrize(
    ("mesh", "total"),
    [(FLAT, (0.0, 0.0, 1.0)), (FLAT, (1.0, 0.0, 1e-3)), (CURVED, (0.3, -0.2, 0.5))],
    ids=["normal", "nearly in the surface", "curved"],
)
def test_a_moment_about_the_normal_needs_a_micro_rotation(mesh, total, element):
    """With the largest part along a normal, and where."""
    shares = np.abs(nodal_normals(mesh.points, mesh.elements) @ total) / np.linalg.norm(total)
    nodes = mesh.nodes_of("top")
    nodes = nodes[element.carriers(mesh.elements, len(mesh.points))["w"][nodes]]
    worst = nodes[np.argmax(shares[nodes])]
    message = f"loads: moment on 'top': {shares[worst]:.3g} of it is along the normal at node {worst} at "
    with pytest.raises(
        ms.InputError, match=re.escape(message) + r"\(.*\) mm, and without micro-rotation nothing resists"
    ):
        applied(ms.Moment("top", total), shell_of(mesh, element, micro_rotation=False))


def test_the_rounding_of_files_is_no_part_along_the_normal():
    applied(ms.Moment("top", (1.0, 0.0, 5e-5)), shell_of(FLAT, micro_rotation=False))


@pytest.mark.parametrize("micro_rotation", [True, False], ids=["ten", "seven"])
def test_work_in_full_turns_about_the_axis(micro_rotation):
    """Directors normal to the moment, turned about it and stretched on the way: the work is |M| times the angle."""
    turns, steps = 2.0, 400
    mesh = ms.mesh.rectangle(1.0, 1.0, (2, 2))
    load = applied(ms.Moment("right", (0.0, 0.7, 0.0)), shell_of(mesh, micro_rotation=micro_rotation))
    angle = np.linspace(0.0, 2.0 * np.pi * turns, steps + 1)
    length = 1.0 + 0.3 * np.sin(3.0 * angle)
    directors = length[:, None] * np.column_stack([np.sin(angle), np.zeros_like(angle), np.cos(angle)])
    state, work = at_rest(mesh), 0.0
    for before, after in pairwise(directors):
        middle = np.broadcast_to(0.5 * (before + after) - [0.0, 0.0, 1.0], state.w.shape)
        forces = load.forces(state._replace(w=middle))
        assert not np.any(forces[:, 7:10])
        work += np.sum(forces[:, 3:6] @ (after - before))
    step = angle[1]
    # the midpoint rule sees the angle of a chord, 2 tan(step/2) for a circle, and as much again of the stretch
    assert abs(work / (0.7 * angle[-1]) - 1.0) < step**2, f"{work / (0.7 * angle[-1]) - 1.0:.1e}"


def test_drills_about_the_director():
    """The director as it is, the section turned about it: all work is that of the couple."""
    mesh = ms.mesh.rectangle(1.0, 1.0, (2, 2))
    forces = applied(ms.Moment("right", (0.0, 0.0, 0.7)), shell_of(mesh)).forces(at_rest(mesh))
    assert not np.any(forces[:, :7])
    assert forces[:, 7:10].sum(axis=0) == pytest.approx([0.0, 0.0, 0.7], rel=1e-14)
