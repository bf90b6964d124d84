"""Sheets that meet at a node: at kinks, ribs and hinges a shell is several surfaces with a director each.

Elements about a node are one *piece* unless hinges part them: across a hinge nothing but u is shared. Within a piece,
elements whose normals at the node differ by less than `KINK` are one *sheet*, with one director, the mean of their
normals. A piece of several sheets is a joint: one rotation carries the directors of all its sheets.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from magshell.arrays import AnyArray, IntArray
from magshell.errors import InputError
from magshell.mesh import Mesh
from magshell.mesh.edges import SIDES
from magshell.model.hinge import Hinge
from magshell.model.images import Images
from magshell.shell.normals import corner_normals
from magshell.shell.triangle import REPEATED

KINK = np.cos(np.radians(30.0))
"""Elements whose normals at a node are further apart than this are different sheets there."""


class Sheets(NamedTuple):
    """What meets at the nodes where there is more than one sheet.

    Attributes
    ----------
    nodes : ndarray, shape (n,)
        Those nodes, rising.
    piece, sheet : ndarray, shape (elements, 8)
        Piece at each node of each element, and sheet within the piece; 0 where there is one only.
    sprung : ndarray of bool, shape (nodes of the mesh,)
        Nodes of hinges with a spring.
    """

    nodes: IntArray
    piece: IntArray
    sheet: IntArray
    sprung: AnyArray


def sheets_of(mesh: Mesh, hinges: Sequence[Hinge], images: Images) -> Sheets:
    """The sheets of a mesh; what meets at nodes that are images of others does so at their roots.

    Raises
    ------
    InputError
        A hinge is on no group of edges, or on an edge that fewer than two elements share.
    """
    elements, count = images.root[mesh.elements], len(mesh.points)
    normals = images.back(corner_normals(mesh.points, mesh.elements), mesh.elements)
    there = np.any(normals, axis=2)
    first = np.empty((count, 3))
    first[elements[there][::-1]] = normals[there][::-1]
    kinked = np.sum(normals * first[elements], axis=2) < KINK
    special = np.zeros(count, dtype=bool)
    special[elements[kinked & there]] = True
    sides = np.where(mesh.elements[:, 4:] == mesh.elements[:, 2:3], -1, elements[:, 4:])
    sharing = np.bincount(sides[sides >= 0], minlength=count)
    hinged, at_hinge, sprung = np.zeros((3, count), dtype=bool)
    for hinge in hinges:
        wanted = images.root[hinge.edges(mesh)]
        _check_edges(hinge, wanted, sharing, hinged)
        hinged[wanted[:, 2]] = at_hinge[wanted] = special[wanted] = True
        sprung[wanted] |= hinge.stiffness > 0.0
    piece, sheet = np.zeros(elements.shape, dtype=np.int64), np.zeros(elements.shape, dtype=np.int64)
    places = np.flatnonzero(there.ravel() & special[elements.ravel()])
    places = places[np.argsort(elements.ravel()[places], kind="stable")]
    for group in np.split(places, np.flatnonzero(np.diff(elements.ravel()[places])) + 1) if places.size else ():
        owner, slot = np.divmod(group, 8)
        if at_hinge[elements[owner[0], slot[0]]]:
            piece[owner, slot] = _pieces(mesh.elements[owner], slot, np.where(hinged[sides[owner]], -1, sides[owner]))
        cosines = np.einsum("ix,jx->ij", normals[owner, slot], normals[owner, slot])
        for number in np.unique(piece[owner, slot]):
            own = piece[owner, slot] == number
            sheet[owner[own], slot[own]] = _components(cosines[np.ix_(own, own)] >= KINK)
    triangles = np.flatnonzero(mesh.triangles)
    for label in (piece, sheet):
        label[np.ix_(triangles, REPEATED)] = label[triangles, 2][:, None]
    return Sheets(np.flatnonzero(special), piece, sheet, sprung)


def _check_edges(hinge: Hinge, edges: IntArray, sharing: IntArray, hinged: AnyArray) -> None:
    """Refuse edges of a hinge that fewer than two elements share, or that belong to another hinge."""
    middles = edges[:, 2]
    for at_fault, what in (
        (sharing[middles] < 2, "is a free edge of the shell; a hinge joins two or more elements"),
        (hinged[middles], "is of another hinge too"),
    ):
        if at_fault.any():
            one, other = edges[np.argmax(at_fault), :2]
            raise InputError(f"{hinge.label}: the edge between nodes {one} and {other} {what}")


def _pieces(nodes: IntArray, slot: IntArray, sides: IntArray) -> IntArray:
    """Piece of each element about a node: those are one that hang together by edges without a hinge.

    An edge is known by its middle node: `nodes` (places, 8) as the mesh has it, `sides` (places, 4) at its root; -1
    where elements do not hang together. An edge may lead from the node to its image.
    """
    meets = (SIDES[None] == slot[:, None, None]).any(axis=2)
    edges, ends = np.where(meets, sides, -1), nodes[np.arange(len(slot)), slot]
    common = (edges[:, None, :, None] == edges[None, :, None, :]) & (edges >= 0)[:, None, :, None]
    glued = nodes[:, None, 4:, None] != nodes[None, :, None, 4:]
    common &= glued | (ends[:, None] == ends)[:, :, None, None]
    return _components(common.any(axis=(2, 3)) | np.eye(len(slot), dtype=bool))


def _components(linked: AnyArray) -> IntArray:
    """Connected component of each of a few things, numbered in the order of their first members."""
    label = np.full(len(linked), -1)
    for start in range(len(linked)):
        if label[start] < 0:
            reached = linked[start]
            while True:
                further = linked[reached].any(axis=0) | reached
                if np.array_equal(further, reached):
                    break
                reached = further
            label[reached] = label.max() + 1
    return label
