"""The nonlinear eigenproblem K(s) φ = 0 on small matrices whose roots are known."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from magshell.linalg import make_solver
from magshell.linalg.superlu import SuperLUFactors
from magshell.solver import eigenproblem
from magshell.solver.eigenproblem import roots_nearest_to_zero

SIZE = 24


def problem(functions, symmetric=True, seed=1):
    """K(s) = Aᵀ diag(f_i(s)) B, singular where one of the functions vanishes; the rest of the diagonal is 1."""
    rng = np.random.default_rng(seed)
    left = np.eye(SIZE) + 0.2 * rng.normal(size=(SIZE, SIZE))
    right = left if symmetric else left + 0.02 * rng.normal(size=(SIZE, SIZE))

    def matrix(s):
        diagonal = np.ones(SIZE)
        diagonal[: len(functions)] = [function(s) for function in functions]
        return sp.csc_array(left.T @ np.diag(diagonal) @ right)

    return matrix, right


def values(matrix, wanted, reach=np.inf):
    return [pair.value for pair in roots_nearest_to_zero(matrix, make_solver("superlu"), wanted, reach).pairs]


def line(root):
    """A function with one root."""
    return lambda s: 1.0 - s / root


def parabola(one, two):
    """A function with two roots, and 1 at zero."""
    return lambda s: (1.0 - s / one) * (1.0 - s / two)


@pytest.mark.parametrize("symmetric", [True, False], ids=["symmetric", "unsymmetric"])
def test_roots_of_a_quadratic_problem_with_their_vectors(symmetric):
    functions = [parabola(2.0, 9.0), parabola(-3.0, 5.0), line(-0.7), lambda s: 1.0 + s**2]
    matrix, right = problem(functions, symmetric)
    roots = roots_nearest_to_zero(matrix, make_solver("superlu"), 4, 20.0)
    assert [pair.value for pair in roots.pairs] == pytest.approx([-0.7, 2.0, -3.0, 5.0], rel=1e-9)
    assert 5.0 <= roots.counted < 9.0
    assert roots.complete
    for pair, place in zip(roots.pairs, [2, 0, 1, 1], strict=True):
        own = np.abs(right @ pair.vector)
        own[place] /= 1e8
        assert own.max() < 1e-6 * own[place] * 1e8, place


def test_roots_far_from_a_quadratic_guess():
    """The guesses know three points of these functions, all next to zero."""
    functions = [lambda s: np.cos(s), lambda s: np.exp(-s) - 0.1, lambda s: 1.0 + s**3 / 64.0]
    found = values(problem(functions)[0], 4, 4.5)
    assert found == pytest.approx([np.pi / 2, -np.pi / 2, np.log(10.0), -4.0], rel=1e-9)


def test_a_root_that_no_guess_tells_of_is_found_by_the_pivots(monkeypatch):
    """Without any guesses: the whole range is searched because the pivots change in it."""
    functions = [parabola(2.0, 9.0), parabola(-3.0, 5.0), line(-0.7), line(2.05)]
    monkeypatch.setattr(eigenproblem._Search, "guesses", lambda self: [])
    assert values(problem(functions)[0], 6, 10.0) == pytest.approx([-0.7, 2.0, 2.05, -3.0, 5.0, 9.0], rel=1e-9)
    assert values(problem(functions)[0], 2, 10.0) == pytest.approx([-0.7, 2.0], rel=1e-9)


@pytest.mark.parametrize("distance", [0.0, 1e-8, 1e-5, 1e-2])
def test_double_roots_have_two_modes(distance):
    functions = [line(2.0), line(2.0 * (1.0 + distance)), parabola(3.0, 10.0)]
    matrix, right = problem(functions)
    pairs = roots_nearest_to_zero(matrix, make_solver("superlu"), 3, 8.0).pairs
    assert [pair.value for pair in pairs] == pytest.approx([2.0, 2.0 * (1.0 + distance), 3.0], rel=1e-8)
    modes = np.array([(right @ pair.vector)[:2] / np.linalg.norm(right @ pair.vector) for pair in pairs[:2]])
    assert abs(np.linalg.det(modes)) > 0.1


def test_a_double_root_of_which_the_guesses_know_one(monkeypatch):
    matrix, _ = problem([line(2.0), line(2.0), line(5.0)])
    guesses = eigenproblem._Search.guesses
    monkeypatch.setattr(eigenproblem._Search, "guesses", lambda self: guesses(self)[1:])
    assert values(matrix, 3, 8.0) == pytest.approx([2.0, 2.0, 5.0], rel=1e-8)


def test_only_roots_within_reach():
    matrix, _ = problem([line(2.0), line(-3.0), parabola(4.0, 30.0)])
    roots = roots_nearest_to_zero(matrix, make_solver("superlu"), 5, 3.5)
    assert [pair.value for pair in roots.pairs] == pytest.approx([2.0, -3.0], rel=1e-9)
    assert roots.counted == 3.5


def test_no_real_roots():
    """Complex roots next to the real line lead Newton's method astray, but not to a root."""
    functions = [lambda s, c=c: (s - c) ** 2 / c**2 + 1e-3 for c in (1.5, -1.5, 2.5)]
    roots = roots_nearest_to_zero(problem(functions)[0], make_solver("superlu"), 4, 10.0)
    assert not roots.pairs
    assert roots.counted == 10.0


def test_a_matrix_that_does_not_change():
    assert values(problem([])[0], 3) == []


def test_of_two_that_differ_by_their_sign_the_positive_one_is_first():
    functions = [lambda s: 1.0 - s**2 / 4.0, lambda s: 1.0 - s**2 / 9.0]
    for seed in range(4):
        assert values(problem(functions, seed=seed)[0], 4, 20.0) == pytest.approx([2.0, -2.0, 3.0, -3.0], rel=1e-9)


def test_a_solver_that_counts_no_pivots(monkeypatch):
    monkeypatch.setattr(SuperLUFactors, "negative_pivots", lambda self: None)
    solver = make_solver("superlu")
    roots = roots_nearest_to_zero(problem([line(2.0), line(-3.0)])[0], solver, 2, 10.0)
    assert [pair.value for pair in roots.pairs] == pytest.approx([2.0, -3.0], rel=1e-9)
    assert roots.counted is None
    assert not roots.complete


def test_roots_that_are_not_found_are_told(monkeypatch):
    """With neither guesses nor linear problems in the gaps."""
    monkeypatch.setattr(eigenproblem._Search, "guesses", lambda self: [])
    monkeypatch.setattr(eigenproblem._Search, "local", lambda self, s: [])
    roots = roots_nearest_to_zero(problem([line(2.3), line(-3.0)])[0], make_solver("superlu"), 2, 10.0)
    assert not roots.pairs
    assert roots.counted == pytest.approx(2.3, rel=eigenproblem.CLEAR)
    assert roots.counted < 2.3
    assert not roots.complete
