"""Fields at the points of a state, for results and global balance (vectorised over the whole shell)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.materials.law import Material, strain_energy
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


def evaluate(body: Body, state: State, stretch_at_points: FloatArray | None = None) -> PointFields:
    """Deformation gradient, micro-rotation and wryness; φ from the nodes, or as given (elements, p)."""
    geometry, shape, elements = body.geometry, body.shape, body.elements
    rest, stretch = elements[:, : shape.director.shape[-1]], elements[:, : shape.phi.shape[-1]]
    a = geometry.A + np.einsum("epan,enx->epax", shape.u, state.u[elements])
    w = np.einsum("epan,enx->epax", shape.director, state.w[rest])
    d, dd = geometry.D + w[:, :, 0], geometry.dD + w[:, :, 1:]
    φ = np.einsum("epn,en->ep", shape.phi, state.phi[stretch]) if stretch_at_points is None else stretch_at_points
    enhanced = np.einsum("epam,emx->epax", shape.enhancement, state.alpha)
    z = geometry.z
    g_tangent = a[:, :, None] + z[:, None, None] * dd[:, :, None]
    g_3 = (1.0 + 2.0 * z * φ[..., None])[..., None] * d[:, :, None]
    g = np.concatenate([g_tangent, g_3[:, :, :, None]], axis=3) + enhanced[:, :, None]
    F = np.einsum("epkax,epkay->epkxy", g, geometry.G)
    if not body.layout.q:
        R = np.broadcast_to(np.eye(3), (*a.shape[:2], 3, 3))
        return PointFields(F, R, np.zeros_like(a))
    q_nodes = state.q[rest]
    q_nodes = q_nodes * np.where(np.sum(q_nodes * q_nodes[:, :1], axis=-1, keepdims=True) < 0.0, -1.0, 1.0)
    q, dq = (np.einsum("epan,enc->epac", shape.rotation[:, :, rows], q_nodes) for rows in (slice(0, 1), slice(1, 3)))
    q = q[:, :, 0]
    length = np.sum(q * q, axis=-1)
    kappa = 2.0 * rotation.product(rotation.conjugate(q)[:, :, None], dq)[..., 1:] / length[..., None, None]
    return PointFields(F, rotation.matrix(q), kappa)


def micropolar_stretch(fields: PointFields) -> FloatArray:
    """U = R̃ᵀF, shape (3, 3, elements, p, k)."""
    return np.moveaxis(np.einsum("epyx,epkyz->epkxz", fields.R, fields.F), (-2, -1), (0, 1))


def plane_stress_stretch(body: Body, state: State, material: Material) -> FloatArray:
    """φ (elements, p), 1/m, that makes the strain energy of each point stationary, by Newton's method.

    It is what the kernels eliminate (`plane_stress.py`) where the remanence lies in the surface. The energy is
    analytic: its first derivative comes from a complex step, the second from a difference of first ones.
    """
    z = body.geometry.z
    step = 1e-4 / z[-1]

    def slope(φ: FloatArray) -> FloatArray:
        fields = evaluate(body, state, φ + 1e-30j / z[-1])
        energy = np.sum(strain_energy(material, micropolar_stretch(fields)) * body.geometry.volume, axis=2)
        return np.asarray(energy.imag * z[-1] / 1e-30)

    φ = np.zeros(body.geometry.volume.shape[:2])
    for _ in range(30):
        curvature = (slope(φ + step) - slope(φ - step)) / (2.0 * step)
        increment = np.divide(-slope(φ), curvature, out=np.zeros_like(φ), where=body.geometry.volume[..., 0] > 0.0)
        φ = φ + np.clip(increment, -0.3 / z[-1], 0.3 / z[-1])
        if np.abs(increment).max() * z[-1] < 1e-12:
            break
    return φ
