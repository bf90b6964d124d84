"""Directions that a surface, a curve, an axis or a coordinate gives to the remanence."""

from __future__ import annotations

import numpy as np
import pytest

import magshell as ms
from magshell.errors import InputError
from magshell.magnetics import remanence
from magshell.magnetics.remanence.curve import chained
from magshell.magnetics.remanence.inside import find
from magshell.shell.shape_functions import gauss_legendre, serendipity

RADIUS = 10e-3
TUBE = ms.mesh.cylinder(RADIUS, 12e-3, elements=(8, 3), angle=(0, 90))


def integration_points(mesh):
    """Nine points of each element, (elements, 9, 3)."""
    return np.einsum("pn,enx->epx", serendipity(gauss_legendre(3)[0])[0], mesh.points[mesh.elements])


def test_radial():
    points = np.random.default_rng(1).uniform(-1, 1, (4, 3, 3))
    axis, through = np.array([1.0, -1.0, 2.0]), np.array([0.3, 0.2, -0.1])
    values = remanence.radial(0.5, axis, through)(None, points)
    assert np.abs(np.linalg.norm(values, axis=-1) - 0.5).max() < 1e-15
    assert np.abs(values @ axis).max() < 1e-15
    assert np.abs(np.sum(np.cross(points - through, values) @ axis, axis=-1)).max() < 1e-14
    assert (np.sum(values * (points - through), axis=-1) > 0).all()
    assert np.array_equal(remanence.radial(0.5, axis, through, inward=True)(None, points), -values)
    with pytest.raises(InputError, match="undefined on the axis itself"):
        remanence.radial(1.0, axis, through)(None, np.broadcast_to(through, (1, 1, 3)))


def test_material_points_are_found_again():
    mesh = ms.mesh.sphere_patch(RADIUS, (20, 150), (-40, 30), (5, 4))
    parent = np.random.default_rng(2).uniform(-0.95, 0.95, (7, 2))
    N, dN, _ = serendipity(parent)
    points = np.einsum("pn,enx->epx", N, mesh.points[mesh.elements])
    inside = find(mesh, points)
    worst = np.abs(inside.values - N).max(), np.abs(inside.derivatives - dN).max()
    assert max(worst) < 1e-11, worst


def test_points_in_triangles():
    """Triangles are rows whose corners 3 and 4 and the mid-side between them are one node; quadratics are exact."""
    corners = np.array([[0.0, 0.0, 0.0], [2.0, 0.1, 0.2], [0.3, 1.0, -0.1]])
    middles = 0.5 * (corners + np.roll(corners, -1, axis=0))
    half = ms.mesh.Mesh(np.concatenate([corners, middles]), np.array([[0, 1, 2, 2, 3, 4, 2, 5]]))

    L = np.random.default_rng(3).dirichlet((1, 1, 1), 5)
    points = (L @ corners)[None]
    inside = find(half, points)

    def quadratic(x):
        return np.stack([x[..., 0] ** 2, x[..., 0] * x[..., 1], 1 + x[..., 2]], axis=-1)

    assert np.abs(inside.at(quadratic(half.points[half.elements])) - quadratic(points)).max() < 1e-13
    assert np.abs(np.cross(*np.moveaxis(inside.slopes(half.points[half.elements]), 2, 0)) - np.cross(
        corners[1] - corners[0], corners[2] - corners[0]
    )).max() < 1e-13  # fmt: skip


def test_tangential_is_the_projection_onto_the_surface():
    along = np.array([1.0, 2.0, 0.5])
    points = integration_points(TUBE)
    values = remanence.tangential(0.2, along)(TUBE, points)
    assert np.abs(np.linalg.norm(values, axis=-1) - 0.2).max() < 1e-15
    normal = points * [1, 1, 0] / RADIUS
    quadratic_error = (np.pi / 4 / 8) ** 3
    assert np.abs(np.sum(values * normal, axis=-1)).max() < 0.2 * quadratic_error
    expected = along - (normal @ along)[..., None] * normal
    expected *= 0.2 / np.linalg.norm(expected, axis=-1, keepdims=True)
    assert np.abs(values - expected).max() < 0.2 * 2 * quadratic_error, np.abs(values - expected).max()


def test_a_direction_normal_to_the_surface_has_no_part_in_it():
    plate = ms.mesh.rectangle(2.0, 1.0, (2, 1))
    with pytest.raises(InputError, match="normal to the surface in element 0"):
        remanence.tangential(0.1, (0.0, 0.0, 1.0))(plate, integration_points(plate))


def test_along_the_inner_edge_of_a_ring():
    """The nearest point of a circle is on the same radius: the tangent there is the circumferential direction."""
    ring = ms.mesh.annulus(6e-3, 10e-3, (3, 24))
    points = integration_points(ring)
    values = remanence.along_curve("inner", 0.3)(ring, points)
    around = remanence.circumferential(0.3)(ring, points)
    sense = np.sign(np.sum(values * around, axis=-1))
    assert (sense == sense[0, 0]).all()
    half_angle = np.pi / 24
    assert np.abs(values - sense[0, 0] * around).max() < 0.3 * 2 * half_angle**3, np.abs(values).max()
    towards = remanence.along_curve("inner", 0.3, towards=(0, 1, 0))(ring, points)
    assert (towards[..., 1] >= 0).all()
    assert np.array_equal(np.abs(towards), np.abs(values))


def test_curves_run_as_their_first_edge_does_whatever_the_order():
    ring = ms.mesh.annulus(6e-3, 10e-3, (1, 8))
    edges = ring.edge_groups["inner"]
    mixed = edges[np.random.default_rng(4).permutation(8)].copy()
    mixed[1::2, :2] = mixed[1::2, [1, 0]]
    found = chained(mixed, "inner")
    same = {tuple(edge) for edge in found.tolist()}
    forwards = {tuple(edge) for edge in edges.tolist()}
    backwards = {(b, a, m) for a, b, m in forwards}
    assert same == (forwards if tuple(mixed[0].tolist()) in forwards else backwards)
    with pytest.raises(InputError, match="'inner' branches at node"):
        chained(np.vstack([edges, [[edges[0, 0], 99, 98]]]), "inner")


def test_curve_that_is_none():
    with pytest.raises(InputError, match=r"no edge group 'strat'. Did you mean 'start'"):
        remanence.along_curve("strat", 0.1)(TUBE, integration_points(TUBE))


def test_harmonic_profile():
    """Two positions a wave length apart and angles a full turn apart make a harmonic wave."""
    length, phase = 3.7e-3, np.radians(45)
    plate = ms.mesh.rectangle(length, 1.5e-3, (6, 2))
    points = integration_points(plate)
    wave = remanence.profile(62e-3, (0, length), (1, 0, 0), (1, 0, 0), (phase, phase + 2 * np.pi), (0, 0, 1))
    θ = 2 * np.pi * points[..., 0] / length + phase
    expected = 62e-3 * np.stack([np.cos(θ), 0 * θ, np.sin(θ)], axis=-1)
    assert np.abs(wave(plate, points) - expected).max() < 1e-15


def test_table_of_magnitudes_is_constant_beyond_its_ends():
    x = np.array([-1.0, 0.0, 0.5, 1.0, 2.5, 4.0])
    points = np.stack([x, 0 * x, 0 * x], axis=-1)[None] + [1.0, 2.0, 3.0]
    values = remanence.profile(
        (1.0, -1.0, 3.0), (0, 1, 3), (5, 0, 0), (1, 0, 0), np.pi / 2, (1, 1, 0), origin=(1, 0, 0)
    )(None, points)
    assert np.abs(values[0, :, 1] - [1, 1, 0, -1, 2, 3]).max() < 1e-15
    assert np.abs(values[0, :, [0, 2]]).max() < 1e-15


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"positions": (0, 0)}, "numbers that rise"),
        ({"positions": ()}, "numbers that rise"),
        ({"angles": (0, 1, 2)}, "one for each of 2 positions"),
        ({"magnitudes": (0, np.nan)}, "magnitudes are"),
        ({"towards": (-2, 0, 0)}, "parallel to start"),
        ({"towards": None}, "towards is missing"),
        ({"along": (0, 0, 0)}, "along is the zero vector"),
    ],
)
def test_profiles_that_make_no_sense(change, words):
    good = {"magnitudes": 1.0, "angles": (0, 1), "positions": (0, 1), "along": (1, 0, 0), "start": (1, 0, 0)}
    with pytest.raises(InputError, match=words):
        remanence.profile(**(good | {"towards": (0, 0, 1)} | change))


def test_groups_ask_only_for_their_own_points():
    """A direction that is undefined in another group is nobody's concern."""
    corners = {"one": [(0, 0), (1, 0), (1, 1), (0, 1)], "two": [(1, 0), (2, 0), (2, 1), (1, 1)]}
    mesh = ms.mesh.blocks(corners, elements=(1, 1))
    points = mesh.points[mesh.elements]
    values = remanence.by_group({"two": remanence.radial(1.0)})(mesh, points)
    assert np.isfinite(values).all()
    seen = []
    remanence.by_group({"two": remanence.function(lambda x: seen.append(x) or x)})(mesh, points)
    assert np.array_equal(seen[0], points[1])
