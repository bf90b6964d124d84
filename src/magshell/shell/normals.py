"""Normals of the undeformed mid-surface at the nodes."""

from __future__ import annotations

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.shell import triangle
from magshell.shell.shape_functions import NODES, serendipity


def nodal_normals(points: FloatArray, elements: IntArray) -> FloatArray:
    """Unit normals (nodes, 3) of the isoparametric surface, averaged over the elements that meet at a node."""
    total = np.zeros_like(points)
    np.add.at(total, elements.ravel(), corner_normals(points, elements).reshape(-1, 3))
    return np.asarray(total / np.linalg.norm(total, axis=-1, keepdims=True))


def corner_normals(points: FloatArray, elements: IntArray) -> FloatArray:
    """Unit normals (elements, 8, 3) of each element's surface at its nodes; zero at the repeated nodes of triangles."""
    x = points[elements]
    triangles = triangle.collapsed(x)
    A = np.einsum("pan,enx->epax", serendipity(NODES)[1], x)
    of_triangles = np.einsum("pan,enx->epax", _from_first_corner(), x[triangles][:, triangle.SLOTS])
    A[np.ix_(triangles, triangle.SLOTS)] = of_triangles
    A[np.ix_(triangles, triangle.REPEATED)] = of_triangles[:, [2, 2]]
    normal = np.cross(A[:, :, 0], A[:, :, 1])
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    normal[np.ix_(triangles, triangle.REPEATED)] = 0.0
    return np.asarray(normal)


def _from_first_corner() -> FloatArray:
    """Derivatives (6, 2, 6) of the six-node functions at the nodes, along the sides from corner 1 to 2 and to 3."""
    derivatives = triangle.six_nodes(triangle.BARYCENTRIC)[1]
    return np.asarray(derivatives[:, 1:] - derivatives[:, :1])
