"""The oracle itself: jets against complex steps and a function differentiated by hand."""

from __future__ import annotations

import numpy as np

from shell import jets


def function(x, log, sqrt):
    """Uses every operation of a jet."""
    return 2.0 / x[0] - x[1] ** 3 * log(x[0] * x[0] + 1.0) + sqrt(x[2] - (-x[1])) / (1.5 + x[0]) - (3.0 - x[2]) * x[1]


def test_gradient_is_the_complex_step_derivative():
    x, step = np.array([0.7, 1.3, 2.1]), 1e-30
    jet = function(jets.variables(x), jets.log, jets.sqrt)
    steps = [function(x + 1j * step * axis, np.log, np.sqrt).imag / step for axis in np.eye(3)]
    assert abs(jet.value - function(x, np.log, np.sqrt)) < 1e-14
    assert np.abs(jet.gradient - steps).max() < 1e-14


def test_hessian_is_the_complex_step_derivative_of_the_gradient():
    """Of r³ with r = |x|: gradient 3 r x, Hessian 3 (r I + x xᵀ / r)."""
    x = np.array([0.7, -1.3, 2.1])
    r = np.linalg.norm(x)
    at = jets.variables(x)
    jet = jets.sqrt(at @ at) ** 3
    assert np.abs(jet.gradient - 3 * r * x).max() < 1e-13
    assert np.abs(jet.hessian - 3 * (r * np.eye(3) + np.outer(x, x) / r)).max() < 1e-13


def test_arrays_of_jets():
    A = np.arange(9.0).reshape(3, 3) + 5.0 * np.eye(3)
    at = jets.variables(A)
    product = at @ A
    assert np.array_equal(jets.value(product), A @ A)
    assert np.array_equal(jets.gradient(product), np.einsum("ia,cj->ijac", np.eye(3), A).reshape(3, 3, 9))
    cross = np.cross(at[0], at[1])
    assert np.array_equal(jets.value(cross), np.cross(A[0], A[1]))
    assert np.array_equal(jets.hessian(np.array([2.0]) * at[0, 0]), np.zeros((1, 9, 9)))
