"""Places where elements touch without being joined: the surface would gape there under load."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import chain
from typing import Any

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import MeshError
from magshell.mesh.edges import Edges, edge_keys
from magshell.mesh.geometry import COINCIDENT, chord_lengths
from magshell.mesh.resting import check_resting
from magshell.mesh.wording import further, place

ON_EDGE = 1e-3
"""A node closer to an edge than this fraction of its element's shortest side lies on it.

Wide enough for a node on the true surface of an arc of 30 degrees, of which the quadratic edge misses 2e-4.
"""


def check_unmatched(
    points: FloatArray, elements: IntArray, edges: Edges, size: float, cuts: Mapping[str, IntArray]
) -> None:
    """Refuse coincident nodes, and nodes on an element that does not have them: on its free edges, or of free edges.

    Where both lie on one of the cuts, edges (k, 3) by name, they are meant; a cut where nothing does is refused.
    """
    from scipy.spatial import cKDTree

    tree = cKDTree(points)
    pairs = np.sort(tree.query_pairs(COINCIDENT * size, output_type="ndarray"), axis=1)
    pairs = pairs[np.lexsort(pairs.T[::-1])]
    sides, nodes = _touching(points, elements, edges, size, tree)
    together, touching = np.zeros(len(pairs), dtype=bool), np.zeros(len(sides), dtype=bool)
    on_any = np.zeros(len(points), dtype=bool)
    for name, rows in cuts.items():
        on_cut = np.zeros(len(points), dtype=bool)
        on_cut[rows] = True
        on_cut[pairs[on_cut[pairs].any(axis=1)]] = True
        own = on_cut[pairs].all(axis=1), on_cut[nodes] & on_cut[edges.sides[sides]].all(axis=1)
        if not (own[0].any() or own[1].any()):
            known = edges.sides[edges.first_side[edges.sharing > 1]]
            shared = np.isin(edge_keys(rows, len(points)), edge_keys(known, len(points))).any()
            fault = "elements share its edges; mesh.cut doubles their nodes" if shared else "its edges are free"
            raise MeshError(
                f"Cut '{name}', from {place(points[rows[0, 0]])} on: no nodes lie on each other there, as {fault}."
            )
        together, touching, on_any = together | own[0], touching | own[1], on_any | on_cut
    if not together.all():
        one, other = pairs[~together][0]
        raise MeshError(
            f"Elements {_owner(elements, one)} and {_owner(elements, other)} are not joined: node {one} of "
            f"the first and node {other} of the second are both at {place(points[one])}. Weld them, leave "
            f"a gap, or name the edge group of a cut in cuts." + further(int((~together).sum()))
        )
    if not touching.all():
        sides, nodes = sides[~touching], nodes[~touching]
        ends = edges.sides[sides[0]]
        raise MeshError(
            f"Elements {sides[0] // 4} and {_owner(elements, nodes[0])} do not match: node {nodes[0]} of the "
            f"second at {place(points[nodes[0]])} lies on the edge of the first between nodes {ends[0]} and "
            f"{ends[1]} without being a node of it. Divide both elements alike along that edge, or leave a "
            f"gap." + further(len(sides))
        )
    check_resting(points, elements, edges, size, on_any)


def coincident(points: FloatArray) -> IntArray:
    """Numbers of the nodes that lie on another."""
    from scipy.spatial import cKDTree

    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    return np.unique(cKDTree(points).query_pairs(COINCIDENT * size, output_type="ndarray"))


def _touching(
    points: FloatArray, elements: IntArray, edges: Edges, size: float, tree: Any
) -> tuple[IntArray, IntArray]:
    """Free sides (k,) and nodes (k,) that lie on them, without those that lie on a node of the side."""
    sides = edges.boundary
    if not sides.size:
        return sides, sides
    start, end, middle = (points[edges.sides[sides, i]] for i in range(3))
    tolerance = ON_EDGE * chord_lengths(points, elements).min(axis=1)[sides // 4]
    reach = np.max([np.linalg.norm(v, axis=1) for v in (start - middle, end - middle)], axis=0)
    near = tree.query_ball_point(middle, reach + tolerance)
    side = np.repeat(np.arange(len(sides)), [len(found) for found in near])
    node = np.fromiter(chain.from_iterable(near), dtype=np.int64, count=len(side))
    strange = ~(elements[sides[side] // 4] == node[:, None]).any(axis=1)
    side, node = side[strange], node[strange]
    distance = _distances(points[node], start[side], end[side], middle[side])
    apart = np.linalg.norm(points[edges.sides[sides[side]]] - points[node][:, None], axis=2).min(axis=1)
    touching = (distance <= tolerance[side]) & (apart > COINCIDENT * size)
    return sides[side[touching]], node[touching]


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
