"""Linear fields through the means of elements and their neighbours: of the transverse shear.

In the coordinates ξ of the element's own tangents at its centre, the slope of the mean v is the least-squares solution
of v_f - v_e = slope · (ξ_f - ξ_e) over the elements f that share a node of the same patch. Across a strip of one
element there is nothing to fit, and no slope.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from magshell.arrays import FloatArray, IntArray
from magshell.evaluation.patches import Patches
from magshell.mesh.edges import is_triangle
from magshell.shell.elements import ElementType
from magshell.shell.triangle import REPEATED

FLAT = 1e-2
"""Least sum of squares of the neighbours' distances, in sizes of the element, from which a slope follows."""


class Neighbours(NamedTuple):
    """What laying linear fields needs of the undeformed shell.

    Attributes
    ----------
    shares : ndarray, shape (elements, p)
        Of the points in an element's mean.
    pairs : ndarray, shape (pairs, 2)
        An element and its neighbour.
    turn : ndarray, shape (pairs, 2, 2)
        From components in the frame of the neighbour to components in that of the element.
    slope : ndarray, shape (pairs, 2)
        Slope for a difference of one.
    nodes : ndarray, shape (elements, 8, 2)
        ξ of the nodes.
    """

    shares: FloatArray
    pairs: IntArray
    turn: FloatArray
    slope: FloatArray
    nodes: FloatArray

    def at_nodes(self, values: FloatArray) -> FloatArray:
        """Two components at the points (elements, p, 2), in their frames, at the nodes (elements, 8, 2)."""
        mean = np.einsum("ep,epx->ex", self.shares, values)
        element, other = self.pairs.T
        change = np.einsum("kxy,ky->kx", self.turn, mean[other]) - mean[element]
        slopes = np.zeros((len(mean), 2, 2))
        for i in range(2):
            for j in range(2):
                slopes[:, i, j] = np.bincount(element, self.slope[:, i] * change[:, j], len(mean))
        return np.asarray(mean[:, None] + self.nodes @ slopes)


def found(element: ElementType, coordinates: FloatArray, frame: FloatArray, patches: Patches) -> Neighbours:
    """Neighbours of elements; `patches.around` has n with the nodes (n, 8, 3) and frames (n, 3, 3) at the centres."""
    centre = element.functions(8, np.zeros((1, 2)), coordinates)
    A = np.einsum("ean,enx->eax", centre.derivatives[:, 0], coordinates)
    dual = np.linalg.solve(A @ np.swapaxes(A, -1, -2), A)
    points, weights = element.integration(coordinates)
    tangents = np.einsum("epan,enx->epax", element.functions(8, points, coordinates).derivatives, coordinates)
    area = weights * np.linalg.norm(np.cross(tangents[:, :, 0], tangents[:, :, 1]), axis=-1)
    shares = area / area.sum(axis=1, keepdims=True)
    places = np.einsum("epn,enx->epx", element.functions(8, points, coordinates).values, coordinates)
    middle = np.einsum("ep,epx->ex", shares, places)
    one, other = _pairs(patches)
    ξ = np.einsum("kax,kx->ka", dual[one], middle[other] - middle[one])
    moments = np.stack([np.bincount(one, ξ[:, i] * ξ[:, j], len(A)) for i in (0, 1) for j in (0, 1)], axis=1)
    values, vectors = np.linalg.eigh(moments.reshape(-1, 2, 2))
    inverse = np.divide(1.0, values, out=np.zeros_like(values), where=values > FLAT)
    inverses = (vectors * inverse[:, None]) @ np.swapaxes(vectors, -1, -2)
    carried = frame[other] @ turned(frame[other, 2], frame[one, 2])
    turn = frame[one] @ np.swapaxes(carried, -1, -2)
    own = len(patches.elements)
    return Neighbours(
        shares[:own],
        np.stack([one, patches.around.original[other]], axis=1),
        turn[:, :2, :2],
        np.einsum("kij,kj->ki", inverses[one], ξ),
        np.einsum("eax,enx->ena", dual, coordinates - middle[:, None])[:own],
    )


def _pairs(patches: Patches) -> tuple[IntArray, IntArray]:
    """Elements, and those in `patches.around` that share a row with them."""
    number, node = np.divmod(patches.places, 8)
    kept = ~(is_triangle(patches.around.elements)[number] & np.isin(node, REPEATED))
    number, rows = number[kept], patches.rows[kept]
    shape = len(patches.around.elements), len(patches.nodes)
    has = sp.csr_array((np.ones(len(number)), (number, rows)), shape=shape)
    together = (has[: len(patches.elements)] @ has.T).tocoo()
    different = together.row != together.col
    return together.row[different], together.col[different]


def turned(before: FloatArray, after: FloatArray) -> FloatArray:
    """Transposed matrices (..., 3, 3) of the smallest rotations that take unit vectors `before` to `after`."""
    before, after = np.broadcast_arrays(before, after)
    v, cosine = np.cross(before, after), np.sum(before * after, axis=-1)
    cross = np.zeros((*v.shape, 3))
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        cross[..., j, k], cross[..., k, j] = -v[..., i], v[..., i]
    turn = np.eye(3) + cross + cross @ cross / (1.0 + cosine)[..., None, None]
    return np.asarray(np.swapaxes(turn, -1, -2))
