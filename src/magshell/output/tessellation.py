"""Smooth drawing of quadratic elements: many small flat pieces on each curved one.

On the parent square, or the triangle of barycentric coordinates, the displaced position is x = Σ N_i x_i with the eight
serendipity functions, or the six of the triangle; it is sampled on a regular lattice, with the surface normal there.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.mesh.edges import is_triangle
from magshell.shell import triangle
from magshell.shell.shape_functions import serendipity

SIDES = np.array([[0, 4, 1], [1, 5, 2], [2, 6, 3], [3, 7, 0]])


class Surface(NamedTuple):
    """Triangles that follow the curved elements, each element with its own points."""

    points: FloatArray
    """(points, 3): those of the quadrilaterals, then those of the triangles"""
    normals: FloatArray
    """(points, 3), of unit length"""
    triangles: IntArray
    """(triangles, 3) point numbers"""


class Lattice(NamedTuple):
    """Elements of one shape: their numbers, nodes and the places of these, functions (m, nodes) and derivatives (m, 2,
    nodes), pieces of one."""

    elements: IntArray
    nodes: IntArray
    slots: IntArray
    N: FloatArray
    dN: FloatArray
    pieces: IntArray


class Tessellation:
    """Each quadrilateral cut into `pieces` × `pieces` small ones, each triangle into as many small triangles.

    Parameters
    ----------
    elements : IntArray, shape (elements, 8)
    pieces : int, optional
        6 without it, fewer where there are more than 10 000 elements.

    Attributes
    ----------
    pieces : int
    lattices : list of Lattice
        Of the quadrilaterals and of the triangles, if there are any.
    """

    def __init__(self, elements: IntArray, pieces: int | None = None) -> None:
        self.pieces = pieces or max(1, min(6, int(600 / len(elements) ** 0.5)))
        triangles = is_triangle(elements)
        lattices = []
        if not triangles.all():
            chosen = np.flatnonzero(~triangles)
            lattices.append(Lattice(chosen, elements[chosen], np.arange(8), *_square(self.pieces)))
        if triangles.any():
            chosen, slots = np.flatnonzero(triangles), triangle.SLOTS
            lattices.append(Lattice(chosen, elements[chosen][:, slots], slots, *_triangle(self.pieces)))
        self.lattices = lattices

    def surface(self, positions: FloatArray) -> Surface:
        """The surface through nodes at these positions, shape (nodes, 3)."""
        normals, triangles, first = [], [], 0
        for lattice in self.lattices:
            tangents = np.einsum("man,enk->aemk", lattice.dN, positions[lattice.nodes])
            normals.append(np.cross(tangents[0], tangents[1]).reshape(-1, 3))
            starts = first + np.arange(len(lattice.elements)) * len(lattice.N)
            triangles.append((starts[:, None, None] + lattice.pieces).reshape(-1, 3))
            first += len(lattice.elements) * len(lattice.N)
        normal = np.concatenate(normals)
        lengths = np.linalg.norm(normal, axis=1, keepdims=True)
        normal /= np.where(lengths > 0, lengths, 1)
        return Surface(self.at_points(positions), normal, np.concatenate(triangles))

    def at_points(self, values: FloatArray) -> FloatArray:
        """Nodal values, shape (nodes,) or (nodes, k), at the points of the surface."""
        return self._sampled([values[lattice.nodes] for lattice in self.lattices], values.shape[1:])

    def at_corners(self, values: FloatArray) -> FloatArray:
        """Values at the nodes of each element, (elements, 8) or (elements, 8, k), at the points of the surface."""
        own = [values[lattice.elements][:, lattice.slots] for lattice in self.lattices]
        return self._sampled(own, values.shape[2:])

    def _sampled(self, own: Sequence[FloatArray], shape: tuple[int, ...]) -> FloatArray:
        pairs = zip(self.lattices, own, strict=True)
        sampled = [np.einsum("mn,en...->em...", lattice.N, values) for lattice, values in pairs]
        return np.concatenate([part.reshape(-1, *shape) for part in sampled])

    def on_elements(self, values: AnyArray) -> AnyArray:
        """Element values, shape (elements,) or (elements, k), at the points of the surface."""
        return np.concatenate(
            [np.repeat(values[lattice.elements], len(lattice.N), axis=0) for lattice in self.lattices]
        )

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
        t = np.linspace(-1, 1, self.pieces + 1)
        N = np.stack([t * (t - 1) / 2, t * (t + 1) / 2, 1 - t**2], axis=1)
        return np.asarray(np.einsum("mn,enk->emk", N, positions[triples]))


def _square(pieces: int) -> tuple[FloatArray, FloatArray, IntArray]:
    """Functions and derivatives on the lattice of the parent square, and its small triangles."""
    ticks, side = np.linspace(-1, 1, pieces + 1), pieces + 1
    eta, xi = np.meshgrid(ticks, ticks, indexing="ij")
    N, dN, _ = serendipity(np.column_stack([xi.ravel(), eta.ravel()]))
    corner = (np.arange(pieces)[:, None] * side + np.arange(pieces)).ravel()
    quads = np.stack([corner, corner + 1, corner + side + 1, corner + side], axis=1)
    return N, dN, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def _triangle(pieces: int) -> tuple[FloatArray, FloatArray, IntArray]:
    """Functions on the lattice of a triangle, derivatives along its sides 1–2 and 1–3, and its small triangles."""
    number = -np.ones((pieces + 2, pieces + 2), dtype=np.int64)
    places = [(i, j) for j in range(pieces + 1) for i in range(pieces + 1 - j)]
    for count, (i, j) in enumerate(places):
        number[i, j] = count
    L = np.array([[pieces - i - j, i, j] for i, j in places]) / pieces
    N, dN = triangle.six_nodes(L)
    up = [(number[i, j], number[i + 1, j], number[i, j + 1]) for i, j in places if i + j < pieces]
    down = [(number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]) for i, j in places if i + j < pieces - 1]
    return N, dN[:, 1:] - dN[:, :1], np.array(up + down)


def element_edges(elements: IntArray) -> IntArray:
    """Every edge of the mesh once, as node triples (end, end, middle), shape (edges, 3)."""
    triples = elements[:, SIDES[:, [0, 2, 1]]].reshape(-1, 3)
    triples = triples[triples[:, 0] != triples[:, 1]]
    return triples[np.unique(triples[:, 2], return_index=True)[1]]


def own_nodes(elements: IntArray) -> IntArray:
    """Node numbers (elements, 8) in which no two elements share a node: 8 e + n for node n of element e."""
    own = np.arange(elements.size).reshape(-1, 8)
    triangles = is_triangle(elements)
    own[np.ix_(triangles, triangle.REPEATED)] = own[triangles, 2:3]
    return own
