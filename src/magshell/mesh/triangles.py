"""Triangles: as rows of a mesh, and made by cutting quadrilaterals."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.errors import InputError, suggest
from magshell.mesh.checks import integer_rows
from magshell.mesh.edges import find_edges, is_triangle
from magshell.mesh.geometry import diagonal_normals, unit
from magshell.mesh.mesh import Mesh

ROW = np.array([0, 1, 2, 2, 3, 4, 2, 5])
PATTERNS = ("rising", "falling", "alternating", "crossed")
_RISING = ((0, 1, 2, 4, 5, 8), (0, 2, 3, 8, 6, 7))
_FALLING = ((0, 1, 3, 4, 8, 7), (1, 2, 3, 5, 6, 8))
_CROSSED = ((0, 1, 8, 4, 10, 9), (1, 2, 8, 5, 11, 10), (2, 3, 8, 6, 12, 11), (3, 0, 8, 7, 9, 12))
"""Nodes a, b, c, ab, bc, ca of the pieces: of the eight, the middle (8), half-ways from it to the corners (9 to 12)."""
_HALF_WAY = (
    np.array([np.concatenate([np.roll([0, -3, -2, -3], i), np.roll([9, 3, 3, 9], i)]) for i in range(4)], dtype=float)
    / 16.0
)
"""The eight-node functions half-way from the centre to each corner."""


def triangle_rows(triangles: ArrayLike) -> IntArray:
    """Rows (n, 8) of `Mesh.elements` for triangles (n, 6) with the nodes a, b, c, ab, bc, ca (VTK_QUADRATIC_TRIANGLE).

    Raises
    ------
    MeshError
        Not whole numbers, or not six to a row.
    """
    rows: IntArray = integer_rows(triangles, 6, "Triangles")[:, ROW]
    return rows


def split(mesh: Mesh, pattern: str = "alternating", elements: ArrayLike | None = None) -> Mesh:
    """Quadrilaterals cut into triangles.

    Parameters
    ----------
    mesh : Mesh
    pattern : {"alternating", "rising", "falling", "crossed"}
        Two triangles from each quadrilateral, along the diagonal from corner 1 to 3 ("rising"), from 2 to 4 ("falling")
        or by turns, so that neighbours mirror each other; or four around its centre ("crossed").
    elements : array_like of int, optional
        Which to cut; by default all. Triangles stay as they are.

    Returns
    -------
    Mesh
        With the groups of the old one; new nodes lie on the old elements.

    Raises
    ------
    InputError
        No such pattern.
    """
    if pattern not in PATTERNS:
        raise InputError(f"split: pattern is {pattern!r}. {suggest(str(pattern), PATTERNS)}")
    cut = np.zeros(len(mesh.elements), dtype=bool)
    cut[slice(None) if elements is None else np.asarray(elements, dtype=np.int64)] = True
    cut &= ~is_triangle(mesh.elements)
    chosen = np.flatnonzero(cut)
    rising = _turns(mesh)[chosen] if pattern == "alternating" else np.full(len(chosen), pattern == "rising")
    inside = _middles(mesh.points[mesh.elements[chosen]], pattern, rising)
    numbers = len(mesh.points) + np.arange(inside.shape[0] * inside.shape[1]).reshape(inside.shape[:2])
    nodes = np.concatenate([mesh.elements[chosen], numbers], axis=1)
    pieces: list[list[IntArray]] = [[row] for row in mesh.elements]
    for element, row, up in zip(chosen, nodes, rising, strict=True):
        patterns = _CROSSED if pattern == "crossed" else _RISING if up else _FALLING
        pieces[element] = [row[np.array(piece)][ROW] for piece in patterns]
    counts = np.array([len(piece) for piece in pieces])
    first = np.cumsum(counts) - counts
    groups = {
        name: np.concatenate([first[e] + np.arange(counts[e]) for e in members])
        for name, members in mesh.element_groups.items()
    }
    points = np.concatenate([mesh.points, inside.reshape(-1, 3)])
    rows = np.concatenate([np.stack(piece) for piece in pieces])
    return Mesh(points, rows, groups, mesh.edge_groups, mesh.node_groups, mesh.cuts)


def _middles(x: FloatArray, pattern: str, rising: AnyArray) -> FloatArray:
    """New nodes (n, 1 or 5, 3) of elements (n, 8, 3): middle of the diagonal, or centre and half-ways to the corners.

    Cuts are straight when seen along the mean normal, and rise to the element's surface.
    """
    normal = unit(diagonal_normals(x))[:, None]
    corners, middles = x[:, :4], x[:, 4:]
    centre = 0.5 * middles.sum(axis=1, keepdims=True) - 0.25 * corners.sum(axis=1, keepdims=True)
    if pattern == "crossed":
        surface = np.einsum("pn,enx->epx", _HALF_WAY, x)
        chord = 0.5 * (centre + corners)
        halves = chord + ((surface - chord) * normal).sum(axis=2, keepdims=True) * normal
        return np.concatenate([centre, halves], axis=1)
    ends = np.where(rising[:, None, None], corners[:, [0, 2]], corners[:, [1, 3]])
    chord = 0.5 * ends.sum(axis=1, keepdims=True)
    return np.asarray(chord + ((centre - chord) * normal).sum(axis=2, keepdims=True) * normal)


def _turns(mesh: Mesh) -> AnyArray:
    """True or false for each element, such that neighbours differ wherever the mesh is a checkerboard."""
    edges = find_edges(mesh.elements)
    pairs = (side // 4 for side in edges.pairs)
    neighbours: list[list[int]] = [[] for _ in mesh.elements]
    for one, other in zip(*pairs, strict=True):
        neighbours[one].append(other)
        neighbours[other].append(one)
    colour = np.full(len(mesh.elements), -1)
    for start in range(len(colour)):
        waiting = [(start, 1)]
        while waiting:
            element, wanted = waiting.pop()
            if colour[element] < 0:
                colour[element] = wanted
                waiting += [(other, 1 - wanted) for other in neighbours[element]]
    return np.asarray(colour == 1)
