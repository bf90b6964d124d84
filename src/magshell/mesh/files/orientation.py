"""Neighbours turned so that their normals agree."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from magshell.arrays import AnyArray, IntArray
from magshell.mesh.edges import SIDES, edge_keys, is_triangle

TURNED_QUAD = np.array([0, 3, 2, 1, 7, 6, 5, 4])
TURNED_TRIANGLE = np.array([0, 2, 1, 1, 7, 5, 1, 4])
"""Where the nodes of a row come from when it is walked the other way round."""


class Agreed(NamedTuple):
    """Elements after they were turned."""

    rows: IntArray
    """(elements, 8)."""
    turned: int
    """How many elements were turned."""
    against: int
    """Edges between neighbours that cannot agree, as the surface has one side only."""


def agreeing(rows: IntArray) -> Agreed:
    """Walk rows (elements, 8) so that neighbours agree which side is up.

    Neighbours are two elements on an edge that no third has. In every connected piece the sense that more elements
    have is kept. On a surface with one side only, such as a Möbius band, normals change sign along a line across it:
    where they do so already, if that is along edges which do not cut the surface apart. A mid-side node may be missing
    (-1).

    Notes
    -----
    Every element stands twice in a graph, as it is and turned. Neighbours that walk their common edge in opposite
    senses are joined as they are, and turned to turned; the others crosswise. A piece that can be made to agree falls
    into two components, which are mirror images; one that cannot is a single one.
    """
    from scipy.sparse.csgraph import connected_components

    count = len(rows)
    one, other, same = neighbours(rows)
    crossed = same * count
    ends = np.concatenate([one, one + count]), np.concatenate([other + crossed, other + count - crossed])
    _, label = connected_components(_graph(*ends, 2 * count), directed=False)
    as_is, turned = label[:count], label[count:]
    sizes = np.bincount(as_is, minlength=label.max() + 1)
    flip = (sizes[turned] > sizes[as_is]) | ((sizes[turned] == sizes[as_is]) & (turned < as_is))
    alike = same == 0
    _, agreed = connected_components(_graph(one[alike], other[alike], count), directed=False)
    for piece in np.unique(as_is[as_is == turned]):
        members = np.flatnonzero(as_is == piece)
        if len(np.unique(agreed[members])) > 1:
            flip[members] = _from_the_first(members, one, other, same)
    triangle = is_triangle(rows)
    result = rows.copy()
    for chosen, order in ((flip & ~triangle, TURNED_QUAD), (flip & triangle, TURNED_TRIANGLE)):
        result[chosen] = rows[chosen][:, order]
    against = int((same ^ flip[one] ^ flip[other]).sum())
    return Agreed(result, int(flip.sum()), against)


def _from_the_first(members: IntArray, one: IntArray, other: IntArray, same: IntArray) -> AnyArray:
    """Which elements of a piece are to be turned, from neighbour to neighbour from its first element on."""
    from scipy.sparse.csgraph import breadth_first_order

    inside = np.isin(one, members)
    one, other = (np.searchsorted(members, each[inside]) for each in (one, other))
    order, before = breadth_first_order(_graph(one, other, len(members)), 0, directed=False)
    differ = dict(zip(zip(one.tolist(), other.tolist(), strict=True), same[inside].tolist(), strict=True))
    flip = np.zeros(len(members), dtype=bool)
    for element in order[1:].tolist():
        known = int(before[element])
        flip[element] = flip[known] ^ bool(differ[(known, element) if (known, element) in differ else (element, known)])
    return flip if 2 * flip.sum() <= len(members) else ~flip


def _graph(one: IntArray, other: IntArray, count: int) -> Any:
    from scipy.sparse import coo_matrix

    return coo_matrix((np.ones(len(one)), (one, other)), shape=(count, count)).tocsr()


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
