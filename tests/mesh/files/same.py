"""When two meshes are the same, whatever the numbers of their nodes and elements."""

from __future__ import annotations

import numpy as np

from magshell.errors import InputError

MISSING = -1


def attempted(action):
    """What a function returns, or None and the message of its InputError."""
    try:
        return action(), ""
    except InputError as error:
        return None, str(error)


def places(mesh, nodes):
    """Rounded positions of nodes, as something that can be compared and sorted."""
    return [tuple(point) for point in np.round(mesh.points[np.ravel(nodes)] / (1e-7 * mesh.size)).astype(int).tolist()]


def walk(mesh, row):
    """An element's corners and middles, begun at its least corner."""
    corners, middles = places(mesh, row[:4]), places(mesh, row[4:])
    first = corners.index(min(corners))
    return tuple(corners[first:] + corners[:first]), tuple(middles[first:] + middles[:first])


def described(mesh):
    """All that a mesh is, without its numbering."""
    walks = [walk(mesh, row) for row in mesh.elements]
    return {
        "nodes": sorted(places(mesh, np.arange(len(mesh.points)))),
        "elements": sorted(walks),
        "element groups": {name: sorted(walks[e] for e in rows) for name, rows in mesh.element_groups.items()},
        "edge groups": {
            name: sorted((*sorted(places(mesh, row[:2])), *places(mesh, row[2:])) for row in rows)
            for name, rows in mesh.edge_groups.items()
        },
        "node groups": {name: sorted(places(mesh, nodes)) for name, nodes in mesh.node_groups.items()},
    }


def first_order(mesh, triangles=False):
    """Points and rows of the straight elements between the corners of a mesh of quadrilaterals."""
    corners = np.unique(mesh.elements[:, :4])
    quads = np.searchsorted(corners, mesh.elements[:, :4])
    if not triangles:
        return mesh.points[corners], np.hstack([quads, np.full_like(quads, MISSING)])
    halves = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    none = np.full(len(halves), MISSING)
    return mesh.points[corners], np.column_stack([halves, halves[:, 2], none, none, halves[:, 2], none])
