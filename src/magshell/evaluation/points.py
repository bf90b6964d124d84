"""Fields at the points of a state, for results and global balance (vectorised over the whole shell)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from magshell.arrays import FloatArray
from magshell.magnetics.law import OMEGA, M
from magshell.materials.law import Material
from magshell.materials.law import evaluate as evaluate_law
from magshell.model.reference import faces_of
from magshell.model.shell import Shell
from magshell.shell.body import Reference
from magshell.shell.deformed import Levels, PointFields, directors_at_nodes
from magshell.shell.geometry import SectionGeometry, base_at, dual
from magshell.shell.rotation import cross
from magshell.shell.shear_profile import Moduli, middle
from magshell.shell.state import State


def faces(shell: Shell, geometry: SectionGeometry) -> Levels:
    """The upper face, the middle and the lower face at the points: three levels."""
    bottom, top = np.moveaxis(faces_of(shell), 2, 0)
    z = np.stack([top, 0.5 * (bottom + top), bottom], axis=2)
    base = base_at(geometry.A, geometry.D, geometry.dD, z)
    warping = np.zeros_like(z)
    for part in shell.parts:
        if part.layered:
            moduli = [Moduli.of(layer.material) for layer in part.layers]
            warping[part.elements] = -1.0  # no shear at the faces
            warping[part.elements, :, 1] = middle(part.at_points, moduli)
    return Levels(z, np.ascontiguousarray(dual(base)), warping, None)


def at_heights(reference: Reference, values: FloatArray, z: FloatArray) -> FloatArray:
    """Values of the levels (elements, p, k) at heights z (elements, p, n): linear within the layer that is nearest.

    Values known at only one level of a layer are constant in it.
    """
    own, made = reference.geometry.z, reference.body.levels["material"]
    apart = np.abs(own[:, :, None] - z[..., None])
    nearest = apart.argmin(axis=3)
    layer = np.take_along_axis(made, nearest, axis=2)
    elsewhere = (made[:, :, None] != layer[..., None]) | (np.arange(own.shape[2]) == nearest[..., None])
    elsewhere |= own[:, :, None] == np.take_along_axis(own, nearest, axis=2)[..., None]
    second = np.where(elsewhere, np.inf, apart).argmin(axis=3)
    alone = elsewhere.all(axis=3)
    at, also = (np.take_along_axis(own, index, axis=2) for index in (nearest, second))
    value, other = (np.take_along_axis(values, index, axis=2) for index in (nearest, second))
    slope = np.divide(other - value, also - at, out=np.zeros_like(value), where=~alone & (also != at))
    return np.asarray(value + slope * (z - at))


def micropolar_stretch(fields: PointFields) -> FloatArray:
    """U = R̃ᵀF, shape (elements, p, k, 3, 3)."""
    return np.einsum("epyx,epkyz->epkxz", fields.R, fields.F)


def of_materials(reference: Reference, materials: Sequence[Material], U: FloatArray) -> tuple[FloatArray, ...]:
    """Energy (e, p, k), stress (..., 3, 3) and tangent (..., 3, 3, 3, 3) of the laws that hold at the points."""
    made, warping = reference.body.levels["material"], reference.body.levels["warping"]
    D = reference.geometry.D[:, :, None]
    U = U + warping[..., None, None] * sheared(U, D)
    W, P, C = np.empty(made.shape), np.empty((*made.shape, 3, 3)), np.empty((*made.shape, 3, 3, 3, 3))
    for number, material in enumerate(materials):
        at = made == number
        W[at], P[at], C[at] = evaluate_law(material, U[at])
    P += warping[..., None, None] * sheared(P, D)
    for _ in range(2):
        C = np.moveaxis(C, (-4, -3), (-2, -1))
        C = C + warping[..., None, None, None, None] * sheared(C, D[..., None, None, :])
    return W, P, C


def sheared(U: FloatArray, D: FloatArray) -> FloatArray:
    """Transverse shear Π U (..., 3, 3) of tensors (..., 3, 3) about directors D (..., 3); see `shell/level.py`."""
    s = 0.5 * np.einsum("...ij,...j->...i", U + np.swapaxes(U, -1, -2), D)
    s = s - np.sum(s * D, axis=-1, keepdims=True) * D
    return np.asarray(s[..., :, None] * D[..., None, :] + D[..., :, None] * s[..., None, :])


def with_warping(reference: Reference, fields: PointFields, warping: FloatArray) -> PointFields:
    """The deformation with the transverse shear that layers have at the heights it is of."""
    if not warping.any():
        return fields
    ρ, R = warping[..., None, None], fields.R[:, :, None]
    U = np.swapaxes(R, -1, -2) @ fields.F
    return fields._replace(F=R @ (U + ρ * sheared(U, reference.geometry.D[:, :, None])))


def magnetic_torque(reference: Reference, fields: PointFields, forces: FloatArray) -> FloatArray:
    """Torque of the field per undeformed volume (e, p, k, 3), N/m², beside that of the force on the position.

    The forces f on m = F B̃ and c on the spin do the work -(f · δm + c · δω) in a rigid rotation: a torque
    -(m × f + c), which is (1/mu0) m × B for the couple.
    """
    m = np.einsum("epkxy,epky->epkx", fields.F, reference.remanence)
    return -(cross(m, forces[..., M : M + 3]) + forces[..., OMEGA : OMEGA + 3])


def director(reference: Reference, state: State) -> FloatArray:
    """Director d (elements, p, 3) at the points."""
    functions, w = reference.shape.director[:, :, 0], directors_at_nodes(reference, state)
    return np.asarray(reference.geometry.D + np.einsum("epn,enx->epx", functions, w))
