"""Products of long vectors, with sums of a fixed order: those of BLAS depend on how many threads it has."""

from __future__ import annotations

import numpy as np

from magshell.arrays import FloatArray


def dot(one: FloatArray, other: FloatArray) -> float:
    """Sum of the products of all entries of two arrays of the same shape."""
    return float(np.sum(one * other))


def norm(vector: FloatArray) -> float:
    """Root of the sum of the squares of all entries."""
    return float(np.sqrt(dot(vector, vector)))
