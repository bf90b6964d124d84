"""What a direct solver and its factorisations are.

The unknowns have different units (m, 1, 1/m, rad), so rows and columns are scaled by the same factors to unit
largest entries; unscaled, the pivoting of a solver destroys the elimination order.
"""

from __future__ import annotations

from copy import copy
from typing import NamedTuple, Protocol

import numpy as np
import scipy.sparse as sp

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.compiled import Kernel
from magshell.linalg.vectors import dot, norm

MOST_ITERATIONS, EIGENVALUE_TOLERANCE = 30, 1e-6


class SingularMatrix(ArithmeticError):
    """The matrix has no inverse; `null_vector` (n,) is the direction in which it does nothing."""

    def __init__(self, null_vector: FloatArray) -> None:
        super().__init__("singular matrix")
        self.null_vector = null_vector


class Factorisation(Protocol):
    """Factors of a square matrix: a value, which later factorisations do not change."""

    def solve(self, right_side: FloatArray) -> FloatArray:
        """Solution (n,) of the system with a right side (n,)."""

    def solve_transposed(self, right_side: FloatArray) -> FloatArray:
        """Solution (n,) of the transposed system."""

    def negative_pivots(self) -> int | None:
        """Pivots below zero, each on the diagonal; None if the solver cannot tell."""

    def smallest_eigenpair(self) -> tuple[float, FloatArray]:
        """Eigenvalue of least magnitude of the scaled matrix, and its direction (n,) in the matrix's own unknowns."""


class LinearSolver(Protocol):
    """A direct solver.

    Attributes
    ----------
    name : str
    factorisations : int
        How many were made.
    """

    name: str
    factorisations: int

    def factorise(self, matrix: sp.csc_array) -> Factorisation:
        """Factorise a square matrix of symmetric pattern, its equations in elimination order.

        Raises
        ------
        SingularMatrix
        """


class Scaled(NamedTuple):
    """A matrix with rows and columns scaled alike.

    Attributes
    ----------
    matrix : csc_array
        s A s, of unit largest entries.
    scale : ndarray, shape (n,)
        The factors s.
    asymmetry : float
        Largest difference of an entry of the scaled matrix from its mirror image; infinite if one has none.
    """

    matrix: sp.csc_array
    scale: FloatArray
    asymmetry: float


def scaled(matrix: sp.csc_array) -> Scaled:
    """A scaled copy of a matrix."""
    data, scale = np.empty_like(matrix.data), np.ones(matrix.shape[0])
    asymmetry = _equilibrate(
        matrix.indptr, matrix.indices, matrix.data, data, scale, np.empty_like(scale), matrix.indptr[1:].copy()
    )
    copied = copy(matrix)  # shares the pattern; a new matrix would have it checked again
    copied.data = data
    return Scaled(copied, scale, asymmetry)


class ScaledFactors:
    """What follows from solutions of the scaled matrix alone."""

    def __init__(self, scaled: Scaled) -> None:
        self.matrix, self.scale = scaled.matrix, scaled.scale

    def solve_scaled(self, right_side: FloatArray, transposed: bool = False) -> FloatArray:
        """Solution of the scaled system."""
        raise NotImplementedError

    def solve(self, right_side: FloatArray) -> FloatArray:
        """See `Factorisation`."""
        return np.asarray(self.scale * self.solve_scaled(self.scale * right_side))

    def solve_transposed(self, right_side: FloatArray) -> FloatArray:
        """See `Factorisation`."""
        return np.asarray(self.scale * self.solve_scaled(self.scale * right_side, transposed=True))

    def smallest_eigenpair(self) -> tuple[float, FloatArray]:
        """See `Factorisation`. By inverse iteration, from a random vector that is always the same."""
        vector = np.random.default_rng(0).normal(size=self.scale.size)
        vector /= norm(vector)
        inverse = 0.0
        for _ in range(MOST_ITERATIONS):
            solution = self.solve_scaled(vector)
            last, inverse = inverse, dot(vector, solution)
            vector = solution / norm(solution)
            if abs(inverse - last) <= EIGENVALUE_TOLERANCE * abs(inverse):
                break
        return 1.0 / inverse if inverse else np.inf, np.asarray(self.scale * vector)


@Kernel
def _equilibrate(
    indptr: IntArray,
    indices: AnyArray,
    data: FloatArray,
    scaled: FloatArray,
    scale: FloatArray,
    largest: FloatArray,
    mirror: AnyArray,
) -> float:
    """Fill s A s and the factors s that make the largest entries of the columns one; returns its asymmetry.

    The factors are one before; `mirror` begins as the end of each column.
    """
    n = scale.size
    for _ in range(2):
        for j in range(n):
            most = 0.0
            for p in range(indptr[j], indptr[j + 1]):
                most = max(most, abs(data[p]) * scale[indices[p]])
            largest[j] = most * scale[j]
        for j in range(n):
            if largest[j] > 0.0:
                scale[j] /= np.sqrt(largest[j])
    asymmetry = 0.0
    for j in range(n):
        for p in range(indptr[j], indptr[j + 1]):
            i = indices[p]
            scaled[p] = data[p] * (scale[j] * scale[i])
            if i > j:
                continue
            at = mirror[i]
            if i == j:
                mirror[j] = p + 1
            elif at < indptr[i + 1] and indices[at] == j:
                asymmetry = max(asymmetry, abs(scaled[p] - scaled[at]))
                mirror[i] += 1
            else:
                asymmetry = np.inf
    return asymmetry
