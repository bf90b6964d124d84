"""Bodies of parts: predicted stresses, the mixed tangent, motions without energy, objectivity, derivatives by steps."""

from __future__ import annotations

import numpy as np
import pytest
from battery import (
    COUPLINGS,
    FIELD,
    PATCHES,
    SINGLES,
    TRIANGULAR,
    TYPES,
    dense,
    each_material,
    free_body,
    name_of,
    places,
    random_increment,
    random_state,
    scaled_error,
    strain_energy,
)
from parts import PARTS, jointed, layered

from magshell import magnetics
from magshell.equations.instant import Increment, Instant
from magshell.evaluation.converged import Converged
from magshell.shell.elements import QUADRATIC
from shell import jets, oracle
from shell.point_oracle import eliminated
from shell.test_element import reference as oracle_of_one
from shell.test_objectivity import rotation_of, superposed, turned_matrix, turned_rows
from shell.test_zero_modes import spectrum

CURVED = PATCHES["curved patch"]
BODIES = {f"{name} parts": (parts, QUADRATIC) for name, parts in PARTS.items()}
BODIES |= {"parts of triangles": (layered, TRIANGULAR), "layered parts, paper": (layered, TYPES["paper"])}
each_body = pytest.mark.parametrize(("parts", "element"), BODIES.values(), ids=BODIES)
each_coupling = pytest.mark.parametrize("coupling", COUPLINGS, ids=name_of)
CONSERVATIVE = [coupling for coupling in COUPLINGS if magnetics.is_conservative(coupling)]


def body(parts, element=QUADRATIC, **options):
    return jointed(CURVED(), parts, element, **options)


def at(d, state, prediction=None):
    return Instant(state, d.model.loading(1.0), prediction)


def test_three_sections_meet_at_the_middle():
    for parts in PARTS.values():
        d = body(parts)
        middle = np.flatnonzero(np.bincount(d.mesh.elements.ravel()) == 4)
        assert np.count_nonzero(d.rows.of == middle[0]) == 3
        assert d.carried[np.arange(d.rows.places, len(d.rows.of)), 10].all()


@each_body
def test_deformation_gradients(parts, element):
    """With the stretches of directors, and of levels in the field of the loading."""
    d = body(parts, element, coupling=CONSERVATIVE[0])
    state = random_state(d, 21)
    fields = Converged(d, state, d.model.loading(1.0)).fields
    for e in (0, len(d.mesh.elements) // 2, len(d.mesh.elements) - 1):
        for p, (parent, weight) in enumerate(oracle.points(d, e)):
            f, here = oracle.element_parts(d, state, e, parent, jets.variables(np.zeros(oracle.unknowns(d))))
            point = oracle.point_of(d, here, e, p, weight, FIELD)
            local = eliminated({name: jets.value(part) for name, part in f.items()}, CONSERVATIVE[0], point)
            expected = [jets.value(F) for F in oracle.deformation_gradients(local.parts, point)]
            assert np.abs(fields.F[e, p, : len(expected)] - expected).max() < 1e-12, f"element {e}, point {p}"


# -- stresses --------------------------------------------------------------------------------------------------------


@each_body
@each_coupling
def test_predicted_stresses_are_the_derivative_of_the_stresses(parts, element, coupling):
    check_predicted_stresses(body(parts, element, coupling=coupling))


def test_predicted_stresses_of_a_nonlinear_coupling(nonlinear):
    check_predicted_stresses(body(layered, coupling=nonlinear))


def check_predicted_stresses(d):
    state, increment = random_state(d, 6), random_increment(d, 6)
    own, predicted = d.predicted(at(d, state)), d.predicted(at(d, state), increment)
    for e in (0, len(d.mesh.elements) // 2, len(d.mesh.elements) - 1):
        variation = np.concatenate([increment.nodal[d.rows.elements[e]].ravel(), increment.alpha[e].ravel()])
        S, κ, dS, dκ = oracle.stresses(d, state, e, FIELD, variation)
        has = np.s_[e, : S.shape[0], : S.shape[1]]
        errors = {
            "S": scaled_error(own.S[has].ravel(), S.ravel()),
            "κ": scaled_error(own.kappa[e, : len(κ)].ravel(), κ.ravel()),
            "ΔS": scaled_error((predicted.S - own.S)[has].ravel(), dS.ravel()),
            "Δκ": scaled_error((predicted.kappa - own.kappa)[e, : len(κ)].ravel(), dκ.ravel()),
        }
        assert max(errors.values()) < 1e-11, f"element {e}: {errors}"


def test_levels_that_an_element_has_not_have_no_stress():
    """Predictions are combined in sums: whatever stands in the arrays must be a number."""
    d = body(layered)
    used = np.arange(d.reference.body.levels.shape[2]) < d.reference.body.points["levels"][..., None]
    assert not used.all()
    assert not d.predicted(at(d, random_state(d, 6))).S[~used].any()


@each_body
def test_mixed_tangent_with_the_states_own_stresses_is_the_plain_one(parts, element):
    d = body(parts, element)
    state = random_state(d, 4)
    own = d.assemble(at(d, state))
    plain, right_side = dense(d, own.matrix), own.right_side
    mixed = d.assemble(at(d, state, d.predicted(at(d, state))))
    errors = scaled_error(dense(d, mixed.matrix), plain), scaled_error(mixed.right_side, right_side)
    assert max(errors) < 1e-12, f"tangent {errors[0]:.1e}, right side {errors[1]:.1e}"


SECOND = np.array([-1 / 560, 8 / 315, -1 / 5, 8 / 5, -205 / 72, 8 / 5, -1 / 5, 8 / 315, -1 / 560])
"""Second differences of eighth order, to be divided by the square of the step."""


def second_slope(function, step):
    """Second derivative at 0."""
    return sum(weight * function(k * step) for k, weight in zip(range(-4, 5), SECOND, strict=True)) / step**2


@each_body
@pytest.mark.parametrize("coupling", CONSERVATIVE, ids=name_of)
def test_mixed_tangent_with_other_stresses_is_symmetric_and_keeps_the_residual(parts, element, coupling):
    d = body(parts, element, coupling=coupling)
    state, other = random_state(d, 4), random_state(d, 5)
    plain = d.assemble(at(d, state))
    K, residual = dense(d, plain.matrix), plain.residual
    assert scaled_error(K, K.T) < 1e-12
    mixed = d.assemble(at(d, state, d.predicted(at(d, other))))
    assert np.array_equal(mixed.residual, residual)
    K_mixed = dense(d, mixed.matrix)
    assert scaled_error(K_mixed, K_mixed.T) < 1e-12
    assert scaled_error(K_mixed, K) > 1e-3


@each_material
def test_mixed_tangent_of_levels_is_that_of_an_energy_with_the_given_stresses(material):
    """Of W + ½ (S' - S) : UᵀU + mu l² (κ' - κ) · κ with fixed S', κ', and ζ eliminated.

    S being symmetric (η = 0); that of layers is not, whose transverse shear is warped.
    """
    material = material._replace(coupling_modulus=0.0)
    for coupling in CONSERVATIVE:
        d = free_body(SINGLES["curved"](), material, coupling, stretch="plane-stress", levels=3)
        state = random_state(d, 1)
        own, given = d.predicted(at(d, state)), d.predicted(at(d, random_state(d, 11)))
        K = dense(d, d.assemble(at(d, state, given)).matrix)
        _, r, K_whole = oracle_of_one(d, state, ((given.S - own.S)[0], (given.kappa - own.kappa)[0]))
        error = scaled_error(K, oracle.condensed(d, r, K_whole)[1])
        assert error < 1e-11, f"{error:.1e}"


# -- derivatives by steps along `moved` ------------------------------------------------------------------------------

WEIGHTS = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0, 4 / 5, -1 / 5, 4 / 105, -1 / 280])
"""Central differences of eighth order, to be divided by the step."""


def slope(function, step=0.02):
    """Derivative at 0."""
    return sum(weight * function(k * step) for k, weight in zip(range(-4, 5), WEIGHTS, strict=True) if weight) / step


@each_body
@pytest.mark.parametrize("coupling", CONSERVATIVE, ids=name_of)
def test_residual_is_the_derivative_of_the_energy(parts, element, coupling):
    d = body(parts, element, coupling=coupling)
    state, increment = random_state(d, 7), random_increment(d, 7)
    increment = Increment(increment.nodal, np.zeros_like(increment.alpha))

    def energy(size):
        moved = state.moved(size * increment.nodal, size * increment.alpha)
        return d.shell.energy(at(d, moved)).sum()

    work = float(np.sum(d.assemble(at(d, state), tangent=False).residual * increment.nodal))
    assert slope(energy) == pytest.approx(work, rel=1e-9)


@each_body
@each_coupling
def test_tangent_is_the_derivative_of_the_residual(parts, element, coupling):
    """After condensation: α follows the nodal values. (Rotations: `test_scatter`, in the chart of the elements.)"""
    d = body(parts, element, coupling=coupling)
    state, increment = random_state(d, 8), random_increment(d, 8).nodal
    increment[:, 7:10] = 0.0
    K = dense(d, d.assemble(at(d, state)).matrix)
    along = d.shell.recovered(increment, whole=False)

    def condensed(size):
        moved = state.moved(size * increment, size * along)
        return d.assemble(at(d, moved), tangent=False).residual.ravel()

    rows = np.setdiff1d(np.arange(d.free.size), np.flatnonzero(np.tile(np.isin(np.arange(11), (7, 8, 9)), len(d.free))))
    expected = slope(condensed)[rows]
    error = scaled_error((K @ increment.ravel())[rows], expected)
    assert error < 1e-9, f"{error:.1e}"


@each_body
@each_coupling
def test_load_rate_is_the_derivative_along_the_field(parts, element, coupling):
    """Stretches of levels follow the field where it pulls across them."""
    d = body(parts, element, coupling=coupling)
    state, loading = random_state(d, 6), d.model.loading(1.0)
    rate = loading._replace(flux_density=np.array([0.3, 0.5, -0.2]))

    def residual(size):
        there = loading._replace(flux_density=loading.flux_density + size * rate.flux_density)
        return d.assemble(Instant(state, there), tangent=False).residual

    found = d.rows.folded(d.shell.load_rate(at(d, state), rate))
    error = scaled_error(found.ravel(), slope(residual, 0.1).ravel())
    assert error < 1e-8, f"{error:.1e}"


# -- motions ---------------------------------------------------------------------------------------------------------


@each_body
def test_exactly_six_motions_without_energy(parts, element):
    """The rigid ones: the stretches of directors are none."""
    d = body(parts, element)
    eigenvalues, K, scale = spectrum(d)
    zero, first, largest = np.abs(eigenvalues[:6]).max(), eigenvalues[6], eigenvalues[-1]
    assert zero < 1e-13 * largest, f"{zero / largest:.1e}"
    assert first > 1e-6 * largest, f"{first / largest:.1e}"
    points, normals = places(d)
    for axis in np.eye(3):
        rigid = np.zeros(d.free.shape)
        rigid[:, :3], rigid[:, 3:6], rigid[:, 7:10] = np.cross(axis, points), np.cross(axis, normals), axis
        motion = rigid[d.free] / scale
        forces = np.abs(scale[:, None] * K * scale @ (motion / np.linalg.norm(motion))).max()
        assert forces < 1e-13 * largest


@each_body
@each_coupling
@pytest.mark.parametrize("angle", [90.0, 250.0])
def test_superposed_rotation_of_body_and_field(parts, element, coupling, angle):
    Q, q = rotation_of(angle)
    d, d_turned = (body(parts, element, coupling=coupling, field=field) for field in (FIELD, Q @ FIELD))
    state = random_state(d, 11)
    moved = superposed(d, state, Q, q)
    energy, energy_turned = strain_energy(d, state).sum(), strain_energy(d_turned, moved).sum()
    first = d.assemble(at(d, state))
    K, residual = dense(d, first.matrix), first.residual
    second = d_turned.assemble(at(d_turned, moved))
    errors = {
        "energy": abs(energy_turned / energy - 1.0),
        "residual": scaled_error(second.residual, turned_rows(residual, Q)),
        "tangent": scaled_error(dense(d, second.matrix), turned_matrix(K, Q)),
    }
    assert errors["energy"] < 1e-12, errors
    assert max(errors["residual"], errors["tangent"]) < 1e-10, errors
