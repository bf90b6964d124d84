"""Parses the command line of `magshell`; each command is a module."""

from __future__ import annotations

import argparse
import logging
import os
import sys
from collections.abc import Sequence
from importlib.metadata import version

from magshell.cli import buckling, check, examples, export, mesh, plot, reproduce, run, show, sweep, view
from magshell.cli.console import complain, console, say
from magshell.cli.letters import write_readably
from magshell.cli.status import BAD_INPUT, INTERRUPTED, NOT_SOLVED
from magshell.errors import InputError, lacks_memory
from magshell.kernel_messages import KernelMessages
from magshell.openblas import allocate_buffers, is_limited

COMMANDS = {
    "run": run,
    "buckling": buckling,
    "check": check,
    "show": show,
    "examples": examples,
    "mesh": mesh,
    "sweep": sweep,
    "plot": plot,
    "view": view,
    "export": export,
    "reproduce": reproduce,
}

NO_MEMORY = "there is not enough memory on this machine; fewer elements need less"
EXAMPLES = """
examples:
  magshell examples                       list the built-in problems
  magshell run strip-10 --out results     solve one of them
  magshell examples --copy gripper        copy one to change it
  magshell check gripper.toml             report what was understood, without solving
  magshell show gripper.toml              draw it: mesh, remanence, field, supports
  magshell run gripper.toml --out results
  magshell mesh part.step --size "0.5 mm" mesh a geometry, or say what a mesh file holds
  magshell view results                   the results as a page for a browser
  magshell plot results --animate shape.gif
  magshell export results --out body.stl  the deformed body as a solid
  magshell sweep strip-10 --set shell.thickness="0.8,1.1 mm" --out sweep
  magshell buckling my-plate.toml --out results
  magshell reproduce --out reproduction   the source paper's examples, compared with its numbers

exit status: 0 solved, 1 not solved, 2 bad input, 130 interrupted"""


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
    write_readably()
    given = _parser().parse_args(arguments)
    # Commands say themselves what is doubtful.
    for part in ("magshell.model", "magshell.problem"):
        logging.getLogger(part).addHandler(logging.NullHandler())
    kernels = KernelMessages(_say)
    kernels.listen()
    try:
        allocate_buffers()
        return int(given.command(given))
    except InputError as error:
        complain(str(error))
        return BAD_INPUT
    except KeyboardInterrupt:
        complain("interrupted")
        return INTERRUPTED
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return NOT_SOLVED
    except OSError as error:
        if lacks_memory(error):
            complain(NO_MEMORY)
            return NOT_SOLVED
        complain(f"{error.filename or 'a file'}: {error.strerror or error}")
        return NOT_SOLVED
    except Exception as error:
        # C code that got no memory may fail without saying why, which Python reports as a SystemError.
        if lacks_memory(error) or (isinstance(error, SystemError) and is_limited()):
            complain(NO_MEMORY)
            return NOT_SOLVED
        if given.debug:
            raise
        complain(
            f"this is a bug in magshell: {type(error).__name__}: {error}. "
            "Please report it with the traceback that --debug shows."
        )
        return NOT_SOLVED
    finally:
        kernels.stop()


def _say(text: str, style: str | None = None) -> None:
    say(console(), text, style)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="magshell",
        description="Thin structures of hard-magnetic soft material in a magnetic field.",
        epilog=EXAMPLES,
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
    for name, command in COMMANDS.items():
        one = commands.add_parser(
            name,
            parents=[common],
            help=command.ABOUT,
            description=f"{command.ABOUT[0].upper()}{command.ABOUT[1:]}.",
            epilog=command.EXAMPLES,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        one.set_defaults(command=command.run)
        command.add_arguments(one)
    return parser
