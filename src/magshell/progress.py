"""What a solve shows while it runs: a bar on a terminal, one line per step elsewhere."""

from __future__ import annotations

import time
from types import TracebackType
from typing import TYPE_CHECKING

import numpy as np
from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

from magshell.kernel_messages import KernelMessages
from magshell.linalg import make_solver
from magshell.solver.events import Observer
from magshell.units import FLUX_DENSITY, show

if TYPE_CHECKING:
    from magshell.equations.discretisation import Discretisation
    from magshell.solver.critical import CriticalPoint
    from magshell.solver.events import Iteration
    from magshell.solver.path import Path
    from magshell.solver.settings import Settings
    from magshell.solver.step import Step


class ProgressDisplay(Observer):
    """Show load, step, iteration, residual and elapsed time; used as a context around the solve.

    Parameters
    ----------
    console : rich.console.Console
        Where to; a live bar if it is a terminal.

    Attributes
    ----------
    path : Path or None
        None until the solve has ended, in whatever way.
    """

    def __init__(self, console: Console) -> None:
        self.path: Path | None = None
        self._console = console
        self._live = console.is_terminal
        self._bar = Progress(
            BarColumn(bar_width=24),
            TaskProgressColumn(),
            TextColumn("{task.description}", markup=False),
            TimeElapsedColumn(),
            console=console,
            transient=True,
            disable=not self._live,
        )
        self._task = self._bar.add_task("preparing", total=1.0)
        self._messages = KernelMessages(self._line, solves=True)

    def __enter__(self) -> ProgressDisplay:
        self._began = time.monotonic()
        self._messages.listen()
        self._bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bar.stop()
        self._messages.stop()

    def started(self, discretisation: Discretisation, settings: Settings) -> None:
        """Name the size and the linear solver."""
        self._stages = discretisation.model.stages
        elements, unknowns = len(discretisation.mesh.elements), discretisation.dofs
        solver = make_solver(settings.linear_solver).name
        self._line(f"{elements} elements, {unknowns} unknowns, linear solver: {solver}")

    def resumed(self, path: Path) -> None:
        """Say how far the path is already."""
        self.started(path.discretisation, path.settings)
        last = path.steps[-1]
        self._line(f"{len(path.steps) - 1} steps up to {self._load(last)}{_field(last)} are solved already")
        if self._live:
            self.converged(last)

    def iterated(self, iteration: Iteration) -> None:
        """Show how far the step is."""
        if self._live:
            self._bar.update(
                self._task,
                description=(
                    f"step {iteration.step}  to {self._load(iteration)}  "
                    f"iteration {iteration.iteration}  residual {iteration.residual:.1e}"
                ),
            )

    def converged(self, step: Step) -> None:
        """Move the bar, or write a line."""
        if self._live:
            self._bar.update(self._task, completed=(step.stage + max(step.load_factor, 0.0)) / len(self._stages))
        elif step.number:
            self._line(
                f"step {step.number}  {self._load(step)}{_field(step)}  {step.iterations} iterations  "
                f"residual {step.residual:.1e}  {time.monotonic() - self._began:.1f} s"
            )

    def cut(self, load_factor: float, reason: str) -> None:
        """Report that a step is tried again, shorter; the reason is given if the path ends there."""
        text = f"step to {_percent(load_factor)} is too large, trying a smaller one"
        if self._live:
            self._bar.update(self._task, description=text)
        else:
            self._line(text)

    def critical(self, point: CriticalPoint) -> None:
        """Say what was passed."""
        before, after = point.negative_pivots
        pivots = f"; negative pivots {before} before, {after} after" if None not in (before, after) else ""
        self._line(f"critical point {point.number}: {point.kind} at {self._load(point)}{_field(point)}{pivots}")

    def finished(self, path: Path) -> None:
        """Say how it ended."""
        self.path, self._stages = path, path.model.stages
        if path.steps:
            last = path.steps[-1]
            self._line(
                f"{'solved' if path.converged else 'stopped'} at {self._load(last)}{_field(last)}: "
                f"{len(path.steps) - 1} steps, {path.solves} linear solves, "
                f"{time.monotonic() - self._began:.1f} s"
            )

    def _load(self, at: Step | CriticalPoint | Iteration) -> str:
        """The load factor, and of several stages which."""
        if len(self._stages) == 1:
            return _percent(at.load_factor)
        return f"{_percent(at.load_factor)} of {self._stages[at.stage].name or f'stage {at.stage + 1}'}"

    def _line(self, text: str, style: str | None = None) -> None:
        self._console.print(text, style=style, soft_wrap=True)


def _percent(load_factor: float) -> str:
    return f"{100.0 * load_factor:.4g} %"


def _field(at: Step | CriticalPoint) -> str:
    magnitude = float(np.linalg.norm(at.flux_density))
    return f" ({show(magnitude, FLUX_DENSITY)})" if magnitude else ""
