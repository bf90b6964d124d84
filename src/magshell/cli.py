"""The command `magshell`: solve, check and list problems. The words are here, the work is elsewhere."""

from __future__ import annotations

import argparse
import os
import pathlib
import sys
from collections.abc import Sequence
from importlib.metadata import version
from typing import TYPE_CHECKING

from magshell.errors import InputError, SolveError
from magshell.units import FLUX_DENSITY, LENGTH, show

if TYPE_CHECKING:
    from rich.console import Console

    from magshell.problem.report import Report
    from magshell.solver import Path

SOLVED, NOT_SOLVED, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130

_AT_THE_END = ("summary.json", "curve.png", "shape.png")

_EXAMPLES = {
    "magshell": """
examples:
  magshell examples                       list the built-in problems
  magshell run strip-10 --out results     solve one of them
  magshell examples --copy gripper        copy one to change it
  magshell check gripper.toml             see what was understood, without solving
  magshell run gripper.toml --out results
  magshell buckling my-plate.toml --out results
  magshell reproduce --out reproduction   the source paper's examples beside what it says

exit status: 0 solved, 1 not solved, 2 bad input, 130 interrupted""",
    "run": """
examples:
  magshell run strip-10 --out results
  magshell run my-arm.toml --out results/my-arm

DIR receives history.csv (the curves), shell.pvd and steps/ (for ParaView), summary.json and the pictures, and where
the path turns or branches critical.csv and critical/ (the modes).
Every converged step is on disk at once: Ctrl-C keeps them.""",
    "buckling": """
examples:
  magshell buckling my-plate.toml --out results
  magshell buckling my-plate.toml --modes 8 --out results

The stages before the last one are followed; the multipliers are load factors of the last stage, about the state that
they lead to (with one stage: about the undeformed state). Negative: the loading reversed.
DIR receives buckling.csv and buckling/ (the modes, for ParaView and as pictures).""",
    "check": """
examples:
  magshell check gripper
  magshell check my-arm.toml""",
    "reproduce": """
examples:
  magshell reproduce --out reproduction
  magshell reproduce gripper strips --out reproduction

NAME is one of strips, hollow-cross, thin-cross, h-shape, pump, gripper.
DIR receives reproduction.csv, index.html (one page with everything, for a browser) and the figures.
Each example is on disk as soon as it is solved: Ctrl-C keeps those that are done.""",
    "examples": """
examples:
  magshell examples
  magshell examples --copy gripper              writes gripper.toml
  magshell examples --copy gripper my-arm.toml""",
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command.

    Parameters
    ----------
    arguments : sequence of str, optional
        What follows `magshell` on the command line.

    Returns
    -------
    int
        0 solved, 1 not solved, 2 bad input, 130 interrupted.
    """
    given = _parser().parse_args(arguments)
    try:
        return int(given.command(given))
    except InputError as error:
        _complain(str(error))
        return BAD_INPUT
    except KeyboardInterrupt:
        _complain("interrupted")
        return INTERRUPTED
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return NOT_SOLVED
    except OSError as error:
        _complain(f"{error.filename or 'a file'}: {error.strerror or error}")
        return NOT_SOLVED
    except Exception as error:
        if given.debug:
            raise
        _complain(
            f"this is a bug in magshell: {type(error).__name__}: {error}. "
            "Please report it with the traceback that --debug shows."
        )
        return NOT_SOLVED


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="magshell",
        description="Thin structures of hard-magnetic soft material in a magnetic field.",
        epilog=_EXAMPLES["magshell"],
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"magshell {version('magshell')}")
    parser.set_defaults(debug=False)
    common = argparse.ArgumentParser(add_help=False)
    common.add_argument(
        "--debug",
        action="store_true",
        default=argparse.SUPPRESS,
        help="show the traceback of an unexpected error",
    )
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    for name, command, about in (
        ("run", _run, "solve a problem and write the results"),
        ("buckling", _buckling, "estimate the loads at which a problem buckles, and the modes"),
        ("check", _check, "say what a problem file means, without solving"),
        ("examples", _examples, "list the built-in problems, or copy one"),
        ("reproduce", _reproduce, "solve the examples of the source paper and compare with it"),
    ):
        one = commands.add_parser(
            name,
            parents=[common],
            help=about,
            description=f"{about[0].upper()}{about[1:]}.",
            epilog=_EXAMPLES[name],
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        one.set_defaults(command=command)
        if name in ("run", "buckling", "check"):
            one.add_argument("problem", metavar="FILE|NAME", help="a problem file (.toml) or a built-in problem")
        if name == "reproduce":
            one.add_argument("names", metavar="NAME", nargs="*", help="an example of the paper; all six without it")
        if name in ("run", "buckling", "reproduce"):
            one.add_argument("--out", metavar="DIR", required=True, help="folder for the results, made if missing")
        if name == "buckling":
            one.add_argument("--modes", metavar="N", type=int, default=4, help="how many modes (default: 4)")
        if name == "examples":
            one.add_argument("--copy", metavar="NAME", help="write the problem file of NAME to DEST")
            one.add_argument("dest", metavar="DEST", nargs="?", help="a file or folder; here, without it")
    return parser


def _run(given: argparse.Namespace) -> int:
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
    console = _console()
    _say(console, problem.title)
    _say_doubts(console, describe(problem))
    directory = _made(pathlib.Path(given.out))
    _forget_earlier_run(console, directory)
    progress = ProgressDisplay(console)
    observers = [HistoryWriter(directory), VtuWriter(directory), CriticalWriter(directory), progress]
    try:
        with progress:
            path = solve(problem.model, problem.settings, observers)
    except SolveError as error:
        path = error.path
        _complain(f"{problem.source}: not solved: {error.reason}")
    except KeyboardInterrupt:
        if progress.path is None or not progress.path.steps:
            raise
        write_summary(progress.path, directory, reason="interrupted")
        kept = len(progress.path.steps) - 1
        _complain(f"{problem.source}: interrupted; the {kept} steps that converged are in {directory}")
        return INTERRUPTED
    write_summary(path, directory)
    for name in problem.file.probes:
        u = path.probe(name).u[-1]
        noise = 1e-9 * max(map(abs, u))
        _say(console, f"{name}: u = ({', '.join(show(x if abs(x) > noise else 0.0, LENGTH) for x in u)})")
    _say_unstable(console, path)
    for picture in draw_pictures(path, directory):
        _say(console, f"picture: {picture}" if isinstance(picture, pathlib.Path) else picture)
    _say(console, f"results: {directory} (history.csv, summary.json; shell.pvd opens in ParaView)")
    return SOLVED if path.converged else NOT_SOLVED


def _buckling(given: argparse.Namespace) -> int:
    from magshell.output.buckling import write_buckling
    from magshell.problem import load
    from magshell.problem.report import describe
    from magshell.progress import ProgressDisplay
    from magshell.solver.buckling import buckling

    problem = load(given.problem)
    console = _console()
    _say(console, problem.title)
    _say_doubts(console, describe(problem))
    directory = _made(pathlib.Path(given.out))
    progress = ProgressDisplay(console)
    try:
        with progress:
            found = buckling(problem.model, given.modes, problem.settings, [progress])
    except SolveError as error:
        _complain(f"{problem.source}: not solved: {error.reason}")
        return NOT_SOLVED
    if not found.modes:
        _say(console, "no real multipliers: the loading does not make the tangent singular")
    for mode in found.modes:
        magnitude = sum(component**2 for component in mode.flux_density.tolist()) ** 0.5
        field = f" ({show(magnitude, FLUX_DENSITY)})" if magnitude else ""
        _say(console, f"mode {mode.number}: load factor {mode.load_factor:.6g}{field}")
    for picture in write_buckling(found, directory):
        _say(console, f"picture: {picture}")
    _say(console, f"results: {directory} (buckling.csv; buckling/ opens in ParaView)")
    return SOLVED


def _reproduce(given: argparse.Namespace) -> int:
    from magshell.reproduction.catalogue import find
    from magshell.reproduction.reproduce import reproduce

    find(given.names)
    console = _console()
    directory = _made(pathlib.Path(given.out))
    try:
        result = reproduce(given.names, directory, console)
    except KeyboardInterrupt:
        _complain(f"interrupted; the examples that are done are in {directory}")
        return INTERRUPTED
    _say(console, f"results: {directory} (reproduction.csv, the figures; index.html opens in a browser)")
    if result.failed:
        _complain(f"not solved: {', '.join(result.failed)}; the reasons are in {directory / 'reproduction.csv'}")
    return NOT_SOLVED if result.failed else SOLVED


def _made(directory: pathlib.Path) -> pathlib.Path:
    """The folder for the results, there and writable."""
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError):
        raise InputError(f"--out {directory}: is a file, or lies below one; name a folder") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"--out {directory}: cannot be made: {reason}") from None
    if not os.access(directory, os.W_OK | os.X_OK):
        raise InputError(f"--out {directory}: is not writable; name another folder")
    return directory


def _forget_earlier_run(console: Console, directory: pathlib.Path) -> None:
    """Remove what only the end of a run writes, so that no run leaves the end of another; say so."""
    earlier = [file for name in _AT_THE_END if (file := directory / name).exists()]
    for file in earlier:
        file.unlink()
    if earlier:
        _say(console, f"the results of an earlier run in {directory} are replaced", style="yellow")


def _check(given: argparse.Namespace) -> int:
    from magshell.problem import load
    from magshell.problem.report import describe

    report = describe(load(given.problem))
    console = _console()
    width = max(len(label) for lines in report.sections.values() for label, _ in lines)
    for section, lines in report.sections.items():
        _say(console, section, style="bold")
        for label, text in lines or [("none", "")]:
            _say(console, f"  {label:<{width}}  {text}")
    _say_doubts(console, report)
    return SOLVED


def _examples(given: argparse.Namespace) -> int:
    from magshell.problem import examples, read

    console = _console()
    if given.copy is None and given.dest is not None:
        raise InputError(f"examples: '{given.dest}' is where to copy to, but --copy NAME says nothing to copy")
    if given.copy is None:
        width = max(map(len, examples.names()))
        for name in examples.names():
            _say(console, f"{name:<{width}}  {read(name)[1].title}")
        return SOLVED
    content = examples.text(given.copy)
    target = pathlib.Path(given.dest or ".")
    if target.is_dir():
        target /= f"{given.copy}.toml"
    try:
        with target.open("x", encoding="utf-8") as file:
            file.write(content)
    except FileExistsError:
        raise InputError(f"{target}: exists already and is left as it is; name another file") from None
    except OSError as error:
        raise InputError(f"{target}: cannot be written: {error.strerror}") from None
    _say(console, f"{target} written; solve it with: magshell run {target} --out results")
    return SOLVED


def _console(stderr: bool = False) -> Console:
    from rich.console import Console

    return Console(stderr=stderr, highlight=False, markup=False, emoji=False)


def _say(console: Console, text: str, style: str | None = None) -> None:
    console.print(text, style=style, soft_wrap=True)


def _say_doubts(console: Console, report: Report) -> None:
    for doubt in report.warnings:
        _say(console, f"warning: {doubt}", style="yellow")


def _say_unstable(console: Console, path: Path) -> None:
    unstable = [step for step in path.steps if step.negative_pivots]
    if unstable:
        text = f"{len(unstable)} of {len(path.steps) - 1} steps are unstable, the first is step {unstable[0].number}: "
        text += "a real shell leaves the path before it. critical.csv says where it turns or branches"
        _say(console, f"warning: {text}", style="yellow")


def _complain(text: str) -> None:
    console = _console(stderr=True)
    for line in text.splitlines():
        _say(console, f"error: {line}", style="red")
