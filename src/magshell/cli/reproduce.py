"""`magshell reproduce`."""

from __future__ import annotations

import argparse
import pathlib

from magshell.cli.console import complain, console, say
from magshell.cli.folders import made
from magshell.cli.status import INTERRUPTED, NOT_SOLVED, SOLVED

ABOUT = "solve the examples of the source paper and compare them with its numbers"
EXAMPLES = """
examples:
  magshell reproduce --out reproduction
  magshell reproduce gripper strips --out reproduction

NAME is one of strips, hollow-cross, thin-cross, h-shape, pump, gripper.
DIR receives reproduction.csv, index.html (one page with everything, for a browser) and the figures.
Each example is on disk as soon as it is solved: Ctrl-C keeps those that are done."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("names", metavar="NAME", nargs="*", help="an example of the paper (default: all six)")
    parser.add_argument("--out", metavar="DIR", required=True, help="folder for the results, made if missing")


def run(given: argparse.Namespace) -> int:
    """Solve and compare."""
    from magshell.reproduction.catalogue import find
    from magshell.reproduction.reproduce import reproduce

    find(given.names)
    out = console()
    directory = made(pathlib.Path(given.out))
    try:
        result = reproduce(given.names, directory, out)
    except KeyboardInterrupt:
        complain(f"interrupted; the examples that are done are in {directory}")
        return INTERRUPTED
    say(out, f"results: {directory} (reproduction.csv, the figures; index.html opens in a browser)")
    if result.failed:
        complain(f"not solved: {', '.join(result.failed)}; the reasons are in {directory / 'reproduction.csv'}")
    return NOT_SOLVED if result.failed else SOLVED
