"""Shape functions, quadrature and enhanced modes."""

from __future__ import annotations

import numpy as np
import pytest
from battery import PATCHES, SINGLES, each_element, each_mesh, free_body
from hypothesis import given, settings
from hypothesis import strategies as st

from magshell.shell.shape_functions import CORNERS, NODES, bilinear, gauss_legendre, serendipity
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
    """Over the mid-surface of every element, with the surface's own area element."""
    d = free_body(mesh, element=element)
    area = np.linalg.norm(np.cross(d.body.geometry.A[:, :, 0], d.body.geometry.A[:, :, 1]), axis=-1)
    modes = d.body.shape.enhancement
    assert modes.shape[2:] == (3, len(element.modes))
    integral = np.einsum("p,ep,epam->eam", element.rule.weights, area, modes)
    size = np.einsum("p,ep,epam->eam", element.rule.weights, area, np.abs(modes)).sum(axis=1, keepdims=True)
    worst = (np.abs(integral) / size).max(initial=0.0)
    assert worst < 1e-15 * 4, f"{worst:.1e} of the integral of the magnitude"
    assert (size > 0.01).all(), f"a mode that vanishes at every point cannot be eliminated: {size}"
