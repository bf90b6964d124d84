"""Fields at the points of a state, for results and global balance (vectorised over the whole shell)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.shell import rotation
from magshell.shell.loops import Body
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


def evaluate(body: Body, state: State) -> PointFields:
    """Deformation gradient, micro-rotation and wryness."""
    geometry, shape, elements = body.geometry, body.shape, body.elements
    corners = elements[:, : shape.rest.shape[1]]
    a = geometry.A + np.einsum("pan,enx->epax", shape.du, state.u[elements])
    w = np.einsum("epan,enx->epax", geometry.director, state.w[corners])
    d, dd = geometry.D + w[:, :, 0], geometry.dD + w[:, :, 1:]
    φ = np.einsum("pn,en->ep", shape.rest, state.phi[corners])
    ā = np.einsum("epm,emx->epx", geometry.enhancement, state.alpha)
    z = geometry.z
    g_tangent = a[:, :, None] + z[:, None, None] * dd[:, :, None]
    g_3 = (1.0 + 2.0 * z * φ[..., None])[..., None] * d[:, :, None] + ā[:, :, None]
    g = np.concatenate([g_tangent, g_3[:, :, :, None]], axis=3)
    F = np.einsum("epkax,epkay->epkxy", g, geometry.G)
    q_nodes = state.q[corners]
    q_nodes = q_nodes * np.where(np.sum(q_nodes * q_nodes[:, :1], axis=-1, keepdims=True) < 0.0, -1.0, 1.0)
    q = np.einsum("pn,enc->epc", shape.rest, q_nodes)
    dq = np.einsum("pan,enc->epac", shape.d_rest, q_nodes)
    length = np.sum(q * q, axis=-1)
    kappa = 2.0 * rotation.product(rotation.conjugate(q)[:, :, None], dq)[..., 1:] / length[..., None, None]
    return PointFields(F, rotation.matrix(q), kappa)
