"""`magshell run`."""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import pathlib
import shlex
import signal
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

from magshell.cli.console import complain, console, say, say_doubts, say_picture
from magshell.cli.folders import made
from magshell.cli.memory import say_memory
from magshell.cli.mesh import say_origin
from magshell.cli.settings import add_settings
from magshell.cli.status import INTERRUPTED, NOT_SOLVED, SOLVED
from magshell.errors import InputError, lacks_memory
from magshell.units import LENGTH, show

if TYPE_CHECKING:
    from types import FrameType

    from rich.console import Console

    from magshell.problem.building import Problem
    from magshell.solver import Observer, Path

_AT_THE_END = ("summary.json", "curve.png", "shape.png")

ABOUT = "solve a problem and write the results"
EXAMPLES = """
examples:
  magshell run strip-10 --out results
  magshell run my-arm.toml --out results/my-arm
  magshell run my-arm.toml --set shell.thickness="0.8 mm" --set field.flux_density="20 mT" --out results/thin
  magshell run --resume results/my-arm

DIR receives history.csv (the curves), shell.pvd and steps/ (for ParaView), summary.json and the pictures, and where
the path turns or branches critical.csv and critical/ (the modes).
Every converged step is on disk at once; checkpoint/ has all that is needed to continue. After Ctrl-C, a full disk or a
kill, --resume continues from the last one, with the same numbers as a run that was never stopped."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("problem", metavar="FILE|NAME", nargs="?", help="a problem file (.toml) or a built-in problem")
    add_settings(parser)
    folder = parser.add_mutually_exclusive_group(required=True)
    folder.add_argument("--out", metavar="DIR", help="folder for the results, made if missing")
    folder.add_argument("--resume", metavar="DIR", help="continue the run in this folder (without FILE)")


def run(given: argparse.Namespace) -> int:
    """Solve, and write the results."""
    from magshell.files import remove_temporaries
    from magshell.output.lock import alone
    from magshell.results import is_one, require_free, require_no_sweep

    problem = None
    if given.resume is not None:
        if given.problem is not None or given.set:
            raise InputError(
                "run: --resume takes the problem from its folder; give FILE and --set with --out, or --resume alone"
            )
        directory = pathlib.Path(given.resume)
        if not directory.is_dir():
            raise InputError(f"--resume {directory}: is not a folder; name one that `magshell run --out` made")
        if not os.path.lexists(directory / "problem.toml"):
            found = "has a path.pickle, which goes on in Python: ms.resume(ms.results.read(…, own=True).path)"
            if not (directory / "path.pickle").is_file():
                found = "is not a results folder; one that `magshell run --out` made has a problem.toml"
            raise InputError(f"--resume {directory}: {found}")
        if not os.access(directory, os.W_OK | os.X_OK):
            raise InputError(f"--resume {directory}: is not writable; copy the folder and go on in the copy")
    elif given.problem is None:
        raise InputError("run: name a problem file or a built-in problem (magshell examples lists them)")
    else:
        from magshell.problem import load
        from magshell.problem.alternatives import read_changes

        problem = load(given.problem, read_changes(given.set))
        directory = made(pathlib.Path(given.out))
    require_no_sweep(directory)
    if problem is not None:
        require_free(problem, directory)
    with alone(directory), _terminating():
        if is_one(directory):
            remove_temporaries(directory)
        return _resumed(directory) if problem is None else _new(problem, directory)


def _new(problem: Problem, directory: pathlib.Path) -> int:
    """A run from the undeformed state."""
    from magshell import results
    from magshell.problem.report import describe
    from magshell.solver import solve

    out = console()
    say(out, problem.title)
    say_origin(out, problem.model.shell.mesh)
    say_doubts(out, describe(problem))
    say_memory(out, problem)
    _forget_earlier_run(out, directory)
    results.make(problem, directory)
    return _follow(out, problem, directory, lambda observers: solve(problem.model, problem.settings, observers))


def _resumed(directory: pathlib.Path) -> int:
    """A run from the last step of an earlier one."""
    from magshell import results
    from magshell.problem import load
    from magshell.solver import resume

    if not results.begun(directory) and (directory / results.PROBLEM).is_file():
        return _new(load(directory / results.PROBLEM), directory)
    found = results.read(directory)
    out, path = console(), found.path
    assert found.problem is not None
    say(out, found.title)
    if path.converged and _is_complete(directory):
        say(out, f"this run is finished: all {len(path.steps) - 1} steps and their files are in {directory}")
        return SOLVED
    for note in () if path.converged else found.notes:
        say(out, f"warning: {note}: the steps from here are not those of a run that was never stopped", style="yellow")
    return _follow(out, found.problem, directory, lambda observers: resume(path, observers))


def _follow(
    out: Console, problem: Problem, directory: pathlib.Path, followed: Callable[[Sequence[Observer]], Path]
) -> int:
    """Follow the path while the folder's files are written, then write those of the end of a run."""
    from magshell.output.checkpoint import step_files
    from magshell.output.pictures import draw_pictures
    from magshell.output.summary import write_summary
    from magshell.progress import ProgressDisplay
    from magshell.results import writers
    from magshell.solver.path import SolveError

    progress = ProgressDisplay(out)
    try:
        with progress:
            path = followed([*writers(problem, directory), progress])
    except SolveError as error:
        path = error.path
        complain(f"{problem.source}: not solved: {error.reason}")
    except BrokenPipeError:
        raise
    except (KeyboardInterrupt, OSError, MemoryError, ImportError, RuntimeError) as stop:
        kept = len(step_files(directory)) - 1
        if not isinstance(stop, (KeyboardInterrupt, OSError)) and not lacks_memory(stop):
            raise
        if lacks_memory(stop) and kept < 0:
            complain(f"{problem.source}: {_reason(stop)}")
            return NOT_SOLVED
        if progress.path is None or kept < 0:
            raise
        reason = _reason(stop)
        with contextlib.suppress(OSError):
            write_summary(progress.path, directory, reason)
        complain(f"{problem.source}: {reason}; the {kept} steps that converged are in {directory}")
        complain(f"go on with: magshell run --resume {shlex.quote(str(directory))}")
        return INTERRUPTED if isinstance(stop, KeyboardInterrupt) else NOT_SOLVED
    write_summary(path, directory)
    for name in problem.file.probes:
        u = path.probe(name).u
        noise = 1e-9 * abs(u).max()
        say(out, f"{name}: u = ({', '.join(show(x if abs(x) > noise else 0.0, LENGTH) for x in u[-1])})")
    _say_unstable(out, path)
    _say_still(out, path)
    for picture in draw_pictures(path, directory):
        say_picture(out, picture)
    say(out, f"results: {directory} (history.csv, summary.json; shell.pvd opens in ParaView)")
    return SOLVED if path.converged else NOT_SOLVED


class _Terminated(KeyboardInterrupt):
    """SIGTERM, which a cluster sends some time before it kills."""


@contextlib.contextmanager
def _terminating() -> Iterator[None]:
    """Treat SIGTERM as Ctrl-C, where signals can be handled."""

    def raise_it(number: int, frame: FrameType | None) -> None:
        raise _Terminated

    try:
        before = signal.signal(signal.SIGTERM, raise_it)
    except ValueError:
        yield
        return
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _reason(stop: BaseException) -> str:
    """What stopped a run."""
    if lacks_memory(stop):
        return "there is not enough memory"
    if isinstance(stop, OSError):
        return f"{stop.filename or 'a file'}: {stop.strerror or stop}"
    return "terminated" if isinstance(stop, _Terminated) else "interrupted"


def _is_complete(directory: pathlib.Path) -> bool:
    """Whether a run has also written its last files."""
    from magshell.files import read_at_most
    from magshell.output.summary import MOST_BYTES

    try:
        converged = json.loads(read_at_most(directory / "summary.json", MOST_BYTES))["converged"]
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return False
    return bool(converged) and all((directory / name).exists() for name in _AT_THE_END)


def _forget_earlier_run(out: Console, directory: pathlib.Path) -> None:
    """Remove the files that the end of an earlier run has written, and say so."""
    from magshell.results import begun

    earlier = [file for name in _AT_THE_END if (file := directory / name).exists()]
    for file in earlier:
        file.unlink()
    if earlier or begun(directory):
        say(out, f"the results of an earlier run in {directory} are replaced", style="yellow")


def _say_still(out: Console, path: Path) -> None:
    """Warn if a path that reached its end has moved nothing."""
    from magshell.output.rounding import STILL

    size = path.model.shell.mesh.size
    largest = max(float(abs(step.state.u).max()) for step in path.steps)
    if path.converged and largest <= STILL * size:
        text = f"nothing moved: the largest displacement of all steps is {show(largest, LENGTH)}"
        text += f", {largest / size:.1g} of the body" if largest else ""
        text += ". Check the supports, the units, and whether field or loads act where something can give way"
        say(out, f"warning: {text}", style="yellow")


def _say_unstable(out: Console, path: Path) -> None:
    unstable = [step for step in path.steps if step.negative_pivots]
    if unstable:
        text = f"{len(unstable)} of {len(path.steps) - 1} steps are unstable, the first is step {unstable[0].number}: "
        text += "a real shell leaves the path before it. critical.csv says where it turns or branches"
        say(out, f"warning: {text}", style="yellow")
