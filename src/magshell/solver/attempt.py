"""The next step: where it leads, and what is held in it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from magshell.solver.constraints import Constraint, Metric, Sphere
from magshell.solver.goals import Goal, LoadGoal
from magshell.solver.newton import System, Trial
from magshell.solver.track import Point, crossing, known, trial_at


class Attempt(NamedTuple):
    """A step to be made.

    Attributes
    ----------
    trial : Trial
    constraint : Constraint or None
        What is held besides the supports; None: the load factor.
    at_goal : bool
        Whether it leads to the goal.
    intended : float
        Its length along the path, as it is expected.
    size : float
        Distance of the trial state from the last point.
    """

    trial: Trial
    constraint: Constraint | None
    at_goal: bool
    intended: float
    size: float


def next_attempt(
    system: System, metric: Metric, points: Sequence[Point], goal: Goal, size: float, by_arc: bool
) -> Attempt:
    """A step towards a goal.

    Parameters
    ----------
    system : System
    metric : Metric
    points : sequence of Point
        The last ones of the path.
    goal : Goal
    size : float
        Length of the step.
    by_arc : bool
        Whether to hold the arc length, unless the goal is within reach.
    """
    longest = size
    if isinstance(goal, LoadGoal):
        longest = _longest(points, size, system.settings.largest_step)
    track, last = known(points, longest), points[-1]
    values = [goal.value(point) for point in track]
    at = crossing(track, values, goal.slope(last.slope), goal.wanted, 2.0 * longest)
    at_goal = at is not None and at <= 1.3 * longest
    distance = longest if at is None else at if at_goal else 0.5 * at
    wanted = goal.wanted if at_goal and isinstance(goal, LoadGoal) else None
    trial = trial_at(system.discretisation, system.course, known(points, distance), distance, wanted)
    chord = trial.state.u - last.state.u, trial.load_factor - last.load_factor
    length = metric.norm(*chord)
    nearer = (goal.value(trial) - values[-1]) * (goal.wanted - values[-1]) > 0.0
    held: Constraint | None
    if at_goal:
        held = goal.hold_wanted()
    elif nearer and not by_arc:
        held = goal.hold(trial)
    else:
        held = Sphere(metric, last.state.u, last.load_factor, *chord, length)
    return Attempt(trial, held, at_goal, distance, length)


def _longest(points: Sequence[Point], size: float, largest: float) -> float:
    """The size, or less where the load factor would change by more than the largest step."""
    track = known(points, size)
    loads = [point.load_factor for point in track]
    limits = [crossing(track, loads, track[-1].slope.load, loads[-1] + change, size) for change in (largest, -largest)]
    return min((limit for limit in limits if limit is not None), default=size)
