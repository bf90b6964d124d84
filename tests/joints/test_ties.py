"""Ties of directors and displacements against derivatives of the energy, in rigid motions, and their zero modes."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from battery import COUPLINGS, dense, each_element, example
from scipy.spatial.transform import Rotation
from shell.test_parts import second_slope, slope

from joints.bodies import BODIES
from magshell.equations.instant import Increment, Instant
from magshell.magnetics import DeformationGradientEnergy
from magshell.model.rows import PHI, S, U, W
from magshell.shell.ties import TURNED

TURN = Rotation.from_rotvec((0.9, -1.3, 2.0))
STEP = 0.012
each_joint = pytest.mark.parametrize("make", BODIES.values(), ids=BODIES)


def turned_rigidly(d, turn):
    """The body turned about the origin."""
    rows = d.rows
    directed = rows.shared(rows.carried.copy())[:, W].any(axis=1) | (rows.kind >= TURNED)
    u, w = (turn.apply(vectors) - vectors for vectors in (rows.points, rows.normals))
    q = np.tile(turn.as_quat(scalar_first=True), (len(u), 1))
    return d.undeformed()._replace(u=u, w=np.where(directed[:, None], w, 0.0), q=q)


def random_increment(d, seed, size):
    """Of the independent unknowns."""
    rng = np.random.default_rng(seed)
    nodal = d.rows.shared(size * rng.uniform(-1, 1, d.carried.shape) * d.carried)
    return Increment(nodal, np.zeros_like(d.undeformed().alpha))


def strained(d, seed=1):
    """A random state near a large rotation."""
    state = d.moved(turned_rigidly(d, TURN), random_increment(d, seed, 0.01))
    rng = np.random.default_rng(seed)
    return state._replace(alpha=0.01 * rng.uniform(-1, 1, state.alpha.shape))


@each_element
@each_joint
def test_forces_and_tangent_are_derivatives_of_the_energy(make, element):
    """Along random increments, spins in the chart exp(ϑ) R; α follows by the condensation in the second derivative."""
    d = make(element, example(DeformationGradientEnergy))
    state, loading = strained(d), d.model.loading(1.0)
    assembly = d.assemble(Instant(state, loading))
    K = dense(d, assembly.matrix)
    assert np.abs(K - K.T).max() < 1e-14 * np.abs(K).max()
    for seed in range(3):
        increment = random_increment(d, seed, 0.05)
        d.assemble(Instant(state, loading))
        along = d.shell.recovered(increment.nodal, whole=False)

        def energy(s, alpha=0.0 * along, increment=increment):
            return float(d.shell.energy(Instant(d.moved(state, s * Increment(increment.nodal, alpha)), loading)).sum())

        independent = (increment.nodal * d.carried).ravel()
        assert slope(energy) == pytest.approx(float(assembly.residual.ravel() @ independent), rel=1e-9)
        second = second_slope(partial(energy, alpha=along), STEP)
        scale = np.abs(independent) @ np.abs(K) @ np.abs(independent)
        assert abs(second - independent @ K @ independent) < 1e-9 * scale


@each_element
@each_joint
def test_a_rigid_rotation_is_free_of_forces(make, element):
    d = make(element)
    still = d.model.loading(0.0)
    residual = d.assemble(Instant(turned_rigidly(d, TURN), still), tangent=False).residual
    scale = np.abs(d.assemble(Instant(strained(d), still), tangent=False).residual).max()
    assert np.abs(residual * d.carried).max() < 1e-13 * scale


@each_element
@pytest.mark.parametrize("coupling", COUPLINGS, ids=lambda one: type(one).__name__)
@each_joint
def test_forces_turn_with_body_and_field(make, element, coupling):
    """Force and couple of each row; the field turns too."""
    d = make(element, coupling)
    state, loading, rows = strained(d), d.model.loading(1.0), d.rows
    q = (TURN * Rotation.from_quat(state.q, scalar_first=True)).as_quat(scalar_first=True)
    u, w = (TURN.apply(rest + now) - rest for rest, now in ((rows.points, state.u), (rows.normals, state.w)))
    directed = np.any(state.w, axis=1, keepdims=True)
    α = np.einsum("ij,emj->emi", TURN.as_matrix(), state.alpha)
    turned = state._replace(u=u, w=np.where(directed, w, 0.0), q=q, alpha=α)
    there = loading._replace(flux_density=TURN.apply(loading.flux_density))
    before, after = (d.assemble(Instant(*one), tangent=False).residual for one in ((state, loading), (turned, there)))
    for columns in (U, W, slice(7, 10)):
        assert np.abs(TURN.apply(before[:, columns]) - after[:, columns]).max() < 1e-12 * np.abs(before).max()
    for columns in (PHI, S):
        assert np.abs(before[:, columns] - after[:, columns]).max() < 1e-12 * np.abs(before).max()


@each_element
@pytest.mark.parametrize("name", BODIES)
def test_zero_modes(name, element):
    """Six rigid ones, and one for each angle that a hinge leaves free."""
    d = BODIES[name](element)
    free = d.free.ravel()
    K = dense(d, d.assemble(Instant(d.undeformed(), d.model.loading(0.0))).matrix)[np.ix_(free, free)]
    scale = 1.0 / np.sqrt(np.diag(K))
    values = np.linalg.eigvalsh(scale[:, None] * K * scale)
    angles = {"hinge": 1, "hinged tee": 2}.get(name, 0)
    assert int(np.sum(values < 1e-10)) == 6 + angles, values[:10]
