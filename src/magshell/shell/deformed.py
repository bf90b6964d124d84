"""Deformation gradient and micro-rotation at the points of a state, and what the coupling laws make of them.

Vectorised over the whole shell, apart from the element kernels.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.magnetics.law import WORK, Coupling
from magshell.magnetics.law import evaluate as evaluate_coupling
from magshell.shell import loops, rotation
from magshell.shell.body import Reference
from magshell.shell.section import LocalField
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
    w = np.einsum("epan,enx->epax", shape.director, directors_at_nodes(reference, state))
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


def directors_at_nodes(reference: Reference, state: State) -> FloatArray:
    """w' of each element's nodes that carry it (elements, nodes, 3), with the stretch s of their directors."""
    count = reference.shape.director.shape[-1]
    rows, normals = reference.body.elements[:, :count], reference.body.normals[:, :count]
    return np.asarray(state.w[rows] + state.s[rows][..., None] * (normals + state.w[rows]))


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


def level_stretch(reference: Reference, state: State, field: LocalField) -> FloatArray | None:
    """Stretches ζ (elements, p, k) that the kernels eliminate; None: no element has them."""
    if reference.body.by_level is None:
        return None
    zeta = np.zeros(reference.body.levels.shape)
    loops.level_stretches(reference.body, state, field.flux_density, zeta)
    return zeta
