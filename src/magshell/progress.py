"""What a solve shows while it runs: a bar on a terminal, one line per step elsewhere."""

from __future__ import annotations

import time
from types import TracebackType
from typing import TYPE_CHECKING

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

from magshell.linalg import make_solver
from magshell.shell.loops import assemble
from magshell.solver.events import Observer
from magshell.units import FLUX_DENSITY, show

if TYPE_CHECKING:
    from magshell.assembly import Discretisation
    from magshell.solver.events import Iteration
    from magshell.solver.path import Path, Step
    from magshell.solver.settings import Settings


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

    def __enter__(self) -> ProgressDisplay:
        self._began = time.monotonic()
        self._bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bar.stop()

    def started(self, discretisation: Discretisation, settings: Settings) -> None:
        """Name the size and the linear solver; say so if the kernels must be compiled first."""
        self._magnitude = discretisation.model.field.magnitude
        elements, unknowns = len(discretisation.mesh.elements), discretisation.dofs
        solver = make_solver(settings.linear_solver).name
        self._line(f"{elements} elements, {unknowns} unknowns, linear solver: {solver}")
        model = discretisation.model
        if not assemble.is_compiled(type(model.shell.material), type(model.coupling)):
            self._line("compiling the kernels for the first use of this version (about a minute) ...")

    def iterated(self, iteration: Iteration) -> None:
        """Show how far the step is."""
        if self._live:
            self._bar.update(
                self._task,
                description=(
                    f"step {iteration.step}  to {self._load(iteration.load_factor)}  "
                    f"iteration {iteration.iteration}  residual {iteration.residual:.1e}"
                ),
            )

    def converged(self, step: Step) -> None:
        """Move the bar, or write a line."""
        if self._live:
            self._bar.update(self._task, completed=step.load_factor)
        elif step.number:
            self._line(
                f"step {step.number}  {self._load(step.load_factor)}  {step.iterations} iterations  "
                f"residual {step.residual:.1e}  {time.monotonic() - self._began:.1f} s"
            )

    def cut(self, load_factor: float, reason: str) -> None:
        """Say that a step is tried again, shorter."""
        if self._live:
            self._bar.update(self._task, description=f"step to {self._load(load_factor)} cut: {reason}")
        else:
            self._line(f"step to {self._load(load_factor)} cut: {reason}")

    def finished(self, path: Path) -> None:
        """Say how it ended."""
        self.path = path
        if path.steps:
            self._line(
                f"{'solved' if path.converged else 'stopped'} at {self._load(path.steps[-1].load_factor)}: "
                f"{len(path.steps) - 1} steps, {path.solves} linear solves, "
                f"{time.monotonic() - self._began:.1f} s"
            )

    def _load(self, load_factor: float) -> str:
        percent = f"{100.0 * load_factor:.4g} %"
        return f"{percent} ({show(load_factor * self._magnitude, FLUX_DENSITY)})" if self._magnitude else percent

    def _line(self, text: str) -> None:
        self._console.print(text, soft_wrap=True)
