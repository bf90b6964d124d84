"""The elements of a shell and, about the sides at which it meets its neighbours, the copies that touch it there.

A part that stands for many alike has the elements of the part next to it across each such side. Their values are those
of the part's own elements, turned with them.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.mesh.geometry import COINCIDENT
from magshell.mesh.welding import merged
from magshell.model.repeated import Cyclic
from magshell.model.shell import Shell


class Around(NamedTuple):
    """The elements of the mesh, and then the copies that share a node with one of them.

    Attributes
    ----------
    points : ndarray, shape (nodes and further ones, 3)
    elements : ndarray, shape (n, 8)
    original : ndarray, shape (n,)
        Element of the mesh that each is, or is a copy of.
    rotation : ndarray, shape (n, 3, 3)
        Q from the original.
    """

    points: FloatArray
    elements: IntArray
    original: IntArray
    rotation: FloatArray


def around(shell: Shell) -> Around:
    """The elements of a shell, with copies if it is repeated."""
    mesh, root = shell.mesh, shell.images.root
    own = np.arange(len(mesh.elements))
    turns: FloatArray = np.broadcast_to(np.eye(3), (len(own), 3, 3))
    found = list(_touching(shell))
    if not found:
        return Around(mesh.points, mesh.elements, own, turns)
    original = np.concatenate([elements for elements, _, _ in found])
    rotation = np.concatenate([np.broadcast_to(Q, (len(elements), 3, 3)) for elements, Q, _ in found])
    shift = np.concatenate([np.broadcast_to(t, (len(elements), 3)) for elements, _, t in found])
    nodes = mesh.elements[original]
    places = np.einsum("eij,enj->eni", rotation, mesh.points[nodes]) + shift[:, None]
    points = np.concatenate([mesh.points, places.reshape(-1, 3)])
    # Copies of one node at one place are one: distances count the roots, too.
    roots = np.concatenate([root, root[nodes.ravel()]])
    standing = merged(np.column_stack([points, mesh.size * roots]), 10.0 * COINCIDENT * mesh.size)
    kept, numbers = np.unique(standing, return_inverse=True)
    copies, first = np.unique(numbers[len(root) :].reshape(nodes.shape), axis=0, return_index=True)
    return Around(
        points[kept],
        np.concatenate([mesh.elements, copies]),
        np.concatenate([own, original[first]]),
        np.concatenate([turns, rotation[first]]),
    )


def _touching(shell: Shell) -> Iterator[tuple[IntArray, FloatArray, FloatArray]]:
    """Elements at a node, with the Q (3, 3) and the translation (3,) that take the node to one of its images."""
    x, elements, images = shell.mesh.points, shell.mesh.elements, shell.images
    touched = np.flatnonzero(images.touched)
    at = {int(node): np.flatnonzero((elements == node).any(axis=1)) for node in touched}
    for node in touched:
        for image in touched[images.root[touched] == images.root[node]]:
            if image != node:
                Q = images.rotation[image] @ images.rotation[node].T
                yield at[int(node)], Q, x[image] - Q @ x[node]
    for one in shell.repeated:
        if isinstance(one, Cyclic):
            nodes, same = one.nodes(shell.mesh)
            for node in nodes[nodes == same]:
                for times in range(1, one.sectors):
                    Q = np.linalg.matrix_power(one.rotation(shell.mesh), times)
                    yield at[int(node)], Q, x[node] - Q @ x[node]
