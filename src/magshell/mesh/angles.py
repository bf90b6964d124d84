"""Angles between elements that share an edge."""

from __future__ import annotations

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import MeshError
from magshell.mesh.edges import Edges
from magshell.mesh.geometry import corner_tangents, unit
from magshell.mesh.wording import further, place

FOLDED = np.radians(0.1)
"""Elements with a smaller angle between them lie on each other."""


def interior_angles(
    points: FloatArray, elements: IntArray, edges: Edges, pairs: tuple[IntArray, IntArray]
) -> FloatArray:
    """Angle (k, 2) between two elements at both ends of their common edge, rad: π where one continues the other.

    It is measured between the directions that lead from the edge into the elements, so that it does not depend on
    which side of them is up.

    Parameters
    ----------
    points : (nodes, 3)
        m.
    elements : (elements, 8)
    edges : Edges
    pairs : (k,) and (k,)
        Numbers of their sides.
    """
    inward = _inward(points[elements], elements)
    one, other = (inward[side] for side in pairs)
    alike = edges.sides[pairs[0], 0] == edges.sides[pairs[1], 0]
    other = np.where(alike[:, None, None], other, other[:, ::-1])
    chord, sum_ = np.linalg.norm(one - other, axis=2), np.linalg.norm(one + other, axis=2)
    result: FloatArray = 2.0 * np.arctan2(chord, sum_)
    return result


def check_folded(points: FloatArray, elements: IntArray, edges: Edges) -> None:
    """Refuse elements that share an edge and lie on each other."""
    pairs = edges.pairs
    angle = interior_angles(points, elements, edges, pairs).max(axis=1)
    bad = np.flatnonzero(angle < FOLDED)
    if bad.size:
        one, other = pairs[0][bad[0]], pairs[1][bad[0]]
        start, end = edges.sides[one, :2]
        raise MeshError(
            f"Elements {one // 4} and {other // 4} lie on each other: at their common edge from node {start} at "
            f"{place(points[start])} to node {end} at {place(points[end])} the angle between them is "
            f"{np.degrees(angle[bad[0]]):.2g} degrees; it must be more than {np.degrees(FOLDED):g}." + further(bad.size)
        )


def _inward(x: FloatArray, elements: IntArray) -> FloatArray:
    """Unit vectors (4 elements, 2, 3) at both ends of each side, perpendicular to it and into the element."""
    leaving, arriving = corner_tangents(x, elements)
    begin = _perpendicular(arriving, leaving)
    end = _perpendicular(np.roll(leaving, -1, axis=1), np.roll(arriving, -1, axis=1))
    return np.stack([begin, end], axis=2).reshape(-1, 2, 3)


def _perpendicular(vectors: FloatArray, along: FloatArray) -> FloatArray:
    """Unit vectors of what the vectors have across a direction."""
    axis = unit(along)
    return unit(vectors - (vectors * axis).sum(axis=-1, keepdims=True) * axis)
