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
from magshell.magnetics.law import forces_and_tangent, is_conservative, magnetic_energy

seeds = st.integers(0, 2**32 - 1)
TOLERANCE = 1e-14
"""Entries are of the order of one, sums have six terms."""


def evaluate(coupling, m, n, B):
    """f, c, K_m, K_ω; the arrays start full of NaN, the law must fill them all."""
    arrays = [np.full(3, np.nan), np.full(3, np.nan), np.full((3, 3), np.nan), np.full((3, 3), np.nan)]
    forces_and_tangent(coupling, m, n, B, *arrays)
    return arrays


def random_vectors(seed, count=3):
    return np.random.default_rng(seed).uniform(-1, 1, (count, 3))


def turning(ϑ):
    """exp([ϑ]×) to second order, jets."""
    S = oracle.skew(ϑ)
    return np.eye(3) + S + 0.5 * (S @ S)


def reference(coupling, m, n, B):
    """f, c, K_m, K_ω from the energy, or from the forces as covector in the chart exp(ϑ) R̃."""
    at = jets.variables(np.zeros(6))
    m_at, R = m + at[:3], turning(at[3:])
    n_at = R @ n
    if type(coupling) in ENERGIES:
        E = ENERGIES[type(coupling)](coupling, m_at, n_at, B)
        assert np.abs(E.hessian[:3, :3]).max() == 0.0, "the theory of the kernels has f independent of m"
        return E.gradient[:3], E.gradient[3:], E.hessian[3:, :3], E.hessian[3:, 3:]
    f, c = FORCES[type(coupling)](coupling, m_at, n_at, B)
    R_0, R_1, R_2 = jets.value(R), jets.gradient(R), jets.hessian(R)
    spin = oracle.axial(np.einsum("ija,kj->ika", R_1, R_0))
    d_spin = oracle.axial(np.einsum("ijab,kj->ikab", R_2, R_0) + np.einsum("ija,kjb->ikab", R_1, R_1))
    assert np.abs(jets.gradient(f)).max() == 0.0, "the theory of the kernels has a constant f"
    K = np.einsum("ka,kb->ab", spin, jets.gradient(c)) + np.einsum("k,kab->ab", jets.value(c), d_spin)
    return jets.value(f), jets.value(c), K[3:, :3], K[3:, 3:]


def test_every_registered_law_has_a_reference():
    missing = [law.__name__ for law in magnetics.laws() if law not in {**ENERGIES, **FORCES}]
    assert not missing, f"add these laws to the reference: {missing}"
    for law in magnetics.laws():
        assert is_conservative(law()) == (law in ENERGIES), law.__name__


@each_coupling
@settings(max_examples=40, deadline=None)
@given(seed=seeds)
def test_forces_and_tangents(coupling, seed):
    m, n, B = random_vectors(seed)
    for name, actual, expected in zip(
        ("f", "c", "K_m", "K_ω"), evaluate(coupling, m, n, B), reference(coupling, m, n, B), strict=True
    ):
        error = np.abs(actual - expected).max()
        assert error < TOLERANCE, f"{name}: {error:.1e}"


@each_coupling
def test_conservative_laws_and_only_they_have_a_symmetric_tangent(coupling):
    """On (m, spin): K_mm = 0, so K_m must vanish or have its mirror image, which f, constant, cannot give."""
    _, _, K_m, K_ω = evaluate(coupling, *random_vectors(1))
    symmetric = np.array_equal(K_ω, K_ω.T) and not K_m.any()
    assert symmetric == is_conservative(coupling), f"K_m {K_m}, K_ω {K_ω}"


@each_coupling
def test_energy(coupling):
    """Its value by the reference; its change along a finite path is the work of f and c on the way."""
    m, n, B = random_vectors(2)
    if not is_conservative(coupling):
        with pytest.raises(ValueError, match=f"{type(coupling).__name__} is not conservative"):
            magnetic_energy(coupling, m, n, B)
        return
    error = abs(magnetic_energy(coupling, m, n, B) - ENERGIES[type(coupling)](coupling, m, n, B))
    assert error < TOLERANCE, f"{error:.1e}"
    step, turn = np.array([0.4, -0.7, 0.3]), np.array([1.1, 0.4, -0.8])
    at = lambda t: (m + t * step, Rotation.from_rotvec(t * turn).apply(n))  # noqa: E731
    work = 0.0
    for t, weight in zip(*np.polynomial.legendre.leggauss(12), strict=True):
        f, c, _, _ = evaluate(coupling, *at(0.5 + 0.5 * t), B)
        work += 0.5 * weight * (f @ step + c @ turn)
    change = magnetic_energy(coupling, *at(1.0), B) - magnetic_energy(coupling, *at(0.0), B)
    assert abs(work - change) < 1e-13, f"work {work}, change of energy {change}"


@each_coupling
@settings(max_examples=20, deadline=None)
@given(seed=seeds)
def test_turns_with_its_arguments(coupling, seed):
    """Body and field turned together: forces and tangents turn along."""
    vectors, Q = random_vectors(seed), Rotation.random(rng=np.random.default_rng(seed)).as_matrix()
    f, c, K_m, K_ω = evaluate(coupling, *vectors)
    turned = evaluate(coupling, *(Q @ vector for vector in vectors))
    for name, actual, expected in zip(
        ("f", "c", "K_m", "K_ω"), turned, (Q @ f, Q @ c, Q @ K_m @ Q.T, Q @ K_ω @ Q.T), strict=True
    ):
        error = np.abs(actual - expected).max()
        assert error < TOLERANCE, f"{name}: {error:.1e}"


@each_coupling
@settings(max_examples=20, deadline=None)
@given(seed=seeds)
def test_a_rigid_magnet_feels_the_torque_m_cross_B(coupling, seed):
    """All laws agree on a body that does not strain, m = n: torque -(m × f + c) = (1/mu0) m × B."""
    m, B = random_vectors(seed, 2)
    f, c, _, _ = evaluate(coupling, m, m, B)
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
