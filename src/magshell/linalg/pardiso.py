"""Intel MKL PARDISO through pypardiso, an extra."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp

from magshell.arrays import FloatArray
from magshell.errors import InputError
from magshell.linalg.factorisation import Scaled, ScaledFactors, scaled


class PardisoFactors(ScaledFactors):
    """Factors of PARDISO, which exchanges rows. The compressed columns are handed over as rows of the transpose."""

    def __init__(self, handles: list[Any], scaled: Scaled) -> None:
        super().__init__(scaled)
        self._handles, self._handle = handles, handles.pop()
        matrix = scaled.matrix
        self._rows = sp.csr_matrix((matrix.data, matrix.indices, matrix.indptr), shape=matrix.shape)
        self._handle.set_phase(22 if getattr(self._handle, "analysed", None) is matrix.indices else 12)
        self._handle._check_A(self._rows)
        self._handle._call_pardiso(self._rows, np.zeros((matrix.shape[0], 1)))
        self._handle.analysed = matrix.indices

    def __del__(self) -> None:
        self._handles.append(self._handle)

    def negative_pivots(self) -> int | None:
        """See `Factorisation`. PARDISO exchanges rows and does not say where."""
        return None

    def solve_scaled(self, right_side: FloatArray, transposed: bool = False) -> FloatArray:
        """See `ScaledFactors`."""
        self._handle.set_iparm(12, 0 if transposed else 2)
        self._handle.set_phase(33)
        return np.asarray(self._handle._call_pardiso(self._rows, np.ascontiguousarray(right_side[:, None]))[:, 0])


class Pardiso:
    """PARDISO; a handle whose factors were released is used again, with its symbolic phase."""

    name = "PARDISO"

    def __init__(self) -> None:
        try:
            from pypardiso import PyPardisoSolver
        except ImportError:
            raise InputError(
                "solver: linear_solver is 'pardiso', an extra: pip install 'magshell[pardiso]' (x86-64 only)"
            ) from None
        self._make: Any = PyPardisoSolver
        self._free: list[Any] = []
        self.factorisations = 0

    def factorise(self, matrix: sp.csc_array) -> PardisoFactors:
        """See `LinearSolver`."""
        self.factorisations += 1
        if not self._free:
            self._free.append(self._make(mtype=11))
        return PardisoFactors(self._free, scaled(matrix))
