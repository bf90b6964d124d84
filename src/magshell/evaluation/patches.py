"""Smooth patches about the nodes: over which elements a field may be averaged, and over which it may not.

Stress and strain jump where thickness, layers, material or remanence change, and at a kink. So a node has a row of its
own for each patch of elements about it that is free of such borders: most have one, those on a border two or more.
Tables of rows begin with one row for each node of the mesh, in its order; the further ones follow.
"""

from __future__ import annotations

import weakref
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.evaluation.extrapolation import to_nodes
from magshell.mesh.edges import SIDES, find_edges, is_triangle
from magshell.model.rows import rows_of
from magshell.model.shell import Shell
from magshell.shell.normals import corner_normals
from magshell.shell.triangle import REPEATED

KINK = np.cos(np.radians(10.0))
"""Elements whose normals at their common edge are further apart than this meet at a kink."""
JUMP = 0.1
"""Share of the remanence by which it differs, at the common edge, between elements that are magnetised apart."""


class Patches(NamedTuple):
    """Rows of nodal values, one for each node and each smooth patch about it.

    Attributes
    ----------
    nodes : ndarray, shape (rows,)
        Node of the mesh of each row; the first rows are the nodes themselves.
    elements : ndarray, shape (elements, 8)
        Row of each node of each element.
    normals : ndarray, shape (rows, 3)
        Unit normals of the undeformed surface, averaged over the patch.
    mean : csr_array, shape (rows, 8 * elements)
        Takes values at the nodes of each element to their mean over the patch.
    first : ndarray, shape (rows,)
        First element of each patch.
    """

    nodes: IntArray
    elements: IntArray
    normals: FloatArray
    mean: sp.csr_array
    first: IntArray


_kept: weakref.WeakKeyDictionary[Shell, Patches] = weakref.WeakKeyDictionary()


def patches_of(shell: Shell) -> Patches:
    """The patches of a shell, found once."""
    if shell not in _kept:
        _kept[shell] = _found(shell)
    return _kept[shell]


def _found(shell: Shell) -> Patches:
    mesh = shell.mesh
    elements, normals = mesh.elements, corner_normals(mesh.points, mesh.elements)
    count = elements.size
    one, other = _joined(elements, _smooth(elements, normals, rows_of(shell).elements, _remanence(shell)))
    graph = sp.coo_array((np.ones(len(one)), (one, other)), shape=(count, count))
    component = connected_components(graph, directed=False)[1]
    _, first, inverse = np.unique(component, return_index=True, return_inverse=True)
    order = _nodes_first(elements.ravel()[first], first)
    place = np.empty_like(order)
    place[order] = np.arange(len(order))
    rows = place[inverse].reshape(elements.shape)
    counts = np.ones(elements.shape)
    counts[np.ix_(is_triangle(elements), REPEATED)] = 0.0
    shares = counts.ravel() / np.bincount(rows.ravel(), counts.ravel())[rows.ravel()]
    mean = sp.csr_array((shares, (rows.ravel(), np.arange(count))), shape=(len(order), count))
    total = np.asarray(mean @ normals.reshape(-1, 3))
    return Patches(
        elements.ravel()[first[order]],
        rows,
        total / np.linalg.norm(total, axis=1, keepdims=True),
        mean,
        first[order] // 8,
    )


def _remanence(shell: Shell) -> FloatArray:
    """Remanence at the nodes of each element (elements, 8, 3), T."""
    matrices = to_nodes(shell.element, shell.mesh.points[shell.mesh.elements])
    return np.asarray(np.einsum("enp,epx->enx", matrices, shell.remanence_at_points))


def _smooth(elements: IntArray, normals: FloatArray, rows: IntArray, remanence: FloatArray) -> IntArray:
    """Pairs (k, 2) of sides, numbered 4 e + s, at which two elements meet without a border."""
    edges = find_edges(elements)
    side = np.argsort(edges.edge_of_side, kind="stable")
    side = side[edges.sharing[edges.edge_of_side[side]] == 2].reshape(-1, 2)
    element, middle = side // 4, SIDES[side % 4, 2]
    turn = np.sum(normals[element[:, 0], middle[:, 0]] * normals[element[:, 1], middle[:, 1]], axis=1)
    here, there = (remanence[element[:, k], middle[:, k]] for k in (0, 1))
    larger = np.linalg.norm(remanence, axis=2).max(axis=1)[element].max(axis=1)
    alike = np.linalg.norm(here - there, axis=1) <= JUMP * larger
    same = np.all([_rows_of_side(rows, side[:, 0]) == _rows_of_side(rows, side[:, 1])], axis=(0, 2))
    return np.asarray(side[alike & (turn > KINK) & same])


def _rows_of_side(rows: IntArray, side: IntArray) -> IntArray:
    """Rows of the nodal arrays at the ends of sides (n, 2), the lower first: equal sections have the same."""
    return np.sort(np.take_along_axis(rows[side // 4], SIDES[side % 4, :2], axis=1), axis=1)


def _joined(elements: IntArray, pairs: IntArray) -> tuple[IntArray, IntArray]:
    """Places in `elements.ravel()` that belong together: those of the nodes of a smooth edge, repeated ones."""
    element, local = pairs // 4, SIDES[pairs % 4]
    here, there = (8 * element[:, k, None] + local[:, k] for k in (0, 1))
    nodes = elements.ravel()
    turned = nodes[here[:, 0]] != nodes[there[:, 0]]
    there[turned, :2] = there[turned, 1::-1]
    triangles = np.flatnonzero(is_triangle(elements))
    repeated = 8 * triangles[:, None] + REPEATED
    third = np.broadcast_to(8 * triangles[:, None] + 2, repeated.shape)
    return np.append(here, repeated), np.append(there, third)


def _nodes_first(nodes: IntArray, first: IntArray) -> IntArray:
    """Order of the patches: for each node the one of the lowest element, then the others."""
    order = np.argsort(first, kind="stable")
    _, lowest = np.unique(nodes[order], return_index=True)
    leading = order[lowest]
    others: AnyArray = np.ones(len(nodes), dtype=bool)
    others[leading] = False
    return np.concatenate([leading, order[others[order]]])
