r"""Stress resultants of the sections, at the nodes.

The stress that a section carries is that of the elastic law and the magnetic one, T = R̃ P + f ⊗ B̃ (first
Piola–Kirchhoff). With t^β = ∫ T G^β √(G/A) dz, per undeformed length of the section with the undeformed normal E_b (a
local axis), n_b = t^β (A_β · E_b), and likewise for z T and for the couple stress m^β:

    N_ab = e_a · n_b,   Q_b = e_3 · n_b,   (M_1b, M_2b) = (e_2, -e_1) · (d × ∫ z T ...),   C_ib = e_i · R̃ m_b,

e_i the deformed local axes. The first index is the direction of the force, the second the section. The moment about a
point of the section's middle line is M and C together. These are what the equations of equilibrium of the shell hold,
with the magnetic torque: no force or moment is lost between the sections.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from magshell.arrays import FloatArray
from magshell.evaluation import points
from magshell.evaluation.strain import Deformation
from magshell.magnetics.law import M
from magshell.shell.deformed import PointFields, of_couplings
from magshell.shell.rotation import cross
from magshell.shell.section import LocalField
from magshell.shell.state import State


class Resultants:
    """Stress resultants of a deformed shell, in the local axes of each row of the patches.

    Parameters
    ----------
    deformation : Deformation
    state : State
    fields : PointFields
        At the levels of the section.
    field : LocalField
    """

    def __init__(self, deformation: Deformation, state: State, fields: PointFields, field: LocalField) -> None:
        discretisation = deformation.discretisation
        self._discretisation, self._state, self._fields = discretisation, state, fields
        self._field, self._recovery, self._axes = field, deformation.recovery, deformation.axes
        geometry, frames = discretisation.reference.geometry, self._recovery.points
        coordinates = discretisation.mesh.points[discretisation.mesh.elements]
        _, weights = discretisation.model.shell.element.integration(coordinates)
        area = np.linalg.norm(np.cross(geometry.A[:, :, 0], geometry.A[:, :, 1]), axis=-1) * weights
        self._per_area = np.divide(1.0, area, out=np.zeros_like(area), where=area > 0.0)
        self._legs = np.einsum("epax,epix->epai", geometry.A, frames)[..., :2]

    @cached_property
    def _stress(self) -> FloatArray:
        """T times the volume per area that it stands for (elements, p, k, 3, 3), N/m."""
        d, fields = self._discretisation, self._fields
        U = points.micropolar_stretch(fields)
        P = fields.R[:, :, None] @ points.of_materials(d.reference, d.materials, U)[1]
        forces = of_couplings(d.reference, d.couplings, fields, self._field)[..., M : M + 3]
        T = P + forces[..., None] * d.reference.remanence[..., None, :]
        return T * (d.reference.geometry.volume * self._per_area[..., None])[..., None, None]

    def _across(self, weights: FloatArray) -> FloatArray:
        """∫ weights T G^β dz for the sections with the normals E_b: vectors (elements, p, 3, b)."""
        legs = self._discretisation.reference.geometry.G[..., :2, :]
        flux = np.einsum("epk,epkxy,epkay->epxa", weights, self._stress, legs)
        return np.asarray(flux @ self._legs)

    def _recovered(self, vectors: FloatArray) -> FloatArray:
        """Vectors (elements, p, 3, b) on the deformed axes, at the rows (rows, 3, b)."""
        values = np.zeros((*vectors.shape[:2], 3, 3))
        values[..., :2] = np.swapaxes(self._axes, -1, -2) @ vectors
        return self._recovery.tensors(values)[..., :2]

    @cached_property
    def forces(self) -> FloatArray:
        """e_i · n_b (rows, 3, 2), N/m."""
        return self._recovered(self._across(np.ones(self._stress.shape[:3])))

    @cached_property
    def moments(self) -> FloatArray:
        """M_ab (rows, 2, 2), N."""
        d = points.director(self._discretisation.reference, self._state)
        lever = self._across(self._discretisation.reference.geometry.z)
        moment = self._recovered(np.swapaxes(cross(d[:, :, None], np.swapaxes(lever, -1, -2)), -1, -2))
        return np.stack([moment[:, 1], -moment[:, 0]], axis=1)

    @cached_property
    def couples(self) -> FloatArray:
        """C_ib (rows, 3, 2), N."""
        metric = self._discretisation.reference.body.points["couple_metric"]
        m = np.einsum("ep,epab,epbx->epxa", self._per_area, metric, self._fields.kappa)
        return self._recovered(self._fields.R @ m @ self._legs)

    @cached_property
    def axes(self) -> FloatArray:
        """Deformed local axes (rows, 3, 3), as rows, in X1, X2, X3."""
        left, _, right = np.linalg.svd(np.swapaxes(self._recovery.axes_of(self._axes), 1, 2))
        return np.asarray(left @ right)


def four(tensor: FloatArray) -> FloatArray:
    """Components 11, 22, 12, 21 (..., 4) of tensors (..., 2, 2)."""
    return np.stack([tensor[..., i, j] for i, j in ((0, 0), (1, 1), (0, 1), (1, 0))], axis=-1)
