"""Normals of the surface that the flat or twisted elements of a first-order mesh stand for."""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from magshell.arrays import FloatArray, IntArray
from magshell.mesh.edges import SIDES, find_edges, is_triangle
from magshell.mesh.geometry import diagonal_normals, unit

BoolArray: TypeAlias = NDArray[np.bool_]

SHARP = np.cos(np.radians(50.0))
"""Elements whose normals are further apart than this meet at a crease."""
BLUNT = np.cos(np.radians(10.0))
"""A smaller angle is never a crease."""
ALONE = 3.0
"""An angle that exceeds every other about its two elements by this factor is a crease."""
SMALLEST_PIVOT = 1e-6
"""Of the fit's scaled moments: what the neighbours do not say of the curvature is zero."""


class Sides(NamedTuple):
    """The sides of the elements, four each (a triangle's third has no length), and what meets at them."""

    ends: IntArray
    """(4 elements, 2)."""
    edge: IntArray
    """(4 elements,): edge number."""
    crease: BoolArray
    """(4 elements,): whether the two elements there meet at an angle that is meant."""
    real: BoolArray
    """(4 elements,): not the side without length of a triangle."""
    normals: FloatArray
    """(4 elements, 2, 3): normal of the smooth surface of this element at both ends."""


def side_normals(points: FloatArray, rows: IntArray) -> Sides:
    """Creases, and normals on both sides of them.

    Elements that meet smoothly about a node share its normal there: that of the paraboloid which fits the nodes of
    their neighbours best. Beyond a crease there is another. The error of such a normal is of second order in the size
    of the elements, at a free edge too, where the mean of the elements' normals is only of first order.

    Parameters
    ----------
    points : (nodes, 3)
    rows : (elements, 8)
        Elements whose neighbours agree which side is up, as far as they can; middles may be missing. Where they do not,
        and where three or more meet, the surface is taken to end.
    """
    edges = find_edges(rows)
    ends = edges.sides[:, :2]
    real = ends[:, 0] != ends[:, 1]
    flat = unit(diagonal_normals(points[rows[:, :4]]))
    partner = _partners(edges.edge_of_side, real)
    against = (partner >= 0) & (edges.sides[:, 0] == edges.sides[partner, 0])
    crease = _creases(rows, flat, partner, against)
    sheet = _sheets(rows, np.where(crease | against, -1, partner))
    normals = _fitted(points, rows, sheet, flat)
    corner = SIDES[:, :2]
    return Sides(ends, edges.edge_of_side, crease, real, normals[sheet[:, corner]].reshape(-1, 2, 3))


def _creases(rows: IntArray, flat: FloatArray, partner: IntArray, against: BoolArray) -> BoolArray:
    """Sides (4 elements,) at a crease: a sharp angle, or one that stands alone among its neighbours."""
    count = len(rows)
    owner = np.repeat(np.arange(count), 4)
    neighbour = np.where(partner >= 0, owner[partner], owner)
    cosine = np.where(against, -1.0, 1.0) * (flat[owner] * flat[neighbour]).sum(axis=1).clip(-1.0, 1.0)
    angle = np.arccos(cosine)
    ring = neighbour.reshape(count, 4)
    around = np.concatenate([4 * ring[:, :, None] + np.arange(4)], axis=2).reshape(count, 16)
    around = np.concatenate([4 * np.arange(count)[:, None] + np.arange(4), around], axis=1)
    ends = rows[:, SIDES[:, :2]].reshape(-1, 2)
    largest = np.zeros(4 * count)
    for column in range(around.shape[1]):
        other = np.repeat(around[:, column], 4)
        touches = (ends[other][:, :, None] == ends[:, None, :]).any(axis=(1, 2))
        np.maximum(largest, np.where(touches, 0.0, angle[other]), out=largest)
    np.maximum(largest, np.where(partner >= 0, largest[partner], 0.0), out=largest)
    crease: BoolArray = (partner >= 0) & ((cosine < SHARP) | ((cosine < BLUNT) & (angle > ALONE * largest)))
    return crease


def _partners(edge: IntArray, real: BoolArray) -> IntArray:
    """The other side (4 elements,) on the edge of each side; -1 where there is none, or more than one."""
    numbers = np.flatnonzero(real)
    order = numbers[np.argsort(edge[numbers], kind="stable")]
    _, start, sharing = np.unique(edge[order], return_index=True, return_counts=True)
    one, other = order[start[sharing == 2]], order[start[sharing == 2] + 1]
    partner = np.full(len(edge), -1)
    partner[one], partner[other] = other, one
    return partner


def _sheets(rows: IntArray, partner: IntArray) -> IntArray:
    """Number (elements, 4) of the sheet about each corner: corners of one node, joined across its smooth edges."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    count = len(rows)
    side = np.flatnonzero(partner >= 0)
    other = partner[side]
    begin, end = SIDES[side % 4, 0], SIDES[side % 4, 1]
    other_begin, other_end = SIDES[other % 4, 0], SIDES[other % 4, 1]
    swapped = rows[side // 4, begin] != rows[other // 4, other_begin]
    matching = np.where(swapped, other_end, other_begin), np.where(swapped, other_begin, other_end)
    doubled = np.flatnonzero(is_triangle(rows))
    ones = np.concatenate([4 * (side // 4) + begin, 4 * (side // 4) + end, 4 * doubled + 2])
    others = np.concatenate([4 * (other // 4) + matching[0], 4 * (other // 4) + matching[1], 4 * doubled + 3])
    graph = coo_matrix((np.ones(len(ones)), (ones, others)), shape=(4 * count, 4 * count))
    _, label = connected_components(graph, directed=False)
    result: IntArray = label.astype(np.int64).reshape(count, 4)
    return result


def _fitted(points: FloatArray, rows: IntArray, sheet: IntArray, flat: FloatArray) -> FloatArray:
    """Normal (sheets, 3) of z = a x + b y + c x² + d x y + e y² + f at the node, fitted to its neighbours.

    The neighbours are the nodes of the elements about the node and of those about them, as far as they are on the
    same side of every crease. What they do not determine stays zero. With f, which is not used, a regular mesh of a
    tube gets normals without an error, so that its straight lines stay straight; through the node they would tilt.
    """
    count = int(sheet.max()) + 1
    node = np.zeros(count, dtype=np.int64)
    node[sheet] = rows[:, :4]
    area = np.linalg.norm(diagonal_normals(points[rows[:, :4]]), axis=1)
    mean = np.zeros((count, 3))
    for corner in range(4):
        np.add.at(mean, sheet[:, corner], flat * area[:, None])
    mean = unit(mean)
    about, far = _neighbourhood(rows, sheet, count)
    tangent = unit(np.cross(mean, np.eye(3)[np.argmin(np.abs(mean), axis=1)]))
    bitangent = np.cross(mean, tangent)
    away = points[far] - points[node[about]]
    x, y, z = ((away * axis[about]).sum(axis=1) for axis in (tangent, bitangent, mean))
    squares = x**2 + y**2
    members = np.bincount(about, minlength=count).clip(min=1)
    scale = np.sqrt(np.bincount(about, squares, count) / members)
    scale[scale == 0.0] = 1.0
    x, y, z = x / scale[about], y / scale[about], z / scale[about]
    terms = np.stack([x, y, x**2, x * y, y**2, np.ones_like(x)], axis=1)
    moments, right = np.zeros((count, 6, 6)), np.zeros((count, 6))
    for i in range(6):
        right[:, i] = np.bincount(about, terms[:, i] * z, count)
        for j in range(i, 6):
            moments[:, i, j] = moments[:, j, i] = np.bincount(about, terms[:, i] * terms[:, j], count)
    slope = np.einsum("nij,nj->ni", np.linalg.pinv(moments, rcond=SMALLEST_PIVOT, hermitian=True), right)[:, :2]
    return unit(mean - slope[:, :1] * tangent - slope[:, 1:] * bitangent)


def _neighbourhood(rows: IntArray, sheet: IntArray, count: int) -> tuple[IntArray, IntArray]:
    """Pairs of a sheet and a node near it: two rings of elements, not across a crease."""
    from scipy.sparse import csr_matrix

    elements = len(rows)
    owner = np.repeat(np.arange(elements), 4)
    belongs = csr_matrix((np.ones(4 * elements), (sheet.ravel(), owner)), shape=(count, elements))
    rings = belongs @ belongs.T @ belongs
    has = csr_matrix((np.ones(4 * elements), (owner, rows[:, :4].ravel())), shape=(elements, int(rows.max()) + 1))
    near = (rings @ has).tocoo()
    return near.row.astype(np.int64), near.col.astype(np.int64)
