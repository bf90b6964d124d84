"""Places where elements touch without being joined: the surface would gape there under load."""

from __future__ import annotations

from itertools import chain

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import MeshError
from magshell.mesh.edges import Edges
from magshell.mesh.geometry import COINCIDENT, chord_lengths
from magshell.mesh.wording import further, place

ON_EDGE = 1e-3
"""A node closer to an edge than this fraction of its element's shortest side lies on it.

Wide enough for a node on the true surface of an arc of 30 degrees, of which the quadratic edge misses 2e-4.
"""


def check_unmatched(points: FloatArray, elements: IntArray, edges: Edges, size: float) -> None:
    """Refuse coincident nodes, and nodes on the free edge of an element that does not have them."""
    from scipy.spatial import cKDTree

    tree = cKDTree(points)
    pairs = tree.query_pairs(COINCIDENT * size, output_type="ndarray")
    if len(pairs):
        one, other = np.sort(pairs, axis=1)[np.lexsort(np.sort(pairs, axis=1).T[::-1])[0]]
        raise MeshError(
            f"Elements {_owner(elements, one)} and {_owner(elements, other)} are not joined: node {one} of "
            f"the first and node {other} of the second are both at {place(points[one])}. Weld the mesh, or "
            f"leave a gap." + further(len(pairs))
        )
    sides = edges.boundary
    if not sides.size:
        return
    start, end, middle = (points[edges.sides[sides, i]] for i in range(3))
    tolerance = ON_EDGE * chord_lengths(points, elements).min(axis=1)[sides // 4]
    reach = np.max([np.linalg.norm(v, axis=1) for v in (start - middle, end - middle)], axis=0)
    near = tree.query_ball_point(middle, reach + tolerance)
    side = np.repeat(np.arange(len(sides)), [len(found) for found in near])
    node = np.fromiter(chain.from_iterable(near), dtype=np.int64, count=len(side))
    strange = ~(elements[sides[side] // 4] == node[:, None]).any(axis=1)
    side, node = side[strange], node[strange]
    distance = _distances(points[node], start[side], end[side], middle[side])
    touching = np.flatnonzero(distance <= tolerance[side])
    if touching.size:
        touched, found = sides[side[touching[0]]], node[touching[0]]
        ends = edges.sides[touched]
        raise MeshError(
            f"Elements {touched // 4} and {_owner(elements, found)} do not match: node {found} of the "
            f"second at {place(points[found])} lies on the edge of the first between nodes {ends[0]} and "
            f"{ends[1]} without being a node of it. Divide both elements alike along that edge, or leave a "
            f"gap." + further(touching.size)
        )


def _owner(elements: IntArray, node: int) -> int:
    return int(np.argmax((elements == node).any(axis=1)))


def _distances(points: FloatArray, start: FloatArray, end: FloatArray, middle: FloatArray) -> FloatArray:
    """Distance (k,) of points from quadratic edges, the foot sought by Gauss-Newton steps along each edge."""
    mean, half, bend = 0.5 * (start + end) - middle, 0.5 * (end - start), middle
    at = np.zeros((len(points), 1))
    for _ in range(8):
        away = points - (bend + at * half + at**2 * mean)
        tangent = half + 2 * at * mean
        at = (at + (away * tangent).sum(axis=1, keepdims=True) / (tangent**2).sum(axis=1, keepdims=True)).clip(-1, 1)
    result: FloatArray = np.linalg.norm(points - (bend + at * half + at**2 * mean), axis=1)
    return result
