"""Fields at the points of a state, for results and global balance (vectorised over the whole shell)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.magnetics.law import OMEGA, WORK, Coupling, M
from magshell.magnetics.law import evaluate as evaluate_coupling
from magshell.materials.law import Material
from magshell.materials.law import evaluate as evaluate_law
from magshell.model.reference import faces_of
from magshell.model.shell import Shell
from magshell.shell import loops, rotation
from magshell.shell.body import Reference
from magshell.shell.geometry import SectionGeometry, base_at, dual
from magshell.shell.rotation import cross
from magshell.shell.section import LocalField
from magshell.shell.shear_profile import Moduli, middle
from magshell.shell.state import State


class PointFields(NamedTuple):
    """At every point p and level k.

    Attributes
    ----------
    F : ndarray, shape (elements, p, k, 3, 3)
        Deformation gradient, enhanced.
    R : ndarray, shape (elements, p, 3, 3)
        Micro-rotation.
    kappa : ndarray, shape (elements, p, 2, 3)
        Wryness vectors of the two parent directions, rad.
    """

    F: FloatArray
    R: FloatArray
    kappa: FloatArray


class Levels(NamedTuple):
    """Heights over the mesh at which the deformation is wanted.

    Attributes
    ----------
    z : ndarray, shape (elements, p, k)
        m.
    G : ndarray, shape (elements, p, k, 3, 3)
        Dual base there, 1/m.
    warping : ndarray, shape (elements, p, k)
        By how much the transverse shear exceeds the director's there, as a share of it.
    zeta : ndarray, shape (elements, p, k), or None
        Stretch that each has of its own.
    """

    z: FloatArray
    G: FloatArray
    warping: FloatArray
    zeta: FloatArray | None


def evaluate(
    reference: Reference, state: State, zeta: FloatArray | None = None, levels: Levels | None = None
) -> PointFields:
    """Deformation gradient, micro-rotation and wryness.

    Parameters
    ----------
    reference : Reference
    state : State
    zeta : ndarray, shape (elements, p, k), optional
        Stretch that the levels of the section have of their own.
    levels : Levels, optional
        By default those of the section.
    """
    geometry, shape, elements = reference.geometry, reference.shape, reference.body.elements
    rest, stretch = elements[:, : shape.director.shape[-1]], elements[:, : shape.phi.shape[-1]]
    a = geometry.A + np.einsum("epan,enx->epax", shape.u, state.u[elements])
    w = np.einsum("epan,enx->epax", shape.director, _at_nodes(reference, state))
    d, dd = geometry.D + w[:, :, 0], geometry.dD + w[:, :, 1:]
    φ = np.einsum("epn,en->ep", shape.phi, state.phi[stretch])
    enhanced = np.einsum("epam,emx->epax", shape.enhancement, state.alpha)
    z, G = (geometry.z, geometry.G) if levels is None else (levels.z, levels.G)
    zeta = zeta if levels is None else levels.zeta
    along = 1.0 + 2.0 * z * φ[..., None] + (0.0 if zeta is None else zeta)
    g_tangent = a[:, :, None] + z[..., None, None] * dd[:, :, None]
    g_3 = along[..., None] * d[:, :, None]
    g = np.concatenate([g_tangent, g_3[:, :, :, None]], axis=3) + enhanced[:, :, None]
    F = np.einsum("epkax,epkay->epkxy", g, G)
    if not reference.body.layout.q:
        R = np.broadcast_to(np.eye(3), (*a.shape[:2], 3, 3))
        return PointFields(F, R, np.zeros_like(a))
    q_nodes = state.q[rest]
    q, dq = (np.einsum("epan,enc->epac", shape.rotation[:, :, rows], q_nodes) for rows in (slice(0, 1), slice(1, 3)))
    q = q[:, :, 0]
    length = np.sum(q * q, axis=-1)
    kappa = 2.0 * rotation.product(rotation.conjugate(q)[:, :, None], dq)[..., 1:] / length[..., None, None]
    return PointFields(F, rotation.matrix(q), kappa)


def _at_nodes(reference: Reference, state: State) -> FloatArray:
    """w' of each element's nodes that carry it (elements, nodes, 3), with the stretch s of their directors."""
    count = reference.shape.director.shape[-1]
    rows, normals = reference.body.elements[:, :count], reference.body.normals[:, :count]
    return np.asarray(state.w[rows] + state.s[rows][..., None] * (normals + state.w[rows]))


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


def of_couplings(
    reference: Reference, couplings: Sequence[Coupling], fields: PointFields, field: LocalField
) -> FloatArray:
    """Forces (e, p, k, 9) of the coupling laws that hold at the points, on m = F B̃, the spin and the position."""
    made, remanence = reference.body.levels["coupling"], reference.remanence
    m = np.einsum("epkxy,epky->epkx", fields.F, remanence)
    n = np.einsum("epxy,epky->epkx", fields.R, remanence)
    forces, B = np.empty((*made.shape, WORK)), np.broadcast_to(field.flux_density, m.shape)
    for number, coupling in enumerate(couplings):
        at = made == number
        slopes = None if field.slopes is None else field.slopes[at]
        forces[at] = evaluate_coupling(coupling, m[at], n[at], B[at], slopes)[1]
    return forces


def magnetic_torque(reference: Reference, fields: PointFields, forces: FloatArray) -> FloatArray:
    """Torque of the field per undeformed volume (e, p, k, 3), N/m², beside that of the force on the position.

    The forces f on m = F B̃ and c on the spin do the work -(f · δm + c · δω) in a rigid rotation: a torque
    -(m × f + c), which is (1/mu0) m × B for the couple.
    """
    m = np.einsum("epkxy,epky->epkx", fields.F, reference.remanence)
    return -(cross(m, forces[..., M : M + 3]) + forces[..., OMEGA : OMEGA + 3])


def level_stretch(reference: Reference, state: State, field: LocalField) -> FloatArray | None:
    """Stretches ζ (elements, p, k) that the kernels eliminate; None: no element has them."""
    if reference.body.by_level is None:
        return None
    zeta = np.zeros(reference.body.levels.shape)
    loops.level_stretches(reference.body, state, field.flux_density, zeta)
    return zeta


def director(reference: Reference, state: State) -> FloatArray:
    """Director d (elements, p, 3) at the points."""
    functions = reference.shape.director
    return np.asarray(reference.geometry.D + np.einsum("epn,enx->epx", functions[:, :, 0], _at_nodes(reference, state)))
