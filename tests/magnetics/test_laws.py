"""Every coupling law: forces and tangents against an independent formula, symmetry and energy, frame indifference."""

from __future__ import annotations

import numpy as np
import pytest
from battery import COUPLINGS, each_coupling
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from shell import jets, oracle

from magnetics.reference import ENERGIES, FORCES
from magshell import magnetics
from magshell.magnetics import law
from magshell.magnetics.law import OMEGA, M, is_conservative

seeds = st.integers(0, 2**32 - 1)
TOLERANCE = 1e-14
"""Entries are of the order of one, sums have six terms."""


def evaluate(coupling, m, n, B):
    """Forces (6,) and tangent (6, 6) on (m, spin); in a uniform field nothing acts on the position."""
    _, forces, K = law.evaluate(coupling, m, n, B)
    rows = [*range(M, M + 3), *range(OMEGA, OMEGA + 3)]
    assert not np.delete(forces, rows).any()
    assert not np.delete(K, rows, axis=0).any()
    assert not np.delete(K, rows, axis=1).any()
    return forces[rows], K[np.ix_(rows, rows)]


def energy(coupling, m, n, B):
    return law.evaluate(coupling, m, n, B)[0]


def random_vectors(seed, count=3):
    return np.random.default_rng(seed).uniform(-1, 1, (count, 3))


def turning(ϑ):
    """exp([ϑ]×) to second order, jets."""
    S = oracle.skew(ϑ)
    return np.eye(3) + S + 0.5 * (S @ S)


def reference(coupling, m, n, B):
    """Forces and tangent from the energy, or from the forces as covector in the chart exp(ϑ) R̃."""
    at = jets.variables(np.zeros(6))
    m_at, R = m + at[:3], turning(at[3:])
    n_at = R @ n
    if type(coupling) in ENERGIES:
        E = ENERGIES[type(coupling)](coupling, m_at, n_at, B)
        return E.gradient, E.hessian
    f, c = FORCES[type(coupling)](coupling, m_at, n_at, B)
    R_0, R_1, R_2 = jets.value(R), jets.gradient(R), jets.hessian(R)
    spin = oracle.axial(np.einsum("ija,kj->ika", R_1, R_0))
    d_spin = oracle.axial(np.einsum("ijab,kj->ikab", R_2, R_0) + np.einsum("ija,kjb->ikab", R_1, R_1))
    K = np.einsum("ka,kb->ab", spin, jets.gradient(c)) + np.einsum("k,kab->ab", jets.value(c), d_spin)
    K += np.einsum("ka,kb->ab", jets.gradient(m_at), jets.gradient(f))
    return np.concatenate([jets.value(f), jets.value(c)]), K


def test_every_registered_law_has_a_reference():
    missing = [kind.__name__ for kind in magnetics.laws() if kind not in {**ENERGIES, **FORCES}]
    assert not missing, f"add these laws to the reference: {missing}"
    for kind in magnetics.laws():
        assert is_conservative(kind()) == (kind in ENERGIES), kind.__name__


@each_coupling
@settings(max_examples=40, deadline=None)
@given(seed=seeds)
def test_forces_and_tangents(coupling, seed):
    m, n, B = random_vectors(seed)
    for name, actual, expected in zip(
        ("forces", "tangent"), evaluate(coupling, m, n, B), reference(coupling, m, n, B), strict=True
    ):
        error = np.abs(actual - expected).max()
        assert error < TOLERANCE, f"{name}: {error:.1e}"


@each_coupling
def test_conservative_laws_and_only_they_have_a_symmetric_tangent(coupling):
    _, K = evaluate(coupling, *random_vectors(1))
    asymmetry = np.abs(K - K.T).max()
    if is_conservative(coupling):
        assert asymmetry < TOLERANCE, f"{asymmetry:.1e}"
    else:
        assert asymmetry > 0.1, f"{asymmetry:.1e}: the law says that it has no energy"


@each_coupling
def test_energy(coupling):
    """Its value by the reference, 0 without; its change along a finite path is the work of the forces on the way."""
    m, n, B = random_vectors(2)
    if not is_conservative(coupling):
        assert energy(coupling, m, n, B) == 0.0
        return
    error = abs(energy(coupling, m, n, B) - ENERGIES[type(coupling)](coupling, m, n, B))
    assert error < TOLERANCE, f"{error:.1e}"
    step, turn = np.array([0.4, -0.7, 0.3]), np.array([1.1, 0.4, -0.8])
    at = lambda t: (m + t * step, Rotation.from_rotvec(t * turn).apply(n))  # noqa: E731
    work = 0.0
    for t, weight in zip(*np.polynomial.legendre.leggauss(12), strict=True):
        forces, _ = evaluate(coupling, *at(0.5 + 0.5 * t), B)
        work += 0.5 * weight * forces @ np.concatenate([step, turn])
    change = energy(coupling, *at(1.0), B) - energy(coupling, *at(0.0), B)
    assert abs(work - change) < 1e-13, f"work {work}, change of energy {change}"


@each_coupling
@settings(max_examples=20, deadline=None)
@given(seed=seeds)
def test_turns_with_its_arguments(coupling, seed):
    """Body and field turned together: forces and tangents turn along."""
    vectors, Q = random_vectors(seed), Rotation.random(rng=np.random.default_rng(seed)).as_matrix()
    forces, K = evaluate(coupling, *vectors)
    both = np.kron(np.eye(2), Q)
    turned = evaluate(coupling, *(Q @ vector for vector in vectors))
    for name, actual, expected in zip(("forces", "tangent"), turned, (both @ forces, both @ K @ both.T), strict=True):
        error = np.abs(actual - expected).max()
        assert error < TOLERANCE, f"{name}: {error:.1e}"


@each_coupling
@settings(max_examples=20, deadline=None)
@given(seed=seeds)
def test_a_rigid_magnet_feels_the_torque_m_cross_B(coupling, seed):
    """All laws agree on a body that does not strain, m = n: torque -(m × f + c) = (1/mu0) m × B."""
    m, B = random_vectors(seed, 2)
    f, c = np.split(evaluate(coupling, m, m, B)[0], 2)
    error = np.abs(-(np.cross(m, f) + c) - np.cross(m, B) / coupling.vacuum_permeability).max()
    assert error < TOLERANCE, f"{error:.1e}"


@each_coupling
def test_proportional_to_the_field(coupling):
    m, n, B = random_vectors(3)
    for once, twice in zip(evaluate(coupling, m, n, B), evaluate(coupling, m, n, 2.0 * B), strict=True):
        assert np.array_equal(2.0 * once, twice)


def test_permeability_of_the_vacuum_is_the_default():
    for coupling in COUPLINGS:
        assert type(coupling)().vacuum_permeability == pytest.approx(4e-7 * np.pi, rel=1e-15)
