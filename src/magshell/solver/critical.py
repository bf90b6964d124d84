r"""Critical points between two steps: limit points and bifurcations, found on the way and located.

At both the tangent K is singular, K φ = 0 with the mode φ. At a limit point the load factor t turns: its derivative
with respect to the arc length, which every point of the path has, changes sign. At a bifurcation it does not, and the
number of negative pivots of K changes alone: another path crosses.

For a symmetric tangent the number of negative pivots is that of its negative eigenvalues (Sylvester), so a conservative
shell is stable where it is zero. Where loads or couples have no potential the tangent is not symmetric. Then the
product of the pivots is still the determinant, so that an odd change is a singular tangent passed; and a shell that has
lost its stability by divergence has an odd number. It may oscillate unstably (flutter) without any sign of it here.

Where the tangent leaves out how the body's own field follows the body, pivots say nothing. Limit points are found all
the same, and there the path's own direction is the mode; bifurcations are not.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.equations.discretisation import Assembly
from magshell.linalg import Factorisation, SingularMatrix
from magshell.shell.state import State
from magshell.solver.constraints import Metric, Sphere
from magshell.solver.continuity import between, length_along
from magshell.solver.newton import Solution, StepFailure, System, Trial, factorise, newton
from magshell.solver.track import Point, point_at, trial_at

LIMIT_POINT, BIFURCATION = "limit point", "bifurcation"
# Of a step: accuracy of a limit point along it, and the distances from which a bifurcation is approached.
ACCURACY, COARSE_CLEARANCE, CLEARANCE = 1e-6, 1e-2, 1e-4
# Bifurcations that are looked for in one step; where there are more, it is made again, shorter.
MOST_IN_A_STEP = 10
# Largest distance of the points on either side of a critical point, over the difference of their distances.
GAP = 10.0

Report = Callable[[Trial, int, str, float], None]


class CriticalPoint(NamedTuple):
    """A state whose tangent is singular.

    Attributes
    ----------
    number : int
        From 1, along the path.
    kind : {"limit point", "bifurcation"}
    stage : int
    load_factor : float
    flux_density : ndarray, shape (3,)
        T.
    arc_length : float
    state : State
    mode : ndarray, shape (nodes, 11)
        The direction in which the tangent does nothing, global axes; its largest displacement is 1 m.
    negative_pivots : tuple of int or None
        Before and after it.
    """

    number: int
    kind: str
    stage: int
    load_factor: float
    flux_density: FloatArray
    arc_length: float
    state: State
    mode: FloatArray
    negative_pivots: tuple[int | None, int | None]

    def __repr__(self) -> str:
        place = f"load factor {self.load_factor:.6g} of stage {self.stage + 1}"
        return f"CriticalPoint({self.number}: {self.kind} at {place})"


class Found(NamedTuple):
    """A located critical point, not yet numbered."""

    kind: str
    point: Point
    mode: FloatArray
    negative_pivots: tuple[int | None, int | None]


def passed(before: Point, after: Point) -> bool:
    """Whether a critical point lies between two points."""
    counts = before.negative_pivots, after.negative_pivots
    return before.slope.load * after.slope.load < 0.0 or (None not in counts and counts[0] != counts[1])


def locate(system: System, metric: Metric, before: Point, after: Point, report: Report) -> Iterator[Found]:
    """The critical points between two points, in the order of the path.

    Raises
    ------
    StepFailure
        A state between the two is not found.
    """
    search = _Search(system, metric, before, after, report)
    try:
        turn = search.turn() if before.slope.load * after.slope.load < 0.0 else None
        if turn is None:
            yield from search.bifurcations(0.0, search.length)
            return
        margin = CLEARANCE * search.length
        yield from search.bifurcations(0.0, max(turn - margin, 0.0))
        yield search.limit_point(turn)
        yield from search.bifurcations(min(turn + margin, search.length), search.length)
    finally:
        search.factors = None  # SciPy's root finder leaves a cycle that holds the search


class _Search:
    """States between two points of the path, by their distance from the first."""

    def __init__(self, system: System, metric: Metric, before: Point, after: Point, report: Report) -> None:
        self.system, self.metric, self.report = system, metric, report
        self.before, self.after = before, after
        self.length = after.arc_length - before.arc_length
        self.known: dict[float, Point] = {}
        self.factors: Factorisation | None = None

    def seen(self, distance: float) -> Point:
        """The point at a distance, which may be one that was solved before."""
        return self.known[distance] if distance in self.known else self.point(distance)

    def point(self, distance: float) -> Point:
        """The point of the path at a distance from the first; `factors` are of its tangent, with its own stresses."""
        self.factors = None
        system, before = self.system, self.before
        state, load_factor, along = before.state, before.load_factor, before.slope.direction
        if distance > 0.0:
            trial = trial_at(system.discretisation, system.course, [self.after, before], distance)
            along = trial.state.u - before.state.u, trial.load_factor - before.load_factor
            sphere = Sphere(self.metric, before.state.u, before.load_factor, *along, self.metric.norm(*along))
            found = newton(system, trial, sphere, lambda *heard: self.report(trial, *heard)).trial
            state, load_factor = found.state, found.load_factor
        own = self.own(state, load_factor)
        solution = Solution(own, system.assemble(own), [0.0], None, None)
        self.factors = factorise(system, solution.assembly)
        point = point_at(system, self.metric, solution, self.factors, before.arc_length + distance, along)
        if distance > 0.0:
            length_along(self.metric, before, point)
        self.known[distance] = point
        return point

    def own(self, state: State, load_factor: float) -> Trial:
        """A state with its own stresses: those that a step predicted would move the zero of an eigenvalue."""
        return Trial(state, load_factor, self.system.predicted(state, load_factor))

    def turn(self) -> float | None:
        """Distance of the limit point."""
        ends = (self.seen(distance).slope.load for distance in (0.0, self.length))
        return self.root(lambda point: point.slope.load, 0.0, self.length) if np.prod([*ends]) < 0.0 else None

    def root(self, function: Callable[[Point], float], low: float, high: float) -> float:
        """Distance at which a function of the point changes its sign."""
        from scipy.optimize import brentq

        ends = {low: self.seen(low), high: self.seen(high)}

        def value(distance: float) -> float:
            return function(ends[distance] if distance in ends else self.point(distance))

        return float(brentq(value, low, high, xtol=ACCURACY * self.length, disp=False))

    def bifurcations(self, low: float, high: float) -> Iterator[Found]:
        """Where the number of negative pivots changes between two distances; raises StepFailure if that has no end."""
        for _ in range(MOST_IN_A_STEP):
            first, last = self.seen(low).negative_pivots, self.seen(high).negative_pivots
            if first is None or last is None or first == last:
                return
            below, above, at = self.singular(low, high)
            self.check_gap(below, above)
            yield self.between(below, above, at)
            low = above
        raise StepFailure(f"more than {MOST_IN_A_STEP} bifurcations lie within one step")

    def singular(self, low: float, high: float) -> tuple[float, float, float]:
        """Two distances on either side of the first bifurcation, a clearance from it, and its own.

        No state is solved at it: there the equations have no single solution, and Newton's method follows round-off.
        """
        first = self.seen(low).negative_pivots
        values = {distance: self.least_eigenvalue(distance, first) for distance in (low, high)}
        for clearance in (COARSE_CLEARANCE * self.length, CLEARANCE * self.length):
            width = np.inf
            while high - low > 2.5 * clearance:
                guess = zero_between(values, low, high) if high - low < 0.5 * width else 0.5 * (low + high)
                guess, width = min(max(guess, low + clearance), high - clearance), high - low
                for distance in (guess - clearance, guess + clearance):
                    if low < distance < high:
                        values[distance] = self.least_eigenvalue(distance, first)
                        low, high = (distance, high) if values[distance] > 0.0 else (low, distance)
        return low, high, zero_between(values, low, high)

    def least_eigenvalue(self, distance: float, first: int | None) -> float:
        """Of the tangent at a distance; positive where it has the first number of negative pivots."""
        pivots = self.point(distance).negative_pivots
        assert self.factors is not None
        size = abs(self.factors.smallest_eigenpair()[0])
        return size if pivots == first else -size

    def check_gap(self, below: float, above: float) -> None:
        """Whether the points at two distances are neighbours; raises StepFailure where one path ends at another's."""
        gap = self.metric.norm(*between(self.seen(below), self.seen(above)))
        if gap > GAP * (above - below):
            raise StepFailure("the step jumps from one path to another")

    def between(self, below: float, above: float, at: float) -> Found:
        """The bifurcation at a distance, on the path through the points on either side of it, with its mode."""
        first, last, system = self.seen(below), self.seen(above), self.system
        trial = trial_at(system.discretisation, system.course, [last, first], at - below)
        point = first._replace(arc_length=self.before.arc_length + at, load_factor=trial.load_factor, state=trial.state)
        mode = self.mode(system.assemble(self.own(trial.state, trial.load_factor)))
        return Found(BIFURCATION, point, mode, (first.negative_pivots, last.negative_pivots))

    def mode(self, assembly: Assembly) -> FloatArray:
        """The direction in which a tangent does least."""
        assert assembly.matrix is not None
        self.factors = None
        try:
            direction = self.system.linear_solver.factorise(assembly.matrix).smallest_eigenpair()[1]
        except SingularMatrix as singular:
            direction = singular.null_vector
        return normalised(self.system.discretisation.direction(direction).nodal)

    def limit_point(self, distance: float) -> Found:
        """The limit point at a distance, with its mode."""
        margin = CLEARANCE * self.length
        near = max(distance - margin, 0.0), min(distance + margin, self.length)
        sides = self.seen(near[0]).negative_pivots, self.seen(near[1]).negative_pivots
        self.check_gap(*near)
        if None not in sides and sides[0] == sides[1]:
            raise StepFailure("the load factor turns where the tangent is not singular")
        point = self.point(distance)
        assert self.factors is not None
        mode = point.slope.increment.nodal
        if self.system.discretisation.exact_tangent:
            mode = self.system.discretisation.direction(self.factors.smallest_eigenpair()[1]).nodal
        return Found(LIMIT_POINT, point, normalised(mode), sides)


def zero_between(values: dict[float, float], low: float, high: float) -> float:
    """Where a function vanishes between two distances: by inverse interpolation of its nearest values."""
    nearest = sorted(values, key=lambda distance: abs(distance - 0.5 * (low + high)))[:4]
    if len({values[distance] for distance in nearest}) == len(nearest):
        found = 0.0
        for one in nearest:
            others = [other for other in nearest if other != one]
            found += one * float(np.prod([values[other] / (values[other] - values[one]) for other in others]))
        if low < found < high:
            return found
    drop = values[low] - values[high]
    return low + (high - low) * values[low] / drop if drop else 0.5 * (low + high)


def normalised(mode: FloatArray) -> FloatArray:
    """A mode (nodes, 11) of largest displacement 1 m."""
    return mode / (float(np.linalg.norm(mode[:, :3], axis=1).max()) or 1.0)
