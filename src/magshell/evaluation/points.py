"""Fields at the points of a state, for results and global balance (vectorised over the whole shell)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.materials.law import Material
from magshell.materials.law import evaluate as evaluate_law
from magshell.shell import loops, rotation
from magshell.shell.body import Reference
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


def evaluate(reference: Reference, state: State, zeta: FloatArray | None = None) -> PointFields:
    """Deformation gradient, micro-rotation and wryness; with the stretches `zeta` (elements, p, k) of the levels."""
    geometry, shape, elements = reference.geometry, reference.shape, reference.body.elements
    rest, stretch = elements[:, : shape.director.shape[-1]], elements[:, : shape.phi.shape[-1]]
    a = geometry.A + np.einsum("epan,enx->epax", shape.u, state.u[elements])
    w = np.einsum("epan,enx->epax", shape.director, _at_nodes(reference, state))
    d, dd = geometry.D + w[:, :, 0], geometry.dD + w[:, :, 1:]
    φ = np.einsum("epn,en->ep", shape.phi, state.phi[stretch])
    enhanced = np.einsum("epam,emx->epax", shape.enhancement, state.alpha)
    z = geometry.z
    along = 1.0 + 2.0 * z * φ[..., None] + (0.0 if zeta is None else zeta)
    g_tangent = a[:, :, None] + z[..., None, None] * dd[:, :, None]
    g_3 = along[..., None] * d[:, :, None]
    g = np.concatenate([g_tangent, g_3[:, :, :, None]], axis=3) + enhanced[:, :, None]
    F = np.einsum("epkax,epkay->epkxy", g, geometry.G)
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


def level_stretch(reference: Reference, state: State, flux_density: FloatArray) -> FloatArray | None:
    """Stretches ζ (elements, p, k) that the kernels eliminate; None: no element has them."""
    if not reference.body.points["by_level"].any():
        return None
    zeta = np.zeros(reference.body.levels.shape)
    loops.level_stretches(reference.body, state, flux_density, zeta)
    return zeta


def director(reference: Reference, state: State) -> FloatArray:
    """Director d (elements, p, 3) at the points."""
    functions = reference.shape.director
    return np.asarray(reference.geometry.D + np.einsum("epn,enx->epx", functions[:, :, 0], _at_nodes(reference, state)))
