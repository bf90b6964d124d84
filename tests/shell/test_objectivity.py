"""Rigid rotations superposed on a deformed body, and the whole problem turned: nothing but the frame changes."""

from __future__ import annotations

import numpy as np
import pytest
from battery import (
    FIELD,
    PATCHES,
    REMANENCE,
    dense,
    each_combination,
    each_element,
    free_body,
    places,
    random_state,
    rest_and_stretch,
    scaled_error,
    strain_energy,
    with_points,
)
from scipy.spatial.transform import Rotation

from magshell.equations.instant import Instant
from magshell.shell import rotation

AXIS = np.array([0.48, -0.6, 0.64])
ANGLES = [1e-3, 90.0, 180.0, 250.0, 359.0, 500.0]
each_angle = pytest.mark.parametrize("angle", ANGLES)


def rotation_of(angle):
    """Matrix and quaternion of a rotation in degrees; the quaternion keeps full turns (cos and sin of half of it)."""
    vector = np.radians(angle) * AXIS
    return Rotation.from_rotvec(vector).as_matrix(), rotation.exponential(vector)


def superposed(d, state, Q, q):
    """The deformed body turned by Q: x → Q x, d → Q d, R̃ → Q R̃, ā → Q ā."""
    rest, _ = rest_and_stretch(d)
    w, turned = state.w.copy(), state.q.copy()
    points, normals = places(d)
    w[rest] = ((normals + state.w) @ Q.T - normals)[rest]
    turned[rest] = rotation.product(np.broadcast_to(q, state.q.shape), state.q)[rest]
    return state._replace(u=(points + state.u) @ Q.T - points, w=w, q=turned, alpha=state.alpha @ Q.T)


def turned_rows(nodal, Q):
    """Vectors of (nodes, 11) turned by Q."""
    result = nodal.copy()
    for columns in (slice(0, 3), slice(3, 6), slice(7, 10)):
        result[:, columns] = nodal[:, columns] @ Q.T
    return result


def turned_matrix(K, Q):
    """T K Tᵀ on (node, component) pairs."""
    block = np.eye(11)
    for at in (0, 3, 7):
        block[at : at + 3, at : at + 3] = Q
    T = np.kron(np.eye(len(K) // 11), block)
    return T @ K @ T.T


@each_angle
@each_combination
def test_superposed_rotation_of_body_and_field(element, material, coupling, angle):
    """Energy to 1e-12, residual and tangent to 1e-10 on a curved patch in a random state that is turned already."""
    mesh = PATCHES["curved patch"]()
    Q, q = rotation_of(angle)
    d, d_turned = (free_body(mesh, material, coupling, element=element, field=field) for field in (FIELD, Q @ FIELD))
    state = random_state(d, 11)
    moved = superposed(d, state, Q, q)
    energy, energy_turned = strain_energy(d, state).sum(), strain_energy(d_turned, moved).sum()
    first, second = (
        d.assemble(Instant(state, d.model.loading(1.0))),
        d_turned.assemble(Instant(moved, d_turned.model.loading(1.0))),
    )
    errors = {
        "energy": abs(energy_turned / energy - 1.0),
        "residual": scaled_error(second.residual, turned_rows(first.residual, Q)),
        "tangent": scaled_error(dense(d, second.matrix), turned_matrix(dense(d, first.matrix), Q)),
    }
    assert errors["energy"] < 1e-12, errors
    assert max(errors["residual"], errors["tangent"]) < 1e-10, errors


@each_angle
@each_element
def test_rigid_rotation_alone_strains_nothing(element, angle):
    """The undeformed curved patch turned: energy and forces vanish beside those of a strain of 1 %."""
    d = free_body(PATCHES["curved patch"](), element=element, field=(0.0, 0.0, 0.0))
    energy = strain_energy(d, superposed(d, d.undeformed(), *rotation_of(angle))).sum()
    forces = np.abs(
        d.assemble(Instant(superposed(d, d.undeformed(), *rotation_of(angle)), d.model.loading(1.0))).residual
    ).max()
    strained = random_state(d, 12, strain=0.01)
    reference = (
        strain_energy(d, strained).sum(),
        np.abs(d.assemble(Instant(strained, d.model.loading(1.0))).residual).max(),
    )
    assert abs(energy) < 1e-10 * reference[0], f"energy {energy:.1e}, of the strain {reference[0]:.1e}"
    assert forces < 1e-11 * reference[1], f"forces {forces:.1e}, of the strain {reference[1]:.1e}"


@pytest.mark.parametrize("angle", [120.0, 250.0])
@each_combination
def test_whole_problem_turned(element, material, coupling, angle):
    """Mesh, remanence, field and state turned: the same problem seen in another frame."""
    mesh = PATCHES["curved patch"]()
    Q, q = rotation_of(angle)
    d = free_body(mesh, material, coupling, element=element)
    there = with_points(mesh, mesh.points @ Q.T)
    d_turned = free_body(there, material, coupling, element=element, remanent=Q @ REMANENCE, field=Q @ FIELD)
    state = random_state(d, 13)
    micro = rotation.product(rotation.product(np.broadcast_to(q, state.q.shape), state.q), rotation.conjugate(q))
    moved = state._replace(u=state.u @ Q.T, w=state.w @ Q.T, q=micro, alpha=state.alpha @ Q.T)
    first, second = (
        d.assemble(Instant(state, d.model.loading(1.0))),
        d_turned.assemble(Instant(moved, d_turned.model.loading(1.0))),
    )
    errors = {
        "energy": abs(strain_energy(d_turned, moved).sum() / strain_energy(d, state).sum() - 1.0),
        "residual": scaled_error(second.residual, turned_rows(first.residual, Q)),
        "tangent": scaled_error(dense(d, second.matrix), turned_matrix(dense(d, first.matrix), Q)),
    }
    assert errors["energy"] < 1e-12, errors
    assert max(errors["residual"], errors["tangent"]) < 1e-10, errors
