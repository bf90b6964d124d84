"""Restores a path from its waypoints."""

from __future__ import annotations

from collections.abc import Iterable

from magshell.equations.discretisation import Discretisation
from magshell.linalg import SOLVERS, nested_dissection
from magshell.model.model import Model
from magshell.solver.goals import goals_of
from magshell.solver.path import Path
from magshell.solver.settings import Settings
from magshell.solver.starts import start_of
from magshell.solver.waypoint import Waypoint


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
