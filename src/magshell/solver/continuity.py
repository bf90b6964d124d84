"""Whether two points lie on one path, and how far apart along it."""

from __future__ import annotations

import numpy as np

from magshell.solver.constraints import Metric
from magshell.solver.newton import StepFailure
from magshell.solver.track import Direction, Point, Slope, arc

# Largest angle between a step and the direction of the path at either end: beyond it the path has been left.
SHARPEST = np.pi / 3
# Largest distance of a solution from its trial state, in lengths of the step: beyond it another path may have been met.
MISS = 0.2
# A step whose load changes by less than this share of what the slopes at both its ends say has jumped over a fold.
JUMP = 0.5


def between(first: Point, second: Point) -> Direction:
    """From one point to another."""
    return second.state.u - first.state.u, second.load_factor - first.load_factor


def length_along(metric: Metric, first: Point, second: Point) -> float:
    """Length of the path between two points that follow each other.

    Raises
    ------
    StepFailure
        They do not lie on one path: what speaks against it.
    """
    chord = between(first, second)
    distance = metric.norm(*chord)
    for slope in (first.slope, second.slope):
        if metric.product(slope.direction, chord) < np.cos(SHARPEST) * distance:
            raise StepFailure("the step leaves the path, or turns back on it")
    length = arc(metric, chord, first.slope, second.slope)
    _check_load(first.slope, second.slope, chord[1], length)
    return length


def _check_load(first: Slope, second: Slope, change: float, length: float) -> None:
    """Whether the load factor changes as much as it must if it rises, or falls, at both ends."""
    way = np.sign(first.load)
    least = min(way * first.load, way * second.load)
    if least > 0.0 and way * change < JUMP * least * length:
        raise StepFailure(
            f"the step jumps over a part of the path where the load factor {'falls' if way > 0.0 else 'rises'}"
        )


def check_near(missed: float, length: float) -> None:
    """Whether a solution is near enough to its trial state; raises StepFailure if it is not."""
    if missed > MISS * length:
        raise StepFailure("the solution is not where the path was expected")
