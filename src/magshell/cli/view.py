"""`magshell view`."""

from __future__ import annotations

import argparse
import pathlib

from magshell.cli.console import console, say
from magshell.cli.status import SOLVED
from magshell.cli.work import bar

ABOUT = "write a results folder as one page for a browser"
EXAMPLES = """
examples:
  magshell view results                              writes results/view.html
  magshell view results --out gripper.html
  magshell view results --color thickness_ratio

The page shows the deformed shape in three dimensions (drag to rotate, wheel to zoom, drag with the right button or with
shift to pan; two fingers on a touch screen), a slider over the steps (arrow keys, space to play), every output as a
colour, the value under the pointer, the probes, and their curves over the field, its angle or the load factor (click a
mark to go to its step). It saves pictures, the solid body and history.csv. It needs no network and no other file: send
it to anybody. A run that was interrupted, or that is still going on, is shown as far as it got."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("directory", metavar="DIR", help="a folder that magshell run has written")
    parser.add_argument("--out", metavar="FILE", help="the page (default: DIR/view.html)")
    parser.add_argument("--color", metavar="OUTPUT", default="u3", help="what colours the shape at first (default: u3)")


def run(given: argparse.Namespace) -> int:
    """Write the page."""
    from magshell.evaluation.outputs import find
    from magshell.output.page import shown_steps, write_page
    from magshell.results import read

    find(given.color)
    found = read(given.directory)
    out = console()
    file = pathlib.Path(given.out or pathlib.Path(given.directory) / "view.html")
    shown, last = len(shown_steps(found.path)), len(found.path.steps) - 1
    with bar(out, "collecting the outputs of every step") as advance:
        write_page(found.path, file, found.title, given.color, advance=advance)
    say(out, f"page: {file} ({file.stat().st_size / 1e6:.2g} MB, {last} steps); open it in a browser")
    if shown <= last:
        text = f"shows {shown} of the steps 0 to {last}, spread evenly: all would be too much for a browser"
        say(out, f"warning: the page {text}", style="yellow")
    return SOLVED
