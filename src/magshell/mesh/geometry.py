"""Shape of single elements: corner Jacobians, edges, middles."""

from __future__ import annotations

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import MeshError
from magshell.mesh.edges import COLLAPSED, SIDES, is_triangle
from magshell.mesh.wording import COUNTING, further, place

COINCIDENT = 1e-6
"""Positions closer than this fraction of the size of the mesh are the same."""
FLAT_CORNER = 1e-6
"""A scaled Jacobian up to this is zero: the two edges at the corner are in line."""


def scaled_jacobians(points: FloatArray, elements: IntArray) -> FloatArray:
    """Sine of the angle from one edge tangent to the other at the corners, (elements, 4).

    At a corner the tangent of an edge with the ends a, b and the middle m is (4 m - 3 a - b) / 2, the
    derivative of its quadratic interpolation. The normal A1 x A2 / (|A1| |A2|) of these tangents is projected
    on that of the diagonals, so that a corner turned inside out counts negative. Corners 3 and 4 of a triangle are one.
    """
    x = points[elements]
    result: FloatArray = np.einsum("eci,ei->ec", corner_normals(x, elements), unit(diagonal_normals(x)))
    return result


def corner_normals(x: FloatArray, elements: IntArray) -> FloatArray:
    """Normal A1 x A2 / (|A1| |A2|) of the edge tangents at the corners, (elements, 4, 3), with x (elements, 8, 3)."""
    leaving, arriving = corner_tangents(x, elements)
    result: FloatArray = np.cross(unit(leaving), unit(arriving))
    return result


def corner_tangents(x: FloatArray, elements: IntArray) -> tuple[FloatArray, FloatArray]:
    """Tangents of the edges towards the next corner and towards the one before, each (elements, 4, 3), m.

    Corners 3 and 4 of a triangle are one and have the same two tangents.
    """
    triangles = is_triangle(elements)
    leaving = 4 * x[:, 4:] - 3 * x[:, :4] - x[:, [1, 2, 3, 0]]
    arriving = 4 * x[:, [7, 4, 5, 6]] - 3 * x[:, :4] - x[:, [3, 0, 1, 2]]
    leaving[triangles, 2] = leaving[triangles, 3]
    arriving[triangles, 3] = arriving[triangles, 2]
    return leaving, arriving


def diagonal_normals(x: FloatArray) -> FloatArray:
    """Area times mean normal of the corners' quadrilateral, (elements, 3) m²: half the diagonals' product."""
    return 0.5 * np.cross(x[:, 2] - x[:, 0], x[:, 3] - x[:, 1])


def centres(points: FloatArray, elements: IntArray) -> FloatArray:
    """Points (elements, 3) of the surface in the middle of the parent square, m."""
    x = points[elements]
    result: FloatArray = 0.5 * x[:, 4:].sum(axis=1) - 0.25 * x[:, :4].sum(axis=1)
    return result


def unit(vectors: FloatArray) -> FloatArray:
    """Vectors divided by their length; a zero vector stays zero."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    result: FloatArray = vectors / np.where(length > 0, length, 1.0)
    return result


def chord_lengths(points: FloatArray, elements: IntArray) -> FloatArray:
    """Straight distance between the ends of each side, (elements, 4) m; a triangle has its second one twice."""
    x, triangles = points[elements[:, :4]], is_triangle(elements)
    result: FloatArray = np.linalg.norm(np.roll(x, -1, axis=1) - x, axis=2)
    result[triangles, COLLAPSED] = result[triangles, COLLAPSED - 1]
    return result


def check_shapes(points: FloatArray, elements: IntArray, size: float) -> None:
    """Refuse edges of no length, bow-ties, middles out of place and corners turned inside out."""
    _check_edges(points, elements, size)
    _check_bow_ties(points, elements)
    _check_middles(points, elements)
    jacobians = scaled_jacobians(points, elements)
    bad, corner = np.nonzero(jacobians <= FLAT_CORNER)
    if bad.size:
        node = elements[bad[0], corner[0]]
        raise MeshError(
            f"Element {bad[0]} is turned inside out at corner {corner[0] + 1}, node {node} at "
            f"{place(points[node])}: its Jacobian there is {jacobians[bad[0], corner[0]]:.3g} (scaled, must "
            f"be positive). The angle inside the corner must be less than 180 degrees {COUNTING}." + further(bad.size)
        )


def _check_edges(points: FloatArray, elements: IntArray, size: float) -> None:
    lengths = chord_lengths(points, elements)
    bad, side = np.nonzero(lengths <= COINCIDENT * size)
    if bad.size:
        one, other = elements[bad[0], SIDES[side[0], :2]]
        raise MeshError(
            f"Element {bad[0]} has an edge of no length, {lengths[bad[0], side[0]]:.3g} m between nodes "
            f"{one} and {other} at {place(points[one])}: an edge must be longer than {COINCIDENT:g} of the "
            f"size of the mesh, {size:.6g} m." + further(bad.size)
        )


def _check_bow_ties(points: FloatArray, elements: IntArray) -> None:
    x = points[elements[:, :4]]
    leaving = np.roll(x, -1, axis=1) - x
    normals = np.cross(leaving, np.roll(x, 1, axis=1) - x)
    largest = np.argmax(np.linalg.norm(normals, axis=2), axis=1)
    reference = np.take_along_axis(normals, largest[:, None, None], axis=1)
    bad = np.flatnonzero(((normals * reference).sum(axis=2) < 0).sum(axis=1) == 2)
    if bad.size:
        raise MeshError(
            f"Element {bad[0]} is a bow-tie: two of its edges cross, near {place(x[bad[0]].mean(axis=0))}. "
            f"Its corners must be given in the order of a walk around it." + further(bad.size)
        )


def _check_middles(points: FloatArray, elements: IntArray) -> None:
    start, end, middle = (points[elements[:, SIDES[:, i]]] for i in range(3))
    chord = end - start
    offset = (middle - 0.5 * (start + end)) / chord_lengths(points, elements)[..., None]
    along = (offset * unit(chord)).sum(axis=2)
    across = np.linalg.norm(offset - along[:, :, None] * unit(chord), axis=2)
    bad, side = np.nonzero((np.abs(along) >= 0.25 - 1e-9) | (across > 0.5))
    if bad.size:
        at, aside = along[bad[0], side[0]], across[bad[0], side[0]]
        ends, node = elements[bad[0], SIDES[side[0], :2]], elements[bad[0], 4 + side[0]]
        raise MeshError(
            f"Element {bad[0]}: node {node} at {place(points[node])} belongs in the middle between nodes "
            f"{ends[0]} and {ends[1]} but lies at {0.5 + at:.3g} of the way and {aside:.3g} of the edge's "
            "length aside; it must lie between 0.25 and 0.75 of the way and at most 0.5 aside." + further(bad.size)
        )
