"""`magshell show`."""

from __future__ import annotations

import argparse
import pathlib

from magshell.cli.console import complain, console, say, say_doubts
from magshell.cli.folders import made
from magshell.cli.settings import add_settings
from magshell.cli.status import NOT_SOLVED, SOLVED
from magshell.errors import InputError

ABOUT = "draw a problem before it is solved: mesh, remanence, field, supports, loads, probes"
EXAMPLES = """
examples:
  magshell show gripper                             writes gripper-show.png
  magshell show my-arm.toml --out pictures/arm.png
  magshell show my-arm.toml --set remanence[0].magnitude="60 mT"
  magshell show my-flower.toml --template           the shape in which it was magnetised"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("problem", metavar="FILE|NAME", help="a problem file (.toml) or a built-in problem")
    add_settings(parser)
    parser.add_argument("--out", metavar="PICTURE.png", help="the picture (default: NAME-show.png in this folder)")
    parser.add_argument(
        "--template",
        action="store_true",
        help="the part in the shape in which it was magnetised, with what it carries there",
    )


def run(given: argparse.Namespace) -> int:
    """Draw."""
    from magshell.output.rendering import RenderingUnavailable
    from magshell.output.setup import draw_setup
    from magshell.output.style import is_ours
    from magshell.problem import load
    from magshell.problem.alternatives import read_changes
    from magshell.problem.report import describe

    problem = load(given.problem, read_changes(given.set))
    out = console()
    say_doubts(out, describe(problem))
    ending = "template" if given.template else "show"
    file = _picture(given.out or f"{pathlib.Path(problem.source).stem}-{ending}.png")
    if given.out is None and file.is_file() and not is_ours(file):
        raise InputError(
            f"{file}: exists already and was not made by magshell; say --out {file} to replace it, or name another"
        )
    try:
        with out.status("drawing"):
            draw_setup(problem.model, file, problem.title, given.template)
    except RenderingUnavailable as unavailable:
        complain(str(unavailable))
        return NOT_SOLVED
    say(out, f"picture: {file}")
    return SOLVED


def _picture(name: str) -> pathlib.Path:
    """Where the picture goes, its folder made."""
    file = pathlib.Path(name)
    if file.suffix.lower() != ".png" or file.is_dir():
        raise InputError(f"--out {name}: name a picture that ends in .png")
    made(file.parent)
    return file
