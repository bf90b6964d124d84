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
from magshell.model.shell import Shell
from magshell.shell import rotation
from magshell.shell.body import Reference
from magshell.shell.geometry import SectionGeometry
from magshell.shell.rotation import cross
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
    """Heights z over the mid-surface (elements, p, k), m, and the dual base there (elements, p, k, 3, 3), 1/m."""

    z: FloatArray
    G: FloatArray


def evaluate(
    reference: Reference, state: State, stretch_at_points: FloatArray | None = None, levels: Levels | None = None
) -> PointFields:
    """Deformation gradient, micro-rotation and wryness.

    φ is that of the nodes, or as given (elements, p); the levels are by default those of the section.
    """
    geometry, shape, elements = reference.geometry, reference.shape, reference.body.elements
    rest, stretch = elements[:, : shape.director.shape[-1]], elements[:, : shape.phi.shape[-1]]
    a = geometry.A + np.einsum("epan,enx->epax", shape.u, state.u[elements])
    w = np.einsum("epan,enx->epax", shape.director, state.w[rest])
    d, dd = geometry.D + w[:, :, 0], geometry.dD + w[:, :, 1:]
    φ = np.einsum("epn,en->ep", shape.phi, state.phi[stretch]) if stretch_at_points is None else stretch_at_points
    enhanced = np.einsum("epam,emx->epax", shape.enhancement, state.alpha)
    z, G = (geometry.z, geometry.G) if levels is None else levels
    g_tangent = a[:, :, None] + z[..., None, None] * dd[:, :, None]
    g_3 = (1.0 + 2.0 * z * φ[..., None])[..., None] * d[:, :, None]
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


def faces(shell: Shell, geometry: SectionGeometry) -> Levels:
    """The upper face, the middle and the lower face at the points: three levels."""
    z = np.broadcast_to(face_heights(shell)[:, None], (*geometry.A.shape[:2], 3))
    covariant = geometry.A[:, :, None] + z[..., None, None] * geometry.dD[:, :, None]
    director = np.broadcast_to(geometry.D[:, :, None, None], (*z.shape, 1, 3))
    base = np.concatenate([covariant, director], axis=3)
    return Levels(z, np.ascontiguousarray(np.swapaxes(np.linalg.inv(base), -1, -2)))


def micropolar_stretch(fields: PointFields) -> FloatArray:
    """U = R̃ᵀF, shape (elements, p, k, 3, 3)."""
    return np.einsum("epyx,epkyz->epkxz", fields.R, fields.F)


def of_materials(reference: Reference, materials: Sequence[Material], U: FloatArray) -> tuple[FloatArray, ...]:
    """Energy (e, p, k), stress (..., 3, 3) and tangent (..., 3, 3, 3, 3) of the laws that hold at the points."""
    made = reference.body.levels["material"]
    W, P, C = np.empty(made.shape), np.empty((*made.shape, 3, 3)), np.empty((*made.shape, 3, 3, 3, 3))
    for number, material in enumerate(materials):
        at = made == number
        W[at], P[at], C[at] = evaluate_law(material, U[at])
    return W, P, C


def of_couplings(
    reference: Reference, couplings: Sequence[Coupling], fields: PointFields, flux_density: FloatArray
) -> FloatArray:
    """Forces (e, p, k, 9) of the coupling laws that hold at the points, on m = F B̃, the spin and the position."""
    made, remanence = reference.body.levels["coupling"], reference.remanence
    m = np.einsum("epkxy,epky->epkx", fields.F, remanence)
    n = np.einsum("epxy,epky->epkx", fields.R, remanence)
    forces = np.empty((*made.shape, WORK))
    for number, coupling in enumerate(couplings):
        at = made == number
        forces[at] = evaluate_coupling(coupling, m[at], n[at], flux_density)[1]
    return forces


def magnetic_torque(reference: Reference, fields: PointFields, forces: FloatArray) -> FloatArray:
    """Torque of the field per undeformed volume (e, p, k, 3), N/m².

    The forces f on m = F B̃ and c on the spin do the work -(f · δm + c · δω) in a rigid rotation: a torque
    -(m × f + c), which is (1/mu0) m × B for the couple.
    """
    m = np.einsum("epkxy,epky->epkx", fields.F, reference.remanence)
    return -(cross(m, forces[..., M : M + 3]) + forces[..., OMEGA : OMEGA + 3])


def plane_stress_stretch(reference: Reference, state: State, materials: Sequence[Material]) -> FloatArray:
    """φ (elements, p), 1/m, that makes the strain energy of each point stationary, by Newton's method.

    It is what the kernels eliminate (`plane_stress.py`) where the remanence lies in the surface.
    """
    geometry = reference.geometry
    outermost = np.abs(geometry.z).max(axis=2)
    d = director(reference, state)
    dF = 2.0 * np.einsum("epk,epx,epky->epkxy", geometry.z, d, geometry.G[..., 2, :])
    φ = np.zeros(geometry.volume.shape[:2])
    for _ in range(30):
        fields = evaluate(reference, state, φ)
        dU = np.einsum("epyx,epkyz->epkxz", fields.R, dF)
        _, P, C = of_materials(reference, materials, micropolar_stretch(fields))
        slope = np.einsum("epk,epkxy,epkxy->ep", geometry.volume, P, dU)
        curvature = np.einsum("epk,epkxy,epkxyzw,epkzw->ep", geometry.volume, dU, C, dU)
        increment = np.divide(-slope, curvature, out=np.zeros_like(φ), where=geometry.volume[..., 0] > 0.0)
        φ = φ + np.clip(increment, -0.3 / outermost, 0.3 / outermost)
        if (np.abs(increment) * outermost).max() < 1e-12:
            break
    return φ


def director(reference: Reference, state: State) -> FloatArray:
    """Director d (elements, p, 3) at the points."""
    functions = reference.shape.director
    rest = reference.body.elements[:, : functions.shape[-1]]
    return np.asarray(reference.geometry.D + np.einsum("epn,enx->epx", functions[:, :, 0], state.w[rest]))


def face_heights(shell: Shell) -> FloatArray:
    """Heights of the upper face, the middle and the lower face of each element over the mid-surface (elements, 3), m."""
    heights = np.empty((len(shell.mesh.elements), 3))
    for region in shell.regions:
        heights[region.elements] = region.thickness * np.array([0.5, 0.0, -0.5])
    return heights
