r"""The nonlinear eigenproblem K(s) φ = 0: the real s nearest to 0, without missing any.

**Guesses.** About s = 0 the problem is taken for a quadratic one, K(s) ≈ K0 + s K1 + s² K2, with the central
differences of K at ±1 (exact where K is quadratic). With μ = 1/s it reads

    μ² φ = -K0⁻¹ (K1 μφ + K2 φ)      or      [-K0⁻¹K1  -K0⁻¹K2] [μφ]     [μφ]
                                             [    1        0   ] [ φ] = μ [ φ],

an ordinary eigenproblem of twice the size, whose eigenvalues of largest magnitude belong to the s nearest to 0
(Arnoldi, by ARPACK; a step takes one solve with K0). Complex s are no loads; real ones are guesses.

**Refinement.** Newton's method on K(s) φ = 0 with cᵀφ fixed (nonlinear inverse iteration): from
(K + δs K') (φ + δφ) = 0 to first order

    x = K⁻¹ K' φ,      δs = -cᵀφ / cᵀx,      φ ← x.

Any c that φ is not normal to serves; c = K' φ makes δs a Rayleigh quotient where K is symmetric.

**No root is passed.** By Sylvester's law the number n(s) of negative pivots of a symmetric K(s) is that of its negative
eigenvalues. Between two points a and b that have m of the roots between them, counted with their multiplicity,

    |n(b) - n(a)| ≤ m,      n(b) - n(a) = m mod 2,

as each root changes n by one, up or down. n is counted at 0, between neighbouring roots and at twice, four times and so
on the last; where it contradicts, the gap is searched by linear problems about its middle, (K + (s - s_m) K') φ = 0,
and by bisection. (Of an unsymmetric K the parity holds, as the product of the pivots is the determinant.) Two roots at
which eigenvalues leave and return within one gap are not seen so.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp

from magshell.arrays import FloatArray
from magshell.linalg import Factorisation, LinearSolver, SingularMatrix
from magshell.linalg.factorisation import scaled
from magshell.linalg.threads import one_blas_thread
from magshell.linalg.vectors import dot, norm

# Guesses beyond those wanted, as complex ones are among them; eigenpairs of the linear problem in a gap.
SPARE, LOCAL = 6, 6
# An eigenvalue counts as real with an imaginary part up to this share of it.
REAL = 1e-6
# Relative change of s at which the refinement ends (the next would be its square), that round-off may keep up, and how
# many iterations it may take.
TOLERANCE, ROUND_OFF, ITERATIONS = 1e-6, 1e-4, 25
# Iterations in which a step must have halved: near a double root each one halves it, elsewhere they converge faster.
PATIENCE = 4
# Distances relative to s: of the difference for K', from a root at which pivots are counted, between equal roots.
WIDTH, CLEAR, SAME = 1e-2, 1e-3, 1e-6
# Sine of the angle from which two vectors are two modes.
APART = 0.1
# Linear problems solved in search of roots that the pivots tell of.
SEARCHES = 24


class Eigenpair(NamedTuple):
    """A root and its vector (n,)."""

    value: float
    vector: FloatArray


class Roots(NamedTuple):
    """What was found.

    Attributes
    ----------
    pairs : list of Eigenpair
        Rising in magnitude.
    counted : float or None
        Magnitude of s up to which the negative pivots tell of no others; None where the solver cannot count.
    complete : bool
        Whether that is as far as they were looked for. If not, there are more.
    """

    pairs: list[Eigenpair]
    counted: float | None
    complete: bool


class NoConvergence(ArithmeticError):
    """The eigenvalues do not converge."""


def roots_nearest_to_zero(
    matrix: Callable[[float], sp.csc_array], solver: LinearSolver, wanted: int, reach: float
) -> Roots:
    """Real s of K(s) φ = 0 with the least magnitude.

    Parameters
    ----------
    matrix : callable
        K (n, n) at s; s = 1 is where K differs a little from K(0).
    solver : LinearSolver
    wanted : int
        How many; there may be fewer.
    reach : float
        Largest magnitude of s; may be infinite.

    Raises
    ------
    SingularMatrix
        K(0) is singular.
    NoConvergence
        Of ARPACK.
    """
    search = _Search(matrix, solver, wanted, reach)
    search.start()
    for guess in search.guesses():
        if len(search.found) >= wanted:
            break
        search.add(search.refined(guess))
    return search.counted()


class _Search:
    """The roots found so far, and the negative pivots counted so far, by s."""

    def __init__(
        self, matrix: Callable[[float], sp.csc_array], solver: LinearSolver, wanted: int, reach: float
    ) -> None:
        self.matrix, self.solver, self.wanted, self.reach = matrix, solver, wanted, reach
        self.found: list[Eigenpair] = []
        self.counts: dict[float, int | None] = {}
        self.searches, self.farthest = 0, 0.0

    def start(self) -> None:
        """K(0), its scale, and its pivots."""
        self.origin = self.matrix(0.0)
        self.scale = scaled(self.origin).scale
        self.factors: Factorisation | None = self.solver.factorise(self.origin)
        self.counts[0.0] = self.factors.negative_pivots()

    # -- guesses -------------------------------------------------------------------------------------------------

    def guesses(self) -> list[Eigenpair]:
        """Real roots of the quadratic problem within reach, rising in magnitude."""
        # Two sets of factors at a time would be twice the memory.
        factors, self.factors = self.factors, None
        assert factors is not None
        ahead, back, size = self.matrix(1.0), self.matrix(-1.0), self.scale.size
        first, second = 0.5 * (ahead - back), 0.5 * (ahead + back - 2.0 * self.origin)
        if not (np.any(first.data) or np.any(second.data)):
            return []  # nothing changes
        del ahead, back

        def companion(y: FloatArray) -> FloatArray:
            forces = first @ (self.scale * y[:size]) + second @ (self.scale * y[size:])
            return np.concatenate([-factors.solve(forces) / self.scale, y[:size]])

        pairs = self._eigenpairs(companion, 2 * size, self.wanted + SPARE)
        self.farthest = max((abs(pair.value) for pair in pairs), default=0.0)
        return [pair._replace(vector=pair.vector[:size]) for pair in pairs if abs(pair.value) <= self.reach]

    def local(self, s: float) -> list[Eigenpair]:
        """Real roots of the linear problem about s, the nearest to it first."""
        self.searches += 1
        width = WIDTH * abs(s)
        slope = (self.matrix(s + width) - self.matrix(s - width)) / (2.0 * width)
        factors = self.factorised(s)

        def inverse(y: FloatArray) -> FloatArray:
            return -factors.solve(slope @ (self.scale * y)) / self.scale

        pairs = self._eigenpairs(inverse, self.scale.size, LOCAL)
        return [pair._replace(value=s + pair.value) for pair in pairs]

    def _eigenpairs(self, product: Callable[[FloatArray], FloatArray], size: int, wanted: int) -> list[Eigenpair]:
        """Real 1/μ of the eigenvalues μ of largest magnitude, rising in magnitude, with vectors of scaled unknowns."""
        from scipy.sparse.linalg import ArpackError, ArpackNoConvergence, LinearOperator, eigs

        operator = LinearOperator((size, size), matvec=product, dtype=float)
        start = np.random.default_rng(self.searches).normal(size=size)
        try:
            with one_blas_thread:
                found: tuple[Any, Any] = eigs(operator, k=min(wanted, size - 2), which="LM", v0=start)
        except ArpackNoConvergence as partly:
            found = partly.eigenvalues, partly.eigenvectors
        except ArpackError as error:
            raise NoConvergence(f"the eigenvalues do not converge: {error}") from None
        values, vectors = np.asarray(found[0], dtype=complex), np.asarray(found[1], dtype=complex)
        real = np.flatnonzero((np.abs(values.imag) <= REAL * np.abs(values)) & (np.abs(values) > 0.0))
        real = real[np.argsort(-np.abs(values[real]))]
        return [Eigenpair(1.0 / float(values[i].real), vectors[:, i].real) for i in real]

    # -- refinement ----------------------------------------------------------------------------------------------

    def factorised(self, s: float) -> Factorisation:
        """Factors of K(s), or of K next to s where it is singular."""
        try:
            return self.solver.factorise(self.matrix(s))
        except SingularMatrix:
            return self.solver.factorise(self.matrix((1.0 + SAME) * s))

    def refined(self, guess: Eigenpair) -> Eigenpair | None:
        """The root next to a guess, whose vector is of scaled unknowns; None: the iteration finds none."""
        s, vector = guess.value, self.scale * guess.vector
        sizes = [np.inf] * PATIENCE
        for _ in range(ITERATIONS):
            width = WIDTH * abs(s)
            change = (self.matrix(s + width) @ vector - self.matrix(s - width) @ vector) / (2.0 * width)
            try:
                factors = self.solver.factorise(self.matrix(s))
            except SingularMatrix as singular:
                return Eigenpair(s, singular.null_vector)
            ahead = factors.solve(change)
            step = -dot(change, vector) / dot(change, ahead)
            if not np.isfinite(step):
                return None
            if abs(step) > CLEAR * abs(s):
                self.counts[s] = factors.negative_pivots()
            s, vector = s + step, ahead / norm(ahead / self.scale)
            size = abs(step / s)
            if size <= TOLERANCE or (size <= ROUND_OFF and size > 0.1 * sizes[-1]):
                return Eigenpair(s, vector)
            if s * guess.value <= 0.0 or abs(s) > self.reach or size > 0.5 * sizes[-PATIENCE]:
                return None
            sizes.append(size)
        return None

    def add(self, pair: Eigenpair | None) -> bool:
        """Keep a root that is not known; a vector of a multiple root is made normal to those that are."""
        if pair is None or abs(pair.value) > self.reach:
            return False
        vector = pair.vector / self.scale
        vector = vector / norm(vector)
        for known in self.found:
            if abs(known.value - pair.value) <= SAME * abs(pair.value):
                other = known.vector / self.scale
                vector = vector - other * dot(vector, other) / dot(other, other)
        if norm(vector) < APART:
            return False
        self.found.append(pair._replace(vector=self.scale * vector))
        self.found.sort(key=lambda one: abs(one.value))
        return True

    # -- no root is passed ---------------------------------------------------------------------------------------

    def counted(self) -> Roots:
        """The roots, after the negative pivots have been counted between them on either side of 0."""
        end = self.reach if np.isfinite(self.reach) else self.farthest
        if len(self.found) >= self.wanted:
            end = min((1.0 + 2.0 * CLEAR) * abs(self.found[self.wanted - 1].value), end)
        counted = None if self.counts[0.0] is None else min([self.complete(side, end) for side in (1.0, -1.0)])
        pairs = self.found[: self.wanted]
        for one, two in pairwise(range(len(pairs))):  # of two that differ by their sign the positive one first
            if pairs[one].value < 0.0 and abs(pairs[one].value + pairs[two].value) <= SAME * pairs[two].value:
                pairs[one], pairs[two] = pairs[two], pairs[one]
        wanted = abs(pairs[-1].value) if len(pairs) == self.wanted else end
        return Roots(pairs, counted, counted is not None and counted >= wanted)

    def complete(self, side: float, end: float) -> float:
        """Find the roots on one side of 0 that the pivots tell of; returns the magnitude up to which all are known."""
        cuts = [0.0, *self.cuts(side, end), end]
        gaps = [*pairwise(cuts)][::-1]
        while gaps:
            low, high = gaps.pop()
            inside = [abs(pair.value) for pair in self.found if low < side * pair.value < high]
            if self.agree(side * low, side * high, len(inside)):
                continue
            if self.searches == SEARCHES or sum(abs(pair.value) <= low for pair in self.found) >= self.wanted:
                return low
            near = [(1.0 - CLEAR) * inside[0], (1.0 + CLEAR) * inside[0]] if inside else []
            near = [cut for cut in near if low < cut < high]
            middle = 0.5 * (low + high)
            if near:
                gaps += [*pairwise([low, *near, high])][::-1]
            elif self.searched(side * (high if inside else middle), side * low, side * high):
                gaps.append((low, high))
            elif inside or high - low < CLEAR * high:
                return low
            else:
                gaps += [(middle, high), (low, middle)]
        return end

    def searched(self, s: float, low: float, high: float) -> bool:
        """Whether the linear problem about s leads to roots between two points that were not known."""
        new, low, high = False, min(low, high), max(low, high)
        for guess in self.local(s):
            if abs(guess.value - s) <= high - low and abs(guess.value) <= self.reach:
                pair = self.refined(guess)
                if pair is not None and low < pair.value < high:
                    new = self.add(pair) or new
        return new

    def cuts(self, side: float, end: float) -> list[float]:
        """Magnitudes on one side between neighbouring roots, where pivots are known if possible, and beyond."""
        roots = [side * pair.value for pair in self.found if 0.0 < side * pair.value < end]
        known = [side * s for s in self.counts if side * s > 0.0]
        cuts = []
        for one, two in pairwise(roots):
            low, high = (1.0 + CLEAR) * one, (1.0 - CLEAR) * two
            if low < high:
                cuts.append(next((cut for cut in known if low < cut < high), 0.5 * (low + high)))
        beyond = 2.0 * roots[-1] if roots else 1.0
        while beyond < end:
            cuts.append(beyond)
            beyond *= 2.0
        return cuts

    def agree(self, low: float, high: float, roots: int) -> bool:
        """Whether the change of the number of negative pivots between two points is one that so many roots can make."""
        before, after = self.count(low), self.count(high)
        if before is None or after is None:
            return True
        change = abs(after - before)
        return change <= roots and (roots - change) % 2 == 0

    def count(self, s: float) -> int | None:
        """Negative pivots of K(s)."""
        if s not in self.counts:
            self.counts[s] = self.factorised(s).negative_pivots()
        return self.counts[s]
