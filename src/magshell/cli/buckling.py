"""`magshell buckling`."""

from __future__ import annotations

import argparse
import pathlib

from magshell.cli.console import complain, console, say, say_doubts, say_picture
from magshell.cli.folders import made
from magshell.cli.settings import add_settings
from magshell.cli.status import NOT_SOLVED, SOLVED
from magshell.units import ANGLE, FLUX_DENSITY, show

ABOUT = "estimate the loads at which a problem buckles, and the modes"
EXAMPLES = """
examples:
  magshell buckling my-plate.toml --out results
  magshell buckling my-plate.toml --modes 8 --out results

The stages before the last one are followed; the multipliers are load factors of the last stage, about the state that
they lead to (with one stage: about the undeformed state). Negative: the loading reversed. They are accurate where the
part turns and strains little before it buckles; both are printed with each.
DIR receives buckling.csv and buckling/ (the modes, for ParaView and as pictures)."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("problem", metavar="FILE|NAME", help="a problem file (.toml) or a built-in problem")
    add_settings(parser)
    parser.add_argument("--out", metavar="DIR", required=True, help="folder for the results, made if missing")
    parser.add_argument("--modes", metavar="N", type=int, default=4, help="how many modes (default: 4)")


def run(given: argparse.Namespace) -> int:
    """Estimate, and write the modes."""
    from magshell.output.buckling import require_free, write_buckling
    from magshell.problem import load
    from magshell.problem.alternatives import read_changes
    from magshell.problem.report import describe
    from magshell.progress import ProgressDisplay
    from magshell.solver.buckling import buckling
    from magshell.solver.path import SolveError

    problem = load(given.problem, read_changes(given.set))
    out = console()
    say(out, problem.title)
    say_doubts(out, describe(problem))
    directory = made(pathlib.Path(given.out))
    require_free(directory)
    progress = ProgressDisplay(out)
    try:
        with progress:
            found = buckling(problem.model, given.modes, problem.settings, [progress])
    except SolveError as error:
        complain(f"{problem.source}: not solved: {error.reason}")
        return NOT_SOLVED
    if not found.modes and not found.doubts:
        say(out, "no real multipliers: the loading does not make the tangent singular")
    for mode in found.modes:
        magnitude = sum(component**2 for component in mode.flux_density.tolist()) ** 0.5
        field = f" ({show(magnitude, FLUX_DENSITY)})" if magnitude else ""
        before = f"rotation before it {show(mode.rotation, ANGLE)}, strain {100.0 * mode.strain:.2g} %"
        say(out, f"mode {mode.number}: load factor {mode.load_factor:.6g}{field}; {before}")
    for doubt in found.doubts:
        say(out, f"warning: {doubt}", style="yellow")
    for picture in write_buckling(found, directory):
        say_picture(out, picture)
    say(out, f"results: {directory} (buckling.csv; buckling/ opens in ParaView)")
    return SOLVED
