"""Coincident nodes merged."""

from __future__ import annotations

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray


def weld(points: FloatArray, elements: IntArray, tolerance: float) -> tuple[FloatArray, IntArray]:
    """Merge nodes that are no further apart than a tolerance, m, and close up the numbering."""
    kept, numbers = np.unique(merged(points, tolerance)[elements], return_inverse=True)
    return points[kept], numbers.reshape(elements.shape)


def merged(points: FloatArray, tolerance: float, apart: AnyArray | None = None) -> IntArray:
    """Number (nodes,) of the node that stands for each: the lowest of those that are joined to it, itself included.

    Parameters
    ----------
    points : (nodes, 3)
    tolerance : float
        Nodes that are no further apart are joined.
    apart : (nodes,) of bool, optional
        Nodes that are joined to no other.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    pairs = cKDTree(points).query_pairs(tolerance, output_type="ndarray")
    if apart is not None:
        pairs = pairs[~apart[pairs].any(axis=1)]
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(points),) * 2)
    _, label = connected_components(graph, directed=False)
    _, first = np.unique(label, return_index=True)
    result: IntArray = first[label].astype(np.int64)
    return result
