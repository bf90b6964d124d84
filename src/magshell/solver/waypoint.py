"""Waypoints: a converged step with all that the steps after it depend on."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from magshell.equations.discretisation import Discretisation
from magshell.linalg import SOLVERS, nested_dissection
from magshell.model.model import Model
from magshell.solver.critical import CriticalPoint
from magshell.solver.goals import goals_of
from magshell.solver.path import Path, Step
from magshell.solver.settings import Settings
from magshell.solver.starts import start_of
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


def path_through(model: Model, settings: Settings, waypoints: Iterable[Waypoint]) -> Path:
    """The path that was followed so far; `magshell.resume` goes on with it.

    Parameters
    ----------
    model : Model
        That of the waypoints.
    settings : Settings
        May be others than those of the steps so far.
    waypoints : iterable of Waypoint
        All of them, the undeformed state first.
    """
    path = Path(model, Discretisation(model, nested_dissection), settings, SOLVERS[settings.linear_solver].name)
    for waypoint in waypoints:
        path.add(waypoint)
    last = path.steps[-1].stage
    for stage in range(last + 1):
        path.courses.append(model.course(stage, start_of(path, stage).amounts))
    if last == len(model.stages) - 1 and path.trail[-1].goal == len(goals_of(model, path.courses[last])):
        path.end()
    return path
