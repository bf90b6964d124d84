"""Geometry of the undeformed shell at the integration points: isoparametric 8-node surface, normals at the corners."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.shell.interpolation import Interpolation
from magshell.shell.shape_functions import serendipity


class SectionGeometry(NamedTuple):
    """What the point's section needs of the undeformed shell; p counts points, k levels through the thickness.

    Attributes
    ----------
    A : ndarray, shape (elements, p, 2, 3)
        Covariant base A_α = X,α of the mid-surface, m.
    D, dD : ndarray, shape (elements, p, 3) and (elements, p, 2, 3)
        Unit director of the undeformed shell and its derivatives D,α.
    director : ndarray, shape (elements, p, 3, corners)
        Functions of the director displacement and their two derivatives.
    z : ndarray, shape (k,)
        Levels, m.
    G : ndarray, shape (elements, p, k, 3, 3)
        Dual of (A_1 + z D,1, A_2 + z D,2, D): G^i = Q⁻¹ A^i with the shifter Q = I - z B; rows, 1/m.
    volume : ndarray, shape (elements, p, k)
        det Q √A times all weights, m³.
    metric : ndarray, shape (elements, p, 2, 2)
        Σ_k volume G^α · G^β, m: all that the couple stress needs of the thickness.
    enhancement : ndarray, shape (elements, p, modes)
        Enhanced modes (√A at the centre / √A) (ξ, η): their integral over the element vanishes.
    """

    A: FloatArray
    D: FloatArray
    dD: FloatArray
    director: FloatArray
    z: FloatArray
    G: FloatArray
    volume: FloatArray
    metric: FloatArray
    enhancement: FloatArray


def director_functions(normals: FloatArray, N: FloatArray, dN: FloatArray) -> FloatArray:
    r"""Functions Ñ_I = N_I / ν and their derivatives, with ν = |Σ N_I D_I|: (elements, points, 3, corners).

    The undeformed director is the interpolated normal made a unit vector, D = Σ Ñ_I D_I, and d = Σ Ñ_I (D_I + w_I).
    A rigid rotation w_I = (R - I) D_I then gives d = R D exactly at every point. (With the surface's own normal at the
    point in place of Σ Ñ_I D_I it does not: one element of the gripper turned by 77° shows the forces of a stretch of
    0.03–0.1 %, and its linear rotations are not zero-energy modes. At the Gauss points the two differ by O(h³) on a
    cylinder and O(h²) on a sphere.)

    Parameters
    ----------
    normals : ndarray, shape (elements, corners, 3)
    N, dN : ndarray, shape (points, corners) and (points, 2, corners)
    """
    mean = np.einsum("pn,enx->epx", N, normals)
    slope = np.einsum("pan,enx->epax", dN, normals)
    ν = np.linalg.norm(mean, axis=-1)
    dν = np.einsum("epax,epx->epa", slope, mean) / ν[..., None]
    values = N / ν[..., None]
    derivatives = dN / ν[..., None, None] - values[:, :, None] * (dν / ν[..., None])[..., None]
    return np.concatenate([values[:, :, None], derivatives], axis=2)


def section_geometry(
    node_coordinates: FloatArray, normals: FloatArray, shape: Interpolation, thickness: float, levels: int
) -> SectionGeometry:
    """Geometry at the points of a surface rule, with a Gauss rule of `levels` points through the thickness.

    Parameters
    ----------
    node_coordinates : ndarray, shape (elements, 8, 3)
        m.
    normals : ndarray, shape (elements, corners, 3)
        Unit normals at the corners, shared by the elements that meet there.
    shape : Interpolation
    thickness : float
        m.
    levels : int
        Gauss points through the thickness.
    """
    A = np.einsum("pan,enx->epax", shape.du, node_coordinates)
    director = director_functions(normals, shape.rest, shape.d_rest)
    D, dD = (np.einsum("epan,enx->epax", director[:, :, rows], normals) for rows in (slice(0, 1), slice(1, 3)))
    z_parent, z_weights = np.polynomial.legendre.leggauss(levels)
    z = 0.5 * thickness * z_parent
    covariant = A[:, :, None] + z[:, None, None] * dD[:, :, None]
    base = np.concatenate([covariant, np.broadcast_to(D[:, :, None], (*covariant.shape[:3], 1, 3))], axis=3)
    G = np.swapaxes(np.linalg.inv(base), -1, -2)
    volume = np.linalg.det(base) * (0.5 * thickness * z_weights) * shape.weights[:, None]
    metric = np.einsum("epk,epkax,epkbx->epab", volume, G[..., :2, :], G[..., :2, :])
    area = np.linalg.norm(np.cross(A[:, :, 0], A[:, :, 1]), axis=-1)
    centre = np.einsum("pan,enx->epax", serendipity(np.zeros((1, 2)))[1], node_coordinates)
    centre_area = np.linalg.norm(np.cross(centre[:, :, 0], centre[:, :, 1]), axis=-1)
    enhancement = (centre_area / area)[..., None] * shape.parent
    return SectionGeometry(
        *(np.ascontiguousarray(a) for a in (A, D[:, :, 0], dD, director, z, G, volume, metric, enhancement))
    )


def least_shifts(geometry: SectionGeometry, thickness: float) -> FloatArray:
    """Least eigenvalue of the shifter I - z B at the two faces, (elements, p, 2): not positive where layers overlap."""
    faces = np.array([-0.5, 0.5]) * thickness
    metric = np.einsum("epax,epbx->epab", geometry.A, geometry.A)
    slope = np.einsum("epax,epbx->epab", geometry.dD, geometry.A)
    curvatures = np.linalg.eigvals(np.linalg.solve(metric, slope)).real
    return np.asarray(1.0 + np.min(faces[:, None] * curvatures[:, :, None], axis=-1))


def unit_forces(geometry: SectionGeometry, shape: Interpolation) -> FloatArray:
    """Nodal forces of a stress of 1 Pa whose contributions do not cancel: norms over all elements for u, w, φ and ω.

    A stress is known to round-off times the modulus, so this times both is how small a residual can be told from zero.
    """
    volume, z = geometry.volume, np.abs(geometry.z)
    leg = np.linalg.norm(geometry.G, axis=-1)
    u = np.einsum("pan,epka,epk->en", np.abs(shape.du), leg[..., :2], volume)
    w = np.einsum("epan,epka,k,epk->en", np.abs(geometry.director[:, :, 1:]), leg[..., :2], z, volume)
    w += np.einsum("epn,epk,epk->en", np.abs(geometry.director[:, :, 0]), leg[..., 2], volume)
    φ = 2.0 * np.einsum("pn,epk,k,epk->en", np.abs(shape.rest), leg[..., 2], z, volume)
    ω = np.einsum("pn,epk->en", np.abs(shape.rest), volume)
    return np.array([np.linalg.norm(forces) for forces in (u, w, φ, ω)])
