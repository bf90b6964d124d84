"""First-order elements raised to second order: middles of their sides on the surface that they stand for."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.mesh.edges import SIDES, find_edges
from magshell.mesh.files.cells import MISSING
from magshell.mesh.files.normals import SHARP, BoolArray, side_normals
from magshell.mesh.geometry import unit

STRAIGHT = 1e-9
"""A middle that is off its chord by no more than this fraction of its length is put on it."""
PARALLEL = 0.15
"""Normals whose angle has no greater sine are one and the same."""

COPLANAR = 1e-5
"""Planes whose normals' angle has no greater sine are one and the same."""

STEEP = 0.3
"""Least sine of the angle between a surface and the plane of its free edge for the edge to be held in that plane."""


class Raised(NamedTuple):
    """A mesh with all its middles."""

    points: FloatArray
    """(nodes, 3): those that were there, then the new middles."""
    rows: IntArray
    """(elements, 8)."""
    middles: int
    """How many are new,"""
    curved: int
    """how many of them are off the chord, and"""
    creases: int
    """how many of the edges are creases."""


def raise_order(points: FloatArray, rows: IntArray) -> Raised:
    r"""Give every edge a middle.

    Parameters
    ----------
    points : (nodes, 3)
    rows : (elements, 8)
        Elements whose neighbours agree which side is up, as far as they can; -1 where a middle is missing. Middles that
        are there stay.

    Notes
    -----
    With the normals $n_1, n_2$ at the ends of a chord of length $c$ and direction $t$, and $\sin\theta_1 = -t\cdot
    n_1$, $\sin\theta_2 = t\cdot n_2$, the middle is off the chord by

        c/4 (tan(θ1/2) e1 + tan(θ2/2) e2),    e_i the unit vector along n_i - (n_i·t) t.

    This is exact for a circular arc whose normals are exact, and straight where the chord lies in the surface. At a
    crease, the two surfaces that meet there both say how far the middle is off along their normals; the shortest
    vector that does both is taken, so that a tube and its lid share their circle. Where three or more meet, it is that
    of the two at the angle nearest to a right one. A free edge that lies in a plane
    with those before and after it stays in that plane.
    """
    edges = find_edges(rows)
    sides = side_normals(points, rows)
    middle_of = np.full(len(edges.first_side), MISSING)
    own = rows[:, 4:].ravel()
    np.maximum.at(middle_of, edges.edge_of_side, own)
    first_real = sides.real[edges.first_side]
    wanted = np.flatnonzero((middle_of == MISSING) & first_real)
    begin, end = points[edges.sides[edges.first_side[wanted], 0]], points[edges.sides[edges.first_side[wanted], 1]]
    offset = _offsets(points, sides.ends, sides.normals, edges.edge_of_side, sides.real, len(edges.first_side))[wanted]
    length = np.linalg.norm(end - begin, axis=1)
    offset[np.linalg.norm(offset, axis=1) <= STRAIGHT * length] = 0.0
    middle_of[wanted] = len(points) + np.arange(len(wanted))
    result = rows.copy()
    for side in range(4):
        number = 4 * np.arange(len(rows)) + side
        chosen = sides.real[number]
        result[chosen, SIDES[side, 2]] = middle_of[edges.edge_of_side[number[chosen]]]
    return Raised(
        points=np.concatenate([points, 0.5 * (begin + end) + offset]),
        rows=result,
        middles=len(wanted),
        curved=int(offset.any(axis=1).sum()),
        creases=len(np.unique(edges.edge_of_side[sides.crease])),
    )


def _offsets(
    points: FloatArray, ends: IntArray, normals: FloatArray, edge: IntArray, real: BoolArray, count: int
) -> FloatArray:
    """Of the middle of each edge from its chord, (edges, 3)."""
    chord = points[ends[:, 1]] - points[ends[:, 0]]
    length = np.linalg.norm(chord, axis=1)
    along = unit(chord)
    offset = np.zeros_like(chord)
    for which, sign in ((0, -1.0), (1, 1.0)):
        sine = sign * (normals[:, which] * along).sum(axis=1)
        across = unit(normals[:, which] - sign * sine[:, None] * along)
        offset += (0.25 * length * np.tan(0.5 * np.arcsin(sine.clip(-1.0, 1.0))))[:, None] * across
    normal = unit(normals.sum(axis=1))
    normal = unit(normal - (normal * along).sum(axis=1)[:, None] * along)
    numbers = np.flatnonzero(real)
    order = numbers[np.argsort(edge[numbers], kind="stable")]
    found, start, sharing = np.unique(edge[order], return_index=True, return_counts=True)
    result = np.zeros((count, 3))
    one, other = order[start], order[start + (sharing > 1)]
    for at in np.flatnonzero(sharing > 2):
        one[at], other[at] = _steepest(order[start[at] : start[at] + sharing[at]], normal)
    result[found] = _meeting(normal[one], normal[other], offset[one], offset[other])
    free = one[sharing == 1]
    plane, known = _planes_of_free_edges(points, ends, free)
    across = np.linalg.norm(np.cross(plane, normal[free]), axis=1) > STEEP
    own, free, plane = found[sharing == 1][known & across], free[known & across], plane[known & across]
    result[own] = _meeting(normal[free], plane, result[own], np.zeros_like(plane))
    return result


def _steepest(sides: IntArray, normal: FloatArray) -> IntArray:
    """The two of several sides on an edge whose surfaces meet at the angle nearest to a right one."""
    cosine = np.abs(normal[sides] @ normal[sides].T)
    pair: IntArray = sides[np.array(np.unravel_index(np.argmin(cosine), cosine.shape))]
    return pair


def _planes_of_free_edges(points: FloatArray, ends: IntArray, free: IntArray) -> tuple[FloatArray, BoolArray]:
    """Unit normal (free, 3) of the plane of each free side and those that follow smoothly; whether there is one.

    Three nodes in a row have a plane, of four it must be the same one.
    """
    begin, end = ends[free, 0], ends[free, 1]
    before, after = _beyond(begin, end, begin), _beyond(begin, end, end)
    own = unit(points[end] - points[begin])
    arriving, leaving = unit(points[begin] - points[before]), unit(points[after] - points[end])
    normals = []
    for node, next_one in ((before, arriving), (after, leaving)):
        smooth = (node >= 0) & ((next_one * own).sum(axis=1) > SHARP)
        normals.append(np.where(smooth[:, None], np.cross(own, next_one), 0.0))
    sizes = [np.linalg.norm(each, axis=1) for each in normals]
    first, second = (unit(each) for each in normals)
    both = (sizes[0] > STRAIGHT) & (sizes[1] > STRAIGHT)
    same = np.linalg.norm(np.cross(first, second), axis=1) <= COPLANAR
    plane = np.where((sizes[0] > STRAIGHT)[:, None], first, second)
    return plane, np.where(both, same, (sizes[0] > STRAIGHT) | (sizes[1] > STRAIGHT))


def _beyond(begin: IntArray, end: IntArray, at: IntArray) -> IntArray:
    """The next node (k,) beyond the node `at` of each free side; -1 unless just one other side has it."""
    sides, nodes = np.arange(len(begin)), np.concatenate([begin, end])
    sharing, total = np.bincount(nodes), np.bincount(nodes, np.tile(sides, 2)).astype(np.int64)
    other = np.where(sharing[at] == 2, total[at] - sides, sides)
    return np.where(sharing[at] == 2, begin[other] + end[other] - at, -1)


def _meeting(n1: FloatArray, n2: FloatArray, d1: FloatArray, d2: FloatArray) -> FloatArray:
    """The shortest vectors d with d·n1 = d1·n1 and d·n2 = d2·n2; the mean where n1 and n2 are the same."""
    a1, a2 = (d1 * n1).sum(axis=1), (d2 * n2).sum(axis=1)
    c = (n1 * n2).sum(axis=1)
    sine2 = 1.0 - c**2
    same = sine2 <= PARALLEL**2
    divisor = np.where(same, 1.0, sine2)
    meeting = ((a1 - c * a2) / divisor)[:, None] * n1 + ((a2 - c * a1) / divisor)[:, None] * n2
    return np.where(same[:, None], 0.5 * (d1 + d2), meeting)
