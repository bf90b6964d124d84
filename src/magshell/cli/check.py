"""`magshell check`."""

from __future__ import annotations

import argparse

from magshell.cli.console import console, say, say_doubts
from magshell.cli.memory import memory_line
from magshell.cli.settings import add_settings
from magshell.cli.status import SOLVED

ABOUT = "report what was understood of a problem file, without solving"
EXAMPLES = """
examples:
  magshell check gripper
  magshell check my-arm.toml
  magshell check my-arm.toml --set shell.thickness="0.8 mm\""""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("problem", metavar="FILE|NAME", help="a problem file (.toml) or a built-in problem")
    add_settings(parser)


def run(given: argparse.Namespace) -> int:
    """Say what was understood."""
    from magshell.problem import load
    from magshell.problem.alternatives import read_changes
    from magshell.problem.report import describe
    from magshell.solver.memory import memory_free, need_of

    problem = load(given.problem, read_changes(given.set))
    report = describe(problem)
    need = need_of(problem.model, problem.settings.linear_solver)
    report.sections["Mesh"].append(("memory of a solve", memory_line(need.memory, memory_free())))
    out = console()
    width = max(len(label) for lines in report.sections.values() for label, _ in lines)
    for section, lines in report.sections.items():
        say(out, section, style="bold")
        for label, text in lines or [("none", "")]:
            say(out, f"  {label:<{width}}  {text}")
    say_doubts(out, report)
    return SOLVED
