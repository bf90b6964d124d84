"""Waypoints: a converged step with all that the steps after it depend on."""

from __future__ import annotations

from typing import NamedTuple

from magshell.solver.critical import CriticalPoint
from magshell.solver.step import Step
from magshell.solver.track import Slope


class Waypoint(NamedTuple):
    """What is known when a step has converged.

    Attributes
    ----------
    step : Step
    critical_points : tuple of CriticalPoint
        Located between the step before and this one.
    slope : Slope
        Direction of the path.
    goal : int
        Of the stage's goals (its stops), the one that comes next, from 0; their number: the stage has ended.
    taken : int
        Steps on the way to it.
    by_arc : bool
        Whether the arc length is held in the next step.
    radius : float
        Size of the next step.
    cuts, solves : int
        Of the whole path so far.
    cpu_seconds : float
        Of the whole path so far.
    """

    step: Step
    critical_points: tuple[CriticalPoint, ...]
    slope: Slope
    goal: int
    taken: int
    by_arc: bool
    radius: float
    cuts: int
    solves: int
    cpu_seconds: float
