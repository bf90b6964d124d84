"""Free edges that rest on elements without being joined to them, as a rib on a plate that has no nodes there."""

from __future__ import annotations

from itertools import chain

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.errors import MeshError
from magshell.mesh.edges import SIDES, Edges
from magshell.mesh.geometry import COINCIDENT, centres, chord_lengths, diagonal_normals, unit
from magshell.mesh.wording import further, place

ON_FACE = 1e-3
"""A node closer to an element than this fraction of the shortest side of both lies on it."""
IN_PLANE = np.cos(np.radians(5.0))
STEPS = 12
CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])


def check_resting(points: FloatArray, elements: IntArray, edges: Edges, size: float, on_cut: AnyArray) -> None:
    """Refuse nodes of free edges that lie on an element that does not have them.

    Nodes that lie on a node of the element are another fault. Where the node and a side of the element lie on a cut,
    `on_cut` (nodes,), they are meant.
    """
    from scipy.spatial import cKDTree

    rim = np.unique(edges.sides[edges.boundary])
    if not rim.size:
        return
    x, middle = points[elements], centres(points, elements)
    reach = np.linalg.norm(x - middle[:, None], axis=2).max(axis=1)
    near = cKDTree(points[rim]).query_ball_point(middle, reach)
    element = np.repeat(np.arange(len(elements)), [len(found) for found in near])
    node = rim[np.fromiter(chain.from_iterable(near), dtype=np.int64, count=len(element))]
    apart = np.linalg.norm(x[element] - points[node][:, None], axis=2).min(axis=1) > COINCIDENT * size
    along = np.any(np.all(on_cut[elements[:, SIDES]], axis=2), axis=1)
    cut = on_cut[node] & along[element]
    element, node = element[apart & ~cut], node[apart & ~cut]
    shortest = chord_lengths(points, elements).min(axis=1)
    of_node = np.full(len(points), np.inf)
    np.minimum.at(of_node, elements, shortest[:, None])
    tolerance = ON_FACE * np.minimum(shortest[element], of_node[node])
    bad = np.flatnonzero(_distances(points[node], x[element]) <= tolerance)
    bad = bad[[not _along(points, elements, element[one], node[one]) for one in bad]]
    if bad.size:
        one, at = element[bad[0]], node[bad[0]]
        owner = int(np.argmax((elements == at).any(axis=1)))
        raise MeshError(
            f"Elements {one} and {owner} are not joined: node {at} on a free edge of the second lies on the first, at "
            f"{place(points[at])}, without being a node of it. Divide the first so that it has nodes and edges there, "
            "as at a T-joint, or leave a gap." + further(bad.size)
        )


def _along(points: FloatArray, elements: IntArray, element: int, node: int) -> bool:
    """Whether a free edge runs alongside an element, in its plane or from a node of it, as lips of narrow slits do."""
    about = np.flatnonzero((elements == node).any(axis=1))
    normals = unit(diagonal_normals(points[elements[np.append(about, element)]]))
    flat = np.abs(normals[:-1] @ normals[-1]) > IN_PLANE
    return bool(flat.all() or np.isin(elements[element], elements[about]).any())


def _distances(points: FloatArray, x: FloatArray) -> FloatArray:
    """Distance (k,) of points from elements with the nodes x (k, 8, 3), by Gauss-Newton steps in the parent square."""
    at = np.zeros((len(points), 2))
    for _ in range(STEPS):
        N, dN = _functions(at)
        away = points - np.einsum("kn,knx->kx", N, x)
        tangents = np.einsum("kna,knx->kax", dN, x)
        metric = np.einsum("kax,kbx->kab", tangents, tangents)
        metric += 1e-9 * np.trace(metric, axis1=1, axis2=2)[:, None, None] * np.eye(2)
        step = np.linalg.solve(metric, np.einsum("kax,kx->ka", tangents, away)[..., None])[..., 0]
        at = (at + step).clip(-1.0, 1.0)
    N, _ = _functions(at)
    result: FloatArray = np.linalg.norm(points - np.einsum("kn,knx->kx", N, x), axis=1)
    return result


def _functions(at: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The eight functions (k, 8) of a quadrilateral and their derivatives (k, 8, 2) at parent coordinates (k, 2)."""
    ξ, η = at[:, :1], at[:, 1:]
    a, b = CORNERS.T
    N, dN = np.empty((len(at), 8)), np.empty((len(at), 8, 2))
    N[:, :4] = 0.25 * (1 + ξ * a) * (1 + η * b) * (ξ * a + η * b - 1)
    dN[:, :4, 0] = 0.25 * a * (1 + η * b) * (2 * ξ * a + η * b)
    dN[:, :4, 1] = 0.25 * b * (1 + ξ * a) * (ξ * a + 2 * η * b)
    for row, sign in ((4, -1.0), (6, 1.0)):
        N[:, row] = (0.5 * (1 - ξ**2) * (1 + sign * η))[:, 0]
        dN[:, row] = np.column_stack([-ξ * (1 + sign * η), 0.5 * sign * (1 - ξ**2)])
    for row, sign in ((5, 1.0), (7, -1.0)):
        N[:, row] = (0.5 * (1 - η**2) * (1 + sign * ξ))[:, 0]
        dN[:, row] = np.column_stack([0.5 * sign * (1 - η**2), -η * (1 + sign * ξ)])
    return N, dN
