"""`magshell examples`."""

from __future__ import annotations

import argparse
import pathlib

from magshell.cli.console import console, say
from magshell.cli.status import SOLVED
from magshell.errors import InputError

ABOUT = "list the built-in problems, or copy one"
EXAMPLES = """
examples:
  magshell examples
  magshell examples --copy gripper              writes gripper.toml
  magshell examples --copy gripper my-arm.toml"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("--copy", metavar="NAME", help="write the problem file of NAME to DEST")
    parser.add_argument("dest", metavar="DEST", nargs="?", help="a file or folder (default: this folder)")


def run(given: argparse.Namespace) -> int:
    """List, or copy."""
    from magshell.problem import examples
    from magshell.problem.reading import parse

    out = console()
    if given.copy is None and given.dest is not None:
        raise InputError(f"examples: '{given.dest}' is where to copy to, but what to copy is missing: --copy NAME")
    if given.copy is None:
        width = max(map(len, examples.names()))
        for name in examples.names():
            say(out, f"{name:<{width}}  {parse(examples.text(name), name).get('title', '')}")
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
    say(out, f"{target} written; solve it with: magshell run {target} --out results")
    return SOLVED
