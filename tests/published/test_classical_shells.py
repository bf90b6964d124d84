"""The shell of seven parameters: what a body that nothing holds may do."""

from __future__ import annotations

import numpy as np
import pytest
from battery import PATCHES, TRIANGULAR, Unsupported, each_mesh, for_element
from scipy.spatial.transform import Rotation

import magshell as ms
from magshell.equations.discretisation import Discretisation
from magshell.equations.instant import Instant


def classical(youngs_modulus, poissons_ratio):
    """St Venant–Kirchhoff without the parameters of the micro-rotation."""
    mu = youngs_modulus / (2.0 * (1.0 + poissons_ratio))
    lam = 2.0 * mu * poissons_ratio / (1.0 - 2.0 * poissons_ratio)
    return ms.MicropolarStVenantKirchhoff(mu, lam, 0.0, 0.0)


def free(mesh, thickness):
    """Discretisation of the body that nothing holds."""
    shell = ms.Shell(mesh, thickness, classical(1.0, 0.3), micro_rotation=False)
    body = Unsupported(shell, ms.UniformField((0, 0, 0)), ms.DeformationGradientEnergy(), (), ())
    return Discretisation(body, lambda graph: np.arange(graph.shape[0]))


@pytest.mark.parametrize("thickness", [0.15, 0.01])
@each_mesh(PATCHES | {"with triangles": lambda: for_element(PATCHES["curved patch"](), TRIANGULAR)})
def test_a_patch_has_six_zero_modes(mesh, thickness):
    """(A lone flat element has two more, the membrane modes of reduced integration; no two elements can share them.)"""
    d = free(mesh, thickness)
    K = d.assemble(Instant(d.undeformed(), d.model.loading(0.0))).matrix.toarray()
    scale = 1.0 / np.sqrt(np.diag(K))
    eigenvalues = np.abs(np.linalg.eigvalsh(scale[:, None] * K * scale))
    eigenvalues.sort()
    assert eigenvalues[5] < 1e-11 * eigenvalues[-1], eigenvalues[:8]
    assert eigenvalues[6] > 1e-3 * thickness**2 * eigenvalues[-1], eigenvalues[:8]


def test_a_turned_patch_is_free_of_forces():
    d = free(PATCHES["curved patch"](), 0.15)
    R = Rotation.from_rotvec([0.4, -2.0, 1.1]).as_matrix() - np.eye(3)
    state = d.undeformed()
    turned = state._replace(u=d.mesh.points @ R.T, w=d.normals @ R.T)
    stretched = state._replace(u=1e-3 * d.mesh.points)
    force, scale = (np.abs(d.assemble(Instant(s, d.model.loading(0.0))).residual).max() for s in (turned, stretched))
    assert force < 1e-11 * scale, f"{force:.1e} against {scale:.1e} of a stretch of 0.1 %"
