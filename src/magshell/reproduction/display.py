"""Display of `magshell reproduce`: the bars of all runs on a terminal, lines elsewhere."""

from __future__ import annotations

from collections.abc import Iterable
from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

from magshell.kernel_messages import KernelMessages


class Display:
    """A bar for each run, used as a context.

    Parameters
    ----------
    console : rich.console.Console
        Where to; bars if it is a terminal.
    names : iterable of str
        Of the runs.
    """

    def __init__(self, console: Console, names: Iterable[str]) -> None:
        self._console = console
        self._bars = Progress(
            TextColumn("{task.description}", markup=False),
            BarColumn(bar_width=32),
            TaskProgressColumn(),
            TimeElapsedColumn(),
            console=console,
            transient=True,
            disable=not console.is_terminal,
        )
        names = list(names)
        width = max(map(len, names))
        self._messages = KernelMessages(self.say, solves=True)
        self._tasks = {name: self._bars.add_task(name.ljust(width), total=1.0, start=False) for name in names}

    def __enter__(self) -> Display:
        self._messages.listen()
        self._bars.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bars.stop()
        self._messages.stop()

    def reached(self, name: str, load_factor: float) -> None:
        """Move a run's bar; may be called from any thread."""
        task = self._tasks[name]
        if not self._bars.tasks[task].started:
            self._bars.start_task(task)
        self._bars.update(task, completed=load_factor)

    def say(self, text: str, style: str | None = None) -> None:
        """A line that stays."""
        self._console.print(text, style=style, soft_wrap=True)
