"""Quaternions against rotation vectors and matrices of SciPy; the update of a state and its inverse."""

from __future__ import annotations

import numpy as np
import pytest
from battery import SINGLES, free_body, random_increment, random_state
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from magshell.equations.instant import difference
from magshell.shell import rotation
from magshell.shell.elements import PAPER

component = st.floats(-1.0, 1.0)
axes = st.tuples(component, component, component).map(np.array).filter(lambda v: np.linalg.norm(v) > 1e-3)
vectors = st.tuples(axes, st.floats(0.0, 3.1)).map(lambda both: both[0] / np.linalg.norm(both[0]) * both[1])
quaternions = vectors.map(rotation.exponential)
ANGLES = [0.0, 1e-300, 1e-12, 1e-8, 1e-4, 1e-2, 0.5, 1.0, 2.0, 3.0, np.pi - 1e-3, np.pi - 1e-6]


@pytest.mark.parametrize("angle", ANGLES)
def test_logarithm_inverts_the_exponential(angle):
    directions = np.random.default_rng(0).normal(size=(20, 3))
    vector = angle * directions / np.linalg.norm(directions, axis=1, keepdims=True)
    error = np.abs(rotation.logarithm(rotation.exponential(vector)) - vector).max()
    assert error <= 1e-12 * min(angle, 1.0), f"angle {angle}: {error:.1e}"


@pytest.mark.parametrize("angle", [*ANGLES, np.pi, 4.0, 2 * np.pi, 11.0])
def test_exponential_is_the_rotation_by_the_vector_at_any_angle(angle):
    vector = angle * np.array([2.0, -1.0, 2.0]) / 3.0
    q = rotation.exponential(vector)
    error = np.abs(rotation.matrix(q) - Rotation.from_rotvec(vector).as_matrix()).max()
    assert error < 1e-15 * (4 + angle), f"{error:.1e}"
    assert abs(np.linalg.norm(q) - 1.0) < 1e-15


def test_logarithm_of_half_a_turn():
    q = np.array([[0.0, 1.0, 0.0, 0.0], [0.0, 0.0, -0.6, 0.8]])
    assert np.abs(np.linalg.norm(rotation.logarithm(q), axis=1) - np.pi).max() < 1e-15


@given(vectors)
def test_logarithm_does_not_depend_on_the_quaternions_sign(vector):
    q = rotation.exponential(vector)
    assume(abs(q[0]) > 1e-12)
    assert np.array_equal(rotation.logarithm(-q), rotation.logarithm(q))


@given(quaternions, quaternions)
def test_product_is_the_composition(p, q):
    expected = Rotation.from_quat(p, scalar_first=True) * Rotation.from_quat(q, scalar_first=True)
    error = np.abs(rotation.matrix(rotation.product(p, q)) - expected.as_matrix()).max()
    assert error < 1e-14, f"{error:.1e}"


@given(vectors, quaternions)
def test_spin_turns_on_from_the_left(spin, q):
    turned = rotation.compose(spin, q)
    expected = Rotation.from_rotvec(spin) * Rotation.from_quat(q, scalar_first=True)
    error = np.abs(rotation.matrix(turned) - expected.as_matrix()).max()
    assert error < 1e-14, f"{error:.1e}"
    assert abs(np.linalg.norm(turned) - 1.0) < 1e-15


@given(quaternions, st.floats(0.1, 10.0))
def test_matrix_of_a_quaternion_of_any_length(q, length):
    error = np.abs(rotation.matrix(length * q) - Rotation.from_quat(q, scalar_first=True).as_matrix()).max()
    assert error < 1e-14, f"{error:.1e}"


@given(quaternions)
def test_conjugate_is_the_inverse(q):
    assert np.abs(rotation.product(rotation.conjugate(q), q) - [1.0, 0.0, 0.0, 0.0]).max() < 1e-15


# -- states ----------------------------------------------------------------------------------------------------------


def test_increment_from_inverts_moved():
    d = free_body(SINGLES["curved"](), element=PAPER)
    state = random_state(d, 1)
    increment = random_increment(d, 2, size=1.5)
    found = difference(d.moved(state, increment), state)
    errors = np.abs(found.nodal - increment.nodal).max(), np.abs(found.alpha - increment.alpha).max()
    assert max(errors) < 1e-14, errors


def test_moved_inverts_increment_from():
    d = free_body(SINGLES["curved"](), element=PAPER)
    state, other = random_state(d, 1), random_state(d, 3)
    reached = d.moved(state, difference(other, state))
    same = np.where(np.sum(reached.q * other.q, axis=1, keepdims=True) < 0.0, -1.0, 1.0)
    errors = {
        "u": np.abs(reached.u - other.u).max(),
        "w": np.abs(reached.w - other.w).max(),
        "phi": np.abs(reached.phi - other.phi).max(),
        "q": np.abs(same * reached.q - other.q).max(),
        "alpha": np.abs(reached.alpha - other.alpha).max(),
    }
    assert max(errors.values()) < 1e-14, errors


def test_moved_leaves_the_state_itself_alone():
    d = free_body(SINGLES["curved"]())
    state = random_state(d, 1)
    before = [part.copy() for part in state]
    d.moved(state, random_increment(d, 2))
    assert all(np.array_equal(a, b) for a, b in zip(before, state, strict=True))


def test_a_small_rotation_survives_many_updates():
    """Quaternions stay of unit length, and a thousand spins of π/500 are a whole turn."""
    q = rotation.identity(1)
    for _ in range(1000):
        q = rotation.compose(np.array([[0.0, 0.0, np.pi / 500]]), q)
    error = np.abs(rotation.matrix(q) - np.eye(3)).max()
    assert error < 1000 * 1e-15, f"{error:.1e}"
