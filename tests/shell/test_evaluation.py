"""Fields of a state at points and nodes, for pictures, files and the global balance."""

from __future__ import annotations

import numpy as np
from battery import PATCHES, REMANENCE, free_body, random_state
from scipy.spatial.transform import Rotation

from magshell.shell import rotation
from magshell.shell.evaluation import evaluate
from shell import jets, oracle


def test_deformation_gradient_rotation_and_wryness():
    d = free_body(PATCHES["curved patch"]())
    state = random_state(d, 21)
    fields = evaluate(d.body, state)
    still = jets.variables(np.zeros(oracle.SIZE))
    for e in range(len(d.mesh.elements)):
        for p, parent in enumerate(d.body.shape.parent):
            f, here = oracle.element_parts(d, state, e, parent, still)
            point = oracle.point_of(d, here, e, np.zeros(3))
            errors = {
                "F": np.abs(fields.F[e, p] - [jets.value(F) for F in oracle.deformation_gradients(f, point)]).max(),
                "R": np.abs(fields.R[e, p] - jets.value(oracle.rotation(f["q"]))).max(),
                "kappa": np.abs(fields.kappa[e, p] - jets.value(oracle.wryness_vectors(f))).max(),
            }
            assert max(errors.values()) < 1e-13, f"element {e}, point {p}: {errors}"


def homogeneous(d, F, vector):
    """A flat body at x = F X, d = F D, micro-rotation by a vector."""
    state, corners = d.undeformed(), d.mesh.corner_nodes
    state.u[:] = d.mesh.points @ (F - np.eye(3)).T
    state.w[corners] = F[:, 2] - [0.0, 0.0, 1.0]
    state.q[corners] = rotation.exponential(vector)
    return state


def test_fields_of_a_homogeneous_state():
    """Remanence J⁻¹ F B̃, thickness ratio |F e3|, director, rotation: everywhere the same."""
    d = free_body(PATCHES["flat patch"]())
    vector = np.array([0.3, -2.1, 1.2])
    F = Rotation.from_rotvec(vector).as_matrix() @ np.array([[1.2, 0.1, 0.0], [-0.2, 0.9, 0.1], [0.1, 0.0, 0.8]])
    state = homogeneous(d, F, vector)
    phi = np.zeros(len(d.mesh.points))
    phi[d.mesh.corner_nodes] = d.mesh.points[d.mesh.corner_nodes, 0]
    errors = {
        "remanence": np.abs(d.element_remanence(state) - F @ REMANENCE / np.linalg.det(F)).max(),
        "thickness": np.abs(d.element_thickness_ratio(state) - np.linalg.norm(F[:, 2])).max(),
        "director": np.abs(d.nodal_director(state) - F[:, 2]).max(),
        "rotation": np.abs(d.nodal_rotation(state) - vector).max(),
        "φ, linear along straight sides": np.abs(d.nodal_phi(state._replace(phi=phi)) - d.mesh.points[:, 0]).max(),
    }
    assert max(errors.values()) < 1e-14, errors
