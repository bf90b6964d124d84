"""Normals of the undeformed mid-surface at the nodes."""

from __future__ import annotations

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.shell.shape_functions import NODES, serendipity


def nodal_normals(points: FloatArray, elements: IntArray) -> FloatArray:
    """Unit normals (nodes, 3) of the isoparametric surface, averaged over the elements that meet at a node."""
    derivatives = serendipity(NODES)[1]
    A = np.einsum("pan,enx->epax", derivatives, points[elements])
    normal = np.cross(A[:, :, 0], A[:, :, 1])
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    total = np.zeros_like(points)
    np.add.at(total, elements.ravel(), normal.reshape(-1, 3))
    return np.asarray(total / np.linalg.norm(total, axis=-1, keepdims=True))
