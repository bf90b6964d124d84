"""Events of a solve, for observers: files, progress and pictures are attached here, not inside the solver."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from magshell.equations.discretisation import Discretisation
    from magshell.solver.critical import CriticalPoint
    from magshell.solver.path import Path
    from magshell.solver.settings import Settings
    from magshell.solver.step import Step


@dataclass(frozen=True)
class Iteration:
    """One evaluation of the residual.

    Attributes
    ----------
    step : int
    stage : int
    load_factor : float
    iteration : int
        Linear solves so far in this step.
    residual : float
        The worst kind's, relative.
    kind : str
        That kind: u, w, phi, omega or alpha.
    seconds : float
        Since the start of the solve.
    """

    step: int
    stage: int
    load_factor: float
    iteration: int
    residual: float
    kind: str
    seconds: float


class Observer:
    """Base class; every method may be left as it is."""

    def started(self, discretisation: Discretisation, settings: Settings) -> None:
        """Before the first step."""

    def resumed(self, path: Path) -> None:
        """In place of `started`, where a path goes on; as it is left here, its steps so far are told once more."""
        self.started(path.discretisation, path.settings)
        for step in path.steps:
            self.converged(step)
        for point in path.critical_points:
            self.critical(point)

    def iterated(self, iteration: Iteration) -> None:
        """After each residual."""

    def kept(self, path: Path) -> None:
        """After each converged step, before any observer is told of it: `path.trail[-1]` is its waypoint."""

    def converged(self, step: Step) -> None:
        """After each converged step, the undeformed one included."""

    def critical(self, point: CriticalPoint) -> None:
        """After a critical point was located, which is after the step beyond it has converged."""

    def cut(self, load_factor: float, reason: str) -> None:
        """A step to this load factor failed and will be tried with a smaller increment."""

    def finished(self, path: Path) -> None:
        """At the end, also before an error is raised."""
