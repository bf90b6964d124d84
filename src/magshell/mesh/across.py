"""How many elements lie between two edges of a surface, along the rows that cross it."""

from __future__ import annotations

import numpy as np

from magshell.arrays import AnyArray
from magshell.mesh.mesh import Mesh


def elements_across(mesh: Mesh, mirrored: AnyArray) -> int:
    """Median number of elements in the rows that run from edge to edge, through opposite sides of their elements.

    Parameters
    ----------
    mesh : Mesh
    mirrored : ndarray of bool, shape (nodes,)
        Nodes in a mirror plane: rows that end there count twice.

    Returns
    -------
    int
        Rows end at free edges, joints and triangles. A surface without such rows has as many as it has elements.
    """
    edges = mesh._edges
    beyond = np.full(4 * len(mesh.elements), -1)
    one, other = edges.pairs
    shared = edges.sharing[edges.edge_of_side[one]] == 2
    beyond[one[shared]], beyond[other[shared]] = other[shared], one[shared]
    start = np.flatnonzero((beyond < 0) & (edges.sharing[edges.edge_of_side] > 0))
    if not start.size:
        return len(mesh.elements)
    side, end, count = start.copy(), start.copy(), np.zeros(len(start), dtype=np.int64)
    going = np.ones(len(start), dtype=bool)
    while going.any():
        end[going] = side[going] - side[going] % 4 + (side[going] + 2) % 4
        count[going] += 1
        side = np.where(going, beyond[end], side)
        going &= side >= 0
    at_mirror = np.asarray(mirrored[edges.sides].all(axis=1))
    rows = np.where(at_mirror[start] | at_mirror[end], 2.0, 1.0) * count
    return int(np.median(rows))
