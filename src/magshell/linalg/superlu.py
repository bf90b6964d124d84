"""SuperLU of SciPy."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.linalg.factorisation import Scaled, ScaledFactors, SingularMatrix, scaled

_SYMMETRIC = {"SymmetricMode": True}
# SuperLU makes room for 30 times the entries of a matrix and counts that in 32 bits; beyond, it finds no memory.
MOST_ENTRIES = 2**31 // 30


class SuperLUFactors(ScaledFactors):
    """Factors of SuperLU; pivots stay on the diagonal where they are not small."""

    def __init__(self, scaled: Scaled) -> None:
        from scipy.sparse.linalg import splu

        super().__init__(scaled)
        try:
            self._factors: Any = splu(self.matrix, permc_spec="NATURAL", diag_pivot_thresh=0.001, options=_SYMMETRIC)
        except RuntimeError:
            shifted = self.matrix + 1e-10 * sp.eye_array(self.matrix.shape[0], format="csc")
            self._factors = splu(sp.csc_array(shifted), permc_spec="NATURAL", diag_pivot_thresh=1.0)
            raise SingularMatrix(self.smallest_eigenpair()[1]) from None
        except MemoryError:
            if self.matrix.nnz <= MOST_ENTRIES:
                raise
            raise InputError(
                f"solver: the tangent has {self.matrix.nnz / 1e6:.1f} million entries; SuperLU takes up to "
                f'{MOST_ENTRIES / 1e6:.1f} million. Take fewer elements, or linear_solver = "multifrontal"'
            ) from None

    def negative_pivots(self) -> int | None:
        """See `Factorisation`. Where rows were exchanged, of a factorisation that exchanges none."""
        from scipy.sparse.linalg import splu

        factors = self._factors
        if not np.array_equal(factors.perm_r, factors.perm_c):
            try:
                factors = splu(self.matrix, permc_spec="NATURAL", diag_pivot_thresh=0.0, options=_SYMMETRIC)
            except RuntimeError:  # a pivot is zero
                return None
            if not np.array_equal(factors.perm_r, factors.perm_c):
                return None
        return int(np.count_nonzero(factors.U.diagonal() < 0.0))

    def solve_scaled(self, right_side: FloatArray, transposed: bool = False) -> FloatArray:
        return np.asarray(self._factors.solve(right_side, trans="T" if transposed else "N"))


class SuperLU:
    """SuperLU of SciPy on equations that are already in nested-dissection order."""

    name = "SuperLU, METIS order"

    def __init__(self) -> None:
        self.factorisations = 0

    def factorise(self, matrix: sp.csc_array) -> SuperLUFactors:
        """See `LinearSolver`."""
        self.factorisations += 1
        return SuperLUFactors(scaled(matrix))
