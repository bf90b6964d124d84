"""`magshell sweep`."""

from __future__ import annotations

import argparse
import pathlib
import shlex

from magshell.cli.console import complain, console, say
from magshell.cli.folders import made
from magshell.cli.status import INTERRUPTED, NOT_SOLVED, SOLVED
from magshell.errors import InputError

ABOUT = "solve a problem for every combination of values of some of its keys"
EXAMPLES = """
examples:
  magshell sweep strip-10 --set shell.thickness="0.4,0.8 mm" --out sweep
  magshell sweep arm.toml --set field.flux_density="0 mT:50 mT:11" --set shell.thickness="0.4,0.8 mm" --out sweep
  magshell sweep arm.toml --set "remanence[0].magnitude=40 mT:120 mT:5" --set shell.element=quadratic,paper --out sweep
  magshell sweep arm.toml --set mesh.elements="[10, 2],[20, 4]" --out sweep
  magshell sweep --resume sweep                        continue, and solve again what failed
  magshell sweep arm.toml --set ... --out sweep --dask tcp://head:8786

KEY is written as messages write it: shell.thickness, remanence[0].magnitude, stages[0].target.
VALUES are first:last:count, or a list; a number without a unit takes that of the next one that has one. A single
quantity for a vector (field.flux_density, the vector of a remanence, the total of a load) is its magnitude: the
direction stays that of the file, and stops of the field beyond its new end are left out.
DIR receives sweep.csv (a row for each cell, up to date after each), sweep-history.csv (all steps of all cells, at the
end), sweep.png, and cells/0001/ and so on, each a folder of results as of `magshell run`. Ctrl-C keeps what is done;
--resume, or the same command again, goes on from there."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("problem", metavar="FILE|NAME", nargs="?", help="a problem file (.toml) or a built-in problem")
    parser.add_argument("--set", metavar="KEY=VALUES", action="append", default=[], help="values of a key (repeatable)")
    where = parser.add_mutually_exclusive_group(required=True)
    where.add_argument("--out", metavar="DIR", help="folder for the results, made if missing")
    where.add_argument("--resume", metavar="DIR", help="continue the sweep in this folder")
    parser.add_argument("--workers", metavar="N", type=int, help="processes (default: as many as there are cores)")
    parser.add_argument("--dask", metavar="ADDRESS", help="solve on the cluster of this Dask scheduler")


def run(given: argparse.Namespace) -> int:
    """Solve all cells that are not solved yet."""
    from magshell.problem.alternatives import read_settings
    from magshell.problem.reading import find
    from magshell.processes import cores
    from magshell.sweep.display import Display
    from magshell.sweep.executors import DaskWorkers, LocalWorkers
    from magshell.sweep.folder import SweepFolder
    from magshell.sweep.grid import doubts, grid
    from magshell.sweep.picture import draw_sweep
    from magshell.sweep.sweep import sweep

    _check(given)
    folder = SweepFolder(pathlib.Path(given.resume or given.out))
    again = shlex.quote(str(folder.path))
    source, texts = folder.read() if given.resume else (find(given.problem), given.set)
    settings = read_settings(texts)
    out = console()
    display = Display(out)
    with display:
        cells = grid(source, settings, display.checked)
        for doubt in doubts(cells):
            say(out, f"warning: {doubt}", style="yellow")
        for note in dict.fromkeys(cell.note for cell in cells if cell.note):
            say(out, f"note: {note}")
        made(folder.path)
        folder.begin(source, texts)
        workers = DaskWorkers(given.dask, folder.path) if given.dask else LocalWorkers(given.workers or cores())
        try:
            outcomes = sweep(folder, settings, cells, workers, display)
        except KeyboardInterrupt:
            complain(f"interrupted; go on with: magshell sweep --resume {again}")
            return INTERRUPTED
        except OSError:
            complain(f"stopped; go on with: magshell sweep --resume {again}")
            raise
    why_not = draw_sweep(settings, cells, outcomes, folder.picture)
    say(out, f"no picture: {why_not}" if why_not else f"picture: {folder.picture}")
    failed = [cell for cell in cells if not outcomes[cell.number].converged]
    say(out, f"results: {folder.path} (sweep.csv, sweep-history.csv; each cell is a folder of results in cells/)")
    if failed:
        complain(f"{len(failed)} of {len(cells)} cells are not solved; try them again with --resume {again}")
    return NOT_SOLVED if failed else SOLVED


def _check(given: argparse.Namespace) -> None:
    if given.resume and (given.problem or given.set):
        raise InputError("--resume DIR: knows its problem and settings; leave FILE and --set out")
    if given.out and not given.problem:
        raise InputError("FILE|NAME: is missing; name a problem file (.toml) or a built-in problem")
    if given.workers is not None and given.workers < 1:
        raise InputError(f"--workers {given.workers}: must be at least 1")
    if given.workers is not None and given.dask:
        raise InputError("--workers: a cluster has its own workers; leave it out beside --dask")
