"""Values at the nodes: exact where constant or linear, of second order elsewhere, never mixed across borders."""

from __future__ import annotations

import numpy as np
import pytest
from battery import TRIANGULAR, TYPES, bowl, each_element, for_element, free_body, homogeneous, patch
from scipy.spatial.transform import Rotation

import magshell as ms
from magshell.evaluation.converged import Converged
from magshell.evaluation.extrapolation import to_nodes
from magshell.evaluation.patches import patches_of
from magshell.evaluation.recovery import local_axes, recovery_of
from magshell.mesh import Mesh, split
from magshell.shell.elements import QUADRATIC

RUBBER = ms.MicropolarNeoHookean(1.0, 1.7, 0.3, 0.2)
OTHER = ms.MicropolarStVenantKirchhoff(1.0, 1.7, 0.3, 0.2)


def shell_of(mesh, **changes):
    return ms.Shell(mesh, 0.1, RUBBER, **changes)


def borders(patches, mesh):
    """The nodes that have more than one row."""
    return set(np.flatnonzero(np.bincount(patches.nodes, minlength=len(mesh.points)) > 1).tolist())


def at_x(mesh, x):
    return set(np.flatnonzero(np.abs(mesh.points[:, 0] - x) < 1e-9).tolist())


# -- patches -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("triangles", [False, True])
def test_a_smooth_shell_of_one_make_has_a_row_for_each_node(triangles):
    mesh = patch((4, 3), distortion=0.2, surface=bowl)
    mesh = for_element(mesh, TRIANGULAR) if triangles else mesh
    found = patches_of(shell_of(mesh))
    np.testing.assert_array_equal(found.nodes, np.arange(len(mesh.points)))
    np.testing.assert_array_equal(found.elements, mesh.elements)
    np.testing.assert_allclose(found.mean.sum(axis=1), 1.0, rtol=1e-14)


def with_region(**changes):
    """Two by four elements, the second half of them a region."""
    mesh = patch((2, 4))
    mesh = Mesh(mesh.points, mesh.elements, {"second": np.arange(4, 8)})
    return mesh, shell_of(mesh, regions=[ms.Region("second", **{"thickness": 0.1, "material": RUBBER} | changes)])


@pytest.mark.parametrize(
    "change",
    [
        {"thickness": 0.2},
        {"material": OTHER},
        {"material": RUBBER._replace(shear_modulus=2.0)},
        {"thickness": None, "material": None, "layers": [ms.Layer(0.05, RUBBER), ms.Layer(0.05, OTHER)]},
    ],
    ids=["thickness", "law", "modulus", "layers"],
)
def test_a_change_of_make_is_a_border(change):
    mesh, shell = with_region(**change)
    found = patches_of(shell)
    assert borders(found, mesh) == set(np.intersect1d(mesh.elements[:4], mesh.elements[4:]).tolist())
    assert len(np.intersect1d(found.elements[:4], found.elements[4:])) == 0
    np.testing.assert_array_equal(found.nodes[found.elements], mesh.elements)
    np.testing.assert_array_equal(found.nodes[: len(mesh.points)], np.arange(len(mesh.points)))


def test_regions_of_equal_data_have_no_border():
    mesh, shell = with_region()
    assert not borders(patches_of(shell), mesh)


def fold(angle):
    """Four by two elements, folded at x = 2."""
    mesh = patch((4, 2))
    points = mesh.points.copy()
    beyond = points[:, 0] > 2.0
    points[beyond] = [2, 0, 0] + (points[beyond] - [2, 0, 0]) @ Rotation.from_rotvec([0, -angle, 0]).as_matrix().T
    return Mesh(points, mesh.elements)


def test_a_kink_is_a_border_and_a_gentle_turn_is_none():
    mesh = fold(np.radians(30.0))
    found = patches_of(shell_of(mesh))
    assert borders(found, mesh) == at_x(mesh, 2.0)
    both = found.normals[[row for row in range(len(found.nodes)) if found.nodes[row] in at_x(mesh, 2.0)]]
    assert np.ptp(both @ found.normals[0]) == pytest.approx(1.0 - np.cos(np.radians(30.0)), abs=1e-12)
    assert not borders(patches_of(shell_of(fold(np.radians(5.0)))), mesh)


def test_a_jump_of_the_remanence_is_a_border_and_a_smooth_change_is_none():
    mesh = patch((4, 2))
    left = mesh.points[mesh.elements].mean(axis=1)[:, 0] < 2.0
    vectors = np.where(left[:, None], [0.1, 0, 0], [-0.1, 0, 0])
    assert borders(patches_of(shell_of(mesh, remanence=ms.remanence.per_element(vectors))), mesh) == at_x(mesh, 2.0)
    turning = ms.remanence.function(lambda x: np.stack([np.cos(x[..., 0]), np.sin(x[..., 0]), 0 * x[..., 0]], axis=-1))
    assert not borders(patches_of(shell_of(mesh, remanence=turning)), mesh)


def test_elements_that_meet_in_a_corner_only_are_apart():
    one, other = patch((1, 1)), patch((1, 1))
    points = np.vstack([one.points, other.points + np.array([1, 1, 0])])
    shared = np.flatnonzero(np.abs(points - [1, 1, 0]).sum(axis=1) < 1e-12)
    number = np.arange(len(points))
    number[shared[1]] = shared[0]
    kept, rows = np.unique(number, return_inverse=True)
    mesh = Mesh(points[kept], rows[np.vstack([one.elements, other.elements + len(one.points)])])
    assert borders(patches_of(shell_of(mesh)), mesh) == {int(rows[shared[0]])}


# -- extrapolation -----------------------------------------------------------------------------------------------------


@each_element
def test_linear_fields_reach_the_nodes(element):
    mesh = for_element(patch((3, 2), distortion=0.2), element)
    coordinates = mesh.points[mesh.elements]
    points, _ = element.integration(coordinates)
    places = np.einsum("epn,enx->epx", element.functions(8, points, coordinates).values, coordinates)
    matrices = to_nodes(element, coordinates)
    nodal = np.einsum("enp,epx->enx", matrices, places)
    kept = np.abs(matrices).sum(axis=2) > 0.0
    np.testing.assert_allclose(nodal[kept], coordinates[kept], atol=1e-13)
    assert kept.sum() == sum(len(set(row)) for row in mesh.elements.tolist())


@pytest.mark.parametrize("name", ["quadratic", "triangles"])
def test_shear_is_laid_through_the_means(name):
    """A linear field on a flat mesh, whatever its values at the points are about the means."""
    mesh = for_element(patch((4, 3), distortion=0.2), TYPES[name])
    d = free_body(mesh, element=TYPES[name])
    recovery = recovery_of(d)
    coordinates = d.mesh.points[d.mesh.elements]
    points, _ = d.model.shell.element.integration(coordinates)
    places = np.einsum("epn,enx->epx", d.model.shell.element.functions(8, points, coordinates).values, coordinates)
    field = np.array([[0.3, -0.2, 0.0], [0.1, 0.4, 0.0], [0.0, 0.0, 0.0]])
    mean = np.einsum("ep,epx->ex", recovery.neighbours.shares, places)
    vectors = np.broadcast_to(mean[:, None], places.shape) @ field.T + [0.7, -0.1, 0.0]
    local = np.einsum("epix,epx->epi", recovery.points, vectors)
    found = np.einsum("rix,ri->rx", recovery.axes, recovery.vectors(local))
    np.testing.assert_allclose(found, d.mesh.points @ field.T + [0.7, -0.1, 0.0], atol=1e-12)


# -- axes --------------------------------------------------------------------------------------------------------------


def test_local_axes_are_the_projection_of_the_direction():
    normals = np.array([[0, 0, 1], [0, 1, 0], [1, 0, 0], [0.6, 0, 0.8]], dtype=float)
    axes = local_axes(normals, np.array([2.0, 0, 0]))
    expected = [[1, 0, 0], [1, 0, 0], [0, 0, 1], [0.8, 0, -0.6]]
    np.testing.assert_allclose(axes[:, 0], expected, atol=1e-15)
    np.testing.assert_allclose(axes @ np.swapaxes(axes, 1, 2), np.tile(np.eye(3), (4, 1, 1)), atol=1e-15)
    np.testing.assert_allclose(np.linalg.det(axes), 1.0)
    np.testing.assert_allclose(axes[:, 2], normals)
    np.testing.assert_allclose(local_axes(normals[:1], np.array([0.0, 0, 3]))[0], np.eye(3)[[0, 1, 2]], atol=1e-15)


@pytest.mark.parametrize("wrong", [(0, 0, 0), (1, 0), (np.nan, 0, 0)])
def test_a_direction_that_is_none_is_refused(wrong):
    strip = ms.mesh.rectangle(1.0, 0.2, (2, 1))
    with pytest.raises(ms.InputError, match=r"local_axis is .* three finite numbers, not all zero"):
        ms.Model(shell_of(strip), [ms.Clamp("left")], loads=[ms.Force("right", (0, 0, 1))], local_axis=wrong)


# -- homogeneous deformation -------------------------------------------------------------------------------------------


@each_element
@pytest.mark.parametrize("surface", [None, bowl], ids=["flat", "curved"])
def test_a_homogeneous_deformation_is_the_same_at_every_node(element, surface):
    """F is constant in space. On a flat shell its components are, too; on a curved one the axes turn."""
    mesh = patch((3, 3), distortion=0.2, **({"surface": surface} if surface else {}))
    d = free_body(mesh, element=element)
    F = np.eye(3) + 0.2 * np.random.default_rng(2).uniform(-1, 1, (3, 3))
    R = Rotation.from_rotvec([0.3, -0.2, 0.1]).as_matrix()
    reached = Converged(d, homogeneous(d, F, R), d.model.loading(1.0))
    axes = recovery_of(d).axes
    for face in ("top", "middle", "bottom"):
        E = axes @ (0.5 * (F.T @ F - np.eye(3))) @ np.swapaxes(axes, 1, 2)
        error = np.abs(reached.at_face("green_strain", face) - E).max()
        assert error < (0.05 if surface else 1e-12), error
        stretches = np.sqrt(np.linalg.eigvalsh(F.T @ F))[::-1]
        error = np.abs(reached.at_face("principal_stretches", face) - stretches).max()
        assert error < (0.02 if surface else 1e-12), error


# -- order -------------------------------------------------------------------------------------------------------------


def lame(count, element=QUADRATIC, distortion=0.0):
    """Largest error of the stresses of a quarter of a ring under inner pressure (plane stress), over all nodes."""
    mesh = patch((count, count), distortion, keep_boundary=True)
    inner, outer, p, mu, lam = 1.0, 2.0, 1e-6, 1.0, 0.0
    r, angle = (inner + (outer - inner) * mesh.points[:, 0] / count, 0.5 * np.pi * mesh.points[:, 1] / count)
    mesh = Mesh(np.stack([r * np.cos(angle), r * np.sin(angle), 0 * r], axis=1), mesh.elements)
    if element.triangle_rule is not None:
        mesh = split(mesh, "rising")
    young = 2.0 * mu
    d = free_body(mesh, ms.MicropolarStVenantKirchhoff(mu, lam, 0.1, 0.1), element=element, remanent=(0, 0, 0))
    a = p * inner**2 / (outer**2 - inner**2)
    r, angle = np.linalg.norm(d.mesh.points[:, :2], axis=1), np.arctan2(d.mesh.points[:, 1], d.mesh.points[:, 0])
    u = a / young * (r + outer**2 / r)
    state = d.undeformed()
    state.u[:, 0], state.u[:, 1] = u * np.cos(angle), u * np.sin(angle)
    stress = Converged(d, state, d.model.loading(0.0)).at_face("stress", "middle")
    radial, hoop = a * (1 - outer**2 / r**2), a * (1 + outer**2 / r**2)
    c, s = np.cos(angle), np.sin(angle)
    turn = np.stack([np.stack([c, -s], axis=1), np.stack([s, c], axis=1)], axis=1)
    diagonal = np.stack([radial, hoop], axis=1)[:, None] * np.eye(2)
    exact = turn @ diagonal @ np.swapaxes(turn, 1, 2)
    return np.abs(stress[:, :2, :2] - exact).max() / p


@pytest.mark.parametrize(("name", "distortion"), [("quadratic", 0.0), ("quadratic", 0.2), ("triangles", 0.0)])
def test_stresses_at_all_nodes_are_of_second_order(name, distortion):
    """Of the interpolated exact displacement: the error is that of differentiation, extrapolation and averaging."""
    errors = [lame(count, TYPES[name], distortion) for count in (4, 8, 16)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders.min() > 1.7, (errors, orders)
