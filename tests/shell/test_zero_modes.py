"""A free element and a free patch have exactly six motions without energy, the rigid ones."""

from __future__ import annotations

import numpy as np
import pytest
from battery import ELEMENTS, MATERIAL, PATCHES, bowl, dense, each_material, each_mesh, example, free_body, patch


def spectrum(d):
    """Eigenvalues of the undeformed stiffness scaled to a diagonal of one, ascending; the stiffness and the scale."""
    free = d.free.ravel()
    K = dense(d, d.assemble(d.undeformed(), 0.0).matrix)[np.ix_(free, free)]
    scale = 1.0 / np.sqrt(np.diag(K))
    return np.linalg.eigvalsh(scale[:, None] * K * scale), K, scale


def rigid_motions(d):
    """The six motions of (u, w, φ, ω) on the free unknowns, columns."""
    columns = []
    for axis in np.eye(3):
        motion = np.zeros(d.free.shape)
        motion[:, :3] = axis
        columns.append(motion[d.free])
        motion = np.concatenate(
            [
                np.cross(axis, d.mesh.points),
                np.cross(axis, d.normals),
                np.zeros((len(d.mesh.points), 1)),
                np.broadcast_to(axis, d.mesh.points.shape),
            ],
            axis=1,
        )
        columns.append(motion[d.free])
    return np.stack(columns, axis=1)


@each_material
@each_mesh(ELEMENTS | PATCHES | {"regular curved patch": lambda: patch((2, 2), surface=bowl)})
@pytest.mark.parametrize(("thickness", "length"), [(0.15, 0.2), (0.01, 0.001)], ids=["thick", "thin as the source's"])
def test_exactly_six(mesh, material, thickness, length):
    """The seventh eigenvalue falls with the squares of thickness and length scale; round-off stays at 1e-15."""
    eigenvalues, _, _ = spectrum(free_body(mesh, material._replace(length_scale=length), thickness=thickness))
    largest = eigenvalues[-1]
    print(f"{len(mesh.elements)} elements: zero {np.abs(eigenvalues[:6]).max():.1e}, next {eigenvalues[6]:.1e}")
    gap = f"sixth {eigenvalues[5]:.1e}, seventh {eigenvalues[6]:.1e}, largest {largest:.1e}"
    assert np.abs(eigenvalues[:6]).max() < 1e-13 * largest, gap
    assert eigenvalues[6] > 1e-4 * thickness**2 * largest, gap


@each_mesh(ELEMENTS | PATCHES)
def test_they_are_the_rigid_motions(mesh):
    d = free_body(mesh)
    eigenvalues, K, scale = spectrum(d)
    motions = rigid_motions(d) / scale[:, None]
    motions /= np.linalg.norm(motions, axis=0)
    forces = np.abs(scale[:, None] * K * scale @ motions).max()
    assert forces < 1e-13 * eigenvalues[-1], f"forces of a rigid motion {forces:.1e}"


def test_without_couple_stress_a_single_element_has_more():
    """Why the length scale must not vanish: with l → 0 the seventh eigenvalue goes to zero with l²."""
    seventh = []
    for length in (1e-2, 1e-3):
        material = example(MATERIAL)._replace(length_scale=length)
        seventh.append(spectrum(free_body(ELEMENTS["flat"](), material))[0][6])
    assert seventh[1] / seventh[0] < 0.02, f"{seventh}"
