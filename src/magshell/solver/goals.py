"""Where a stage is led: to a load factor, or to a displacement of a probe."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Protocol

from magshell.model.course import Course
from magshell.model.model import Model
from magshell.solver.constraints import Constraint, ProbeValue
from magshell.solver.newton import Trial
from magshell.solver.step import Step
from magshell.solver.track import Point, Slope


class Goal(Protocol):
    """A value that a quantity of the path must reach."""

    @property
    def wanted(self) -> float:
        """That value."""

    @property
    def named(self) -> str:
        """The goal in words."""

    def value(self, point: Point | Trial | Step) -> float:
        """Of the quantity."""

    def slope(self, slope: Slope) -> float:
        """Its derivative with respect to the arc length."""

    def hold(self, trial: Trial) -> Constraint | None:
        """What keeps the quantity at a trial's value; None: the load factor itself is kept."""

    def hold_wanted(self) -> Constraint | None:
        """What keeps it at the wanted value."""


class LoadGoal(NamedTuple):
    """A load factor."""

    wanted: float

    @property
    def named(self) -> str:
        """The goal in words."""
        return f"load factor {self.wanted:.6g}"

    def value(self, point: Point | Trial | Step) -> float:
        """The load factor."""
        return point.load_factor

    def slope(self, slope: Slope) -> float:
        """Of the load factor."""
        return slope.load

    def hold(self, trial: Trial) -> None:
        """The load factor is kept."""
        return

    def hold_wanted(self) -> None:
        """The load factor is kept."""
        return


class ProbeGoal(NamedTuple):
    """A displacement component of a node, m."""

    node: int
    column: int
    wanted: float

    @property
    def named(self) -> str:
        """The goal in words."""
        return f"u{self.column + 1} = {1e3 * self.wanted:.6g} mm of node {self.node}"

    def value(self, point: Point | Trial | Step) -> float:
        """The displacement."""
        return float(point.state.u[self.node, self.column])

    def slope(self, slope: Slope) -> float:
        """Of the displacement."""
        return float(slope.increment.u[self.node, self.column])

    def hold(self, trial: Trial) -> ProbeValue:
        """The displacement that the trial has."""
        return ProbeValue(self.node, self.column, self.value(trial))

    def hold_wanted(self) -> ProbeValue:
        """The wanted displacement."""
        return ProbeValue(self.node, self.column, self.wanted)


def goals_of(model: Model, course: Course) -> Sequence[Goal]:
    """The goals of a stage, in order."""
    stage = course.stage
    if stage.probe is not None and stage.component is not None and stage.target is not None:
        return [ProbeGoal(model.probe_nodes[stage.probe], stage.component - 1, stage.target)]
    return [LoadGoal(stop) for stop in course.stops()]
