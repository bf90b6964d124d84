"""`magshell export`."""

from __future__ import annotations

import argparse
import pathlib

from magshell.cli.console import console, say
from magshell.cli.folders import made
from magshell.cli.status import SOLVED
from magshell.errors import InputError

ABOUT = "write the deformed body with its true thickness, for printers, CAD and other solvers"
EXAMPLES = """
examples:
  magshell export results --out body.stl               the last step
  magshell export results --out body.vtu --step 5

.stl is a closed surface of flat triangles, binary, in mm: for slicers and CAD. .vtu holds solid elements of second
order, hexahedra of 20 nodes and wedges of 15, in m, with the outputs of the mid-surface: for ParaView
and other solvers. Stresses and strains of the faces are in DIR/steps.
A run that was interrupted, or that is still going on, is exported as far as it got."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("directory", metavar="DIR", help="a folder that magshell run has written")
    parser.add_argument("--out", metavar="FILE", required=True, help="the file to write: .stl or .vtu")
    parser.add_argument("--step", metavar="N", default="-1", help="number of the step, negative from the end")


def run(given: argparse.Namespace) -> int:
    """Export."""
    from magshell.files import with_suffix
    from magshell.output.solid.export import STL, VTU, write_solid
    from magshell.results import read

    target = with_suffix(given.out, STL, VTU)
    path = read(given.directory).path
    step, count = _number(given.step), len(path.steps)
    if not -count <= step < count:
        raise InputError(f"--step {given.step}: there is no such step; the path has steps 0 to {count - 1}")
    made(pathlib.Path(target).parent)
    out = console()
    with out.status("making the solid"):
        written = write_solid(path, target, step)
    parts = f"{written.cells} {'triangles, mm' if target.suffix.lower() == STL else 'solid elements, m'}"
    say(out, f"solid: {written.file}, step {written.step} ({1e9 * written.volume:.6g} mm^3, {parts})")
    return SOLVED


def _number(text: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise InputError(f"--step {text}: is not a number of a step") from None
