"""The cross product as a matrix."""

from __future__ import annotations

import numpy as np

from magshell.arrays import FloatArray


def cross_matrix(vectors: FloatArray) -> FloatArray:
    """[v]× (n, 3, 3) of vectors (n, 3): [v]× a = v × a."""
    matrices = np.zeros((len(vectors), 3, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        matrices[:, k, j], matrices[:, j, k] = vectors[:, i], -vectors[:, i]
    return matrices
