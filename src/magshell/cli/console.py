"""Output of commands: plain lines, warnings, errors."""

from __future__ import annotations

import pathlib
import sys
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
    """The warnings and notes of a report."""
    for doubt in report.warnings:
        say(on, f"warning: {doubt}", style="yellow")
    for note in report.notes:
        say(on, f"note: {note}")


def say_picture(on: Console, picture: pathlib.Path | str) -> None:
    """Where a picture is, or a warning that says why there is none."""
    if isinstance(picture, pathlib.Path):
        say(on, f"picture: {picture}")
    else:
        say(on, f"warning: {picture}", style="yellow")


def complain(text: str) -> None:
    """An error, one line of it at a time."""
    try:
        on = console(stderr=True)
    except Exception:  # too little memory to load rich
        print(*(f"error: {line}" for line in text.splitlines()), sep="\n", file=sys.stderr)
        return
    for line in text.splitlines():
        say(on, f"error: {line}", style="red")
