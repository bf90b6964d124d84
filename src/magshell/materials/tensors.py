"""Tensor operations that material laws share; the kernels compile them together with the laws."""

from __future__ import annotations

import numpy as np

from magshell.arrays import FloatArray
from magshell.compiled import also_compiled


@also_compiled
def fill_inverse_transpose(U: FloatArray, V: FloatArray) -> float:
    """Fill V with U⁻ᵀ of a 3 × 3 array, from its cofactors; return det U."""
    for i in range(3):
        a, b = (i + 1) % 3, (i + 2) % 3
        for j in range(3):
            c, d = (j + 1) % 3, (j + 2) % 3
            V[i, j] = U[a, c] * U[b, d] - U[a, d] * U[b, c]
    J: float = U[0, 0] * V[0, 0] + U[0, 1] * V[0, 1] + U[0, 2] * V[0, 2]
    for i in range(3):
        for j in range(3):
            V[i, j] /= J
    return J


@also_compiled
def inverse_transpose(U: FloatArray) -> tuple[FloatArray, float]:
    """U⁻ᵀ and det U of a 3 × 3 array."""
    V = np.empty_like(U)
    J = fill_inverse_transpose(U, V)
    return V, J
