"""Which edges the elements have, and who shares them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import AnyArray, IntArray

SIDES = np.array([[0, 1, 4], [1, 2, 5], [2, 3, 6], [3, 0, 7]])
"""Local node numbers (end, end, middle) of the four sides, walked counter-clockwise."""
COLLAPSED = 2
"""The side that a triangle lacks: its corners 3 and 4 are one node."""


class Edges(NamedTuple):
    """Sides of the elements and the edges they lie on.

    Side number `4 e + s` is side `s` of element `e`. Two sides lie on one edge when they have the same two ends. The
    side that a triangle lacks is listed too, with one node in all three places, on an edge of zero length.
    """

    sides: IntArray
    """(4 elements, 3): end, end, middle, in the sense in which the element walks its side."""
    edge_of_side: IntArray
    """(4 elements,): edge number."""
    first_side: IntArray
    """(edges,): the lowest side number on the edge."""
    sharing: IntArray
    """(edges,): number of sides on the edge; 0 if it has zero length."""

    @property
    def real(self) -> IntArray:
        """Edges of non-zero length: end, end, middle, (k, 3), in rising order of their keys."""
        return self.sides[self.first_side[self.sharing > 0]]

    @property
    def boundary(self) -> IntArray:
        """Side numbers of the edges that only one element has."""
        return np.sort(self.first_side[self.sharing == 1])

    @property
    def pairs(self) -> tuple[IntArray, IntArray]:
        """Side numbers (k,) and (k,) of every two sides that lie on one edge."""
        order = np.argsort(self.edge_of_side, kind="stable")
        order = order[self.sharing[self.edge_of_side[order]] > 1]
        edge = self.edge_of_side[order]
        found = [np.zeros((2, 0), dtype=np.int64)]
        for step in range(1, int(self.sharing.max())):
            together = np.flatnonzero(edge[step:] == edge[:-step])
            found.append(np.stack([order[together], order[together + step]]))
        one, other = np.concatenate(found, axis=1)
        return one, other

    @property
    def closed(self) -> bool:
        """Whether every edge is walked as often one way as the other: the surface bounds a volume."""
        sense = np.sign(self.sides[:, 1] - self.sides[:, 0])
        return not np.bincount(self.edge_of_side, sense).any()


def is_triangle(elements: IntArray) -> AnyArray:
    """Which rows (n, 8) are triangles: [a, b, c, c, ab, bc, c, ca]."""
    return np.asarray((elements[:, 2] == elements[:, 3]) & (elements[:, 2] == elements[:, 6]))


def find_edges(elements: IntArray) -> Edges:
    """Edges of `elements` (n, 8)."""
    sides = elements[:, SIDES].reshape(-1, 3)
    _, first, edge_of_side, sharing = np.unique(
        edge_keys(sides, int(elements.max()) + 1), return_index=True, return_inverse=True, return_counts=True
    )
    sharing[sides[first, 0] == sides[first, 1]] = 0
    return Edges(sides, edge_of_side, first, sharing)


def edge_keys(edges: IntArray, node_count: int) -> IntArray:
    """One whole number per edge (k, 3), equal for edges with the same two ends whatever their sense."""
    ends = np.sort(edges[:, :2], axis=1)
    keys: IntArray = ends[:, 0] * node_count + ends[:, 1]
    return keys
