"""Distributions of the remanence, and what they refuse."""

from __future__ import annotations

import numpy as np
import pytest
from battery import free_body, patch

import magshell as ms
from magshell.errors import InputError
from magshell.magnetics import remanence
from magshell.mesh import blocks

POINTS = np.random.default_rng(0).uniform(-1, 1, (4, 3, 3))


def test_constant():
    values = remanence.constant((1.0, 2.0, 3.0))(None, POINTS)
    assert values.shape == POINTS.shape
    assert np.array_equal(values[2, 1], [1.0, 2.0, 3.0])


@pytest.mark.parametrize("axis", [(0.0, 0.0, 1.0), (0.0, 2.0, 0.0), (1.0, 1.0, -1.0)])
@pytest.mark.parametrize("mirrored", [True, False])
def test_meridional_points_away_from_the_pole(axis, mirrored):
    """Along the sphere, of the given magnitude, in the plane of axis and radius; below the equator reversed."""
    pole = np.array(axis) / np.linalg.norm(axis)
    values = remanence.meridional(0.3, axis, mirrored)(None, POINTS)
    assert np.abs(np.linalg.norm(values, axis=-1) - 0.3).max() < 1e-15
    assert np.abs(np.sum(values * POINTS, axis=-1)).max() < 1e-15
    assert np.abs(np.sum(values * np.cross(pole, POINTS), axis=-1)).max() < 1e-15
    away = -np.sign(values @ pole)
    below = POINTS @ pole < 0.0
    assert below.any()
    assert not below.all()
    assert np.array_equal(away, np.where(below & mirrored, -1.0, 1.0))


def test_meridional_halves_are_mirror_images():
    sample = remanence.meridional(1.0)
    mirror = np.array([1.0, 1.0, -1.0])
    assert np.abs(sample(None, POINTS * mirror) - sample(None, POINTS) * mirror).max() < 1e-15


@pytest.mark.parametrize("axis", [(0.0, 0.0, 1.0), (1.0, -2.0, 0.5)])
def test_circumferential_is_axis_cross_radius(axis):
    values = remanence.circumferential(2.0, axis)(None, POINTS)
    expected = np.cross(axis, POINTS)
    expected *= 2.0 / np.linalg.norm(expected, axis=-1, keepdims=True)
    assert np.abs(values - expected).max() < 1e-15


def test_circumferential_towards_a_direction():
    plain = remanence.circumferential(2.0)(None, POINTS)
    values = remanence.circumferential(2.0, towards=(0.0, 3.0, 0.0))(None, POINTS)
    assert (values[..., 1] >= 0.0).all()
    assert np.array_equal(np.abs(values), np.abs(plain))


@pytest.mark.parametrize("sample", [remanence.meridional(1.0), remanence.circumferential(1.0)])
def test_undefined_on_the_axis(sample):
    with pytest.raises(InputError, match="undefined on the axis itself"):
        sample(None, np.array([[[0.0, 0.0, 2.0]]]))


def test_function_of_position():
    values = remanence.function(lambda points: 2.0 * points[:, ::-1])(None, POINTS)
    assert np.array_equal(values, 2.0 * POINTS[..., ::-1])
    with pytest.raises(InputError, match=r"returned shape \(12,\); expected \(12, 3\)"):
        remanence.function(lambda points: points[:, 0])(None, POINTS)


def two_blocks():
    corners = {"one": [(0, 0), (1, 0), (1, 1), (0, 1)], "two": [(1, 0), (2, 0), (2, 1), (1, 1)]}
    return blocks(corners, elements=(2, 2))


def test_by_group():
    mesh = two_blocks()
    points = mesh.points[mesh.elements]
    values = remanence.by_group({"two": remanence.constant((0.0, 1.0, 0.0))})(mesh, points)
    assert np.array_equal(values[mesh.elements_of("two")], np.broadcast_to((0.0, 1.0, 0.0), (4, 8, 3)))
    assert not values[mesh.elements_of("one")].any()


def test_an_element_in_two_groups_is_refused():
    mesh = two_blocks()
    both = type(mesh)(
        mesh.points, mesh.elements, {**mesh.element_groups, "all": np.arange(8)}, mesh.edge_groups, mesh.node_groups
    )
    one = remanence.constant((1.0, 0.0, 0.0))
    with pytest.raises(InputError, match="is in the groups 'one' and 'all'"):
        remanence.by_group({"one": one, "all": one})(both, both.points[both.elements])


def test_unknown_group_is_refused_with_the_nearest_name():
    mesh = two_blocks()
    with pytest.raises(InputError, match="'one'"):
        remanence.by_group({"onne": remanence.constant((1.0, 0.0, 0.0))})(mesh, mesh.points[mesh.elements])


def test_per_element():
    mesh = patch((2, 2))
    vectors = np.arange(12.0).reshape(4, 3)
    values = remanence.per_element(vectors)(mesh, mesh.points[mesh.elements])
    assert np.array_equal(values[3], np.broadcast_to(vectors[3], (8, 3)))
    with pytest.raises(InputError, match=r"shape \(3, 3\); the mesh needs \(4, 3\)"):
        remanence.per_element(vectors[:3])(mesh, mesh.points[mesh.elements])


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: remanence.constant((1.0, 2.0)), "needs 3 finite components"),
        (lambda: remanence.constant((1.0, 2.0, float("nan"))), "needs 3 finite components"),
        (lambda: remanence.meridional(1.0, axis=(0.0, 0.0, 0.0)), "zero vector; it must have a direction"),
        (lambda: remanence.circumferential(1.0, towards=(0.0, 0.0, 0.0)), "zero vector; it must have a direction"),
    ],
)
def test_vectors_that_make_no_sense(make, message):
    with pytest.raises(InputError, match=message):
        make()


def test_remanence_that_is_not_finite_names_the_element():
    values = np.zeros((2, 3))
    values[1, 2] = np.nan
    with pytest.raises(InputError, match="not finite in element 1"):
        free_body(patch((2, 1)), remanent=values)


def test_a_disc_may_have_a_node_on_the_axis():
    """A remanence is asked for at integration points, none of which lies there."""
    disc = ms.mesh.rectangle(2.0, 2.0, (2, 2))
    disc = ms.mesh.Mesh(disc.points - [1.0, 1.0, 0.0], disc.elements, disc.element_groups, disc.edge_groups)
    rubber = ms.MicropolarNeoHookean(shear_modulus=1e5, lame_lambda=1e6, coupling_modulus=1e4, length_scale=1e-2)
    shell = ms.Shell(disc, 0.1, rubber, remanence.radial(0.1))
    model = ms.Model(shell, [ms.Clamp("left")], ms.UniformField([0, 0, 1e-3]))
    assert np.linalg.norm(model.shell.remanence_at_points, axis=-1) == pytest.approx(0.1)
