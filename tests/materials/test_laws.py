"""Every material law: energy, stress and tangent against an independent formula, the undeformed state, isotropy."""

from __future__ import annotations

import numpy as np
import pytest
from battery import MATERIALS, PARAMETERS, each_material, name_of, patch, scaled_error
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from shell import jets

from magshell import materials
from magshell.errors import InputError
from magshell.magnetics import remanence
from magshell.materials import MicropolarMooneyRivlin, MicropolarNeoHookean
from magshell.materials.law import evaluate
from magshell.model.shell import Shell
from materials.reference import ENERGIES

TOLERANCE = 1e-12
seeds = st.integers(0, 2**32 - 1)


def strain_energy(material, U):
    return evaluate(material, U)[0]


def stress(material, U):
    return evaluate(material, U)[1]


def tangent(material, U):
    return evaluate(material, U)[2]


def random_stretch(seed):
    """A relative rotation of up to 60° times a stretch of 0.5 to 1.6 in random directions."""
    rng = np.random.default_rng(seed)
    frame = Rotation.random(rng=rng).as_matrix()
    stretch = frame @ np.diag(rng.uniform(0.5, 1.6, 3)) @ frame.T
    return Rotation.from_rotvec(rng.uniform(-0.6, 0.6, 3)).as_matrix() @ stretch


def test_every_registered_law_has_a_reference():
    missing = [law.__name__ for law in materials.laws() if law not in ENERGIES]
    assert not missing, f"add these laws to the reference energies: {missing}"


@each_material
@settings(max_examples=60, deadline=None)
@given(seed=seeds)
def test_energy_stress_and_tangent(material, seed):
    U = random_stretch(seed)
    W = ENERGIES[type(material)](material, jets.variables(U))
    own, P, C = evaluate(material, U)
    errors = {
        "energy": abs(own - W.value) / max(abs(W.value), material.shear_modulus),
        "stress": scaled_error(P.ravel(), W.gradient),
        "tangent": scaled_error(C.reshape(9, 9), W.hessian),
    }
    assert max(errors.values()) < TOLERANCE, errors


@each_material
def test_stress_and_tangent_are_derivatives_of_the_laws_own_energy_and_stress(material):
    """Central differences of sixth order: 1e-12 of truncation, and of round-off over the step."""
    steps, weights = 2e-3 * np.array([1.0, 2.0, 3.0]), np.array([1.5, -0.3, 1.0 / 30.0]) / 2e-3 / 2.0
    for seed in range(10):
        U, directions = random_stretch(seed), np.eye(9).reshape(9, 3, 3)
        ahead = U + steps[:, None, None, None] * directions
        behind = U - steps[:, None, None, None] * directions
        of_energy = weights @ (strain_energy(material, ahead) - strain_energy(material, behind))
        of_stress = np.tensordot(weights, stress(material, ahead) - stress(material, behind), axes=1)
        errors = {
            "stress": scaled_error(stress(material, U).ravel(), of_energy),
            "tangent": scaled_error(tangent(material, U).reshape(9, 9), of_stress.reshape(9, 9).T),
        }
        assert max(errors.values()) < 1e-11, f"state {seed}: {errors}"


@each_material
def test_undeformed_state_has_no_energy_and_no_stress(material):
    energy, P = strain_energy(material, np.eye(3)), stress(material, np.eye(3))
    assert abs(energy) < 1e-15 * 4 * material.lame_lambda, f"energy {energy:.1e}"
    assert np.abs(P).max() < 1e-15, f"stress {np.abs(P).max():.1e}"


@each_material
def test_linear_limit_has_the_moduli_of_the_parameters(material):
    """C : e is lambda tr(e) I + 2 mu sym e + 2 eta skw e."""
    C = tangent(material, np.eye(3))
    for seed in range(5):
        e = np.random.default_rng(seed).uniform(-1, 1, (3, 3))
        symmetric, skew = 0.5 * (e + e.T), 0.5 * (e - e.T)
        expected = material.lame_lambda * np.trace(e) * np.eye(3) + 2 * material.shear_modulus * symmetric
        expected += 2 * material.coupling_modulus * skew
        error = np.abs(np.einsum("ijkl,kl->ij", C, e) - expected).max()
        assert error < 1e-14, f"{error:.1e}"


@each_material
@settings(max_examples=30, deadline=None)
@given(seed=seeds)
def test_isotropic(material, seed):
    """W(QᵀUQ) = W(U), and the stress turns along."""
    U, Q = random_stretch(seed), Rotation.random(rng=np.random.default_rng(seed + 1)).as_matrix()
    turned = Q.T @ U @ Q
    energy = abs(strain_energy(material, turned) - strain_energy(material, U))
    P = np.abs(stress(material, turned) - Q.T @ stress(material, U) @ Q).max()
    scale = np.abs(stress(material, U)).max()
    assert energy < TOLERANCE * max(strain_energy(material, U), 1.0), f"energy {energy:.1e}"
    assert TOLERANCE * max(scale, 1.0) > P, f"stress {P:.1e}"


@each_material
def test_a_relative_rotation_costs_energy_through_eta_alone(material):
    """U = Q, a body that turns without its microstructure: 2 eta sin² of the angle."""
    for angle in (0.3, 1.0, 2.0, -1.3):
        U = Rotation.from_rotvec(angle * np.array([2.0, -1.0, 2.0]) / 3.0).as_matrix()
        expected = 2.0 * material.coupling_modulus * np.sin(angle) ** 2
        error = abs(strain_energy(material, U) - expected)
        assert error < 1e-14, f"angle {angle}: {error:.1e}"


@each_material
@settings(max_examples=40, deadline=None)
@given(seed=seeds)
def test_energy_is_not_negative(material, seed):
    energy = strain_energy(material, random_stretch(seed))
    assert energy > -1e-15, f"{energy:.3g}"


@each_material
def test_many_points_at_once(material):
    """Axes before the last two are points, as post-processing uses it; stresses and tangents likewise."""
    U = np.array([random_stretch(seed) for seed in range(6)]).reshape(2, 3, 3, 3)
    for together, each in zip(
        evaluate(material, U), zip(*(evaluate(material, one) for one in U.reshape(6, 3, 3)), strict=True), strict=True
    ):
        assert together.shape[:2] == (2, 3)
        assert np.array_equal(together.reshape(6, *together.shape[2:]), np.array(each))
    assert evaluate(material, np.empty((0, 3, 3)))[2].shape == (0, 3, 3, 3, 3)


@each_material
def test_couple_modulus(material):
    assert material.couple_modulus == material.shear_modulus * material.length_scale**2


def test_mooney_rivlin_without_its_second_invariant():
    """… differs from neo-Hooke in the volumetric part only: the same at any stretch with J = 1."""
    values = {name: PARAMETERS[name] for name in MicropolarNeoHookean._fields}
    first, second = MicropolarNeoHookean(**values), MicropolarMooneyRivlin(**values, second_invariant_share=0.0)
    U = random_stretch(5)
    U /= np.cbrt(np.linalg.det(U))
    assert abs(strain_energy(first, U) - strain_energy(second, U)) < 1e-14


# -- parameters ------------------------------------------------------------------------------------------------------


def shell(material):
    return Shell(patch((1, 1)), 0.1, material, remanence.constant((1.0, 0.0, 0.0)))


@pytest.mark.parametrize("value", [-1.0, float("nan"), float("inf")])
@pytest.mark.parametrize(
    ("material", "name"),
    [(material, name) for material in MATERIALS for name in material._fields],
    ids=lambda value: value if isinstance(value, str) else name_of(value),
)
def test_negative_or_endless_parameters_are_refused(material, name, value):
    with pytest.raises(InputError, match=f"material: .*{name}"):
        shell(material._replace(**{name: value}))


@each_material
@pytest.mark.parametrize("name", ["shear_modulus", "length_scale"])
def test_parameters_that_must_not_vanish(material, name):
    with pytest.raises(InputError, match=f"{name} is 0; it must be finite and positive"):
        shell(material._replace(**{name: 0.0}))


@each_material
def test_no_coupling_modulus_is_allowed(material):
    assert shell(material._replace(coupling_modulus=0.0)).material.coupling_modulus == 0.0


def test_the_share_of_the_second_invariant_is_below_one():
    with pytest.raises(InputError, match="second_invariant_share is 1; it must be at least 0 and below 1"):
        shell(MicropolarMooneyRivlin(1.0, 5.0, 0.1, 0.1, second_invariant_share=1.0))


def test_mooney_rivlin_needs_a_lambda_for_its_second_invariant():
    with pytest.raises(InputError, match=r"lame_lambda is 0\.4 Pa; .* at least 0\.6 Pa"):
        shell(MicropolarMooneyRivlin(1.0, 0.4, 0.1, 0.1, second_invariant_share=0.3))
