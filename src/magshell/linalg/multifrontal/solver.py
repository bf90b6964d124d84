"""The multifrontal solver: the symbolic phase once per pattern, then factorisations as values."""

from __future__ import annotations

import weakref
from concurrent.futures import ThreadPoolExecutor
from queue import SimpleQueue
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.linalg.factorisation import Factorisation, Scaled, ScaledFactors, scaled
from magshell.linalg.multifrontal import elimination, solution
from magshell.linalg.multifrontal.blas import address_of_product
from magshell.linalg.multifrontal.fronts import Entries, Fronts, analyse
from magshell.linalg.multifrontal.schedule import Schedule, schedule_of
from magshell.linalg.superlu import SuperLUFactors
from magshell.linalg.threads import one_blas_thread, threads

# Largest difference of mirrored entries of the scaled matrix that is round-off.
SYMMETRIC = 1e-13
# A pivot of the scaled matrix that is zero but for round-off.
VANISHING = 1e-15
# Backward error |b - A x| / (|b| + |x|) that is round-off, and the rounds of refinement that may lead there.
ROUND_OFF, REFINEMENTS = 1e-13, 4


class Analysis(NamedTuple):
    """The symbolic phase of a pattern."""

    indptr: AnyArray
    indices: AnyArray
    fronts: Fronts
    entries: Entries
    schedule: Schedule


class Unstable(ArithmeticError):
    """The factors without row exchanges are too inaccurate."""


class MultifrontalFactors(ScaledFactors):
    """LU, or LDLᵀ if the matrix is symmetric, without row exchanges.

    Where that is unstable, as the backward error of every solution shows, SuperLU takes over.
    """

    def __init__(self, analysis: Analysis, scaled: Scaled, stores: list[elimination.Factors]) -> None:
        super().__init__(scaled)
        self._scaled = scaled
        self._analysis = analysis
        self._other: SuperLUFactors | None = None
        fronts, symmetric = analysis.fronts, scaled.asymmetry < SYMMETRIC
        self._factors = _store(stores, fronts, symmetric)
        self._gone = weakref.finalize(self, stores.append, self._factors)
        elimination.scatter(self.matrix.indptr, self.matrix.data, analysis.entries, self._factors)
        least = _eliminate(analysis, self._factors)
        if not VANISHING < least < np.inf:
            self._other = self._take_over()

    def negative_pivots(self) -> int | None:
        """See `Factorisation`."""
        if self._other is not None:
            return self._other.negative_pivots()
        return elimination.negative_pivots(self._analysis.fronts, self._factors.lower)

    def solve_scaled(self, right_side: FloatArray, transposed: bool = False) -> FloatArray:
        """See `ScaledFactors`."""
        if self._other is None:
            try:
                return self._refined(right_side, transposed and not self._factors.symmetric)
            except Unstable:
                self._other = self._take_over()
        return self._other.solve_scaled(right_side, transposed)

    def _refined(self, right_side: FloatArray, transposed: bool) -> FloatArray:
        matrix = self.matrix.T if transposed else self.matrix
        solution, last = self._solve_once(right_side, transposed), np.inf
        for _ in range(REFINEMENTS):
            residual = right_side - matrix @ solution
            error, size = np.abs(residual).max(), np.abs(right_side).max() + np.abs(solution).max()
            if error <= ROUND_OFF * size:
                return solution
            if not error < 0.5 * last * size:
                break
            solution, last = solution + self._solve_once(residual, transposed), error / size
        raise Unstable

    def _solve_once(self, right_side: FloatArray, transposed: bool) -> FloatArray:
        fronts = self._analysis.fronts
        values = right_side[fronts.order]
        run = solution.solve_transposed if transposed else solution.solve
        run(fronts, self._factors, values, np.empty(fronts.beyond.max(initial=0)))
        out = np.empty_like(values)
        out[fronts.order] = values
        return out

    def _take_over(self) -> SuperLUFactors:
        self._gone.detach()
        self._factors = elimination.Factors(np.empty(0), np.empty(0), False)
        return SuperLUFactors(self._scaled)


class Multifrontal:
    """Multifrontal solver on equations that are already in nested-dissection order."""

    name = "multifrontal, METIS order"

    def __init__(self) -> None:
        self.factorisations = 0
        self._analysis: Analysis | None = None
        self._stores: list[elimination.Factors] = []

    def factorise(self, matrix: sp.csc_array) -> Factorisation:
        """See `LinearSolver`."""
        self.factorisations += 1
        analysis = self._analysis
        if analysis is None or analysis.indptr is not matrix.indptr or analysis.indices is not matrix.indices:
            fronts, entries = analyse(matrix.indptr, matrix.indices)
            analysis = Analysis(matrix.indptr, matrix.indices, fronts, entries, schedule_of(fronts))
            self._analysis = analysis
        return MultifrontalFactors(analysis, scaled(matrix), self._stores)


def _store(stores: list[elimination.Factors], fronts: Fronts, symmetric: bool) -> elimination.Factors:
    """Panels of zeros: those of factors that are gone, where they fit, as new memory is slow at its first use."""
    lower, upper = fronts.lower[-1], 0 if symmetric else fronts.upper[-1]
    fitting = [store for store in stores if (store.lower.size, store.upper.size) == (lower, upper)]
    stores.clear()
    if not fitting:
        return elimination.Factors(np.zeros(lower), np.zeros(upper), symmetric)
    fitting[0].lower[:], fitting[0].upper[:] = 0.0, 0.0
    return fitting[0]._replace(symmetric=symmetric)


def _eliminate(analysis: Analysis, factors: elimination.Factors) -> float:
    """All tasks, each by one thread at a time, then the top; returns the least pivot's magnitude."""
    schedule, dgemm = analysis.schedule, address_of_product()
    tree = elimination.Tree(schedule.child_pointer, schedule.child, schedule.update_at)
    kept, rooms = np.empty(schedule.kept), SimpleQueue[elimination.Room]()
    workers = max(1, min(threads(), len(schedule.tasks)))
    for _ in range(workers):
        stack, update, panel = (np.empty(size) for size in (schedule.stack, schedule.largest, schedule.widest))
        rooms.put(elimination.Room(stack, update, panel, kept))

    def run(sequence: IntArray) -> float:
        room = rooms.get()
        try:
            return elimination.eliminate(sequence, analysis.fronts, tree, factors, room, dgemm)
        finally:
            rooms.put(room)

    with one_blas_thread:
        if workers > 1:
            with ThreadPoolExecutor(workers) as pool:
                least = [*pool.map(run, schedule.tasks)]
        else:
            least = [run(sequence) for sequence in schedule.tasks]
        return min([*least, run(schedule.top)])
