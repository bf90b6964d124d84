r"""Mass and centroid of the undeformed shell.

With positions x + z D across the thickness h, the volume per unit parent area is

    det(A_1 + z D,1, A_2 + z D,2, D) = a + b z + c z²,    a = (A_1 × A_2) · D,    c = (D,1 × D,2) · D,
    b = (A_1 × D,2 + D,1 × A_2) · D,

so that ∫ dV = h a + h³/12 c and ∫ (x + z D) dV = (h a + h³/12 c) x + h³/12 b D.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.model.shell import Shell
from magshell.shell.geometry import director_functions
from magshell.shell.shape_functions import gauss_legendre

POINTS = 5


class Mass(NamedTuple):
    """Of a shell.

    Attributes
    ----------
    total : float
        kg.
    centroid : ndarray, shape (3,)
        m.
    """

    total: float
    centroid: FloatArray


def mass_of(shell: Shell, normals: FloatArray) -> Mass:
    """Mass and centroid of a shell with unit normals (nodes, 3).

    Raises
    ------
    InputError
        It has no density.
    """
    if shell.density is None:
        raise InputError("shell: density is missing; the mass needs it")
    mesh, element = shell.mesh, shell.element
    thickness, density = np.empty(len(mesh.elements)), np.full(len(mesh.elements), shell.density)
    for region in shell.regions:
        thickness[region.elements] = region.thickness
    X, N = mesh.points[mesh.elements], normals[mesh.elements[:, : element.rest_nodes]]
    points, weights = gauss_legendre(POINTS)
    surface = element.functions(8, points, X)
    rest = element.functions(element.rest_nodes, points, X)
    director = director_functions(N, rest.values, rest.derivatives)
    x, A = np.einsum("epn,enx->epx", surface.values, X), np.einsum("epan,enx->epax", surface.derivatives, X)
    D, dD = np.einsum("epn,enx->epx", director[:, :, 0], N), np.einsum("epan,enx->epax", director[:, :, 1:], N)
    mixed = np.cross(A[:, :, 0], dD[:, :, 1]) + np.cross(dD[:, :, 0], A[:, :, 1])
    a, b, c = (
        np.einsum("epx,epx->ep", product, D) * weights
        for product in (np.cross(A[:, :, 0], A[:, :, 1]), mixed, np.cross(dD[:, :, 0], dD[:, :, 1]))
    )
    cubed = (thickness**3 / 12.0)[:, None]
    masses = density[:, None] * (thickness[:, None] * a + cubed * c)
    moments = masses[..., None] * x + (density[:, None] * cubed * b)[..., None] * D
    total = float(masses.sum())
    return Mass(total, moments.sum(axis=(0, 1)) / total)
