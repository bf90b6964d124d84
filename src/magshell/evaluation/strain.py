"""Strain and stress at the faces of the shell and in its middle, at the nodes.

F = R U is split at the points, at the height of the face. What goes to the nodes is the logarithm H = ln U and two
small rotations, of F against the micro-rotation and of the axes of the deformed mid-surface against F: they are
objective, and whatever is extrapolated det F = exp(tr H) is positive. The stress is that of the law at the node. With
Ũ = R̃ᵀR exp(H) and P = ∂W/∂Ũ it is

    σ = J⁻¹ R̃ P Ũᵀ R̃ᵀ        (Cauchy).
"""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from magshell.arrays import FloatArray, IntArray
from magshell.equations.discretisation import Discretisation
from magshell.evaluation import points
from magshell.evaluation.recovery import Recovery, recovery_of
from magshell.materials.law import evaluate as evaluate_law
from magshell.shell.deformed import evaluate
from magshell.shell.state import State

FACES = ("top", "middle", "bottom")
SYMMETRIC = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))
"""Components of a symmetric tensor, in the order of VTK."""


class Strained(NamedTuple):
    """At a face, in the local axes of each row of the patches.

    Attributes
    ----------
    logarithm : ndarray, shape (rows, 3, 3)
        H = ln U, on the undeformed axes.
    micro : ndarray, shape (rows, 3)
        Rotation vector of R̃ᵀR, rad.
    shown : ndarray, shape (rows, 3)
        Rotation vector from R to the rotation of the deformed axes, rad.
    """

    logarithm: FloatArray
    micro: FloatArray
    shown: FloatArray


class Deformation:
    """A deformed shell at the points, on the frames of `Recovery.points`.

    Parameters
    ----------
    discretisation : Discretisation
    state : State
    zeta : ndarray, shape (elements, p, k), or None
        Stretch that the levels have of their own.

    Attributes
    ----------
    recovery : Recovery
    F : ndarray, shape (3, elements, p, 3, 3)
        At the upper face, in the middle and at the lower face: images of the axes of the frames, as columns.
    back : ndarray, shape (elements, p, 3, 3)
        The inverse of the micro-rotation, from global components to components in the frames.
    axes : ndarray, shape (elements, p, 3, 3)
        Deformed axes, as columns.
    """

    def __init__(self, discretisation: Discretisation, state: State, zeta: FloatArray | None) -> None:
        self.discretisation, self.recovery = discretisation, recovery_of(discretisation)
        reference, faces = discretisation.reference, self.recovery.faces
        if zeta is not None:
            faces = faces._replace(zeta=points.at_heights(reference, zeta, faces.z))
        fields = evaluate(reference, state, None, faces)
        fields = points.with_warping(reference, fields, faces.warping)
        frames = self.recovery.points
        self.F = np.moveaxis(fields.F, 2, 0) @ np.swapaxes(frames, -1, -2)
        self.back = frames @ np.swapaxes(fields.R, -1, -2)
        self.axes = deformed_axes(self.F[FACES.index("middle")])


class Face:
    """Strain and stress at a face of a deformed shell; each is computed when first asked for.

    Parameters
    ----------
    deformation : Deformation
    name : {"top", "middle", "bottom"}
    """

    def __init__(self, deformation: Deformation, name: str) -> None:
        self._deformation, self._number = deformation, FACES.index(name)
        self._discretisation, self._recovery = deformation.discretisation, deformation.recovery

    @cached_property
    def strained(self) -> Strained:
        """What is extrapolated."""
        F, recovery = self._deformation.F[self._number], self._recovery
        values, vectors = np.linalg.eigh(np.swapaxes(F, -1, -2) @ F)
        H = _of_values(0.5 * np.log(values), vectors)
        R = F @ _of_values(values**-0.5, vectors)
        rotations = self._deformation.back @ R, np.swapaxes(R, -1, -2) @ self._deformation.axes
        return Strained(recovery.tensors(H), *(recovery.vectors(_rotation_vectors(one)) for one in rotations))

    @cached_property
    def _split(self) -> tuple[FloatArray, FloatArray]:
        return tuple(np.linalg.eigh(self.strained.logarithm))  # type: ignore[return-value]

    @cached_property
    def log_strain(self) -> FloatArray:
        """ln U (rows, 3, 3)."""
        return self.strained.logarithm

    @cached_property
    def green_strain(self) -> FloatArray:
        """½ (FᵀF - I) (rows, 3, 3)."""
        values, vectors = self._split
        return _of_values(0.5 * np.expm1(2.0 * values), vectors)

    @cached_property
    def principal_stretches(self) -> FloatArray:
        """Largest first (rows, 3)."""
        return np.exp(self._split[0][:, ::-1])

    @cached_property
    def principal_strain(self) -> FloatArray:
        """The largest logarithmic strain (rows,)."""
        return self._split[0][:, 2]

    @cached_property
    def cauchy(self) -> FloatArray:
        """Cauchy stress of the elastic law, Pa, on the deformed axes (rows, 3, 3); not symmetric."""
        values, vectors = self._split
        axes, strained = self._recovery.axes, self.strained
        micro, shown = (Rotation.from_rotvec(one).as_matrix() for one in (strained.micro, strained.shown))
        stretch = _of_values(np.exp(values), vectors)
        U = micro @ stretch
        P = np.empty_like(U)
        made = materials_at(self._discretisation, self._recovery)[:, self._number]
        for number, material in enumerate(self._discretisation.materials):
            at = made == number
            turn = axes[at]
            _, stress, _ = evaluate_law(material, np.swapaxes(turn, -1, -2) @ U[at] @ turn)
            P[at] = turn @ stress @ np.swapaxes(turn, -1, -2)
        to_shown = np.swapaxes(micro @ shown, -1, -2)
        stress = to_shown @ P @ np.swapaxes(to_shown @ U, -1, -2)
        return np.asarray(stress * np.exp(-values.sum(axis=1))[:, None, None])

    @cached_property
    def stress(self) -> FloatArray:
        """Symmetric part of the Cauchy stress (rows, 3, 3), Pa."""
        return 0.5 * (self.cauchy + np.swapaxes(self.cauchy, -1, -2))

    @cached_property
    def axial_stress(self) -> FloatArray:
        """Axial vector of the skew part of the Cauchy stress (rows, 3), Pa."""
        return axial(self.cauchy)

    @cached_property
    def principal_stress(self) -> FloatArray:
        """Of the symmetric part, largest first (rows, 3), Pa."""
        return np.asarray(np.linalg.eigvalsh(self.stress)[:, ::-1])

    @cached_property
    def von_mises(self) -> FloatArray:
        """Of the symmetric part (rows,), Pa."""
        return von_mises(self.stress)


def deformed_axes(F: FloatArray) -> FloatArray:
    """Rotations (..., 3, 3) from undeformed to deformed axes of a surface.

    The third is normal to the deformed surface; the two others are turned in it by the polar rotation of what F
    (..., 3, 3), of components on undeformed axes, does to the surface.
    """
    first, second = F[..., 0], F[..., 1]
    normal = np.cross(first, second)
    area = np.linalg.norm(normal, axis=-1)
    normal = normal / area[..., None]
    # The two-dimensional U is (C + det U I) / tr U, and det U is the ratio of areas.
    c11, c22, c12 = (np.sum(a * b, axis=-1) for a, b in ((first, first), (second, second), (first, second)))
    trace = np.sqrt(c11 + c22 + 2.0 * area)
    _, u22, u12 = ((c + more) / trace for c, more in ((c11, area), (c22, area), (c12, 0.0)))
    e1 = (u22[..., None] * first - u12[..., None] * second) / area[..., None]
    return np.stack([e1, np.cross(normal, e1), normal], axis=-1)


def materials_at(discretisation: Discretisation, recovery: Recovery) -> IntArray:
    """Number of the material at the faces of each row (rows, 3): that of the level next to the face."""
    levels, first = discretisation.reference.body.levels[:, 0], recovery.patches.first
    apart = np.abs(levels["z"][:, :, None] - recovery.faces.z[:, 0, None])
    return np.asarray(np.take_along_axis(levels["material"], apart.argmin(axis=1), axis=1)[first])


def von_mises(stress: FloatArray) -> FloatArray:
    """Of symmetric tensors (..., 3, 3)."""
    deviator = stress - np.trace(stress, axis1=-2, axis2=-1)[..., None, None] * np.eye(3) / 3.0
    return np.asarray(np.sqrt(1.5 * np.sum(deviator**2, axis=(-2, -1))))


def axial(tensor: FloatArray) -> FloatArray:
    """Vectors (..., 3) of which the skew part of tensors (..., 3, 3) is the cross product."""
    skew = 0.5 * (tensor - np.swapaxes(tensor, -1, -2))
    return np.stack([skew[..., 2, 1], skew[..., 0, 2], skew[..., 1, 0]], axis=-1)


def symmetric(tensor: FloatArray) -> FloatArray:
    """Components (..., 6) of symmetric tensors (..., 3, 3)."""
    return np.stack([tensor[..., i, j] for i, j in SYMMETRIC], axis=-1)


def _of_values(values: FloatArray, vectors: FloatArray) -> FloatArray:
    """Symmetric tensors with these eigenvalues (..., 3) and eigenvectors (..., 3, 3)."""
    return np.asarray((vectors * values[..., None, :]) @ np.swapaxes(vectors, -1, -2))


def _rotation_vectors(matrices: FloatArray) -> FloatArray:
    flat = matrices.reshape(-1, 3, 3)
    return np.asarray(Rotation.from_matrix(flat).as_rotvec()).reshape(matrices.shape[:-1])
