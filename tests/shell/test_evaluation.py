"""Fields of a state at points and nodes, for pictures, files and the global balance."""

from __future__ import annotations

import numpy as np
from battery import PATCHES, REMANENCE, each_element, free_body, homogeneous, random_state, rest_and_stretch
from scipy.spatial.transform import Rotation

from magshell.evaluation.converged import Converged
from magshell.shell.deformed import evaluate
from shell import jets, oracle


@each_element
def test_deformation_gradient_rotation_and_wryness(element):
    d = free_body(PATCHES["curved patch"](), element=element)
    state = random_state(d, 21)
    fields = evaluate(d.reference, state)
    still = jets.variables(np.zeros(oracle.unknowns(d)))
    for e in range(len(d.mesh.elements)):
        for p, (parent, weight) in enumerate(oracle.points(d, e)):
            f, here = oracle.element_parts(d, state, e, parent, still)
            point = oracle.point_of(d, here, e, p, weight, np.zeros(3))
            errors = {
                "F": np.abs(fields.F[e, p] - [jets.value(F) for F in oracle.deformation_gradients(f, point)]).max(),
                "R": np.abs(fields.R[e, p] - jets.value(oracle.rotation(f["q"]))).max(),
                "kappa": np.abs(fields.kappa[e, p] - jets.value(oracle.wryness_vectors(f))).max(),
            }
            assert max(errors.values()) < 1e-13, f"element {e}, point {p}: {errors}"


@each_element
def test_fields_of_a_homogeneous_state(element):
    """Remanence J⁻¹ F B̃, thickness ratio |F e3|, director, rotation: everywhere the same."""
    d = free_body(PATCHES["flat patch"](), element=element)
    vector = np.array([0.3, -2.1, 1.2])
    R = Rotation.from_rotvec(vector).as_matrix()
    F = R @ np.array([[1.2, 0.1, 0.0], [-0.2, 0.9, 0.1], [0.1, 0.0, 0.8]])
    state, (_, stretch) = homogeneous(d, F, R), rest_and_stretch(d)
    phi = np.zeros(len(d.mesh.points))
    phi[stretch] = d.mesh.points[stretch, 0]
    loading = d.model.loading(1.0)
    converged = Converged(d, state, loading)
    errors = {
        "remanence": np.abs(converged.remanence() - F @ REMANENCE / np.linalg.det(F)).max(),
        "thickness": np.abs(converged.thickness_ratio() - np.linalg.norm(F[:, 2])).max(),
        "director": np.abs(converged.director() - F[:, 2]).max(),
        "rotation": np.abs(converged.rotation() - vector).max(),
        "φ, linear along straight sides": np.abs(
            Converged(d, state._replace(phi=phi), loading).phi() - d.mesh.points[:, 0]
        ).max(),
    }
    assert max(errors.values()) < 1e-14, errors
