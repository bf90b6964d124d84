"""The path of a stage as a curve: its last points, their directions, and where it leads.

The path is known at its last points and has a known direction at the last of them. Through these goes a polynomial in
the arc length, cubic from the third point on. It gives trial states, and where a load factor or a displacement will be
met. Unlike one in the load factor it also holds at limit points.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple, TypeAlias

import numpy as np

from magshell.arrays import FloatArray
from magshell.equations.discretisation import Discretisation
from magshell.equations.instant import Increment, Instant, Prediction, combined, difference
from magshell.linalg import Factorisation
from magshell.model.course import Course
from magshell.shell.state import State
from magshell.solver.constraints import Metric
from magshell.solver.newton import Solution, StepFailure, System, Trial, factorise

# Part of a step by which the tangent of its end may be that of a state before.
CLOSE = 1e-2
# A point closer behind than this part of a step says nothing of where the step leads: the round-off of its difference
# from the last point is enlarged by the square of that ratio.
REACH = 100.0

Direction: TypeAlias = tuple[FloatArray, float]


class Slope(NamedTuple):
    """Derivative of the path with respect to its arc length: of the unknowns and of the load factor."""

    increment: Increment
    load: float

    @property
    def direction(self) -> Direction:
        """Displacements (nodes, 3) and load factor."""
        return self.increment.u, self.load

    @property
    def reversed(self) -> Slope:
        """The other way along the path."""
        return Slope(-self.increment, -self.load)


class Point(NamedTuple):
    """A converged state on the path.

    Attributes
    ----------
    arc_length, load_factor : float
    state : State
    slope : Slope
    prediction : Prediction
        Of that state, for mixed tangents nearby.
    negative_pivots : int or None
        Of the tangent; None where the linear solver cannot tell, or the tangent leaves something out.
    """

    arc_length: float
    load_factor: float
    state: State
    slope: Slope
    prediction: Prediction
    negative_pivots: int | None


def known(track: Sequence[Point], distance: float) -> list[Point]:
    """The points that tell where the path is this far ahead of the last: that one, and those not too close behind."""
    last = track[-1]
    return [*(one for one in track[-3:-1] if last.arc_length - one.arc_length >= distance / REACH), last]


def _weights(track: Sequence[Point], distance: float) -> tuple[float, list[float]]:
    """Of the last slope and of the differences of up to two earlier points from the last one.

    P(τ) = τ P' + τ² g(τ), with g the polynomial through (P_k - τ_k P') / τ_k².
    """
    earlier = [point.arc_length - track[-1].arc_length for point in track[-3:-1]]
    shares = [
        (distance / at) ** 2 * float(np.prod([(distance - other) / (at - other) for other in earlier if other != at]))
        for at in earlier
    ]
    return distance - sum(share * at for share, at in zip(shares, earlier, strict=True)), shares


def trial_at(
    discretisation: Discretisation,
    course: Course,
    track: Sequence[Point],
    distance: float,
    load_factor: float | None = None,
) -> Trial:
    """Trial state this far ahead of the last point; supports are put where its load factor, or the given one, wants."""
    last = track[-1]
    on_slope, shares = _weights(track, distance)
    increment = on_slope * last.slope.increment
    for share, point in zip(shares, track[-3:-1], strict=True):
        increment = increment + share * difference(point.state, last.state)
    if load_factor is None:
        load_factor = value_at(track, [point.load_factor for point in track[-3:]], last.slope.load, distance)
    held = course.amounts(load_factor).held - course.amounts(last.load_factor).held
    increment = discretisation.with_imposed(increment, held)
    prediction = _predicted_ahead(discretisation, course, track, on_slope, shares)
    return Trial(discretisation.moved(last.state, increment), load_factor, prediction)


def _predicted_ahead(
    discretisation: Discretisation, course: Course, track: Sequence[Point], on_slope: float, shares: Sequence[float]
) -> Prediction:
    """By the same polynomial. (Those of the trial state itself have large membrane parts that the path has not.)"""
    last = track[-1]
    at_last = Instant(last.state, course.at(last.load_factor))
    sloping = discretisation.predicted(at_last, last.slope.increment)
    points = [point.prediction for point in track[-3:-1]]
    return combined([1.0 - on_slope - sum(shares), on_slope, *shares], [last.prediction, sloping, *points])


def value_at(track: Sequence[Point], values: Sequence[float], slope: float, distance: float) -> float:
    """A scalar this far ahead, from its values at the last (up to three) points and its slope at the last."""
    on_slope, shares = _weights(track, distance)
    change = sum(share * (value - values[-1]) for share, value in zip(shares, values[:-1], strict=True))
    return float(values[-1] + on_slope * slope + change)


def crossing(
    track: Sequence[Point], values: Sequence[float], slope: float, wanted: float, longest: float
) -> float | None:
    """Least distance ahead, within the longest, at which a scalar takes a value."""
    linear = slope * longest
    half, whole = (value_at(track, values, slope, part * longest) - values[-1] - part * linear for part in (0.5, 1.0))
    root = least_root((values[-1] - wanted, linear, 8.0 * half - whole, 2.0 * whole - 8.0 * half))
    return None if root is None else longest * root


def least_root(cubic: tuple[float, float, float, float]) -> float | None:
    """Least root in (0, 1] of a cubic c_0 + c_1 x + c_2 x² + c_3 x³, by Newton's method between its extremes."""
    c_0, c_1, c_2, c_3 = cubic

    def value(x: float) -> float:
        return c_0 + x * (c_1 + x * (c_2 + x * c_3))

    ends = [0.0, *(x for x in _extremes(c_1, c_2, c_3) if 0.0 < x < 1.0), 1.0]
    for low, high in pairwise(ends):
        at_low, at_high = value(low), value(high)
        if at_high == 0.0:
            return high
        if at_low * at_high >= 0.0:
            continue
        x = low + (high - low) * at_low / (at_low - at_high)
        for _ in range(100):
            at = value(x)
            low, high = (x, high) if at * at_low > 0.0 else (low, x)
            gradient = c_1 + x * (2.0 * c_2 + 3.0 * x * c_3)
            step = -at / gradient if gradient else np.inf
            new = x + step if low < x + step < high else 0.5 * (low + high)
            if abs(new - x) <= 1e-15 * x:
                break
            x = new
        return x
    return None


def _extremes(c_1: float, c_2: float, c_3: float) -> list[float]:
    """Where the derivative c_1 + 2 c_2 x + 3 c_3 x² vanishes, rising."""
    under = c_2**2 - 3.0 * c_3 * c_1
    if under < 0.0:
        return []
    q = -(c_2 + np.copysign(np.sqrt(under), c_2))
    return sorted(float(top / below) for top, below in ((q, 3.0 * c_3), (c_1, q)) if below)


def close_factors(metric: Metric, solution: Solution, along: Direction) -> Factorisation | None:
    """Those of the last iteration, where the last increment was small beside a direction."""
    last = np.inf if solution.increment is None else metric.norm(solution.increment.u, 0.0)
    return solution.factors if last <= CLOSE * metric.norm(*along) else None


def point_at(
    system: System,
    metric: Metric,
    solution: Solution,
    factors: Factorisation | None,
    arc_length: float,
    along: Direction,
) -> Point:
    """The point of a converged state, with the slope that goes along a direction.

    Factors of a tangent close to that of the state serve; without any, its own is factorised.

    Raises
    ------
    StepFailure
        The tangent is singular, or nothing changes with the load factor.
    """
    factors = factorise(system, solution.assembly) if factors is None else factors
    trial = solution.trial
    per_load = system.per_load(trial, solution.assembly, factors)
    length = metric.norm(per_load.u, 1.0)
    if not np.isfinite(length):
        raise StepFailure("the tangent is singular at the converged state")
    side = -1.0 if metric.product((per_load.u, 1.0), along) < 0.0 else 1.0
    slope = Slope(side / length * per_load, side / length)
    prediction = system.predicted(trial.state, trial.load_factor)
    pivots = factors.negative_pivots() if system.discretisation.exact_tangent else None
    return Point(arc_length, trial.load_factor, trial.state, slope, prediction, pivots)


def arc(metric: Metric, chord: Direction, first: Slope, second: Slope) -> float:
    """Length of the arc over a chord, as that of a circle which turns by the angle between the slopes."""
    cosine = np.clip(metric.product(first.direction, second.direction), -1.0, 1.0)
    half = 0.5 * float(np.arccos(cosine))
    return metric.norm(*chord) / float(np.sinc(half / np.pi))
