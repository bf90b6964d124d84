"""Closed surfaces that are the skin of a solid and no shell."""

from __future__ import annotations

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.mesh.edges import Edges, find_edges
from magshell.mesh.files.cells import MISSING
from magshell.mesh.files.normals import SHARP
from magshell.mesh.geometry import corner_normals, diagonal_normals, unit

FACE = 0.1
"""A flat piece with this fraction of the area of its closed surface is a face of a solid."""
FLAT = 1e-3
"""Angle between normals of one plane, as files of single precision have them."""
PARALLEL = np.cos(np.radians(1.0))


def skin_of_a_solid(points: FloatArray, rows: IntArray) -> str:
    """Why a surface, or a part of it, looks like the skin of a solid; empty if it does not.

    Parts that are closed, without a free edge, are looked at. One is a skin if elements meet at a sharp edge, or if two
    of its faces are flat and parallel. What is round all over, as a balloon, is not.

    Parameters
    ----------
    points : (nodes, 3)
    rows : (elements, 8)
        Elements whose neighbours agree which side is up; -1 where a middle is missing.
    """
    edges = find_edges(rows)
    part, closed = _closed_parts(rows, edges)
    if not closed.any():
        return ""
    x = _with_middles(points, rows)
    one, other = _pairs(edges)
    kept = closed[part[one // 4]]
    one, other = one[kept], other[kept]
    sharp = np.flatnonzero(_cosines(x, rows, one, other) < SHARP)
    if sharp.size:
        ends = points[edges.sides[one[sharp[0]], :2]]
        where = ", ".join(f"{value:.4g}" for value in ends.mean(axis=0))
        return f"its elements meet at more than 50° along {sharp.size} edges, as at ({where})"
    if _has_parallel_faces(x, rows, one // 4, other // 4, part, closed):
        return "it has two flat faces that are parallel, each with a tenth of its area or more"
    return ""


def _closed_parts(rows: IntArray, edges: Edges) -> tuple[IntArray, IntArray]:
    """Number of the connected part of each element; which parts have two elements on every edge."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    owner = np.arange(len(edges.edge_of_side)) // 4
    graph = coo_matrix((np.ones(len(owner)), (owner, len(rows) + edges.edge_of_side)), shape=2 * (5 * len(rows),))
    part = connected_components(graph, directed=False)[1][: len(rows)].astype(np.int64)
    sharing = edges.sharing[edges.edge_of_side]
    open_sides = (sharing != 2) & (sharing != 0)
    closed = np.ones(part.max() + 1, dtype=bool)
    closed[part[owner[open_sides]]] = False
    return part, closed


def _pairs(edges: Edges) -> tuple[IntArray, IntArray]:
    """Sides that lie on the edges which two elements share: one, the other."""
    order = np.argsort(edges.edge_of_side, kind="stable")
    start = np.searchsorted(edges.edge_of_side[order], np.flatnonzero(edges.sharing == 2))
    return order[start], order[start + 1]


def _with_middles(points: FloatArray, rows: IntArray) -> FloatArray:
    """Positions (elements, 8, 3), with a middle halfway where it is missing."""
    x: FloatArray = points[rows]
    halfway = 0.5 * (x[:, :4] + np.roll(x[:, :4], -1, axis=1))
    x[:, 4:] = np.where((rows[:, 4:] == MISSING)[..., None], halfway, x[:, 4:])
    return x


def _cosines(x: FloatArray, rows: IntArray, one: IntArray, other: IntArray) -> FloatArray:
    """Cosine of the angle between the normals on both sides of an edge, at that of its ends where it is least."""
    normals = unit(corner_normals(x, rows))
    begin, end = normals[one // 4, one % 4], normals[one // 4, (one % 4 + 1) % 4]
    begin_beyond, end_beyond = normals[other // 4, (other % 4 + 1) % 4], normals[other // 4, other % 4]
    result: FloatArray = np.minimum((begin * begin_beyond).sum(axis=1), (end * end_beyond).sum(axis=1))
    return result


def _has_parallel_faces(
    x: FloatArray, rows: IntArray, one: IntArray, other: IntArray, part: IntArray, closed: IntArray
) -> bool:
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    area_normals = diagonal_normals(x)
    flat, area = unit(area_normals), np.linalg.norm(area_normals, axis=1)
    straight = np.linalg.norm(unit(corner_normals(x, rows)) - flat[:, None], axis=2).max(axis=1) < FLAT
    joined = straight[one] & straight[other] & (np.linalg.norm(flat[one] - flat[other], axis=1) < FLAT)
    graph = coo_matrix((np.ones(joined.sum()), (one[joined], other[joined])), shape=2 * (len(x),))
    count, piece = connected_components(graph, directed=False)
    areas = np.bincount(piece, area * straight, count)
    normal: FloatArray = np.stack([np.bincount(piece, area_normals[:, axis], count) for axis in range(3)], axis=1)
    of_part = np.zeros(count, dtype=np.int64)
    of_part[piece] = part
    whole = np.bincount(part, area)
    faces = np.flatnonzero((areas > FACE * whole[of_part]) & closed[of_part])
    directions = unit(normal[faces])
    opposite = directions @ directions.T < -PARALLEL
    return bool((opposite & (of_part[faces][:, None] == of_part[faces])).any())
