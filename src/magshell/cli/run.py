"""`magshell run`."""

from __future__ import annotations

import argparse
import pathlib
from typing import TYPE_CHECKING

from magshell.cli.console import complain, console, say, say_doubts
from magshell.cli.folders import made
from magshell.cli.status import INTERRUPTED, NOT_SOLVED, SOLVED
from magshell.errors import SolveError
from magshell.units import LENGTH, show

if TYPE_CHECKING:
    from rich.console import Console

    from magshell.solver import Path

_AT_THE_END = ("summary.json", "curve.png", "shape.png")

ABOUT = "solve a problem and write the results"
EXAMPLES = """
examples:
  magshell run strip-10 --out results
  magshell run my-arm.toml --out results/my-arm

DIR receives history.csv (the curves), shell.pvd and steps/ (for ParaView), summary.json and the pictures, and where
the path turns or branches critical.csv and critical/ (the modes).
Every converged step is on disk at once: Ctrl-C keeps them."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What follows the command."""
    parser.add_argument("problem", metavar="FILE|NAME", help="a problem file (.toml) or a built-in problem")
    parser.add_argument("--out", metavar="DIR", required=True, help="folder for the results, made if missing")


def run(given: argparse.Namespace) -> int:
    """Solve, and write the results."""
    from magshell.output.critical import CriticalWriter
    from magshell.output.history import HistoryWriter
    from magshell.output.pictures import draw_pictures
    from magshell.output.summary import write_summary
    from magshell.output.vtu import VtuWriter
    from magshell.problem import load
    from magshell.problem.report import describe
    from magshell.progress import ProgressDisplay
    from magshell.solver import solve

    problem = load(given.problem)
    out = console()
    say(out, problem.title)
    say_doubts(out, describe(problem))
    directory = made(pathlib.Path(given.out))
    _forget_earlier_run(out, directory)
    progress = ProgressDisplay(out)
    observers = [HistoryWriter(directory), VtuWriter(directory), CriticalWriter(directory), progress]
    try:
        with progress:
            path = solve(problem.model, problem.settings, observers)
    except SolveError as error:
        path = error.path
        complain(f"{problem.source}: not solved: {error.reason}")
    except KeyboardInterrupt:
        if progress.path is None or not progress.path.steps:
            raise
        write_summary(progress.path, directory, reason="interrupted")
        kept = len(progress.path.steps) - 1
        complain(f"{problem.source}: interrupted; the {kept} steps that converged are in {directory}")
        return INTERRUPTED
    write_summary(path, directory)
    for name in problem.file.probes:
        u = path.probe(name).u[-1]
        noise = 1e-9 * max(map(abs, u))
        say(out, f"{name}: u = ({', '.join(show(x if abs(x) > noise else 0.0, LENGTH) for x in u)})")
    _say_unstable(out, path)
    for picture in draw_pictures(path, directory):
        say(out, f"picture: {picture}" if isinstance(picture, pathlib.Path) else picture)
    say(out, f"results: {directory} (history.csv, summary.json; shell.pvd opens in ParaView)")
    return SOLVED if path.converged else NOT_SOLVED


def _forget_earlier_run(out: Console, directory: pathlib.Path) -> None:
    """Remove what only the end of a run writes, so that no run leaves the end of another; say so."""
    earlier = [file for name in _AT_THE_END if (file := directory / name).exists()]
    for file in earlier:
        file.unlink()
    if earlier:
        say(out, f"the results of an earlier run in {directory} are replaced", style="yellow")


def _say_unstable(out: Console, path: Path) -> None:
    unstable = [step for step in path.steps if step.negative_pivots]
    if unstable:
        text = f"{len(unstable)} of {len(path.steps) - 1} steps are unstable, the first is step {unstable[0].number}: "
        text += "a real shell leaves the path before it. critical.csv says where it turns or branches"
        say(out, f"warning: {text}", style="yellow")
