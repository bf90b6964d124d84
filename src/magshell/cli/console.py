"""What commands say: plain lines, warnings, errors."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console

    from magshell.problem.report import Report


def console(stderr: bool = False) -> Console:
    """Standard output, or error output, with texts as they are."""
    from rich.console import Console

    return Console(stderr=stderr, highlight=False, markup=False, emoji=False)


def say(on: Console, text: str, style: str | None = None) -> None:
    """A line, however long."""
    on.print(text, style=style, soft_wrap=True)


def say_doubts(on: Console, report: Report) -> None:
    """The warnings of a report."""
    for doubt in report.warnings:
        say(on, f"warning: {doubt}", style="yellow")


def complain(text: str) -> None:
    """An error, one line of it at a time."""
    on = console(stderr=True)
    for line in text.splitlines():
        say(on, f"error: {line}", style="red")
