"""Shape functions, quadrature and enhanced modes."""

from __future__ import annotations

import numpy as np
import pytest
from battery import PATCHES, SINGLES, each_element, each_mesh, flat, free_body
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from magshell.shell.shape_functions import (
    CORNERS,
    NODES,
    bilinear,
    gauss_legendre,
    quadratic_complete,
    serendipity,
)
from shell import jets, oracle

coordinates = st.floats(-1.0, 1.0)
FUNCTIONS = {"bilinear": (bilinear, CORNERS, oracle.four), "serendipity": (serendipity, NODES, oracle.eight)}
each_function = pytest.mark.parametrize(("functions", "nodes", "other"), FUNCTIONS.values(), ids=FUNCTIONS)


@each_function
@settings(max_examples=50, deadline=None)
@given(xi=coordinates, eta=coordinates)
def test_partition_of_unity(functions, nodes, other, xi, eta):
    values, *derivatives = functions(np.array([[xi, eta]]))
    error = abs(values.sum() - 1.0)
    assert error < 1e-13, f"sum of the functions off by {error:.1e}"
    for order, rows in enumerate(derivatives, start=1):
        error = np.abs(rows.sum(axis=-1)).max()
        assert error < 1e-13, f"sum of the derivatives of order {order} is {error:.1e}"


@each_function
def test_one_at_its_own_node_and_zero_at_the_others(functions, nodes, other):
    assert np.array_equal(functions(nodes)[0], np.eye(len(nodes)))


@each_function
@settings(max_examples=50, deadline=None)
@given(xi=coordinates, eta=coordinates)
def test_values_and_derivatives(functions, nodes, other, xi, eta):
    """Against another form of the functions, differentiated by jets; the bound is 10 eps of the largest value, 4."""
    values, first, *second = functions(np.array([[xi, eta]]))
    expected = other(jets.variables([xi, eta]))
    errors = [np.abs(values[0] - jets.value(expected)).max(), np.abs(first[0].T - jets.gradient(expected)).max()]
    if second:
        H = jets.hessian(expected)
        rows = np.stack([H[:, 0, 0], H[:, 1, 1], H[:, 0, 1]])
        errors.append(np.abs(second[0][0] - rows).max())
    assert max(errors) < 1e-14, f"values, first, second derivatives: {errors}"


@settings(max_examples=50, deadline=None)
@given(xi=coordinates, eta=coordinates)
def test_serendipity_reproduces_cubics_without_xi2_eta2(xi, eta):
    """Its space: all quadratics, ξ²η and ξη². This is why a distorted element cannot bend exactly."""
    monomials = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (2, 1), (1, 2)]
    at_nodes = np.array([NODES[:, 0] ** a * NODES[:, 1] ** b for a, b in monomials])
    values = at_nodes @ serendipity(np.array([[xi, eta]]))[0][0]
    error = np.abs(values - [xi**a * eta**b for a, b in monomials]).max()
    assert error < 1e-14, f"{error:.1e}"


@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_quadrature_is_exact_to_its_degree(count):
    at, weights = gauss_legendre(count)
    integral = lambda a: 2.0 / (a + 1) if a % 2 == 0 else 0.0  # noqa: E731
    for a in range(2 * count):
        for b in range(2 * count):
            error = abs(weights @ (at[:, 0] ** a * at[:, 1] ** b) - integral(a) * integral(b))
            assert error < 1e-14, f"ξ^{a} η^{b}: {error:.1e}"


@each_element
@each_mesh(SINGLES | PATCHES)
def test_enhanced_modes_integrate_to_zero(mesh, element):
    """What a mode adds to F on flat elements, to g_3 on any: over the surface of every element, with its own area."""
    d = free_body(mesh, element=element)
    assert d.reference.shape.enhancement.shape[2:] == (3, element.vectors)
    of_triangles = element.triangle_rule is not None
    modes, geometry = d.reference.shape.enhancement[..., : len(element.modes) + of_triangles], d.reference.geometry
    weights = element.integration(d.mesh.points[d.mesh.elements])[1]
    area = np.linalg.norm(np.cross(geometry.A[:, :, 0], geometry.A[:, :, 1]), axis=-1) * weights
    parts = [modes[:, :, 2]]
    if np.ptp(mesh.points[:, 2]) == 0.0:
        base = np.concatenate([geometry.A, geometry.D[:, :, None]], axis=2)
        F = np.einsum("epam,epxa->epmx", modes, np.linalg.inv(base))
        parts += [F[..., x] for x in range(3)]
    for part in parts:
        integral, size = np.einsum("ep,epm->em", area, part), np.einsum("ep,epm->em", area, np.abs(part))
        worst = (np.abs(integral) / np.maximum(size, 0.1)).max(initial=0.0)
        assert worst < 1e-15 * 8, f"{worst:.1e} of the integral of the magnitude"
    seen = np.abs(modes).max(axis=(1, 2)) > 0.01
    assert seen[d.mesh.triangles | (not of_triangles)].all(), "a mode that no point sees cannot be eliminated"
    assert not seen[~d.mesh.triangles, len(element.modes) :].any(), "quadrilaterals have none of the triangles'"


# -- complete functions ----------------------------------------------------------------------------------------------

SQUARE = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * 1.0
shifts = st.lists(st.floats(-0.45, 0.45), min_size=8, max_size=8).map(lambda values: np.reshape(values, (4, 2)))
coefficients = st.lists(st.floats(-1.0, 1.0), min_size=6, max_size=6).map(np.array)
turns = st.tuples(*[st.floats(-3.0, 3.0)] * 3).map(np.array)


@settings(max_examples=200, deadline=None)
@given(shift=shifts, coefficient=coefficients, turn=turns, xi=coordinates, eta=coordinates)
def test_complete_functions_hold_every_quadratic_polynomial(shift, coefficient, turn, xi, eta):
    """On any convex quadrilateral with straight sides (corners within 0.45 of a square's), turned anyhow in space."""
    Q = Rotation.from_rotvec(turn).as_matrix()
    corners = SQUARE + shift
    plane = np.vstack([corners, 0.5 * (corners + np.roll(corners, -1, axis=0))])
    at = bilinear(np.array([[xi, eta]]))[0] @ corners

    def polynomial(x):
        return np.stack([np.ones(len(x)), *x.T, *(x.T**2), x[:, 0] * x[:, 1]], axis=1) @ coefficient

    values, derivatives = quadratic_complete(np.array([[xi, eta]]), (flat(plane) @ Q.T)[None])
    error = abs(values[0, 0] @ polynomial(plane) - polynomial(at)[0])
    assert error < 1e-12, f"{error:.1e}"
    expected = oracle.eight_complete(jets.variables([xi, eta]), flat(plane) @ Q.T)
    errors = (
        np.abs(values[0, 0] - jets.value(expected)).max(),
        np.abs(derivatives[0, 0].T - jets.gradient(expected)).max(),
    )
    assert max(errors) < 1e-12, f"values and derivatives, against another form: {errors}"
    assert abs(values.sum() - 1.0) < 1e-13
    assert np.abs(derivatives.sum(axis=-1)).max() < 1e-13


def test_plain_functions_do_not():
    """By as much as the distortion: this is what the complete ones add."""
    corners = SQUARE + np.array([[0.0, 0.0], [0.0, 0.0], [0.4, 0.3], [0.0, 0.0]])
    plane = np.vstack([corners, 0.5 * (corners + np.roll(corners, -1, axis=0))])
    at = np.array([[0.0, 0.0]])
    error = abs(serendipity(at)[0][0] @ plane[:, 0] ** 2 - (bilinear(at)[0] @ corners)[0, 0] ** 2)
    assert error == pytest.approx(0.1**2, rel=1e-12), f"{error:.3g}: ¼ of the twist of X1, 0.4, squared"
