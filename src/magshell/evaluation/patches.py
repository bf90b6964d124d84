"""Smooth patches about the nodes: over which elements a field may be averaged, and over which it may not.

Stress and strain jump where thickness, layers, material or remanence change, and at a kink. So a node has a row of its
own for each patch of elements about it that is free of such borders: most have one, those on a border two or more.
Tables of rows begin with one row for each node of the mesh, in its order; the further ones follow.

Where a part that stands for many alike meets its neighbours, their elements belong to the patches like its own.
"""

from __future__ import annotations

import weakref
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.evaluation.around import Around, around
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
    first : ndarray, shape (rows,)
        First element of each patch.
    around : Around
        The elements, and those of the neighbours.
    places : ndarray, shape (k,)
        Nodes in the patches, as places in `around.elements.ravel()`: all of the elements, then those of neighbours.
    rows : ndarray, shape (k,)
        Row of each of them.
    mean : csr_array, shape (rows, k)
        Takes values at the places to their mean over the patch.
    """

    nodes: IntArray
    elements: IntArray
    normals: FloatArray
    first: IntArray
    around: Around
    places: IntArray
    rows: IntArray
    mean: sp.csr_array


_kept: weakref.WeakKeyDictionary[Shell, Patches] = weakref.WeakKeyDictionary()


def patches_of(shell: Shell) -> Patches:
    """The patches of a shell, found once."""
    if shell not in _kept:
        _kept[shell] = _found(shell)
    return _kept[shell]


def _found(shell: Shell) -> Patches:
    about = around(shell)
    elements, normals = about.elements, corner_normals(about.points, about.elements)
    one, other = _joined(elements, _smooth(elements, normals, *_made(shell, about)))
    graph = sp.coo_array((np.ones(len(one)), (one, other)), shape=(elements.size, elements.size))
    component = connected_components(graph, directed=False)[1]
    _, first, inverse = np.unique(component, return_index=True, return_inverse=True)
    own = np.flatnonzero(first < shell.mesh.elements.size)
    first = first[own]
    order = _nodes_first(elements.ravel()[first], first)
    row_of = np.full(inverse.max() + 1, -1)
    row_of[own[order]] = np.arange(len(order))
    places = np.flatnonzero(row_of[inverse] >= 0)
    rows = row_of[inverse[places]]
    counts = np.ones(elements.shape)
    counts[np.ix_(is_triangle(elements), REPEATED)] = 0.0
    shares = counts.ravel()[places]
    shares /= np.bincount(rows, shares)[rows]
    mean = sp.csr_array((shares, (rows, np.arange(len(rows)))), shape=(len(order), len(rows)))
    total = np.asarray(mean @ normals.reshape(-1, 3)[places])
    return Patches(
        elements.ravel()[first[order]],
        rows[: shell.mesh.elements.size].reshape(shell.mesh.elements.shape),
        total / np.linalg.norm(total, axis=1, keepdims=True),
        first[order] // 8,
        about,
        places,
        rows,
        mean,
    )


def _made(shell: Shell, about: Around) -> tuple[IntArray, FloatArray]:
    """Rows of the nodal arrays (n, 8), those of images by their roots, and remanence (n, 8, 3), T, at the nodes."""
    rows = rows_of(shell)
    root = np.arange(len(rows.of))
    root[rows.images.rows] = rows.images.roots
    matrices = to_nodes(shell.element, shell.mesh.points[shell.mesh.elements])
    remanence = np.einsum("enp,epx->enx", matrices, shell.remanence_at_points)
    turned = np.einsum("eij,enj->eni", about.rotation, remanence[about.original])
    return root[rows.elements][about.original], turned


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
