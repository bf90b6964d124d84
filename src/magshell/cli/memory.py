"""Messages on the memory that a solve needs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from magshell.cli.console import say

if TYPE_CHECKING:
    from rich.console import Console

    from magshell.problem.building import Problem

# With fewer elements a solve needs well below a gigabyte.
FEW_ELEMENTS = 500
# From so many bytes on, or from this share of the free memory, a run says it.
MUCH, SHARE = 1e9, 0.25


def memory_line(needed: float, free: float | None) -> str:
    """The memory that a solve needs, and what is free."""
    return f"about {_shown(needed)}" + (f"; {_shown(free)} are free" if free is not None else "")


def say_memory(on: Console, problem: Problem) -> None:
    """The need of a large solve; warnings where it will fail."""
    from magshell.linalg.superlu import MOST_ENTRIES
    from magshell.solver.memory import memory_free, need_of

    if len(problem.model.shell.mesh.elements) < FEW_ELEMENTS:
        return
    need, free = need_of(problem.model, problem.settings.linear_solver), memory_free()
    if problem.settings.linear_solver == "superlu" and need.tangent > MOST_ENTRIES:
        tangent, most = (f"{entries / 1e6:.1f} million" for entries in (need.tangent, MOST_ENTRIES))
        text = (
            f"the tangent has {tangent} entries; SuperLU takes up to {most}: the solve will fail; take fewer elements"
        )
        say(on, f'warning: {text} or solver.linear_solver = "multifrontal"', style="yellow")
    line = f"memory: {memory_line(need.memory, free)}"
    if free is not None and need.memory > free:
        say(on, f"warning: {line}: the solve may be killed; take fewer elements or a larger machine", style="yellow")
    elif need.memory > MUCH or (free is not None and need.memory > SHARE * free):
        say(on, line)


def _shown(size: float) -> str:
    return f"{size / 1e9:.2g} GB" if size < 10e9 else f"{size / 1e9:.0f} GB"
