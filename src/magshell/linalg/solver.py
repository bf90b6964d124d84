"""Direct solvers for the tangent: SuperLU (always there) and PARDISO (an extra), equilibrated alike.

The unknowns have different units (m, 1, 1/m, rad), so rows and columns are scaled by the same factors to unit
largest entries; unscaled, the pivoting of SuperLU destroys the elimination order.
"""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
import scipy.sparse as sp

from magshell.arrays import FloatArray
from magshell.errors import InputError, suggest


class SingularMatrix(ArithmeticError):
    """The matrix has no inverse; `null_vector` (n,) is the direction in which it does nothing."""

    def __init__(self, null_vector: FloatArray) -> None:
        super().__init__("singular matrix")
        self.null_vector = null_vector


class LinearSolver(Protocol):
    """A direct solver."""

    name: str

    def factorise(self, matrix: sp.csc_array) -> None:
        """Factorise a square matrix (equations in elimination order); the pattern never changes.

        Raises
        ------
        SingularMatrix
        """

    def refactorise(self) -> None:
        """Factorise the last matrix again, already scaled: the library's work alone, for measurements."""

    def solve(self, right_side: FloatArray) -> FloatArray:
        """Solution of the factorised system."""


def equilibration(matrix: sp.csc_array) -> FloatArray:
    """Factors s (n,) such that rows and columns of s A s have largest entries near one."""
    indptr, indices = matrix.indptr, matrix.indices
    size = np.abs(matrix.data)
    scale = np.ones(matrix.shape[0])
    for _ in range(2):
        largest = np.maximum.reduceat(size, indptr[:-1])
        largest[largest == 0.0] = 1.0
        factor = 1.0 / np.sqrt(largest)
        scale *= factor
        size *= factor[indices]
        size *= np.repeat(factor, np.diff(indptr))
    return scale


class _Equilibrated:
    """Scaling shared by the solvers."""

    def _scaled(self, matrix: sp.csc_array) -> sp.csc_array:
        self._scale = equilibration(matrix)
        data = matrix.data * self._scale[matrix.indices]
        data *= np.repeat(self._scale, np.diff(matrix.indptr))
        return sp.csc_array((data, matrix.indices, matrix.indptr), shape=matrix.shape)


_SYMMETRIC = {"SymmetricMode": True}


class SuperLU(_Equilibrated):
    """SuperLU of SciPy on equations that are already in nested-dissection order; pivots stay on the diagonal."""

    name = "SuperLU, METIS order"

    def factorise(self, matrix: sp.csc_array) -> None:
        """See `LinearSolver`."""
        self._matrix = self._scaled(matrix)
        self.refactorise()

    def refactorise(self) -> None:
        """See `LinearSolver`."""
        from scipy.sparse.linalg import splu

        try:
            self._factors = splu(self._matrix, permc_spec="NATURAL", diag_pivot_thresh=0.001, options=_SYMMETRIC)
        except RuntimeError:
            shifted = self._matrix + 1e-10 * sp.eye_array(self._matrix.shape[0], format="csc")
            self._factors = splu(sp.csc_array(shifted), permc_spec="NATURAL", diag_pivot_thresh=1.0)
            raise SingularMatrix(self._null_vector()) from None

    def solve(self, right_side: FloatArray) -> FloatArray:
        """See `LinearSolver`."""
        return np.asarray(self._scale * self._factors.solve(self._scale * right_side))

    def _null_vector(self) -> FloatArray:
        """By inverse iteration."""
        vector = np.random.default_rng(0).normal(size=self._scale.size)
        for _ in range(3):
            vector = self._factors.solve(vector / np.linalg.norm(vector))
        return np.asarray(self._scale * vector)


class Pardiso(_Equilibrated):
    """Intel MKL PARDISO through pypardiso; the symbolic phase is kept between factorisations."""

    name = "PARDISO"

    def __init__(self) -> None:
        try:
            from pypardiso import PyPardisoSolver
        except ImportError:
            raise InputError(
                "solver: linear_solver is 'pardiso', an extra: pip install 'magshell[pardiso]' (x86-64 only)"
            ) from None
        self._pardiso: Any = PyPardisoSolver(mtype=11)
        self._analysed = False

    def factorise(self, matrix: sp.csc_array) -> None:
        """See `LinearSolver`. The compressed columns are handed over as rows of the transpose."""
        scaled = self._scaled(matrix)
        self._matrix = sp.csr_matrix((scaled.data, scaled.indices, scaled.indptr), shape=scaled.shape)
        self.refactorise()

    def refactorise(self) -> None:
        """See `LinearSolver`."""
        self._pardiso.set_phase(22 if self._analysed else 12)
        self._pardiso._check_A(self._matrix)
        self._pardiso._call_pardiso(self._matrix, np.zeros((self._matrix.shape[0], 1)))
        self._analysed = True

    def solve(self, right_side: FloatArray) -> FloatArray:
        """See `LinearSolver`."""
        self._pardiso.set_iparm(12, 2)
        self._pardiso.set_phase(33)
        scaled = np.ascontiguousarray((self._scale * right_side)[:, None])
        return np.asarray(self._scale * self._pardiso._call_pardiso(self._matrix, scaled)[:, 0])


SOLVERS: dict[str, type[SuperLU] | type[Pardiso]] = {"superlu": SuperLU, "pardiso": Pardiso}


def make_solver(name: str) -> LinearSolver:
    """Solver by its name in the settings.

    Raises
    ------
    InputError
        Unknown name, or an extra that is not installed.
    """
    if name not in SOLVERS:
        raise InputError(f"solver: linear_solver is '{name}'. {suggest(name, SOLVERS)}")
    return SOLVERS[name]()
