"""Display of a running sweep: one bar on a terminal, a line for each cell elsewhere."""

from __future__ import annotations

import time
from collections.abc import Mapping
from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

from magshell.kernel_cache import FIRST_USE
from magshell.sweep.grid import Cell
from magshell.sweep.outcomes import Outcome


class Display:
    """How far a sweep is; used as a context.

    Parameters
    ----------
    console : rich.console.Console
        Where to; a live bar if it is a terminal.
    """

    def __init__(self, console: Console) -> None:
        self._console = console
        self._live = console.is_terminal
        self._bar = Progress(
            BarColumn(bar_width=32),
            TextColumn("{task.description}", markup=False),
            TimeElapsedColumn(),
            TextColumn("{task.fields[left]}", markup=False),
            console=console,
            transient=True,
            disable=not self._live,
        )
        self._task = self._bar.add_task("", total=None, left="")
        self._all = self._before = self._done = self._failed = self._running = 0
        self._began = time.monotonic()

    def __enter__(self) -> Display:
        self._bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bar.stop()

    def checked(self, count: int) -> None:
        """So many cells have been checked."""
        self._bar.update(self._task, description=f"checking cell {count}")

    def begin(self, count: int, before: Mapping[int, Outcome]) -> None:
        """The sweep has so many cells, of which some need no solving any more."""
        self._all, self._before, self._began = count, len(before), time.monotonic()
        kept = f", of which {len(before)} are done" if before else ""
        self._line(f"{count} cells{kept}")
        self._show()

    def compiling(self) -> None:
        """The cell that runs alone has its kernels compiled."""
        self._line(FIRST_USE)

    def running(self, count: int) -> None:
        """So many cells are being solved."""
        self._running = count
        self._show()

    def ended(self, cell: Cell, outcome: Outcome) -> None:
        """A cell is solved, or is not to be solved."""
        self._done += bool(outcome.converged)
        self._failed += not outcome.converged
        self._running -= 1
        if not outcome.converged:
            self._line(f"cell {cell.name} ({cell.label}): not solved: {outcome.reason}", "red")
        elif not self._live:
            steps, seconds = outcome.summary.get("steps"), outcome.summary.get("cpu_seconds")
            self._line(f"cell {cell.name} ({cell.label}): solved, {steps} steps, {seconds:.1f} s  [{self._counts()}]")
        self._show()

    def died(self, cell: Cell) -> None:
        """The process that solved a cell was killed; the cell will be tried again."""
        self._line(f"cell {cell.name} ({cell.label}): its process was killed; it is tried again", "yellow")

    def _counts(self) -> str:
        failed = f", {self._failed} failed" if self._failed else ""
        return f"{self._before + self._done} of {self._all} done{failed}"

    def _show(self) -> None:
        ended = self._done + self._failed
        spent = time.monotonic() - self._began
        left = self._all - self._before - ended
        estimate = f"about {_clock(spent / ended * left)} left" if ended and left else ""
        self._bar.update(
            self._task,
            total=self._all,
            completed=self._before + ended,
            description=f"{self._counts()}, {self._running} running",
            left=estimate,
            refresh=True,
        )

    def _line(self, text: str, style: str | None = None) -> None:
        self._console.print(text, style=style, soft_wrap=True)


def _clock(seconds: float) -> str:
    whole = round(seconds)
    return f"{whole // 3600}:{whole // 60 % 60:02d}:{whole % 60:02d}"
