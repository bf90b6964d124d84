"""Lines along which the sheets of a shell meet: kinks, joints of three or more, and where normals change sign."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.mesh.angles import interior_angles
from magshell.mesh.edges import edge_keys, find_edges
from magshell.mesh.mesh import Mesh

KINK = np.radians(30.0)
"""Neighbours whose surfaces turn by more than this at their common edge meet at a kink."""


class Line(NamedTuple):
    """Edges in a row, between nodes where such edges end, branch or come into another group."""

    edges: IntArray
    """(k, 3): end, end, middle, from one end of the line to the other."""
    closed: bool
    """Whether the last edge ends where the first begins."""
    angle: FloatArray
    """(2,): the least and the greatest angle along it by which the surface turns there, rad; 0 is smooth."""
    groups: tuple[str, ...]
    """Names of the edge groups that have its edges."""

    @property
    def nodes(self) -> IntArray:
        """Sorted numbers of its nodes, middles included."""
        return np.unique(self.edges)


class Junctions(NamedTuple):
    """The lines of a mesh at which sheets meet."""

    kinks: list[Line]
    """Two elements on each edge, whose surfaces turn by more than 30 degrees."""
    joints: list[Line]
    """Three elements or more on each edge."""
    flips: list[Line]
    """Two elements on each edge, with opposite sides up."""


def junctions_of(mesh: Mesh) -> Junctions:
    """Find kinks, joints and changes of sign of the normals.

    The angle at an edge is measured between the directions into its two elements, at both ends of the edge: it does not
    depend on which side of them is up.
    """
    edges = find_edges(mesh.elements)
    one, other = edges.pairs
    number, count = edges.edge_of_side[one], len(edges.first_side)
    turn = (np.pi - interior_angles(mesh.points, mesh.elements, edges, (one, other))).max(axis=1)
    sharpest = np.zeros(count)
    np.maximum.at(sharpest, number, turn)
    two = edges.sharing == 2
    against = np.zeros(count, dtype=bool)
    against[number[edges.sides[one, 0] == edges.sides[other, 0]]] = True
    return Junctions(
        *(
            _lines(mesh, edges.sides[edges.first_side[chosen]], sharpest[chosen])
            for chosen in (two & (sharpest > KINK), edges.sharing > 2, two & against)
        )
    )


def _lines(mesh: Mesh, rows: IntArray, angle: FloatArray) -> list[Line]:
    """Edges (k, 3) in lines, each of edges that are in the same groups."""
    if not len(rows):
        return []
    count, keys = len(mesh.points), edge_keys(rows, len(mesh.points))
    inside = [np.isin(keys, edge_keys(group, count)) for group in mesh.edge_groups.values()]
    patterns, which = np.unique(np.array(inside, dtype=bool).reshape(-1, len(rows)).T, axis=0, return_inverse=True)
    lines = []
    for pattern, named in enumerate(patterns):
        members = np.flatnonzero(which.ravel() == pattern)
        groups = tuple(name for name, has in zip(mesh.edge_groups, named, strict=True) if has)
        for chain, against in _chains(rows[members]):
            order = members[chain]
            walked = rows[order]
            walked[against] = walked[against][:, [1, 0, 2]]
            bounds = np.array([angle[order].min(), angle[order].max()])
            lines.append(Line(walked, bool(walked[0, 0] == walked[-1, 1]), bounds, groups))
    return lines


def _chains(rows: IntArray) -> list[tuple[IntArray, AnyArray]]:
    """Numbers of the edges of each chain in a row, and which of them are walked backwards.

    Chains end at nodes that have one edge or more than two; what is left are loops, from their first edge on.
    """
    about: dict[int, list[int]] = {}
    for number, (begin, end) in enumerate(rows[:, :2].tolist()):
        about.setdefault(begin, []).append(number)
        about.setdefault(end, []).append(number)
    left = set(range(len(rows)))
    ends = [(node, number) for node, found in about.items() if len(found) != 2 for number in found]
    chains = []
    for node, number in [*ends, *((int(row[0]), number) for number, row in enumerate(rows))]:
        if number not in left:
            continue
        order, against = [], []
        while number in left:
            left.remove(number)
            begin, end = (int(each) for each in rows[number, :2])
            order.append(number)
            against.append(end == node)
            node = begin if end == node else end
            if len(about[node]) == 2:
                number = next((other for other in about[node] if other != number), number)
        chains.append((np.array(order), np.array(against)))
    return chains
