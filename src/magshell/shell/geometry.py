"""Geometry of the undeformed mid-surface at the integration points, from the isoparametric 8-node surface."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.shell.shape_functions import gauss_legendre, serendipity
from magshell.typing import FloatArray


class Surface(NamedTuple):
    """Base vectors of the mid-surface at parent points of every element.

    Attributes
    ----------
    A : ndarray, shape (elements, points, 2, 3)
        Covariant base A_α = X,α, m.
    D : ndarray, shape (elements, points, 3)
        Unit normal A_1 × A_2 / |A_1 × A_2|.
    dD : ndarray, shape (elements, points, 2, 3)
        Its derivatives D,α.
    area : ndarray, shape (elements, points)
        √A = |A_1 × A_2|, m² per parent area.
    """

    A: FloatArray
    D: FloatArray
    dD: FloatArray
    area: FloatArray


class SectionGeometry(NamedTuple):
    """What the point's section needs of the undeformed shell; p counts points, k levels through the thickness.

    Attributes
    ----------
    A, D, dD : ndarray
        As in `Surface`.
    z : ndarray, shape (k,)
        Levels, m.
    G : ndarray, shape (elements, p, k, 3, 3)
        Contravariant base at the level, G^i = Q⁻¹ A^i, Q = I - z B; rows G^1, G^2, D; 1/m.
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
    z: FloatArray
    G: FloatArray
    volume: FloatArray
    metric: FloatArray
    enhancement: FloatArray


def surface_at(corner_coordinates: FloatArray, parent: FloatArray) -> Surface:
    """Base vectors of elements with nodes (elements, 8, 3), m, at parent points (points, 2)."""
    _, derivatives, second = serendipity(parent)
    A = np.einsum("pan,enx->epax", derivatives, corner_coordinates)
    A_11, A_22, A_12 = np.moveaxis(np.einsum("pan,enx->epax", second, corner_coordinates), 2, 0)
    A_1, A_2 = A[:, :, 0], A[:, :, 1]
    normal = np.cross(A_1, A_2)
    area = np.linalg.norm(normal, axis=-1)
    D = normal / area[..., None]
    slope = np.stack(
        [np.cross(A_11, A_2) + np.cross(A_1, A_12), np.cross(A_12, A_2) + np.cross(A_1, A_22)], axis=2
    )
    slope -= np.einsum("epax,epx->epa", slope, D)[..., None] * D[:, :, None, :]
    return Surface(A, D, slope / area[:, :, None, None], area)


def section_geometry(
    node_coordinates: FloatArray, parent: FloatArray, weights: FloatArray, thickness: float, levels: int
) -> SectionGeometry:
    """Geometry at the points of a surface rule, with a Gauss rule of `levels` points through the thickness.

    Parameters
    ----------
    node_coordinates : ndarray, shape (elements, 8, 3)
        m.
    parent, weights : ndarray, shape (points, 2) and (points,)
        Rule on the parent square.
    thickness : float
        m.
    levels : int
        Gauss points through the thickness.
    """
    surface = surface_at(node_coordinates, parent)
    z_parent, z_weights = np.polynomial.legendre.leggauss(levels)
    z = 0.5 * thickness * z_parent
    covariant = surface.A[:, :, None] + z[:, None, None] * surface.dD[:, :, None]
    D = np.broadcast_to(surface.D[:, :, None, None, :], (*covariant.shape[:3], 1, 3))
    base = np.concatenate([covariant, D], axis=3)
    G = np.swapaxes(np.linalg.inv(base), -1, -2)
    volume = np.linalg.det(base) * (0.5 * thickness * z_weights) * weights[:, None]
    metric = np.einsum("epk,epkax,epkbx->epab", volume, G[..., :2, :], G[..., :2, :])
    centre = surface_at(node_coordinates, np.zeros((1, 2))).area
    enhancement = (centre / surface.area)[..., None] * parent
    return SectionGeometry(
        *(np.ascontiguousarray(a) for a in (surface.A, surface.D, surface.dD, z, G, volume, metric, enhancement))
    )


def surface_rule(points_per_direction: int = 2) -> tuple[FloatArray, FloatArray]:
    """The element's surface rule: 2 × 2 Gauss points."""
    return gauss_legendre(points_per_direction)
