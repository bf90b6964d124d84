"""Smooth drawing of quadratic quads: many small flat pieces on each curved element.

On the parent square the displaced position is x(ξ, η) = Σ N_i(ξ, η) x_i with the eight serendipity functions;
it is sampled on a regular lattice, and the surface normal is x,ξ × x,η there.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.shell.shape_functions import serendipity

SIDES = np.array([[0, 4, 1], [1, 5, 2], [2, 6, 3], [3, 7, 0]])


class Surface(NamedTuple):
    """Triangles that follow the curved elements, each element with its own points."""

    points: FloatArray
    """(elements·lattice, 3)"""
    normals: FloatArray
    """(elements·lattice, 3), of unit length"""
    triangles: IntArray
    """(triangles, 3) point numbers"""


class Tessellation:
    """Each element cut into `pieces` × `pieces` small quads.

    Parameters
    ----------
    elements : IntArray, shape (elements, 8)
    pieces : int, optional
        6 without it, fewer where there are more than 10 000 elements.
    """

    def __init__(self, elements: IntArray, pieces: int | None = None) -> None:
        self._elements = elements
        self._pieces = pieces or max(1, min(6, int(600 / len(elements) ** 0.5)))
        ticks = np.linspace(-1, 1, self._pieces + 1)
        eta, xi = np.meshgrid(ticks, ticks, indexing="ij")
        self._N, self._dN, _ = serendipity(np.column_stack([xi.ravel(), eta.ravel()]))

    def surface(self, positions: FloatArray) -> Surface:
        """The surface through nodes at these positions, shape (nodes, 3)."""
        x = positions[self._elements]
        tangents = np.einsum("man,enk->aemk", self._dN, x)
        normals = np.cross(tangents[0], tangents[1]).reshape(-1, 3)
        lengths = np.linalg.norm(normals, axis=1, keepdims=True)
        normals /= np.where(lengths > 0, lengths, 1)
        return Surface(self.at_points(positions), normals, self._triangles())

    def at_points(self, values: FloatArray) -> FloatArray:
        """Nodal values, shape (nodes,) or (nodes, k), at the points of the surface."""
        sampled = np.einsum("mn,en...->em...", self._N, values[self._elements])
        return np.asarray(sampled.reshape(-1, *values.shape[1:]))

    def on_elements(self, values: FloatArray) -> FloatArray:
        """Element values, shape (elements,) or (elements, k), at the points of the surface."""
        return np.repeat(values, len(self._N), axis=0)

    def edges(self, positions: FloatArray, triples: IntArray) -> FloatArray:
        """Curves through node triples (end, end, middle).

        Parameters
        ----------
        positions : FloatArray, shape (nodes, 3)
        triples : IntArray, shape (k, 3)

        Returns
        -------
        FloatArray, shape (k, pieces + 1, 3)
        """
        t = np.linspace(-1, 1, self._pieces + 1)
        N = np.stack([t * (t - 1) / 2, t * (t + 1) / 2, 1 - t**2], axis=1)
        return np.asarray(np.einsum("mn,enk->emk", N, positions[triples]))

    def _triangles(self) -> IntArray:
        side = self._pieces + 1
        corner = (np.arange(self._pieces)[:, None] * side + np.arange(self._pieces)).ravel()
        quads = np.stack([corner, corner + 1, corner + side + 1, corner + side], axis=1)
        triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
        first = np.arange(len(self._elements)) * side**2
        return np.asarray((first[:, None, None] + triangles).reshape(-1, 3))


def element_edges(elements: IntArray) -> IntArray:
    """Every edge of the mesh once, as node triples (end, end, middle), shape (edges, 3)."""
    triples = elements[:, SIDES[:, [0, 2, 1]]].reshape(-1, 3)
    return triples[np.unique(triples[:, 2], return_index=True)[1]]
