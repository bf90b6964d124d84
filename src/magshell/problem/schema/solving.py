"""The entries of `stages` and the tables `solver` and `results`."""

from __future__ import annotations

from typing import Literal

from magshell.problem import fields as f
from magshell.problem.schema.table import Table


class StageTable(Table):
    """A part of the load path."""

    name: f.Name | None = None
    control: Literal["load", "arc-length", "displacement"] = "load"
    stops: f.StageStops = ()
    probe: f.ProbeName | None = None
    component: Literal[1, 2, 3] | None = None
    target: f.Length | None = None
    branch: f.Count | None = None
    side: Literal[1, -1] = 1


class ResultsTable(Table):
    """What files and pages hold beside what they always do, and the axes that tensors are in."""

    local_axis: f.Direction = (1.0, 0.0, 0.0)
    outputs: f.Names = ()


class SolverTable(Table):
    """How the path is followed; what is left out has the default of `magshell.Settings`."""

    tolerance: f.PositiveNumber | None = None
    max_iterations: f.Count | None = None
    target_iterations: f.Count | None = None
    first_step: f.PositiveNumber | None = None
    smallest_step: f.PositiveNumber | None = None
    largest_step: f.PositiveNumber | None = None
    linear_solver: f.Name | None = None
