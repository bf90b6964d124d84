"""The element against the independent derivation: residual, tangent, condensation, spins, predicted stresses."""

from __future__ import annotations

import numpy as np
import pytest
from battery import (
    FIELD,
    SINGLES,
    dense,
    each_combination,
    each_coupling,
    each_material,
    free_body,
    random_increment,
    random_state,
    scaled_error,
    strain_energy,
)

from magshell import magnetics
from magshell.equations.instant import Instant
from magshell.shell.deformed import evaluate
from shell import oracle

# Round-off of some 10⁴ products and of the condensation's division, which costs the condition number of K_αα (10–100).
TOLERANCE = 1e-11


def own_stresses(d, state, increment=None):
    """Those of a state, or what is predicted of it after an increment."""
    return d.predicted(Instant(state, d.model.loading(1.0)), increment)


def reference(d, state, given=None):
    """Strain energy, and residual and tangent on (node, component) pairs then α, of a one-element body."""
    energy, r, K = oracle.element(d, state, 0, FIELD, given)
    return energy, in_order(d, r), in_order(d, K)


def in_order(d, values):
    """A vector or matrix of the element's variables in the order of the body's nodes; places of one node add."""
    order = np.concatenate([oracle.where(d, 0), d.free.size + np.arange(len(values) - oracle.NODAL)])
    result = np.zeros([d.free.size + len(values) - oracle.NODAL] * values.ndim)
    np.add.at(result, np.ix_(*[order] * values.ndim), values)
    return result


@each_combination
@pytest.mark.parametrize("seed", [1, 2])
def test_energy_residual_tangent_and_condensation(element, material, coupling, seed):
    d = free_body(SINGLES["curved"](), material, coupling, element=element)
    state = random_state(d, seed)
    assembly = d.assemble(Instant(state, d.model.loading(1.0)))
    energy, r, K = reference(d, state)
    r_condensed, K_condensed, offset, gain = oracle.condensed(d, r, K)
    right_side = np.zeros(d.free.size)
    right_side[d.free.ravel()] = assembly.right_side[d.numbering.number[d.free]]
    increment = random_increment(d, seed).nodal
    d_alpha = -offset - gain @ increment.ravel()
    errors = {
        "energy": abs(strain_energy(d, state)[0] / energy - 1.0),
        "residual": scaled_error(assembly.residual.ravel(), r[: d.free.size]),
        "right side": scaled_error(right_side, -r_condensed),
        "tangent": scaled_error(dense(d, assembly.matrix), K_condensed),
    }
    if element.vectors:
        errors["recovered α"] = scaled_error(d.shell.recovered(increment, whole=True).ravel(), d_alpha)
    assert max(errors.values()) < TOLERANCE, errors


@each_combination
def test_tangent_is_symmetric_exactly_for_conservative_laws(element, material, coupling):
    d = free_body(SINGLES["curved"](), material, coupling, element=element)
    K = dense(d, d.assemble(Instant(random_state(d, 3), d.model.loading(1.0))).matrix)
    asymmetry = scaled_error(K, K.T)
    if magnetics.is_conservative(coupling):
        assert asymmetry < 1e-12, f"asymmetry {asymmetry:.1e}"
    else:
        assert asymmetry > 1e-6, f"asymmetry {asymmetry:.1e}: the law says that it has no energy"


@each_combination
def test_mixed_tangent_with_the_states_own_stresses_is_the_plain_one(element, material, coupling):
    d = free_body(SINGLES["curved"](), material, coupling, element=element)
    state = random_state(d, 4)
    own = d.assemble(Instant(state, d.model.loading(1.0)))
    plain, right_side = dense(d, own.matrix), own.right_side
    mixed = d.assemble(Instant(state, d.model.loading(1.0), own_stresses(d, state)))
    errors = scaled_error(dense(d, mixed.matrix), plain), scaled_error(mixed.right_side, right_side)
    assert max(errors) < 1e-13, f"tangent {errors[0]:.1e}, right side {errors[1]:.1e}"


@each_coupling
def test_mixed_tangent_with_other_stresses_keeps_the_residual(coupling):
    d = free_body(SINGLES["curved"](), coupling=coupling)
    state, other = random_state(d, 4), random_state(d, 5)
    plain = d.assemble(Instant(state, d.model.loading(1.0)))
    K, residual = dense(d, plain.matrix), plain.residual
    mixed = d.assemble(Instant(state, d.model.loading(1.0), own_stresses(d, other)))
    assert np.array_equal(mixed.residual, residual)
    change = scaled_error(dense(d, mixed.matrix), K)
    assert change > 1e-3, f"the tangent changes by {change:.1e}: the given stresses are not used"


@each_material
@pytest.mark.parametrize("seed", [1, 2])
def test_mixed_tangent_is_that_of_an_energy_with_the_given_stresses(material, seed):
    """S being symmetric (η = 0): of W + ½ (S' - S) : UᵀU + mu l² (κ' - κ) · κ with fixed S', κ'."""
    d = free_body(SINGLES["curved"](), material._replace(coupling_modulus=0.0))
    state = random_state(d, seed)
    own, given = own_stresses(d, state), own_stresses(d, random_state(d, seed + 10))
    dS, dκ = (given.S - own.S)[0], (given.kappa - own.kappa)[0]
    assert scaled_error(dS.ravel(), dS.swapaxes(-1, -2).ravel()) < 1e-12
    assembly = d.assemble(Instant(state, d.model.loading(1.0), given))
    _, r, K = reference(d, state, (dS, dκ))
    K_condensed = oracle.condensed(d, r, K)[1]
    error = scaled_error(dense(d, assembly.matrix), K_condensed)
    assert error < TOLERANCE, f"{error:.1e}"


@each_material
def test_mixed_tangent_is_symmetric_with_a_coupling_modulus_too(material):
    d = free_body(SINGLES["curved"](), material, magnetics.DeformationGradientEnergy(0.8))
    K = dense(
        d, d.assemble(Instant(random_state(d, 4), d.model.loading(1.0), own_stresses(d, random_state(d, 5)))).matrix
    )
    asymmetry = scaled_error(K, K.T)
    assert asymmetry < 1e-12, f"asymmetry {asymmetry:.1e}"


@each_material
def test_residual_alone_is_the_same(material):
    d = free_body(SINGLES["curved"](), material)
    state = random_state(d, 4)
    with_tangent = d.assemble(Instant(state, d.model.loading(1.0))).residual
    alone = d.assemble(Instant(state, d.model.loading(1.0)), tangent=False)
    assert alone.matrix is None
    assert np.array_equal(alone.residual, with_tangent)


@each_combination
def test_predicted_stresses_are_the_derivative_of_the_stresses(element, material, coupling):
    d = free_body(SINGLES["curved"](), material, coupling, element=element)
    state, increment = random_state(d, 6), random_increment(d, 6)
    variation = np.concatenate([increment.nodal[d.rows.elements[0]].ravel(), increment.alpha[0].ravel()])
    S, κ, dS, dκ = oracle.stresses(d, state, 0, FIELD, variation)
    own, predicted = own_stresses(d, state), own_stresses(d, state, increment)
    errors = {
        "S": scaled_error(own.S[0].ravel(), S.ravel()),
        "κ": scaled_error(own.kappa[0].ravel(), κ.ravel()),
        "ΔS": scaled_error((predicted.S - own.S)[0].ravel(), dS.ravel()),
        "Δκ": scaled_error((predicted.kappa - own.kappa)[0].ravel(), dκ.ravel()),
    }
    assert max(errors.values()) < TOLERANCE, errors


@each_material
def test_predicted_stresses_are_linear_in_the_increment(material):
    d = free_body(SINGLES["curved"](), material)
    state, one, other = random_state(d, 6), random_increment(d, 7), random_increment(d, 8)
    own = own_stresses(d, state)
    both = own_stresses(d, state, 2.0 * one + -3.0 * other)
    first, second = own_stresses(d, state, one), own_stresses(d, state, other)
    for name in ("S", "kappa"):
        start, a, b = (getattr(stresses, name).ravel() for stresses in (own, first, second))
        error = scaled_error(getattr(both, name).ravel() - start, 2.0 * (a - start) - 3.0 * (b - start))
        assert error < 1e-13, f"{name}: {error:.1e}"


def test_the_sign_of_all_quaternions_means_nothing():
    d = free_body(SINGLES["curved"]())
    state = random_state(d, 9)
    first = d.assemble(Instant(state, d.model.loading(1.0)))
    residual, K = first.residual, dense(d, first.matrix)
    second = d.assemble(Instant(state._replace(q=-state.q), d.model.loading(1.0)))
    errors = scaled_error(second.residual.ravel(), residual.ravel()), scaled_error(dense(d, second.matrix), K)
    assert max(errors) < 1e-14, errors


def test_residual_is_continuous_where_nodes_turn_past_180_degrees():
    """Nodes are turned about X2 in proportion to X1, from the first one of the element to the farthest by 180°."""
    d = free_body(SINGLES["curved"]())
    x = d.mesh.points[:, 0] - d.mesh.points[d.mesh.elements[0, 0], 0]
    pace, step = np.pi / np.abs(x).max(), 1e-7
    half = 0.5 * np.outer([1.0 - step, 1.0 + step], pace * x)
    q = np.stack([np.cos(half), 0.0 * half, np.sin(half), 0.0 * half], axis=-1)
    before, after = (q @ q[:, d.mesh.elements[0, 0], :, None])[..., 0].min(axis=1)
    assert before > 0.0 > after
    residuals = [
        d.assemble(Instant(d.undeformed()._replace(q=one), d.model.loading(1.0))).residual.ravel() for one in q
    ]
    assert scaled_error(residuals[1], residuals[0]) < 100.0 * step
    points = [evaluate(d.reference, d.undeformed()._replace(q=one)).R for one in q[:2]]
    assert np.abs(points[1] - points[0]).max() < 100.0 * step
