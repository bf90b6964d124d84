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

MOST_ITERATIONS, EIGENVALUE_TOLERANCE = 30, 1e-6


class SingularMatrix(ArithmeticError):
    """The matrix has no inverse; `null_vector` (n,) is the direction in which it does nothing."""

    def __init__(self, null_vector: FloatArray) -> None:
        super().__init__("singular matrix")
        self.null_vector = null_vector


class LinearSolver(Protocol):
    """A direct solver."""

    name: str
    factorisations: int

    def factorise(self, matrix: sp.csc_array) -> None:
        """Factorise a square matrix (equations in elimination order); the pattern never changes, and counts it.

        Raises
        ------
        SingularMatrix
        """

    def refactorise(self) -> None:
        """Factorise the last matrix again, already scaled: the library's work alone, for measurements."""

    def solve(self, right_side: FloatArray) -> FloatArray:
        """Solution of the factorised system."""

    def negative_pivots(self) -> int | None:
        """Pivots below zero of the last factorisation, each on the diagonal; None if the solver cannot tell."""

    def smallest_eigenpair(self) -> tuple[float, FloatArray]:
        """Eigenvalue of least magnitude of the scaled matrix, and its direction (n,) in the matrix's own unknowns."""


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
    """Scaling shared by the solvers, and what follows from solutions alone."""

    factorisations = 0
    _scale: FloatArray

    def _solve_scaled(self, right_side: FloatArray) -> FloatArray:
        raise NotImplementedError

    def solve(self, right_side: FloatArray) -> FloatArray:
        """See `LinearSolver`."""
        return np.asarray(self._scale * self._solve_scaled(self._scale * right_side))

    def smallest_eigenpair(self) -> tuple[float, FloatArray]:
        """See `LinearSolver`. By inverse iteration, from a random vector that is always the same."""
        vector = np.random.default_rng(0).normal(size=self._scale.size)
        vector /= np.linalg.norm(vector)
        inverse = 0.0
        for _ in range(MOST_ITERATIONS):
            solution = self._solve_scaled(vector)
            last, inverse = inverse, float(vector @ solution)
            vector = solution / np.linalg.norm(solution)
            if abs(inverse - last) <= EIGENVALUE_TOLERANCE * abs(inverse):
                break
        return 1.0 / inverse, np.asarray(self._scale * vector)

    def _scaled(self, matrix: sp.csc_array) -> sp.csc_array:
        self.factorisations += 1
        self._scale = equilibration(matrix)
        data = matrix.data * self._scale[matrix.indices]
        data *= np.repeat(self._scale, np.diff(matrix.indptr))
        return sp.csc_array((data, matrix.indices, matrix.indptr), shape=matrix.shape)


_SYMMETRIC = {"SymmetricMode": True}
# SuperLU makes room for 30 times the entries of a matrix and counts that in 32 bits; beyond, it finds no memory.
MOST_ENTRIES = 2**31 // 30


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

        self._factors: Any = None  # two sets of factors at a time would be twice the memory
        try:
            self._factors = splu(self._matrix, permc_spec="NATURAL", diag_pivot_thresh=0.001, options=_SYMMETRIC)
        except RuntimeError:
            shifted = self._matrix + 1e-10 * sp.eye_array(self._matrix.shape[0], format="csc")
            self._factors = splu(sp.csc_array(shifted), permc_spec="NATURAL", diag_pivot_thresh=1.0)
            raise SingularMatrix(self.smallest_eigenpair()[1]) from None
        except MemoryError:
            if self._matrix.nnz <= MOST_ENTRIES:
                raise
            raise InputError(
                f"solver: the tangent has {self._matrix.nnz / 1e6:.1f} million entries; SuperLU takes up to "
                f'{MOST_ENTRIES / 1e6:.1f} million. Take fewer elements, or linear_solver = "pardiso" (an extra)'
            ) from None

    def negative_pivots(self) -> int | None:
        """See `LinearSolver`. Where rows were exchanged, of a factorisation that exchanges none."""
        from scipy.sparse.linalg import splu

        factors = self._factors
        if not np.array_equal(factors.perm_r, factors.perm_c):
            factors = splu(self._matrix, permc_spec="NATURAL", diag_pivot_thresh=0.0, options=_SYMMETRIC)
            if not np.array_equal(factors.perm_r, factors.perm_c):
                return None
        return int(np.count_nonzero(factors.U.diagonal() < 0.0))

    def _solve_scaled(self, right_side: FloatArray) -> FloatArray:
        return np.asarray(self._factors.solve(right_side))


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

    def negative_pivots(self) -> int | None:
        """See `LinearSolver`. PARDISO exchanges rows and does not say where."""
        return None

    def _solve_scaled(self, right_side: FloatArray) -> FloatArray:
        self._pardiso.set_iparm(12, 2)
        self._pardiso.set_phase(33)
        return np.asarray(self._pardiso._call_pardiso(self._matrix, np.ascontiguousarray(right_side[:, None]))[:, 0])


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
