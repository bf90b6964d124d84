"""Which material point of its element a position is: inverse of the isoparametric map.

A quadrilateral is X(ξ) = Σ N_i(ξ) X_i with the eight serendipity functions on the square, a triangle (whose corners 3
and 4 and the mid-side between them are one node) with the six quadratic functions of ξ = (L_2, L_3). From the middle
of the element Newton's method, in the tangent plane of the surface, solves

    A_α · (X(ξ) - P) = 0.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray
from magshell.mesh.edges import is_triangle
from magshell.shell.shape_functions import serendipity
from magshell.shell.triangle import SLOTS, six_nodes

if TYPE_CHECKING:
    from magshell.mesh import Mesh

ITERATIONS = 20
CLOSE = 1e-11
FARTHEST = 1.5


class Inside(NamedTuple):
    """Functions of the elements' nodes at the points.

    Attributes
    ----------
    values : FloatArray, shape (elements, points, 8)
    derivatives : FloatArray, shape (elements, points, 2, 8)
        With respect to the parent coordinates.
    """

    values: FloatArray
    derivatives: FloatArray

    def at(self, nodal: FloatArray) -> FloatArray:
        """Values (elements, points, 3) of a field given at the elements' nodes (elements, 8, 3)."""
        return np.asarray(np.einsum("epn,enx->epx", self.values, nodal))

    def slopes(self, nodal: FloatArray) -> FloatArray:
        """Its derivatives (elements, points, 2, 3)."""
        return np.asarray(np.einsum("epan,enx->epax", self.derivatives, nodal))


def find(mesh: Mesh, points: FloatArray) -> Inside:
    """Functions at points (elements, points, 3) of the elements; NaN for points that are NaN."""
    X = mesh.points[mesh.elements]
    triangles = is_triangle(mesh.elements)
    middle = np.where(triangles[:, None], 1.0 / 3.0, 0.0)
    parent = np.repeat(np.broadcast_to(middle, (len(X), 2))[:, None], points.shape[1], axis=1)
    for _ in range(ITERATIONS):
        here = _functions(parent, triangles)
        A = here.slopes(X)
        gap = np.einsum("epax,epx->epa", A, points - here.at(X))
        metric = np.einsum("epax,epbx->epab", A, A)
        change = np.linalg.solve(metric, gap[..., None])[..., 0]
        parent = np.clip(parent + change, -FARTHEST, FARTHEST)
        if not np.any(np.abs(change) > CLOSE):
            break
    return _functions(parent, triangles)


def _functions(parent: FloatArray, triangles: AnyArray) -> Inside:
    shape = parent.shape[:2]
    values, derivatives, _ = serendipity(parent.reshape(-1, 2))
    result = Inside(values.reshape(*shape, 8), derivatives.reshape(*shape, 2, 8))
    if triangles.any():
        r, s = np.moveaxis(parent[triangles], -1, 0)
        N, dN = six_nodes(np.stack([1.0 - r - s, r, s], axis=-1).reshape(-1, 3))
        six, along = np.zeros((*r.shape, 8)), np.zeros((*r.shape, 2, 8))
        six[..., SLOTS] = N.reshape(*r.shape, 6)
        along[..., SLOTS] = (dN[:, 1:] - dN[:, :1]).reshape(*r.shape, 2, 6)
        result.values[triangles], result.derivatives[triangles] = six, along
    return result
