"""Neighbours turned so that their normals agree."""

from __future__ import annotations

import numpy as np

from magshell.arrays import IntArray
from magshell.errors import InputError
from magshell.mesh.edges import SIDES, edge_keys, is_triangle

TURNED_QUAD = np.array([0, 3, 2, 1, 7, 6, 5, 4])
TURNED_TRIANGLE = np.array([0, 2, 1, 1, 7, 5, 1, 4])
"""Where the nodes of a row come from when it is walked the other way round."""


def agreeing(rows: IntArray) -> tuple[IntArray, int]:
    """Rows (elements, 8) walked so that neighbours agree which side is up, and how many were turned.

    In every connected part the sense that more elements have is kept. A mid-side node may be missing (-1).

    Notes
    -----
    Every element stands twice in a graph, as it is and turned. Neighbours that walk their common edge in opposite
    senses are joined as they are, and turned to turned; the others crosswise. A part that can be made to agree falls
    into two components, which are mirror images; one that cannot is a single one.

    Raises
    ------
    InputError
        A part with one side only, such as a Möbius band.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    count = len(rows)
    one, other, same = neighbours(rows)
    crossed = same * count
    ends = np.concatenate([one, one + count]), np.concatenate([other + crossed, other + count - crossed])
    graph = coo_matrix((np.ones(len(ends[0])), ends), shape=(2 * count, 2 * count))
    _, label = connected_components(graph, directed=False)
    as_is, turned = label[:count], label[count:]
    one_sided = np.flatnonzero(as_is == turned)
    if one_sided.size:
        raise InputError(
            f"the surface of element {one_sided[0]} has one side only, like a Möbius band: walking along it one "
            f"comes back upside down. A shell needs a top and a bottom; cut the surface along a line"
        )
    sizes = np.bincount(as_is, minlength=label.max() + 1)
    flip = (sizes[turned] > sizes[as_is]) | ((sizes[turned] == sizes[as_is]) & (turned < as_is))
    triangle = is_triangle(rows)
    result = rows.copy()
    for chosen, order in ((flip & ~triangle, TURNED_QUAD), (flip & triangle, TURNED_TRIANGLE)):
        result[chosen] = rows[chosen][:, order]
    return result, int(flip.sum())


def neighbours(rows: IntArray) -> tuple[IntArray, IntArray, IntArray]:
    """Pairs of elements with a common edge that no third has: one, the other, whether they walk it alike (1 or 0)."""
    sides = rows[:, SIDES].reshape(-1, 3)
    owner = np.repeat(np.arange(len(rows)), 4)
    real = sides[:, 0] != sides[:, 1]
    sides, owner = sides[real], owner[real]
    keys = edge_keys(sides, int(rows.max()) + 1)
    order = np.argsort(keys, kind="stable")
    _, start, sharing = np.unique(keys[order], return_index=True, return_counts=True)
    first, second = order[start[sharing == 2]], order[start[sharing == 2] + 1]
    return owner[first], owner[second], (sides[first, 0] == sides[second, 0]).astype(np.int64)
